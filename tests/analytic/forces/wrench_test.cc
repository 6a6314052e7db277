// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/forces/wrench.h"

#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/special_functions/bessel.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "analytic/rod/field_models.h"
#include "problem/error.h"
#include "problem/lagrange.h"
#include "problem/surroundings/magnets/field.h"
#include "tests/analytic/oracles/bent_rods.h"
#include "tests/analytic/oracles/cylinder_body.h"

namespace ciliaval::analytic::forces {
namespace {

using oracle::contorted;
using oracle::paper_cilium;
using oracle::record;
using oracle::relative_difference;
using oracle::sampled;
using surroundings::magnets::dipole_jet;
using surroundings::magnets::jet;
using surroundings::magnets::Magnet;
using surroundings::magnets::Shape;

Magnet magnet(Shape shape) {
  const Quaternion turn(Eigen::AngleAxisd(0.7, Vector3(1, 2, 3).normalized()));
  const Vector3 M = shape == Shape::cylinder ? Vector3(0, 0, 8e5) : Vector3(1e5, -2e5, 8e5);
  return {"test", shape, {12e-3, -7e-3, 15e-3}, turn, 6e-3, 4e-3, {4e-3, 5e-3, 7e-3}, M};
}

const std::vector<Shape> shapes{Shape::ball, Shape::cylinder, Shape::cuboid};

/// ∫₀^∞ J₁(a k) J₁(b k)/k e^{−z k} dk
double bessel_integral(double a, double b, double z) {
  const auto integrand = [&](double k) {
    if (k == 0) return 0.0;
    return boost::math::cyl_bessel_j(1, a * k) * boost::math::cyl_bessel_j(1, b * k) / k *
           std::exp(-z * k);
  };
  double sum = 0;
  for (int i = 0; i < 45; ++i)  // the last panel's factor is e⁻⁴⁴
    sum += boost::math::quadrature::gauss_kronrod<double, 61>::integrate(integrand, i / z,
                                                                         (i + 1) / z, 0);
  return sum;
}

// Oracle: two coaxial discs of charges σ, σ' repel each other by μ₀σσ'πab ∫J₁(ak)J₁(bk)/k
// e^{−zk}dk, of which four make two cylinders (Vokoun, Beleggia, Heller, Šittner, J. Magn. Magn.
// Mater. 321, 3758, 2009, Eq. 6 for a = b).
TEST(Wrench, OfCoaxialCylindersIsTheBesselIntegral) {
  const Cilium cilium = paper_cilium();
  double error = 0;
  for (const double radius : {1.5e-3, 4e-3})
    for (const double gap : {1e-3, 5e-3, 40e-3}) {
      Magnet above;
      above.shape = Shape::cylinder;
      above.diameter = 2 * radius;
      above.length = 6e-3;
      above.position = {0, 0, 20e-3 + gap + 3e-3};
      above.magnetization = {0, 0, 5e5};
      double expected = 0;  // on the magnet above, along z
      for (const double lower : {3e-3, 20e-3})
        for (const double upper : {20e-3 + gap, 26e-3 + gap}) {
          const double charges =
              (lower > 4e-3 ? 75e3 : -75e3) * (upper > 20.5e-3 + gap ? 5e5 : -5e5);
          expected += vacuum_permeability * charges * std::numbers::pi * 1.5e-3 * radius *
                      bessel_integral(1.5e-3, radius, upper - lower);
        }
      const Wrench on_magnet = wrench_on_magnet(cilium, oracle::straight(cilium), above);
      const Wrench on_cilium = wrench_on_cilium(cilium, oracle::straight(cilium), {above});
      EXPECT_LT(expected, 0);  // unlike poles face each other
      error = std::max({error, relative_difference(on_magnet.force, Vector3(0, 0, expected)),
                        relative_difference(on_cilium.force, Vector3(0, 0, -expected))});
      EXPECT_LT(on_magnet.torque.norm(), 1e-12 * std::abs(expected) * 6e-3);
    }
  record("force of coaxial cylinders against the Bessel integral, relative", error);
  EXPECT_LT(error, 3e-13);
}

// Oracle: the force between two dipoles, 3μ₀/(4πa⁴)[(m·n)m' + (m'·n)m + (m·m')n − 5(m·n)(m'·n)n],
// and the torque m' × B; the next multipoles are smaller by (size/distance)².
TEST(Wrench, IsThatOfTwoDipolesFarAway) {
  const Cilium cilium = paper_cilium();
  const double volume = cilium.area() * 17e-3;
  const Vector3 m = 75e3 * volume * Vector3::UnitZ();
  for (const Shape shape : shapes) {
    const auto difference = [&](double distance) {
      Magnet far = magnet(shape);
      const Vector3 n = Vector3(2, -1, 1.5).normalized();
      far.position = Vector3(0, 0, 11.5e-3) + distance * n;
      const Vector3 own = surroundings::magnets::moment(far);
      const Vector3 force =
          3 * vacuum_permeability / (4 * std::numbers::pi * std::pow(distance, 4)) *
          (m.dot(n) * own + own.dot(n) * m + m.dot(own) * n - 5 * m.dot(n) * own.dot(n) * n);
      const Vector3 torque = own.cross(dipole_jet(m, distance * n).B);
      const Wrench found = wrench_on_magnet(cilium, oracle::straight(cilium), far);
      return std::array{relative_difference(found.force, force),
                        relative_difference(found.torque, torque)};
    };
    const auto near = difference(0.4);
    const auto far = difference(0.8);
    EXPECT_LT(far[0], 1e-3);
    EXPECT_LT(far[1], 1e-3);
    EXPECT_NEAR(near[0] / far[0], 4, 0.1);
    EXPECT_NEAR(near[1] / far[1], 4, 0.1);
  }
}

// Oracle: Newton. The two ways integrate different fields over different magnets.
// Measured 1.2e-14; margin 10.
TEST(Wrench, OnTheMagnetIsTheReactionToThatOnTheBentCilium) {
  using Section = CrossSection::Shape;
  double error = 0;
  for (const CrossSection& section :
       {CrossSection{}, CrossSection{.shape = Section::tube, .inner_diameter = 1e-3},
        CrossSection{.shape = Section::rectangle, .width = 2e-3, .height = 1e-3}})
    for (const Shape shape : shapes) {
      Cilium cilium = paper_cilium();
      cilium.section = section;
      const Deformation deformation = sampled(cilium, contorted());
      const Magnet m = magnet(shape);
      const Wrench here = wrench_on_cilium(cilium, deformation, {m});
      const Wrench there = wrench_on_magnet(cilium, deformation, m);
      error = std::max(error, (here.force + there.force).norm() / here.force.norm());
      const Vector3 about_the_base = there.torque + m.position.cross(there.force);
      error = std::max(error, (here.torque + about_the_base).norm() / here.torque.norm());
    }
  record("Newton's third law between cilium and magnet, relative", error);
  EXPECT_LT(error, 1.5e-13);
}

// Measured 1.2e-15 of force and torque; margin 10.
TEST(Wrench, BetweenTwoCiliaObeysNewtonsThirdLaw) {
  const Cilium cilium = paper_cilium();
  const Deformation first = sampled(cilium, contorted());
  const Deformation second = sampled(
      cilium, oracle::moved(oracle::arc(60, 2.0), Quaternion::Identity(), {9e-3, -4e-3, 1e-3}));
  const rod::VolumeField volume;
  const auto on = [&](const Deformation& deformation, const Deformation& other) {
    return wrench(
        charges_of(rod::rod_magnet(cilium, deformation)),
        [&](std::span<const Vector3> x) { return volume.field(cilium, other, x).B; },
        Vector3::Zero());
  };
  const Wrench a = on(first, second);
  const Wrench b = on(second, first);
  record("force between two cilia, N", a.force.norm());
  record("Newton's third law of force, relative", (a.force + b.force).norm() / a.force.norm());
  record("Newton's third law of torque, relative", (a.torque + b.torque).norm() / a.torque.norm());
  EXPECT_LT((a.force + b.force).norm(), 2e-14 * a.force.norm());
  EXPECT_LT((a.torque + b.torque).norm(), 2e-14 * a.torque.norm());
}

/// −∫ m·B dV over the bent rod x = r + X d₁ + Y d₂, m dV = (M₁ d₁ + M₂ d₂ + M₃ ∂x/∂S) dX dY dS.
double energy(const Cilium& cilium, const Deformation& deformation, const Magnet& m) {
  const rod::RodMagnet rod = rod::rod_magnet(cilium, deformation);
  double sum = 0;
  const QuadratureRule radial = gauss_legendre(8, 0, 1);
  for (const rod::RodStretch& stretch : rod.stretches) {
    const QuadratureRule rule = gauss_legendre(24, stretch.begin, stretch.end);
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      const CentrelinePoint point = rod::at(rod, stretch, rule.nodes[i]);
      for (std::size_t j = 0; j < radial.nodes.size(); ++j)
        for (int k = 0; k < 16; ++k) {
          const double r = 1.5e-3 * radial.nodes[j];
          const double phi = 2 * std::numbers::pi * k / 16;
          const Vector3 x =
              point.position + point.rotation * Vector3(r * std::cos(phi), r * std::sin(phi), 0);
          const double area = 1.5e-3 * radial.weights[j] * r * 2 * std::numbers::pi / 16;
          const Vector3& M = stretch.magnetization;
          const Vector3 carried =
              point.rotation * Vector3(M.x(), M.y(), 0) + M.z() * rod::stretch_vector(point, x);
          sum -= rule.weights[i] * area * carried.dot(jet(m, x).B);
        }
    }
  }
  return sum;
}

// Oracle: the energy −∫ m·B dV by volume quadrature, differences of fourth order by the magnet's
// place and turn: the force on the magnet is minus its derivative. Measured 1.3e-8; margin 8.
TEST(Wrench, IsTheDerivativeOfTheEnergy) {
  Cilium cilium = paper_cilium();
  cilium.segments.back().transverse_magnetization = {40e3, -60e3};
  const Deformation deformation = sampled(cilium, contorted());
  double error = 0;
  for (const Shape shape : shapes) {
    const Magnet m = magnet(shape);
    const Wrench found = wrench_on_magnet(cilium, deformation, m);
    const auto slope = [&](const std::function<void(Magnet&, double)>& move, double h) {
      const auto at = [&](double t) {
        Magnet moved = m;
        move(moved, t);
        return energy(cilium, deformation, moved);
      };
      return -(8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
    };
    Vector3 force;
    Vector3 torque;
    for (int k = 0; k < 3; ++k) {
      force[k] = slope([k](Magnet& moved, double t) { moved.position[k] += t; }, 1e-4);
      torque[k] = slope(
          [k](Magnet& moved, double t) {
            moved.rotation = Eigen::AngleAxisd(t, Vector3::Unit(k)) * moved.rotation;
          },
          1e-2);
    }
    error = std::max({error, relative_difference(force, found.force),
                      relative_difference(torque, found.torque)});
  }
  record("force and torque against differences of the energy, relative", error);
  EXPECT_LT(error, 1e-7);
}

// Oracle: a uniformly magnetised ball in a harmonic field is a dipole at its centre: F = ∇(m·B) and
// m × B, with the gradient of the model `volume`, and for the poles that of `line`.
TEST(Wrench, OnABallIsThatOnItsDipole) {
  const Cilium cilium = paper_cilium();
  const Deformation deformation = sampled(cilium, contorted());
  const Magnet ball = magnet(Shape::ball);
  const Vector3 m = surroundings::magnets::moment(ball);
  const auto check = [&](const auto& model, const Wrench& found) {
    const Matrix3 gradient =
        model.gradient(cilium, deformation, std::span(&ball.position, 1)).front();
    const Vector3 B = oracle::flux_density(model, cilium, deformation, ball.position);
    EXPECT_LT(relative_difference(found.force, gradient * m), 1e-11);
    EXPECT_LT(relative_difference(found.torque, m.cross(B)), 1e-11);
  };
  check(rod::VolumeField(), wrench_on_magnet(cilium, deformation, ball));
  check(rod::LineField(), wrench(
                              charges_of(ball),
                              [&](std::span<const Vector3> x) {
                                return rod::LineField().field(cilium, deformation, x).B;
                              },
                              ball.position));
  // And the reaction on the line's poles.
  const Wrench poles = wrench(
      poles_of(rod::rod_magnet(cilium, deformation)),
      [&](std::span<const Vector3> x) {
        std::vector<Vector3> B;
        for (const Vector3& point : x) B.push_back(jet(ball, point).B);
        return B;
      },
      Vector3::Zero());
  const Matrix3 gradient =
      rod::LineField().gradient(cilium, deformation, std::span(&ball.position, 1)).front();
  EXPECT_LT(relative_difference(-poles.force, gradient * m), 1e-11);
}

// Oracle: the rod's end sections. A body that the rod's map moves has the same charged faces, as
// patches of degree six, which are off the circle by some 1e-7.
TEST(Wrench, OnABodyIsThatOnTheRodOfItsShape) {
  const Cilium cilium = paper_cilium();
  const oracle::Shape shape = contorted();
  const Deformation rod = sampled(cilium, shape);
  const auto map = [&](const Vector3& X) {
    const CentrelinePoint point = shape(X.z());
    return Vector3(point.position + point.rotation * Vector3(X.x(), X.y(), 0));
  };
  const Deformation body = oracle::deformation_of({}, map);
  const Magnet m = magnet(Shape::cuboid);
  const Wrench a = wrench_on_cilium(cilium, rod, {m});
  const Wrench b = wrench_on_cilium(cilium, body, {m});
  EXPECT_LT(relative_difference(b.force, a.force), 1e-6);
  EXPECT_LT(relative_difference(b.torque, a.torque), 1e-6);
}

TEST(Wrench, IsRefusedIfTheMagnetsTouch) {
  const Cilium cilium = paper_cilium();
  Magnet m = magnet(Shape::ball);
  m.position = {0, 0, 22e-3};
  EXPECT_THROW(wrench_on_cilium(cilium, oracle::straight(cilium), {m}), SolverError);
}

}  // namespace
}  // namespace ciliaval::analytic::forces

// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Bent rods: the closed forms against quadratures that share nothing with them but the integrand's
// definition, and the models against each other where theory says what is between them.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analytic/rod/field_models.h"
#include "analytic/sources/dipole.h"
#include "problem/lagrange.h"
#include "tests/analytic/oracles/bent_rods.h"
#include "tests/analytic/oracles/derby_olbert.h"

namespace ciliaval::analytic {
namespace {

using oracle::arc;
using oracle::contorted;
using oracle::flux_density;
using oracle::paper_cilium;
using oracle::record;
using oracle::relative_difference;
using oracle::sampled;
using Slices = rod::VolumeOptions::Slices;

const std::vector<Vector3> sensors = {
    oracle::paper_sensor, {4e-3, -3e-3, 1e-3}, {-6e-3, 2e-3, 9e-3}, {2e-3, 7e-3, 14e-3}};

double largest_difference(const FieldModel& a, const FieldModel& b, const Cilium& cilium,
                          const Deformation& deformation) {
  double difference = 0;
  for (const Vector3& x : sensors)
    difference = std::max(difference, relative_difference(flux_density(a, cilium, deformation, x),
                                                          flux_density(b, cilium, deformation, x)));
  return difference;
}

const std::vector<std::pair<std::string, oracle::Shape>> shapes = {{"arc", arc(60, 0.5)},
                                                                   {"contorted rod", contorted()}};

// Oracle: the triple quadrature with the wedge Jacobian (and F·M under shear). Measured 2e-12; the
// quadrature's tolerance is 1e-11.
TEST(BentRod, TwoDiscsAreTheFieldOfItsTrueVolume) {
  for (const auto& [name, shape] : shapes) {
    const double error =
        largest_difference(rod::VolumeField({Slices::wedge, rod::Method::closed_form}),
                           rod::VolumeField({Slices::wedge, rod::Method::quadrature, 1e-11}),
                           paper_cilium(), sampled(paper_cilium(), shape));
    record("two discs against wedge quadrature, " + name, error);
    EXPECT_LT(error, 2e-11) << name;
  }
}

// Oracle: the triple quadrature without Jacobian. Measured 3e-12, both tolerances being 1e-11.
TEST(BentRod, StackedLoopsAreTheFieldOfItsFlatSlices) {
  for (const auto& [name, shape] : shapes) {
    const double error =
        largest_difference(rod::VolumeField({Slices::stacked, rod::Method::closed_form, 1e-11}),
                           rod::VolumeField({Slices::stacked, rod::Method::quadrature, 1e-11}),
                           paper_cilium(), sampled(paper_cilium(), shape));
    record("stacked loops against stacked quadrature, " + name, error);
    EXPECT_LT(error, 2e-11) << name;
  }
}

/// Points 30 and 300 radii from the magnet, all round.
std::vector<Vector3> far_points() {
  std::vector<Vector3> points;
  for (const double distance : {45e-3, 450e-3})
    for (int i = 0; i < 7; ++i) {
      const double cosine = 0.9 - 0.3 * i;
      const double sine = std::sqrt(1 - cosine * cosine);
      points.push_back(Vector3(0, 0, 11e-3) + distance * Vector3(sine * std::cos(2.0 * i),
                                                                 sine * std::sin(2.0 * i), cosine));
    }
  return points;
}

// Oracle: the quadratures, which sum what does not cancel far away. Here the tilted discs and poles
// of either sign cancel like a/L. Measured 1e-13, from the interpolated centreline's rounding.
TEST(BentRod, ClosedFormsKeepTheirDigitsFarAway) {
  const Cilium cilium = paper_cilium();
  for (const auto& [name, shape] : shapes) {
    const Deformation deformation = sampled(cilium, shape);
    double error = 0;
    for (const Vector3& x : far_points()) {
      const auto compare = [&](const FieldModel& closed, const FieldModel& quadrature) {
        error =
            std::max(error, relative_difference(flux_density(closed, cilium, deformation, x),
                                                flux_density(quadrature, cilium, deformation, x)));
      };
      compare(rod::LineField(),
              rod::LineField({sources::PushForward::F, rod::Method::quadrature, 1e-12}));
      compare(rod::VolumeField(),
              rod::VolumeField({Slices::wedge, rod::Method::quadrature, 1e-12}));
      compare(rod::VolumeField({Slices::stacked, rod::Method::closed_form, 1e-12}),
              rod::VolumeField({Slices::stacked, rod::Method::quadrature, 1e-12}));
    }
    record("closed forms against quadratures, 30 and 300 radii, " + name, error);
    EXPECT_LT(error, 1e-12) << name;
  }
}

// Oracle: the charge of the arc's two ends in 50 digits, and M t inside, with Boost.Math's
// integrals; that these two discs are the rod's field is the claim of the tests above.
TEST(BentRod, TwoDiscsKeepTheirDigitsWhereverAPointIsPut) {
  const Cilium cilium = paper_cilium();
  const oracle::Shape shape = arc(60, 0.5);
  const Deformation deformation = sampled(cilium, shape);
  const double M = 75e3;
  const double R = 1.5e-3;
  std::vector<std::pair<Vector3, std::optional<double>>> points;  // and S, if inside
  for (const Vector3& x : sensors) points.push_back({x, {}});
  for (const Vector3& x : far_points()) points.push_back({x, {}});
  const auto beside = [&](double S, double r, double phi, double height, bool inside) {
    const CentrelinePoint p = shape(S);
    const Vector3 offset(r * std::cos(phi), r * std::sin(phi), height);
    points.push_back({p.position + p.rotation * offset, inside ? std::optional(S) : std::nullopt});
  };
  for (int i = 0; i < 8; ++i) {
    const double phi = 0.8 * i;
    const double t = (i + 0.5) / 8;
    beside(3e-3, R * t, phi, -1e-6, false);  // a micrometre from the end faces
    beside(20e-3, R * t, phi, 1e-6, false);
    beside(3e-3, 0, 0, -2e-3 * t, false);  // on the axis
    beside(3e-3 + 17e-3 * t, 0, 0, 0, true);
    beside(3e-3 + 17e-3 * t, R - 1e-6, phi, 0, true);  // next to the mantle
    beside(3e-3 + 17e-3 * t, R + 1e-6, phi, 0, false);
    beside(3e-3 + 17e-3 * t, R * t, phi, 0, true);
  }
  double error = 0;
  for (const auto& [x, S] : points) {
    Vector3 exact = Vector3::Zero();
    for (const auto& [end, sigma] : {std::pair(3e-3, -M), std::pair(20e-3, M)})
      exact += oracle::charged_disc(sigma, shape(end).position, shape(end).normal(), R, x);
    if (S) exact += vacuum_permeability * M * shape(*S).normal();
    const Field field = rod::VolumeField().field(cilium, deformation, std::span(&x, 1));
    const double difference = (field.B.front() - exact).norm();
    error = std::max(error, difference / exact.norm());
    EXPECT_LE(difference, field.uncertainty.front().norm()) << x.transpose();
  }
  record("two discs of the arc, everywhere, against 50 digits", error);
  EXPECT_LT(error, 1e-12);
}

// Oracle: the quadratures at 1e-12. The estimate of each closed form covers the difference.
TEST(BentRod, UncertaintyBoundsTheErrorAndKeepsTheDefaultTolerance) {
  const Cilium cilium = paper_cilium();
  for (const auto& named : shapes) {
    const std::string& name = named.first;
    const Deformation deformation = sampled(cilium, named.second);
    for (const Vector3& x : sensors) {
      const auto check = [&](const FieldModel& model, const FieldModel& oracle) {
        const Field value = model.field(cilium, deformation, std::span(&x, 1));
        const Field exact = oracle.field(cilium, deformation, std::span(&x, 1));
        const double bound = value.uncertainty.front().norm();
        EXPECT_LE((value.B.front() - exact.B.front()).norm(),
                  bound + exact.uncertainty.front().norm())
            << name;
        EXPECT_LE(bound, 1e-10 * exact.B.front().norm()) << name;
      };
      check(rod::LineField(),
            rod::LineField({sources::PushForward::F, rod::Method::quadrature, 1e-13}));
      check(rod::LineField({sources::PushForward::R}),
            rod::LineField({sources::PushForward::R, rod::Method::quadrature, 1e-13}));
      check(rod::VolumeField(), rod::VolumeField({Slices::wedge, rod::Method::quadrature, 1e-12}));
      check(rod::VolumeField({Slices::stacked}),
            rod::VolumeField({Slices::stacked, rod::Method::quadrature, 1e-12}));
    }
  }
}

// Oracle: the quadrature of the dipoles M πR² dr. Measured 6e-15, its tolerance being 1e-12.
TEST(BentRod, TwoPolesAreTheFieldOfItsLineOfDipoles) {
  for (const auto& [name, shape] : shapes) {
    const double error = largest_difference(
        rod::LineField({sources::PushForward::F, rod::Method::closed_form}),
        rod::LineField({sources::PushForward::F, rod::Method::quadrature, 1e-12}), paper_cilium(),
        sampled(paper_cilium(), shape));
    record("two poles against line quadrature, " + name, error);
    EXPECT_LT(error, 2e-12) << name;
  }
}

// Oracle: 200 Gauss points on the exact shape, written here.
TEST(BentRod, LineOfSectionNormalsIsItsPlainIntegral) {
  const Cilium cilium = paper_cilium();
  const oracle::Shape shape = contorted();
  const QuadratureRule rule = gauss_legendre(200, 3e-3, 20e-3);
  double error = 0;
  double to_F = 0;
  for (const Vector3& x : sensors) {
    Vector3 B = Vector3::Zero();
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      const CentrelinePoint point = shape(rule.nodes[i]);
      const double strength = rule.weights[i] * 75e3 * std::numbers::pi * 1.5e-3 * 1.5e-3;
      B +=
          sources::dipole_field(strength * (point.rotation * Vector3::UnitZ()), x - point.position);
    }
    const Deformation deformation = sampled(cilium, shape);
    const Vector3 value =
        flux_density(rod::LineField({sources::PushForward::R}), cilium, deformation, x);
    error = std::max(error, relative_difference(value, B));
    to_F = std::max(
        to_F,
        relative_difference(
            flux_density(rod::LineField({sources::PushForward::F}), cilium, deformation, x), B));
  }
  record("line R against a plain integral, contorted rod", error);
  EXPECT_LT(error, 1e-12);
  EXPECT_GT(to_F, 0.05);  // r' is 20 % longer than d₃ and 9° from it
}

TEST(BentRod, PushForwardsAgreeWithoutShearAndStretch) {
  const Cilium cilium = paper_cilium();
  const Deformation deformation = sampled(cilium, arc(60, 0.5));
  EXPECT_LT(
      largest_difference(rod::LineField({sources::PushForward::R, rod::Method::closed_form, 1e-12}),
                         rod::LineField({sources::PushForward::F}), cilium, deformation),
      1e-12);
  EXPECT_LT(largest_difference(rod::DipoleField({sources::PushForward::R}),
                               rod::DipoleField({sources::PushForward::F}), cilium, deformation),
            1e-12);
}

// Oracle: moment and centroid of the exact shape by 200 Gauss points, written here.
TEST(BentRod, DipoleIsItsTotalMomentAtItsCentroid) {
  const Cilium cilium = paper_cilium();
  const oracle::Shape shape = contorted();
  const QuadratureRule rule = gauss_legendre(200, 3e-3, 20e-3);
  Vector3 centroid = Vector3::Zero();
  Vector3 tangents = Vector3::Zero();
  Vector3 normals = Vector3::Zero();
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const CentrelinePoint point = shape(rule.nodes[i]);
    centroid += rule.weights[i] / 17e-3 * point.position;
    tangents += rule.weights[i] * point.derivative;
    normals += rule.weights[i] * (point.rotation * Vector3::UnitZ());
  }
  const double strength = 75e3 * std::numbers::pi * 1.5e-3 * 1.5e-3;
  const Deformation deformation = sampled(cilium, shape);
  for (const Vector3& x : sensors) {
    EXPECT_LT(relative_difference(flux_density(rod::DipoleField(), cilium, deformation, x),
                                  sources::dipole_field(strength * tangents, x - centroid)),
              1e-13);
    EXPECT_LT(relative_difference(
                  flux_density(rod::DipoleField({sources::PushForward::R}), cilium, deformation, x),
                  sources::dipole_field(strength * normals, x - centroid)),
              1e-13);
  }
}

// Oracle: the wedge's moment density exceeds the stack's by M a·(d₃ × κ) at the offset a from the
// axis, so to leading order in R the fields differ by ∫ M I (c·∇) b dS, c = d₃ × κ, I = πR⁴/4, b
// the field of a dipole d₃; the rest is smaller by R²: it falls fourfold when R is halved.
TEST(BentRod, WedgeAndStackDifferByTheFirstMomentOfTheJacobian) {
  const oracle::Shape shape = arc(60, 0.5);
  const Vector3 x(-1e-3, 2e-3, -1.5e-3);
  const QuadratureRule rule = gauss_legendre(60, 3e-3, 20e-3);
  std::vector<double> rest;
  for (const double radius : {0.4e-3, 0.2e-3}) {
    Cilium cilium = paper_cilium();
    cilium.diameter = 2 * radius;
    const double h = 1e-5;
    Vector3 expected = Vector3::Zero();
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      const CentrelinePoint point = shape(rule.nodes[i]);
      const Vector3 d3 = point.rotation * Vector3::UnitZ();
      const Vector3 c = d3.cross(point.curvature);
      const auto b = [&](double s) {
        return sources::dipole_field(d3, x - point.position - s * c.normalized());
      };
      const Vector3 slope = (8 * (b(h) - b(-h)) - (b(2 * h) - b(-2 * h))) / (12 * h);
      expected +=
          rule.weights[i] * 75e3 * std::numbers::pi * std::pow(radius, 4) / 4 * c.norm() * slope;
    }
    const Deformation deformation = sampled(cilium, shape);
    const Vector3 difference =
        flux_density(rod::VolumeField({Slices::wedge}), cilium, deformation, x) -
        flux_density(rod::VolumeField({Slices::stacked, rod::Method::closed_form, 1e-13}), cilium,
                     deformation, x);
    rest.push_back(relative_difference(difference, expected));
  }
  record("wedge − stacked against its leading term, R = 0.2 mm", rest[1]);
  EXPECT_LT(rest[1], 0.02);
  EXPECT_NEAR(rest[0] / rest[1], 4, 0.2);
}

// On the paper's cilium the Jacobian is worth some tenths of a percent.
TEST(BentRod, JacobianMattersLittleOnThePapersCilium) {
  const double difference =
      largest_difference(rod::VolumeField({Slices::stacked}), rod::VolumeField({Slices::wedge}),
                         paper_cilium(), sampled(paper_cilium(), arc(60, 0.5)));
  record("stacked against wedge, arc of 69°", difference);
  EXPECT_GT(difference, 1e-3);
  EXPECT_LT(difference, 3e-2);
}

// Oracle: the multipole expansion. Every model has the dipole's total moment (stacked: that of R),
// so what is between them falls like 1/distance.
TEST(BentRod, EveryModelTendsToItsDipoleFarAway) {
  const Cilium cilium = paper_cilium();
  const Deformation deformation = sampled(cilium, contorted());
  const Vector3 direction = Vector3(0.6, -0.3, 0.5).normalized();
  const rod::DipoleField dipole_F({sources::PushForward::F});
  const rod::DipoleField dipole_R({sources::PushForward::R});
  const std::vector<std::pair<std::shared_ptr<FieldModel>, const rod::DipoleField*>> models = {
      {std::make_shared<rod::LineField>(rod::LineOptions{sources::PushForward::F}), &dipole_F},
      {std::make_shared<rod::LineField>(rod::LineOptions{sources::PushForward::R}), &dipole_R},
      {std::make_shared<rod::VolumeField>(rod::VolumeOptions{Slices::wedge}), &dipole_F},
      {std::make_shared<rod::VolumeField>(rod::VolumeOptions{Slices::stacked}), &dipole_R}};
  for (const auto& [model, dipole] : models) {
    double previous = 0;
    for (const double distance : {1.0, 2.0, 4.0}) {
      const Vector3 x = distance * direction;
      const double difference = relative_difference(flux_density(*model, cilium, deformation, x),
                                                    flux_density(*dipole, cilium, deformation, x));
      EXPECT_LT(difference, 0.02 / distance);
      if (previous > 0) {
        EXPECT_NEAR(previous / difference, 2, 0.1);
      }
      previous = difference;
    }
  }
}

}  // namespace
}  // namespace ciliaval::analytic

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/surroundings/magnets/field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "analytic/sources/dipole.h"
#include "problem/error.h"
#include "problem/lagrange.h"
#include "tests/analytic/oracles/bent_rods.h"
#include "tests/analytic/oracles/derby_olbert.h"

namespace ciliaval::surroundings::magnets {
namespace {

using oracle::record;
using oracle::relative_difference;

Magnet magnet(Shape shape) {
  const Quaternion turn(Eigen::AngleAxisd(0.7, Vector3(1, 2, 3).normalized()));
  const Vector3 M = shape == Shape::cylinder ? Vector3(0, 0, 8e5) : Vector3(1e5, -2e5, 8e5);
  return {"test", shape, {0.01, 0.02, -0.01}, turn, 3e-3, 4e-3, {4e-3, 5e-3, 7e-3}, M};
}

const std::vector<Shape> shapes{Shape::ball, Shape::cylinder, Shape::cuboid};

/// Points outside of all three shapes, in their own axes: near, on the axes, on the lines through
/// edges, on both sides of the distances where closed forms hand over to series, and far away.
std::vector<Vector3> points() {
  const Vector3 oblique = Vector3(0.3, -0.5, 0.81).normalized();
  std::vector<Vector3> result{{0, 0, 5e-3},
                              {1e-12, 0, 5e-3},
                              {0, 1e-7, -6e-3},
                              {2e-3, 2.5e-3, 5e-3},
                              {2e-3, 2.5e-3, -5e-3},
                              {2e-3, 0.1, 0},
                              {1.5e-3 * (1 + 1e-9), 0, 4.5e-3},
                              {0, 0, 0.3},
                              {-0.02, 0.01, 3e-3}};
  for (const double r : {5.5e-3, 8e-3, 0.0284, 0.0285, 0.0569, 0.0570, 0.2, 2.0})
    result.push_back(r * oblique);
  return result;
}

Vector3 in_space(const Magnet& magnet, const Vector3& own) {
  return magnet.position + magnet.rotation * own;
}

// Oracle: analytic/sources. Measured 9e-16; margin 3.
TEST(MagnetField, BallIsTheDipole) {
  const Magnet ball = magnet(Shape::ball);
  double error = 0;
  for (const Vector3& own : points()) {
    const Vector3 x = in_space(ball, own);
    const Vector3 exact = analytic::sources::dipole_field(moment(ball), x - ball.position);
    error = std::max(error, relative_difference(jet(ball, x).B, exact));
  }
  record("ball against the dipole, relative", error);
  EXPECT_LT(error, 3e-15);
}

// Oracle: Derby & Olbert in 50 digits. The two discs cancel far away, by distance over length.
// Measured 1.9e-15; margin 10.
TEST(MagnetField, CylinderIsDerbyAndOlberts) {
  const Magnet cylinder = magnet(Shape::cylinder);
  double error = 0;
  for (const Vector3& own : points()) {
    const Vector3 exact = oracle::derby_olbert(8e5, 1.5e-3, -2e-3, 2e-3, own);
    const Vector3 B = cylinder.rotation.conjugate() * jet(cylinder, in_space(cylinder, own)).B;
    error = std::max(error, relative_difference(B, exact) / std::max(1.0, own.norm() / 4e-3));
  }
  record("cylinder against Derby and Olbert, relative, over distance/length", error);
  EXPECT_LT(error, 2e-14);
}

/// B of the charges M·n on the faces of a cuboid, by Gauss's rule on panels that shrink towards the
/// foot of the point, in its own axes.
Vector3 field_of_faces(const Magnet& cuboid, const Vector3& x) {
  const QuadratureRule rule = gauss_legendre(16, 0, 1);
  const Vector3 h = cuboid.edges / 2;
  const int panels = 8;
  Vector3 B = Vector3::Zero();
  for (int n = 0; n < 3; ++n)
    for (const double side : {-1.0, 1.0})
      for (int p = 0; p < panels * panels; ++p)
        for (std::size_t i = 0; i < rule.nodes.size(); ++i)
          for (std::size_t j = 0; j < rule.nodes.size(); ++j) {
            const int a = (n + 1) % 3;
            const int b = (n + 2) % 3;
            Vector3 y;
            y[n] = side * h[n];
            y[a] = h[a] * (2 * (p % panels + rule.nodes[i]) / panels - 1);
            y[b] = h[b] * (2 * (p / panels + rule.nodes[j]) / panels - 1);
            const double area =
                4 * h[a] * h[b] * rule.weights[i] * rule.weights[j] / (panels * panels);
            B += analytic::sources::pole_field(side * cuboid.magnetization[n] * area, x - y);
          }
  return B;
}

// Oracle: Coulomb's law on the six faces. The sum of 98304 charges is itself good to 1e-13 of
// their field, which cancels far away by distance over size.
// Measured 1.5e-14; margin 13.
TEST(MagnetField, CuboidIsTheFieldOfItsChargedFaces) {
  const Magnet cuboid = magnet(Shape::cuboid);
  double error = 0;
  for (const Vector3& own : points()) {
    const Vector3 B = cuboid.rotation.conjugate() * jet(cuboid, in_space(cuboid, own)).B;
    const Vector3 exact = field_of_faces(cuboid, own);
    error = std::max(error, relative_difference(B, exact) / std::max(1.0, own.norm() / 7e-3));
  }
  record("cuboid against its charged faces, relative, over distance/size", error);
  EXPECT_LT(error, 2e-13);
}

// Oracle: differences of fourth order of B and of its gradient, which are good to some 1e-10.
// Measured 1.7e-10; margin 12.
TEST(MagnetField, DerivativesAreThoseOfTheField) {
  double first = 0;
  double second = 0;
  for (const Shape shape : shapes) {
    const Magnet m = magnet(shape);
    for (const Vector3& own : points()) {
      const Vector3 x = in_space(m, own);
      const FieldJet value = jet(m, x);
      const double h = 2e-4 * own.norm();
      double norm = 0;
      for (const Matrix3& matrix : value.second) norm = std::max(norm, matrix.norm());
      for (int k = 0; k < 3; ++k) {
        const auto at = [&](double t) { return jet(m, x + t * h * Vector3::Unit(k)); };
        const FieldJet a = at(-2), b = at(-1), c = at(1), d = at(2);
        const Vector3 slope = (8 * (c.B - b.B) - (d.B - a.B)) / (12 * h);
        const Matrix3 change =
            (8 * (c.gradient - b.gradient) - (d.gradient - a.gradient)) / (12 * h);
        first = std::max(first, (slope - value.gradient.col(k)).norm() / value.gradient.norm());
        second =
            std::max(second, (change - value.second[static_cast<std::size_t>(k)]).norm() / norm);
      }
    }
  }
  record("gradient against differences, relative", first);
  record("second derivative against differences, relative", second);
  EXPECT_LT(first, 2e-9);
  EXPECT_LT(second, 2e-9);
}

// Oracle: Maxwell. ∇·B = 0 and ∇×B = 0, so that ∂ⁿB is symmetric in all indices and free of traces.
// Measured 1.5e-14, of the cuboid's corners; margin 13.
TEST(MagnetField, HasNeitherDivergenceNorCurl) {
  double error = 0;
  for (const Shape shape : shapes) {
    const Magnet m = magnet(shape);
    for (const Vector3& own : points()) {
      const FieldJet value = jet(m, in_space(m, own));
      const Matrix3& g = value.gradient;
      error =
          std::max({error, std::abs(g.trace()) / g.norm(), (g - g.transpose()).norm() / g.norm()});
      double norm = 0;
      for (const Matrix3& matrix : value.second) norm = std::max(norm, matrix.norm());
      for (std::size_t k = 0; k < 3; ++k) {
        error = std::max(error, std::abs(value.second[k].trace()) / norm);
        for (int i = 0; i < 3; ++i)
          for (std::size_t j = 0; j < 3; ++j)
            error = std::max(error, std::abs(value.second[k](i, static_cast<int>(j)) -
                                             value.second[j](i, static_cast<int>(k))) /
                                        norm);
      }
    }
  }
  record("divergence and curl of B and of its gradient, relative", error);
  EXPECT_LT(error, 2e-13);
}

// Oracle: the multipoles of even bodies: the next after the dipole is smaller by (size/distance)².
TEST(MagnetField, BecomesTheDipolesFarAwayBySecondOrder) {
  for (const Shape shape : {Shape::cylinder, Shape::cuboid}) {
    const Magnet m = magnet(shape);
    const auto difference = [&](double r) {
      const Vector3 offset = r * Vector3(0.2, 0.9, -0.4).normalized();
      const FieldJet dipole = dipole_jet(moment(m), offset);
      const FieldJet value = jet(m, m.position + offset);
      return std::array{relative_difference(value.B, dipole.B),
                        (value.gradient - dipole.gradient).norm() / dipole.gradient.norm(),
                        (value.second[1] - dipole.second[1]).norm() / dipole.second[1].norm()};
    };
    const auto near = difference(0.2);
    const auto far = difference(0.8);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_GT(near[i], 1e-5);
      EXPECT_NEAR(near[i] / far[i], 16, 0.1);
    }
  }
}

TEST(MagnetField, IsRefusedInsideTheMagnet) {
  for (const Shape shape : shapes) {
    const Magnet m = magnet(shape);
    EXPECT_THROW(jet(m, m.position), SolverError);
    EXPECT_THROW(jet(m, nearest_point(m, in_space(m, {0.01, 0.02, 0.03}))), SolverError);
  }
}

}  // namespace
}  // namespace ciliaval::surroundings::magnets

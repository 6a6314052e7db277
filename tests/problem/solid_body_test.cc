// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/solid_body.h"

#include <gtest/gtest.h>

namespace ciliaval {
namespace {

const LagrangeBasis quadratic({0, 0.5, 1});

Vector3 reference_map(const Vector3& xi) {
  return {2 * xi[0] + 0.1 * xi[1] * xi[2], 3 * xi[1] - 0.2 * xi[0] * xi[0], xi[2]};
}

/// x(X) quadratic in ξ only if X is affine; so the deformation is affine here.
const Matrix3 gradient = (Matrix3() << 1.1, 0.2, 0.0, -0.1, 0.9, 0.3, 0.05, 0.0, 1.2).finished();

SolidCell cell() {
  SolidCell c;
  for (const double z : quadratic.nodes())
    for (const double y : quadratic.nodes())
      for (const double x : quadratic.nodes()) {
        c.reference.push_back(reference_map({x, y, z}));
        c.current.emplace_back(gradient * c.reference.back() + Vector3(1, 2, 3));
      }
  return c;
}

// Oracle: the maps the cell was made from, and ∂X/∂ξ by hand.
TEST(SolidBody, EvaluatesACurvedCell) {
  const Vector3 xi(0.3, 0.6, 0.9);
  const SolidPoint p = evaluate(quadratic, cell(), xi);
  EXPECT_NEAR((p.reference - reference_map(xi)).norm(), 0, 1e-14);
  EXPECT_NEAR((p.current - (gradient * p.reference + Vector3(1, 2, 3))).norm(), 0, 1e-14);
  EXPECT_NEAR((p.deformation_gradient - gradient).norm(), 0, 1e-13);
  const Matrix3 dX = (Matrix3() << 2, 0.1 * 0.9, 0.1 * 0.6, -0.4 * 0.3, 3, 0, 0, 0, 1).finished();
  EXPECT_NEAR((p.reference_gradient - dX).norm(), 0, 1e-13);
}

// Oracle: the cross product of the face's edges.
TEST(SolidBody, EvaluatesAFace) {
  ChargedFace face;
  for (const double y : quadratic.nodes())
    for (const double x : quadratic.nodes()) {
      face.reference.emplace_back(2 * x, 3 * y, 0);
      face.current.emplace_back(2 * x, 0, 3 * y);
    }
  const FacePoint p = evaluate(quadratic, face, 0.25, 0.75);
  EXPECT_NEAR((p.reference_area - Vector3(0, 0, 6)).norm(), 0, 1e-13);
  EXPECT_NEAR((p.current - Vector3(0.5, 0, 2.25)).norm(), 0, 1e-14);
}

}  // namespace
}  // namespace ciliaval

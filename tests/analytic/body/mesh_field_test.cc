// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analytic/body/mesh_field.h"
#include "analytic/rod/field_models.h"
#include "analytic/sources/dipole.h"
#include "problem/lagrange.h"
#include "tests/analytic/oracles/bent_rods.h"
#include "tests/analytic/oracles/cylinder_body.h"
#include "tests/analytic/oracles/derby_olbert.h"

namespace ciliaval::analytic {
namespace {

using oracle::CylinderBody;
using oracle::deformation_of;
using oracle::flux_density;
using oracle::identity;
using oracle::paper_cilium;
using oracle::record;
using oracle::relative_difference;

const body::MeshField mesh_F({sources::PushForward::F, 1e-10});
const body::MeshField mesh_R({sources::PushForward::R, 1e-8});
const std::vector<Vector3> outside = {
    oracle::paper_sensor, {0.4e-3, 0.3e-3, 2.5e-3}, {3e-3, -2e-3, 10e-3}};

double error_of_straight(const FieldModel& model, const CylinderBody& cylinder,
                         const std::vector<Vector3>& points) {
  double error = 0;
  const Deformation deformation = deformation_of(cylinder, identity);
  for (const Vector3& x : points)
    error =
        std::max(error, relative_difference(flux_density(model, paper_cilium(), deformation, x),
                                            oracle::derby_olbert(75e3, 1.5e-3, 3e-3, 20e-3, x)));
  return error;
}

// Oracle: Derby & Olbert in 50 digits. Nodes on the circle, so that the end faces have an error of
// O(h^(p+1)), which is all the field sees.
TEST(MeshField, ConvergesAtTheOrderOfTheGeometry) {
  for (const std::size_t degree : {1, 2, 3, 4}) {
    double previous = 0;
    for (const std::size_t cuts : {1, 2, 4}) {
      const CylinderBody cylinder{.degree = degree, .cuts = cuts, .layers = 1};
      const double error = error_of_straight(mesh_F, cylinder, outside);
      record("mesh F, degree " + std::to_string(degree) + ", cuts " + std::to_string(cuts), error);
      if (previous > 0) {
        EXPECT_GT(std::log2(previous / error), static_cast<double>(degree) + 1 - 0.2);
      }
      previous = error;
    }
  }
}

// Measured 7e-14; the tolerance asked is 1e-10.
TEST(MeshField, OfHighDegreeIsDerbyAndOlbertsCylinder) {
  const CylinderBody cylinder{.degree = 9, .cuts = 2};
  const std::vector<Vector3> points = {oracle::paper_sensor,
                                       {0.4e-3, 0.3e-3, 2.5e-3},
                                       {3e-3, -2e-3, 10e-3},
                                       {0.9e-3, -0.3e-3, 20.01e-3},
                                       {0.45, 0.1, -0.3},
                                       // inside: on the axis, off it, near the end face
                                       {0, 0, 12e-3},
                                       {1.2e-3, -0.4e-3, 7e-3},
                                       {-0.6e-3, 0.5e-3, 19.9e-3}};
  const double error = error_of_straight(mesh_F, cylinder, points);
  record("mesh F of degree 9, out- and inside", error);
  EXPECT_LT(error, 1e-10);
}

// Measured 2e-8, the geometry of degree 6; margin 6.
TEST(MeshField, VolumeQuadratureOfRotatedMomentsIsDerbyAndOlbertsCylinder) {
  const CylinderBody cylinder{.degree = 6, .layers = 1};
  const double error = error_of_straight(mesh_R, cylinder, outside);
  record("mesh R of degree 6, straight", error);
  EXPECT_LT(error, 1e-7);
}

// Oracle: Derby & Olbert. R·M is integrated over the volume, so the mantle's geometry counts too:
// the same order p + 1. Measured 2.6e-7 at degree 4, the 1e-6 that is asked for and below.
TEST(MeshField, RotatedMomentsConvergeAtTheOrderOfTheGeometry) {
  const std::vector<Vector3> points = {oracle::paper_sensor, {3e-3, -2e-3, 10e-3}};
  for (const std::size_t degree : {1, 2, 3, 4}) {
    double previous = 0;
    for (const std::size_t cuts : {1, 2}) {
      const CylinderBody cylinder{.degree = degree, .cuts = cuts, .layers = 2};
      const double error = error_of_straight(mesh_R, cylinder, points);
      record("mesh R, degree " + std::to_string(degree) + ", cuts " + std::to_string(cuts), error);
      if (previous > 0) {
        EXPECT_GT(std::log2(previous / error), static_cast<double>(degree) + 1 - 0.2);
      }
      previous = error;
    }
    if (degree == 4) {
      EXPECT_LT(previous, 1e-6);
    }
  }
}

// Oracle: Derby & Olbert. Patches are cut towards the point, down to a micrometre from the charged
// face and from the mantle, where a fixed rule would be off by orders of magnitude.
// Measured 1.5e-11 with F; with R 3e-8, of the geometry.
TEST(MeshField, HoldsAMicrometreOffItsSurface) {
  struct Push {
    std::string name;
    body::MeshField model;
    CylinderBody cylinder;
    double tolerance;
  };
  for (const Push& push :
       {Push{"F", body::MeshField({sources::PushForward::F, 1e-8}), {.degree = 8}, 1e-8},
        Push{"R",
             body::MeshField({sources::PushForward::R, 1e-6}),
             {.degree = 4, .cuts = 2, .layers = 2},
             1e-6}}) {
    const Deformation body = deformation_of(push.cylinder, identity);
    for (const auto& [where, x] :
         std::vector<std::pair<std::string, Vector3>>{{"below", {0.4e-3, 0.3e-3, 3e-3 - 1e-6}},
                                                      {"above", {-0.2e-3, 0.7e-3, 20e-3 + 1e-6}},
                                                      {"beside", {1.5e-3 + 1e-6, 0, 9.3e-3}}}) {
      const Vector3 exact = oracle::derby_olbert(75e3, 1.5e-3, 3e-3, 20e-3, x);
      const Field field = push.model.field(paper_cilium(), body, std::span(&x, 1));
      const double error = relative_difference(field.B.front(), exact);
      record("mesh " + push.name + ", a micrometre " + where, error);
      EXPECT_LT(error, push.tolerance) << push.name << ' ' << where;
      EXPECT_LE(field.uncertainty.front().norm(), push.tolerance * exact.norm())
          << push.name << ' ' << where;
    }
  }
}

// Oracle: the same moments integrated to 1e-10.
TEST(MeshField, UncertaintyBoundsTheErrorOfItsVolumeQuadrature) {
  const CylinderBody cylinder{.degree = 3, .cuts = 1, .layers = 2};
  const Deformation body = deformation_of(cylinder, identity);
  for (const double height : {1e-4, 1e-3, 1e-2, 1e-1}) {
    const Vector3 x(0.3e-3, -0.8e-3, 20e-3 + height);
    const Vector3 exact =
        flux_density(body::MeshField({sources::PushForward::R, 1e-10}), paper_cilium(), body, x);
    for (const double tolerance : {1e-3, 1e-5, 1e-7}) {
      const Field field = body::MeshField({sources::PushForward::R, tolerance})
                              .field(paper_cilium(), body, std::span(&x, 1));
      EXPECT_LE((field.B.front() - exact).norm(),
                field.uncertainty.front().norm() + 1e-10 * exact.norm());
      EXPECT_LE(field.uncertainty.front().norm(), tolerance * exact.norm());
    }
  }
}

// Oracle: a rigid motion has F = R, and turns the field.
TEST(MeshField, RigidMotionTurnsTheField) {
  const CylinderBody cylinder{.degree = 3, .cuts = 1, .layers = 2};
  const Quaternion Q(Eigen::AngleAxisd(1.9, Vector3(0.2, 0.9, -0.4).normalized()));
  const Vector3 shift(2e-3, -1e-3, 3e-3);
  const Deformation straight = deformation_of(cylinder, identity);
  const Deformation turned =
      deformation_of(cylinder, [&](const Vector3& X) { return Vector3(Q * X + shift); });
  double error_F = 0;
  double error_R = 0;
  for (const Vector3& x : outside) {
    const auto moved = [&](const FieldModel& model) {
      return Vector3(Q.inverse() * flux_density(model, paper_cilium(), turned, Q * x + shift));
    };
    error_F = std::max(
        error_F,
        relative_difference(moved(mesh_F), flux_density(mesh_F, paper_cilium(), straight, x)));
    error_R = std::max(error_R, relative_difference(moved(mesh_R), moved(mesh_F)));
  }
  const Vector3 inside(0.5e-3, 0.2e-3, 9e-3);
  error_F = std::max(
      error_F, relative_difference(flux_density(mesh_F, paper_cilium(), turned, Q * inside + shift),
                                   Q * flux_density(mesh_F, paper_cilium(), straight, inside)));
  record("mesh F, rigid motion", error_F);
  record("mesh R against F, rigid motion", error_R);
  EXPECT_LT(error_F, 1e-12);
  EXPECT_LT(error_R, 1e-9);
}

/// x = r(Z) + X d₁ + Y d₂.
oracle::Map rod_map(const oracle::Shape& shape) {
  return [shape](const Vector3& X) {
    const CentrelinePoint point = shape(X.z());
    return Vector3(point.position + point.rotation * Vector3(X.x(), X.y(), 0));
  };
}

// Oracle: the two discs of the model `volume`, out- and inside, for a rod in pure bending and one
// that is sheared, stretched and twisted as well. Measured 1.4e-11, the area of an end
// face of degree 8.
TEST(MeshField, OfABentRodIsTheFieldOfItsTwoDiscs) {
  const CylinderBody cylinder{.degree = 8};
  for (const auto& shape : {oracle::arc(60, 0.5), oracle::contorted()}) {
    const Deformation body = deformation_of(cylinder, rod_map(shape));
    const Deformation rod = oracle::sampled(paper_cilium(), shape);
    std::vector<Vector3> points = {oracle::paper_sensor, {-6e-3, 2e-3, 9e-3}};
    for (const double S : {4e-3, 13e-3})
      points.push_back(rod_map(shape)(Vector3(0.7e-3, -0.9e-3, S)));
    double error = 0;
    for (const Vector3& x : points)
      error = std::max(
          error, relative_difference(flux_density(mesh_F, paper_cilium(), body, x),
                                     flux_density(rod::VolumeField(), paper_cilium(), rod, x)));
    record("mesh F of degree 8 against the rod's two discs", error);
    EXPECT_LT(error, 1e-9);
  }
}

// In pure bending F = Λ diag(1, 1, J), so that F·M/J = R·M = M d₃ and both fields are one.
// Measured 8e-14, asked 1e-8.
TEST(MeshField, PushForwardsAgreeInPureBending) {
  const CylinderBody cylinder{.degree = 6};
  const Deformation body = deformation_of(cylinder, rod_map(oracle::arc(60, 0.5)));
  double difference = 0;
  for (const Vector3& x : {oracle::paper_sensor, Vector3(-6e-3, 2e-3, 9e-3)})
    difference =
        std::max(difference, relative_difference(flux_density(mesh_R, paper_cilium(), body, x),
                                                 flux_density(mesh_F, paper_cilium(), body, x)));
  record("mesh R against F in pure bending", difference);
  EXPECT_LT(difference, 1e-8);
}

/// ∫ b(moment, x − F X) dV₀ over the exact cylinder, Gauss–Legendre in r and z, trapezoid in φ.
Vector3 field_of_uniform_moment(const Vector3& moment, const Matrix3& F, const Vector3& x) {
  const QuadratureRule radial = gauss_legendre(24, 0, 1.5e-3);
  const QuadratureRule axial = gauss_legendre(60, 3e-3, 20e-3);
  const int azimuths = 60;
  Vector3 B = Vector3::Zero();
  for (std::size_t i = 0; i < radial.nodes.size(); ++i) {
    for (std::size_t k = 0; k < axial.nodes.size(); ++k) {
      for (int j = 0; j < azimuths; ++j) {
        const double phi = 2 * std::numbers::pi * j / azimuths;
        const double r = radial.nodes[i];
        const Vector3 X(r * std::cos(phi), r * std::sin(phi), axial.nodes[k]);
        const double dV =
            radial.weights[i] * axial.weights[k] * r * 2 * std::numbers::pi / azimuths;
        B += sources::dipole_field(dV * moment, x - F * X);
      }
    }
  }
  return B;
}

// Oracle: F = Q·U with a given rotation and stretch has the moments F·M and Q·M J per reference
// volume, whose fields are integrated here over the exact cylinder. Measured 2e-8, the geometry of
// degree 6; margin 6.
TEST(MeshField, PushForwardsOfAHomogeneousDeformationAreTheirIntegrals) {
  const CylinderBody cylinder{.degree = 6, .layers = 1};
  const Quaternion Q(Eigen::AngleAxisd(0.8, Vector3(1, 2, -0.5).normalized()));
  Matrix3 U;
  U << 0.95, 0.05, 0.1, 0.05, 1.1, -0.08, 0.1, -0.08, 1.25;
  const Matrix3 F = Q.toRotationMatrix() * U;
  const Deformation body =
      deformation_of(cylinder, [&](const Vector3& X) { return Vector3(F * X); });
  const Vector3 M = 75e3 * Vector3::UnitZ();
  const Vector3 moment_F = F * M;
  const Vector3 moment_R = F.determinant() * (Q * M);
  double error_F = 0;
  double error_R = 0;
  double apart = 1;
  for (const Vector3& X : {Vector3(4e-3, 1e-3, 1e-3), Vector3(-1e-3, 5e-3, 12e-3)}) {
    const Vector3 x = F * X;
    const Vector3 B_F = flux_density(mesh_F, paper_cilium(), body, x);
    const Vector3 B_R = flux_density(mesh_R, paper_cilium(), body, x);
    error_F = std::max(error_F, relative_difference(B_F, field_of_uniform_moment(moment_F, F, x)));
    error_R = std::max(error_R, relative_difference(B_R, field_of_uniform_moment(moment_R, F, x)));
    apart = std::min(apart, relative_difference(B_R, B_F));
  }
  record("mesh F, homogeneous deformation", error_F);
  record("mesh R, homogeneous deformation", error_R);
  EXPECT_LT(error_F, 1e-7);
  EXPECT_LT(error_R, 1e-7);
  EXPECT_GT(apart, 0.02);
}

// Oracle: the same faces integrated to 1e-12. The estimate bounds the error of the integration, not
// that of the mesh.
TEST(MeshField, UncertaintyBoundsTheErrorOfItsQuadrature) {
  const CylinderBody cylinder{.degree = 3, .cuts = 2, .layers = 1};
  const Deformation body = deformation_of(cylinder, identity);
  for (const double height : {1e-5, 1e-4, 1e-3, 1e-2, 1e-1}) {
    const Vector3 x(0.3e-3, -0.8e-3, 20e-3 + height);
    const Field field = body::MeshField({sources::PushForward::F, 1e-5})
                            .field(paper_cilium(), body, std::span(&x, 1));
    const Vector3 exact =
        flux_density(body::MeshField({sources::PushForward::F, 1e-12}), paper_cilium(), body, x);
    EXPECT_LE((field.B.front() - exact).norm(),
              field.uncertainty.front().norm() + 1e-12 * exact.norm());
    EXPECT_LE(field.uncertainty.front().norm(), 1e-5 * exact.norm());
  }
}

}  // namespace
}  // namespace ciliaval::analytic

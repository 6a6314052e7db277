// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Oracle of this file: Maxwell's equations, ∇·B = 0 everywhere, ∇×(B/μ₀ − m) = 0, and what they say
// of flux and jumps. Differences are of fourth order.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include "analytic/rod/field_models.h"
#include "problem/lagrange.h"
#include "tests/analytic/oracles/bent_rods.h"

namespace ciliaval::analytic {
namespace {

using oracle::arc;
using oracle::contorted;
using oracle::flux_density;
using oracle::paper_cilium;
using oracle::record;
using oracle::sampled;
using Slices = rod::VolumeOptions::Slices;
using VectorField = std::function<Vector3(const Vector3&)>;

/// ∂B_i/∂x_j
Matrix3 gradient(const VectorField& B, const Vector3& x, double h) {
  Matrix3 result;
  for (int j = 0; j < 3; ++j) {
    const Vector3 step = h * Vector3::Unit(j);
    result.col(j) =
        (8 * (B(x + step) - B(x - step)) - (B(x + 2 * step) - B(x - 2 * step))) / (12 * h);
  }
  return result;
}

Vector3 curl(const Matrix3& g) {
  return {g(2, 1) - g(1, 2), g(0, 2) - g(2, 0), g(1, 0) - g(0, 1)};
}

VectorField field_of(const FieldModel& model, const oracle::Shape& shape) {
  return [&model, deformation = sampled(paper_cilium(), shape)](const Vector3& x) {
    return flux_density(model, paper_cilium(), deformation, x);
  };
}

// Measured 6e-10 of |∇B|, the error of the differences; margin 15.
TEST(Maxwell, FieldOutsideHasNeitherDivergenceNorCurl) {
  const std::vector<std::shared_ptr<FieldModel>> models = {
      std::make_shared<rod::DipoleField>(), std::make_shared<rod::LineField>(),
      std::make_shared<rod::LineField>(
          rod::LineOptions{sources::PushForward::R, rod::Method::quadrature, 1e-12}),
      std::make_shared<rod::VolumeField>(),
      std::make_shared<rod::VolumeField>(
          rod::VolumeOptions{Slices::stacked, rod::Method::closed_form, 1e-11})};
  double error = 0;
  for (const auto& model : models) {
    const VectorField B = field_of(*model, contorted());
    for (const Vector3& x :
         {oracle::paper_sensor, Vector3(5e-3, -4e-3, 6e-3), Vector3(-3e-3, 3e-3, 30e-3)}) {
      const Matrix3 g = gradient(B, x, 2e-5);
      error = std::max({error, std::abs(g.trace()) / g.norm(), curl(g).norm() / g.norm()});
    }
  }
  record("divergence and curl outside over the gradient", error);
  EXPECT_LT(error, 1e-8);
}

// m = F·M/J is what makes the field of two discs solenoidal inside a sheared, twisted magnet: any
// other m would leave μ₀∇·m, of the order μ₀Mκ = 6 T/m.
// Measured 6e-12 T/m.
TEST(Maxwell, FieldOfTheWedgeInsideHasNoDivergence) {
  const rod::VolumeField model;
  const VectorField B = field_of(model, contorted());
  const CentrelinePoint section = contorted()(11e-3);
  double error = 0;
  for (const Vector3& offset :
       {Vector3(0, 0, 0), Vector3(0.9e-3, 0.2e-3, 0), Vector3(-0.4e-3, -1.1e-3, 0)})
    error = std::max(
        error, std::abs(gradient(B, section.position + section.rotation * offset, 2e-5).trace()));
  record("divergence of B inside a contorted rod, T/m", error);
  EXPECT_LT(error, 1e-9);
}

// Inside the arc m is known: M t for the wedge, M t/J for the stack, J = 1 − κ·offset.
TEST(Maxwell, MagneticFieldInsideTheArcHasNoCurl) {
  const double curvature = 60;
  const Vector3 centre(1 / curvature, 0, 0);
  for (const Slices slices : {Slices::wedge, Slices::stacked}) {
    const rod::VolumeField model({slices, rod::Method::closed_form, 1e-12});
    const VectorField B = field_of(model, arc(curvature, 0));
    const VectorField H = [&](const Vector3& x) {
      const Vector3 arm = x - centre;  // in the plane of the arc, the tangent is ŷ × arm
      const double distance = std::hypot(arm.x(), arm.z());
      const Vector3 t = Vector3(arm.z(), 0, -arm.x()) / distance;
      const double J = slices == Slices::wedge ? 1 : curvature * distance;
      return Vector3(B(x) / vacuum_permeability - 75e3 / J * t);
    };
    const double theta = curvature * 12e-3;
    const Vector3 x =
        centre + 15.9e-3 * Vector3(-std::cos(theta), 0, std::sin(theta)) + Vector3(0, 0.6e-3, 0);
    const Matrix3 g = gradient(H, x, 2e-5);
    // A wrong m would leave a curl of the order Mκ = 4.5e6 A/m².
    EXPECT_LT(curl(g).norm(), 1.0);
    EXPECT_LT(std::abs(gradient(B, x, 2e-5).trace()), 1e-6);
  }
}

TEST(Maxwell, OnlyTheTangentialFieldJumpsAcrossTheMantle) {
  const rod::VolumeField model;
  const VectorField B = field_of(model, arc(60, 0.5));
  const CentrelinePoint section = arc(60, 0.5)(9e-3);
  for (const double phi : {0.0, 1.0, 2.5, 4.0}) {
    const Vector3 n = section.rotation * Vector3(std::cos(phi), std::sin(phi), 0);
    const auto at = [&](double r) { return B(section.position + r * n); };
    const Vector3 jump = at(1.5e-3 * (1 - 1e-10)) - at(1.5e-3 * (1 + 1e-10));
    const Vector3 expected = vacuum_permeability * 75e3 * section.normal();
    EXPECT_LT((jump - expected).norm(), 1e-9 * expected.norm());
  }
}

TEST(Maxwell, OnlyTheTangentialFieldJumpsAcrossTheEndFaces) {
  // Under shear m is not normal to the end face, so the tangential B does jump there.
  const rod::VolumeField model;
  const VectorField B = field_of(model, contorted());
  for (const double S : {3e-3, 20e-3}) {
    const CentrelinePoint end = contorted()(S);
    const Vector3 n = end.normal();
    const Vector3 x = end.position + end.rotation * Vector3(0.5e-3, -0.3e-3, 0);
    const Vector3 above = B(x + 1e-12 * n);
    const Vector3 below = B(x - 1e-12 * n);
    EXPECT_NEAR((above - below).dot(n), 0, 1e-8);
    EXPECT_GT((above - below).norm(), 1e-3);
    const Vector3 on = B(x);
    EXPECT_NEAR((on - above).dot(n), 0, 1e-8);
  }
}

/// ∮ B·dA over a hemisphere about the section's centre, on the side of d₃, and the section's plane
/// that closes it, T·m². The plane is cut at the mantle.
double flux_around_the_upper_half(const VectorField& B, const CentrelinePoint& section, double R,
                                  double outer) {
  const int azimuths = 120;
  const double dphi = 2 * std::numbers::pi / azimuths;
  const QuadratureRule inside = gauss_legendre(24, 0, R);
  const QuadratureRule outside = gauss_legendre(60, R / outer, 1);  // r = R/u
  const QuadratureRule polar = gauss_legendre(60, 0, 1);            // cos θ
  double flux = 0;
  for (int i = 0; i < azimuths; ++i) {
    const Vector3 e = section.rotation * Vector3(std::cos(i * dphi), std::sin(i * dphi), 0);
    const Vector3 n = section.normal();
    const auto through_plane = [&](double r) { return -B(section.position + r * e).dot(n) * r; };
    for (std::size_t k = 0; k < inside.nodes.size(); ++k)
      flux += inside.weights[k] * dphi * through_plane(inside.nodes[k]);
    for (std::size_t k = 0; k < outside.nodes.size(); ++k) {
      const double r = R / outside.nodes[k];
      flux += outside.weights[k] * dphi * r * r / R * through_plane(r);
    }
    for (std::size_t k = 0; k < polar.nodes.size(); ++k) {
      const double cosine = polar.nodes[k];
      const Vector3 normal = std::sqrt(1 - cosine * cosine) * e + cosine * n;
      flux += polar.weights[k] * dphi * outer * outer *
              B(section.position + outer * normal).dot(normal);
    }
  }
  return flux;
}

// Measured 7e-16 of μ₀MπR², which is what would be left if μ₀m were missing; margin 100.
TEST(Maxwell, NoFluxLeavesAClosedSurfaceThroughTheMagnet) {
  const rod::VolumeField model;
  const double magnet_flux =
      vacuum_permeability * 75e3 * std::numbers::pi * 1.5e-3 * 1.5e-3;  // μ₀MπR²
  for (const oracle::Shape& shape : {arc(60, 0.5), contorted()}) {
    const double flux =
        flux_around_the_upper_half(field_of(model, shape), shape(11e-3), 1.5e-3, 40e-3);
    record("flux through a closed surface over the magnet's", std::abs(flux) / magnet_flux);
    EXPECT_LT(std::abs(flux), 1e-13 * magnet_flux);
  }
}

}  // namespace
}  // namespace ciliaval::analytic

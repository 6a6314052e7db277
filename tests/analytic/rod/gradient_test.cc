// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Oracles of this file: differences of fourth order of the field, Maxwell's equations, and the
// gradient of a straight cylinder by problem/surroundings/magnets, which shares no code.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "analytic/rod/field_models.h"
#include "problem/error.h"
#include "problem/surroundings/magnets/field.h"
#include "tests/analytic/oracles/bent_rods.h"

namespace ciliaval::analytic {
namespace {

using oracle::contorted;
using oracle::paper_cilium;
using oracle::record;
using oracle::sampled;

const std::vector<Vector3> points{
    oracle::paper_sensor, {5e-3, -4e-3, 6e-3}, {-3e-3, 3e-3, 30e-3}, {0.2, -0.3, 0.1}};

/// The largest difference between the gradient and differences of the field, over |∇B|, and the
/// largest trace and antisymmetric part.
struct Deviation {
  double differences = 0;
  double maxwell = 0;
};
template <class Model>
Deviation deviation(const Model& model) {
  const Cilium cilium = paper_cilium();
  const Deformation deformation = sampled(cilium, contorted());
  const std::vector<Matrix3> gradients = model.gradient(cilium, deformation, points);
  Deviation result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Matrix3& g = gradients[i];
    const double h = 2e-4 * (points[i] - Vector3(0, 0, 8e-3)).norm();
    for (int k = 0; k < 3; ++k) {
      const auto B = [&](double t) {
        return oracle::flux_density(model, cilium, deformation,
                                    points[i] + t * h * Vector3::Unit(k));
      };
      const Vector3 slope = (8 * (B(1) - B(-1)) - (B(2) - B(-2))) / (12 * h);
      result.differences = std::max(result.differences, (slope - g.col(k)).norm() / g.norm());
    }
    result.maxwell = std::max(
        {result.maxwell, std::abs(g.trace()) / g.norm(), (g - g.transpose()).norm() / g.norm()});
  }
  return result;
}

// Differences of a field of 1e-15 over steps of 2e-4 of the distance are good to 1e-11 or so.
// Measured 9e-12, and 4e-15 of trace and antisymmetric part; margin 10.
TEST(RodGradient, IsTheDerivativeOfTheField) {
  using sources::PushForward;
  const auto check = [](const char* name, const auto& model) {
    const Deviation found = deviation(model);
    record(std::string("gradient against differences, ") + name, found.differences);
    record(std::string("trace and antisymmetric part, ") + name, found.maxwell);
    EXPECT_LT(found.differences, 1e-10) << name;
    EXPECT_LT(found.maxwell, 4e-14) << name;
  };
  check("dipole F", rod::DipoleField());
  check("dipole R", rod::DipoleField({PushForward::R}));
  check("line, poles", rod::LineField());
  check("line, R", rod::LineField({PushForward::R, rod::Method::quadrature, 1e-12}));
  check("volume", rod::VolumeField());
}

// On the axis of the straight magnet, next to it, beside it and far away. Far away the ends cancel
// by distance over length. Measured 5e-14; margin 10.
TEST(RodGradient, OfTheStraightMagnetIsThatOfTheCylinder) {
  using surroundings::magnets::Magnet;
  using surroundings::magnets::Shape;
  const Cilium cilium = paper_cilium();
  const Deformation straight = oracle::straight(cilium);
  Magnet magnet;
  magnet.shape = Shape::cylinder;
  magnet.position = {0, 0, 11.5e-3};
  magnet.diameter = 3e-3;
  magnet.length = 17e-3;
  magnet.magnetization = {0, 0, 75e3};
  double error = 0;
  for (const Vector3& x :
       {Vector3(0, 0, -1e-3), Vector3(1e-13, 0, 21e-3), Vector3(1e-6, -1e-6, 1e-3),
        Vector3(1.5e-3, 0, 2e-3), Vector3(1.6e-3, 0, 3e-3), Vector3(2e-3, 1e-3, 9e-3),
        Vector3(0, 0, 0.5), Vector3(0.3, 0.4, 0.1)}) {
    const Matrix3 exact = surroundings::magnets::jet(magnet, x).gradient;
    const Matrix3 g = rod::VolumeField().gradient(cilium, straight, std::span(&x, 1)).front();
    error = std::max(error, (g - exact).norm() / exact.norm() /
                                std::max(1.0, (x - magnet.position).norm() / magnet.length));
  }
  record("gradient of the straight magnet against the cylinder, relative", error);
  EXPECT_LT(error, 5e-13);
}

// A pole moved along the segment is a dipole: the line's closed form and its quadrature are one,
// whatever the section. A tube has two charged discs at each end.
TEST(RodGradient, OfTheLinesPolesIsThatOfItsDipoles) {
  using Shape = CrossSection::Shape;
  for (const CrossSection& section :
       {CrossSection{}, CrossSection{.shape = Shape::tube, .inner_diameter = 1e-3},
        CrossSection{.shape = Shape::rectangle, .width = 2e-3, .height = 1e-3}}) {
    Cilium cilium = paper_cilium();
    cilium.section = section;
    const Deformation deformation = sampled(cilium, contorted());
    const rod::LineField quadrature({sources::PushForward::F, rod::Method::quadrature, 1e-12});
    const auto a = rod::LineField().gradient(cilium, deformation, points);
    const auto b = quadrature.gradient(cilium, deformation, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_LT((a[i] - b[i]).norm(), 1e-11 * b[i].norm());
      const Vector3 B = oracle::flux_density(quadrature, cilium, deformation, points[i]);
      EXPECT_LT((oracle::flux_density(rod::LineField(), cilium, deformation, points[i]) - B).norm(),
                1e-11 * B.norm());
    }
  }
}

TEST(RodGradient, IsRefusedWhereThereIsNone) {
  const Cilium cilium = paper_cilium();
  const Deformation straight = oracle::straight(cilium);
  const auto at = [&](const auto& model, const Vector3& x) {
    return model.gradient(cilium, straight, std::span(&x, 1));
  };
  const Vector3 outside(0, 0, -1e-3);
  EXPECT_THROW(at(rod::VolumeField(), Vector3(0, 0, 10e-3)), InputError);
  EXPECT_THROW(at(rod::VolumeField(), Vector3(1.5e-3, 0, 20e-3)), InputError);
  EXPECT_THROW(at(rod::VolumeField({rod::VolumeOptions::Slices::stacked}), outside), InputError);
  EXPECT_THROW(at(rod::LineField({sources::PushForward::F, rod::Method::uniform}), outside),
               InputError);
}

}  // namespace
}  // namespace ciliaval::analytic

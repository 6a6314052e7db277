// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "analytic/rod/field_models.h"
#include "tests/analytic/oracles/bent_rods.h"

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

using NamedModel = std::pair<std::string, std::shared_ptr<FieldModel>>;

std::vector<NamedModel> rod_models() {
  const auto volume = [](Slices slices, rod::Method method) {
    return std::make_shared<rod::VolumeField>(rod::VolumeOptions{slices, method, 1e-11});
  };
  const auto line = [](sources::PushForward push_forward, rod::Method method) {
    return std::make_shared<rod::LineField>(rod::LineOptions{push_forward, method, 1e-12});
  };
  return {
      {"dipole F", std::make_shared<rod::DipoleField>(rod::DipoleOptions{sources::PushForward::F})},
      {"dipole R", std::make_shared<rod::DipoleField>(rod::DipoleOptions{sources::PushForward::R})},
      {"line F", line(sources::PushForward::F, rod::Method::closed_form)},
      {"line F quadrature", line(sources::PushForward::F, rod::Method::quadrature)},
      {"line R", line(sources::PushForward::R, rod::Method::quadrature)},
      {"wedge", volume(Slices::wedge, rod::Method::closed_form)},
      {"wedge quadrature", volume(Slices::wedge, rod::Method::quadrature)},
      {"stacked", volume(Slices::stacked, rod::Method::closed_form)},
      {"stacked quadrature", volume(Slices::stacked, rod::Method::quadrature)}};
}

// Oracle: the laws know no direction in space. Measured 2e-15, of rounding alone.
TEST(Invariance, RotatingRodAndPointRotatesTheField) {
  const Cilium cilium = paper_cilium();
  const Quaternion rotation(Eigen::AngleAxisd(2.1, Vector3(0.3, -0.8, 0.4).normalized()));
  const Vector3 shift(1e-3, -2e-3, 4e-3);
  const Deformation original = sampled(cilium, contorted());
  const Deformation turned = sampled(cilium, oracle::moved(contorted(), rotation, shift));
  double error = 0;
  for (const auto& [name, model] : rod_models()) {
    for (const Vector3& x : {oracle::paper_sensor, Vector3(5e-3, -4e-3, 6e-3)}) {
      const Vector3 expected = rotation * flux_density(*model, cilium, original, x);
      const Vector3 value = flux_density(*model, cilium, turned, rotation * x + shift);
      error = std::max(error, relative_difference(value, expected));
    }
  }
  const rod::VolumeField wedge;
  const CentrelinePoint section = contorted()(8e-3);
  const Vector3 inside = section.position + section.rotation * Vector3(1e-3, -0.5e-3, 0);
  error = std::max(
      error, relative_difference(flux_density(wedge, cilium, turned, rotation * inside + shift),
                                 rotation * flux_density(wedge, cilium, original, inside)));
  record("rotated field against field of the rotated, relative", error);
  EXPECT_LT(error, 1e-12);
}

/// The paper's cilium with its magnet cut into segments of the given magnetisations.
Cilium cut_magnet(const std::vector<double>& magnetizations) {
  Cilium cilium = paper_cilium();
  const Segment magnet = cilium.segments.back();
  cilium.segments.pop_back();
  for (const double M : magnetizations) {
    cilium.segments.push_back(magnet);
    cilium.segments.back().length /= static_cast<double>(magnetizations.size());
    cilium.segments.back().magnetization = M;
  }
  return cilium;
}

// Oracle: superposition of the segments one by one.
TEST(Linearity, FieldsOfSegmentsAdd) {
  const std::vector<double> magnetizations = {75e3, 0, -30e3, 50e3};
  const Cilium cilium = cut_magnet(magnetizations);
  const Deformation deformation = sampled(cilium, contorted());
  double error = 0;
  for (const auto& [name, model] : rod_models()) {
    const Vector3 x(-2e-3, 3e-3, -1e-3);
    Vector3 sum = Vector3::Zero();
    for (std::size_t i = 0; i < magnetizations.size(); ++i) {
      std::vector<double> one(magnetizations.size(), 0.0);
      one[i] = magnetizations[i];
      sum += flux_density(*model, cut_magnet(one), deformation, x);
    }
    error = std::max(error, relative_difference(flux_density(*model, cilium, deformation, x), sum));
  }
  record("field of four segments against the sum of each", error);
  EXPECT_LT(error, 2e-11);  // the quadratures' tolerance
}

TEST(Linearity, ACutThroughTheMagnetChangesNothing) {
  const Cilium whole = paper_cilium();
  const Cilium halves = cut_magnet({75e3, 75e3});
  const CentrelinePoint cut = arc(60, 0.5)(11.5e-3);
  const Vector3 rim = cut.position + cut.rotation * Vector3(1.5e-3, 0, 0);
  for (const auto& [name, model] : rod_models()) {
    if (name.starts_with("dipole")) continue;  // two dipoles are not one
    std::vector<Vector3> points = {oracle::paper_sensor, {5e-3, -4e-3, 6e-3}};
    if (name == "wedge") {
      points.push_back(rim);
      points.push_back(cut.position);
      points.push_back(cut.position + cut.rotation * Vector3(1e-3, 0.7e-3, 0));
    }
    for (const Vector3& x : points)
      EXPECT_LT(relative_difference(flux_density(*model, halves, sampled(halves, arc(60, 0.5)), x),
                                    flux_density(*model, whole, sampled(whole, arc(60, 0.5)), x)),
                2e-11)
          << name;
  }
}

// Oracle: the normal component of B is continuous, so on the interface itself it is that of both
// sides, whichever side the rounding of the point falls on.
TEST(Linearity, FieldOnAnInterfaceIsThatOfItsTwoSides) {
  const Cilium cilium = cut_magnet({75e3, -30e3});
  const Deformation deformation = sampled(cilium, arc(60, 0.5));
  const CentrelinePoint cut = arc(60, 0.5)(11.5e-3);
  for (const double r : {0.0, 0.4e-3, 1.2e-3}) {
    const Vector3 x = cut.position + cut.rotation * Vector3(r, 0.3e-3, 0);
    const auto normal_field = [&](double height) {
      return flux_density(rod::VolumeField(), cilium, deformation, x + height * cut.normal())
          .dot(cut.normal());
    };
    EXPECT_NEAR(normal_field(0), normal_field(1e-11), 1e-8);
    EXPECT_NEAR(normal_field(0), normal_field(-1e-11), 1e-8);
  }
}

TEST(Linearity, ACiliumWithoutMagnetHasNoField) {
  const Cilium cilium = cut_magnet({0, 0});
  for (const auto& [name, model] : rod_models())
    EXPECT_EQ(flux_density(*model, cilium, sampled(cilium, contorted()), {0, 0, -1e-3}),
              Vector3(0, 0, 0))
        << name;
}

}  // namespace
}  // namespace ciliaval::analytic

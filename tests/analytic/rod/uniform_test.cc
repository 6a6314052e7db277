// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The paper's own discretisation: sums of n and n³ dipoles over slices of equal height.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analytic/elastica/elastica.h"
#include "analytic/rod/field_models.h"
#include "analytic/sources/dipole.h"
#include "problem/error.h"
#include "tests/analytic/oracles/bent_rods.h"

namespace ciliaval::analytic {
namespace {

using oracle::flux_density;
using oracle::paper_cilium;
using oracle::paper_sensor;
using oracle::record;
using oracle::relative_difference;
using Slices = rod::VolumeOptions::Slices;

constexpr double curvature = 60;
constexpr double azimuth = 0.5;

rod::LineField line_sum(unsigned int n) {
  return rod::LineField({.method = rod::Method::uniform, .elements = n});
}

rod::VolumeField volume_sum(Slices slices, unsigned int n) {
  return rod::VolumeField({.slices = slices, .method = rod::Method::uniform, .elements = n});
}

/// Eq. 5 summed over n slices of equal dz of the arc, on which S = arcsin(κz)/κ and dS = dz/cosθ;
/// `rings` and `azimuths` dipoles in each, of the volumes r dr dφ, or one on the axis.
Vector3 plain_sum(int n, int rings, bool jacobian, const Vector3& x) {
  const double R = 1.5e-3;
  const Vector3 e(std::cos(azimuth), std::sin(azimuth), 0);
  const double bottom = std::sin(curvature * 3e-3) / curvature;
  const double top = std::sin(curvature * 20e-3) / curvature;
  const double dz = (top - bottom) / n;
  Vector3 B = Vector3::Zero();
  for (int i = 0; i < n; ++i) {
    const double z = bottom + (i + 0.5) * dz;
    const double theta = std::asin(curvature * z);
    const Vector3 t = std::sin(theta) * e + std::cos(theta) * Vector3::UnitZ();
    const Vector3 u = std::cos(theta) * e - std::sin(theta) * Vector3::UnitZ();
    const Vector3 v = Vector3::UnitZ().cross(e);
    const Vector3 r((1 - std::cos(theta)) / curvature * e + z * Vector3::UnitZ());
    const double dS = dz / std::cos(theta);
    if (rings == 0) {
      B += sources::dipole_field(75e3 * std::numbers::pi * R * R * dS * t, x - r);
      continue;
    }
    for (int j = 0; j < rings; ++j)
      for (int k = 0; k < rings; ++k) {
        const double radius = (j + 0.5) * R / rings;
        // The paper's φ counts from the plane of bending, the rod's from d₁: turned by the azimuth.
        const double phi = 2 * std::numbers::pi * (k + 0.5) / rings - azimuth;
        const double dA = radius * R / rings * 2 * std::numbers::pi / rings;
        const double J = jacobian ? 1 - curvature * radius * std::cos(phi) : 1;
        const Vector3 y = r + radius * (std::cos(phi) * u + std::sin(phi) * v);
        B += sources::dipole_field(75e3 * J * dA * dS * t, x - y);
      }
  }
  return B;
}

// Oracle: the sums written out on the arc. Measured 1e-14; margin 100.
TEST(PapersSums, AreThePlainSumsOverSlicesOfEqualHeight) {
  for (const Vector3& x : {paper_sensor, Vector3(4e-3, -3e-3, 1e-3)}) {
    const auto error = [&](const FieldModel& model, const Vector3& sum) {
      return relative_difference(flux_density(model, paper_cilium(), oracle::bent_cilium(), x),
                                 sum);
    };
    const double line = error(line_sum(13), plain_sum(13, 0, false, x));
    const double stacked = error(volume_sum(Slices::stacked, 7), plain_sum(7, 7, false, x));
    const double wedge = error(volume_sum(Slices::wedge, 7), plain_sum(7, 7, true, x));
    record("uniform sums against the plain ones", std::max({line, stacked, wedge}));
    EXPECT_LT(line, 1e-12);
    EXPECT_LT(stacked, 1e-12);
    EXPECT_LT(wedge, 1e-12);
  }
}

/// The paper's cilium under the paper's load of 4 mN at 16 mm.
Deformation papers_deformation() {
  return *elastica::Elastica()
              .solve(paper_cilium(), {ContactLoad{4e-3, 16e-3, std::numbers::pi / 6}})
              .steps.front()
              .deformation;
}

// Oracle: the closed forms. The midpoint rule is of second order. The figures are those of the
// table in docs/evidence/fields.md.
TEST(PapersSums, ConvergeToTheClosedFormsAtSecondOrder) {
  const Deformation deformation = papers_deformation();
  const auto converge = [&](const std::string& name, auto sum, const FieldModel& closed,
                            const std::vector<unsigned int>& counts) {
    const Vector3 exact = flux_density(closed, paper_cilium(), deformation, paper_sensor);
    double previous = 0;
    for (const unsigned int n : counts) {
      const Field field = sum(n).field(paper_cilium(), deformation, std::span(&paper_sensor, 1));
      const double error = relative_difference(field.B.front(), exact);
      record(name + ", n = " + std::to_string(n), error);
      EXPECT_LE(error * exact.norm(), field.uncertainty.front().norm()) << name << ' ' << n;
      if (previous > 0) {
        EXPECT_NEAR(std::log2(previous / error), 2, 0.1) << name << ' ' << n;
        EXPECT_LE(field.uncertainty.front().norm(), 5 * error * exact.norm()) << name << ' ' << n;
      }
      previous = error;
    }
  };
  converge("line", line_sum, rod::LineField(), {25, 50, 100, 200, 400, 800, 1600});
  converge("stacked", [](unsigned int n) { return volume_sum(Slices::stacked, n); },
           rod::VolumeField({Slices::stacked}), {20, 40, 80});
  converge("wedge", [](unsigned int n) { return volume_sum(Slices::wedge, n); }, rod::VolumeField(),
           {20, 40, 80});
}

TEST(PapersSums, TakeEitherPushForward) {
  const Deformation deformation = oracle::sampled(paper_cilium(), oracle::contorted());
  for (const sources::PushForward push_forward :
       {sources::PushForward::F, sources::PushForward::R}) {
    const Vector3 exact =
        flux_density(rod::LineField({push_forward}), paper_cilium(), deformation, paper_sensor);
    const Vector3 sum =
        flux_density(rod::LineField({push_forward, rod::Method::uniform, 1e-10, 4000}),
                     paper_cilium(), deformation, paper_sensor);
    EXPECT_LT(relative_difference(sum, exact), 1e-6);
  }
}

TEST(PapersSums, HaveAnEstimateForASingleDipoleToo) {
  const Field field =
      line_sum(1).field(paper_cilium(), oracle::bent_cilium(), std::span(&paper_sensor, 1));
  const Vector3 exact =
      flux_density(rod::LineField(), paper_cilium(), oracle::bent_cilium(), paper_sensor);
  EXPECT_LE((field.B.front() - exact).norm(), 3 * field.uncertainty.front().norm());
  EXPECT_GT(field.uncertainty.front().norm(), 0);
}

TEST(PapersSums, SayWhatTheyCannotDo) {
  const auto error_of = [](const FieldModel& model, const Deformation& deformation,
                           const Vector3& x) -> std::string {
    try {
      flux_density(model, paper_cilium(), deformation, x);
    } catch (const InputError& error) {
      return std::string("input: ") + error.what();
    } catch (const SolverError& error) {
      return std::string("solver: ") + error.what();
    }
    return {};
  };
  // Bent by 2 rad, the arc's tip points down.
  const Deformation falling = oracle::sampled(paper_cilium(), oracle::arc(100, 0));
  EXPECT_TRUE(error_of(line_sum(10), falling, paper_sensor).starts_with("input: the method"));
  EXPECT_TRUE(
      error_of(line_sum(0), oracle::bent_cilium(), paper_sensor).starts_with("input: the method"));
  const Vector3 inside = oracle::arc(curvature, azimuth)(9e-3).position;
  const std::string message = error_of(volume_sum(Slices::wedge, 4), oracle::bent_cilium(), inside);
  EXPECT_TRUE(message.starts_with("solver: ")) << message;
  EXPECT_NE(message.find("inside the magnet"), std::string::npos);
}

}  // namespace
}  // namespace ciliaval::analytic

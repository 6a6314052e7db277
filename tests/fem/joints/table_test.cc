// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "fem/beam/section.h"
#include "fem/joints/end_problem.h"
#include "problem/error.h"
#include "problem/joints/joints.h"

namespace ciliaval::joints {
namespace {

using fem::joints::Bar;
using fem::joints::Base;
using fem::joints::Excess;

/// Cilium of diameter 1 with the bars as its segments.
Cilium cilium(const std::vector<Bar>& bars) {
  Cilium result;
  result.diameter = 1;
  for (const Bar& bar : bars)
    result.segments.push_back({.name = "bar",
                               .length = bar.length,
                               .young_modulus = bar.young_modulus,
                               .poisson_ratio = bar.poisson_ratio});
  return result;
}

/// Excess that a cilium has by its corrections, M and Q at height z: of the energy's shear
/// coefficient, as the end problem's.
Excess corrected(const std::vector<Bar>& bars, double z) {
  Excess sum;
  const Corrections all = corrections(cilium(bars));
  double S = 0;
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const Joint& joint = all.joints[i];
    const double arm = z - S;  // M at the joint is M + arm Q
    sum.rotation += joint.rotation;
    sum.coupling += joint.coupling + arm * joint.rotation;
    sum.displacement += joint.displacement + 2 * arm * joint.coupling + arm * arm * joint.rotation;
    sum.extension += joint.extension;
    S += bars[i].length;
  }
  // The rods' shear coefficient is Cowper's; the tip carries a moment (z − S) Q.
  S = 0;
  for (const Bar& bar : bars) {
    const double GA = bar.young_modulus / (2 * (1 + bar.poisson_ratio)) * std::numbers::pi / 4;
    const double difference = 1 / fem::beam::cowper_circle(bar.poisson_ratio) -
                              1 / fem::joints::energy_shear_coefficient(bar.poisson_ratio);
    sum.displacement += bar.length * difference / GA;
    S += bar.length;
  }
  const Bar& last = bars.back();
  const double GA = last.young_modulus / (2 * (1 + last.poisson_ratio)) * std::numbers::pi / 4;
  const double half = (1 / fem::joints::energy_shear_coefficient(last.poisson_ratio) -
                       1 / fem::beam::cowper_circle(last.poisson_ratio)) /
                      (2 * GA);
  sum.coupling -= half;
  sum.displacement -= 2 * (z - S) * half;
  return sum;
}

/// The largest of the four differences, in units of the softest segment at the clamp.
double difference(const Excess& a, const Excess& b, double E) {
  const double EA = E * std::numbers::pi / 4;
  const double EI = EA / 16;
  return std::max({EI * std::abs(a.rotation - b.rotation), EI * std::abs(a.coupling - b.coupling),
                   EI * std::abs(a.displacement - b.displacement),
                   EA * std::abs(a.extension - b.extension)});
}

double between(std::mt19937_64& random, double a, double b) {
  return std::uniform_real_distribution<double>(a, b)(random);
}

struct Measured {
  std::vector<double> errors;  ///< d/EI
  double quantile(double q) {
    std::sort(errors.begin(), errors.end());
    return errors[static_cast<std::size_t>(q * static_cast<double>(errors.size() - 1))];
  }
};

TEST(JointTable, ItsEntriesAreTheEndProblems) {
  Measured measured;
  std::mt19937_64 random(1);
  for (int i = 0; i < 12; ++i) {
    const double nu = between(random, 0, 0.4999);
    const double stiff = std::pow(10, between(random, 0, 3));
    const std::vector<Bar> bars{{2, 1, nu}, {2, stiff, between(random, 0, 0.4999)}};
    const double error =
        difference(corrected(bars, 2), fem::joints::excess(bars, Base::clamped, 2), 1);
    measured.errors.push_back(error);
  }
  RecordProperty("largest", std::to_string(measured.quantile(1)));
  std::printf("long segments: median %.1e, largest %.1e d/EI\n", measured.quantile(0.5),
              measured.quantile(1));
  EXPECT_LT(measured.quantile(1), 2e-4);
}

TEST(JointTable, ShortSegments) {
  Measured measured;
  std::mt19937_64 random(2);
  for (int i = 0; i < 12; ++i) {
    const double nu = between(random, 0.3, 0.4999);
    const double stiff = std::pow(10, between(random, 0.3, 3));
    const std::vector<Bar> bars{{between(random, 0.3, 1.5), 1, nu},
                                {2, stiff, between(random, 0.3, 0.4999)}};
    measured.errors.push_back(
        difference(corrected(bars, 0), fem::joints::excess(bars, Base::clamped, 0), 1));
  }
  std::printf("short segments: median %.1e, largest %.1e d/EI\n", measured.quantile(0.5),
              measured.quantile(1));
  EXPECT_LT(measured.quantile(1), 1e-3);
}

// Three segments, the middle one short, between bodies that are not rigid.
TEST(JointTable, AShortSegmentInTheMiddle) {
  Measured measured;
  std::mt19937_64 random(3);
  for (int i = 0; i < 12; ++i) {
    const std::vector<Bar> bars{
        {2, std::pow(10, between(random, 0, 2)), between(random, 0.3, 0.4999)},
        {between(random, 0.3, 1.5), 1, between(random, 0.3, 0.4999)},
        {2, std::pow(10, between(random, 0, 2)), between(random, 0.3, 0.4999)}};
    measured.errors.push_back(
        difference(corrected(bars, 2), fem::joints::excess(bars, Base::clamped, 2), 1));
  }
  std::printf("in the middle: median %.1e, largest %.1e d/EI\n", measured.quantile(0.5),
              measured.quantile(1));
  EXPECT_LT(measured.quantile(1), 3e-3);
}

TEST(JointTable, SaysWhereItEnds) {
  const Bar base{1, 1, 0.49};
  const Bar tip{3, 10, 0.4};
  EXPECT_NO_THROW(corrections(cilium({base, tip})));
  EXPECT_THROW(corrections(cilium({{0.29, 1, 0.49}, tip})), InputError);
  EXPECT_THROW(corrections(cilium({{1, 1, 0.49995}, tip})), InputError);
  EXPECT_THROW(corrections(cilium({{1, 1, -0.1}, tip})), InputError);
  Cilium tube = cilium({base, tip});
  tube.section = {.shape = CrossSection::Shape::tube, .inner_diameter = 0.5};
  EXPECT_THROW(corrections(tube), InputError);
}

}  // namespace
}  // namespace ciliaval::joints

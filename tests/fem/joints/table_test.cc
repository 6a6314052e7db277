// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "problem/error.h"
#include "problem/joints/joints.h"
#include "problem/joints/shear_coefficient.h"
#include "tools/end_problem/excess.h"

namespace ciliaval::joints {
namespace {

using tools::end_problem::Bar;
using tools::end_problem::Base;
using tools::end_problem::Excess;

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

/// The excess of joints together, M and Q at height z.
Excess together(const std::vector<Joint>& joints, const std::vector<Bar>& bars, double z) {
  Excess sum;
  double S = 0;
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const Joint& joint = joints[i];
    const double arm = z - S;  // M at the joint is M + arm Q
    sum.rotation += joint.rotation;
    sum.coupling += joint.coupling + arm * joint.rotation;
    sum.displacement += joint.displacement + 2 * arm * joint.coupling + arm * arm * joint.rotation;
    sum.extension += joint.extension;
    S += bars[i].length;
  }
  return sum;
}

/// Excess of a cilium by its corrections, beyond bars with the energy's shear coefficient, as the
/// end problem's is. The rods' is Cowper's: with ∫ Q² dS = [−QM], the tip carries (z − S) Q.
Excess corrected(const std::vector<Bar>& bars, double z) {
  Excess sum = together(corrections(cilium(bars)).joints, bars, z);
  const auto difference = [](const Bar& bar) {
    const double GA = bar.young_modulus / (2 * (1 + bar.poisson_ratio)) * std::numbers::pi / 4;
    return (1 / energy_shear_coefficient(bar.poisson_ratio) -
            1 / cowper_shear_coefficient(bar.poisson_ratio)) /
           GA;
  };
  double S = 0;
  for (const Bar& bar : bars) {
    sum.displacement -= bar.length * difference(bar);
    S += bar.length;
  }
  sum.coupling -= difference(bars.back()) / 2;
  sum.displacement -= (z - S) * difference(bars.back());
  return sum;
}

double between(std::mt19937_64& random, double a, double b) {
  return std::uniform_real_distribution<double>(a, b)(random);
}

/// Oracle: the end problem. The corrections of random bars differ from it by less than they are
/// uncertain by.
void compare(const char* what, double z,
             const std::function<std::vector<Bar>(std::mt19937_64&)>& draw) {
  std::mt19937_64 random(1);
  double largest = 0;
  for (int i = 0; i < 12; ++i) {
    const std::vector<Bar> bars = draw(random);
    const Excess own = corrected(bars, z);
    const Excess exact = tools::end_problem::excess(bars, Base::clamped, z);
    const Excess bound = together(uncertainties(cilium(bars)).joints, bars, z);
    for (const auto part :
         {&Excess::rotation, &Excess::coupling, &Excess::displacement, &Excess::extension}) {
      const double error = std::abs(own.*part - exact.*part);
      EXPECT_LE(error, bound.*part) << what << i;
      largest = std::max(largest, error / (bound.*part));
    }
  }
  std::printf("%s: error over uncertainty at most %.2f\n", what, largest);
}

TEST(JointTable, LongSegments) {
  compare("long segments", 2, [](std::mt19937_64& random) {
    return std::vector<Bar>{{2, 1, between(random, 0, 0.4999)},
                            {2, std::pow(10, between(random, 0, 3)), between(random, 0, 0.4999)}};
  });
}

TEST(JointTable, ShortSegments) {
  compare("short segments", 1.5, [](std::mt19937_64& random) {
    return std::vector<Bar>{
        {between(random, 0.3, 1.5), 1, between(random, 0.3, 0.4999)},
        {2, std::pow(10, between(random, 0.3, 3)), between(random, 0.3, 0.4999)}};
  });
}

TEST(JointTable, AShortSegmentInTheMiddle) {
  compare("between bodies that are not rigid", 3.5, [](std::mt19937_64& random) {
    return std::vector<Bar>{{2, std::pow(10, between(random, 0, 2)), between(random, 0.3, 0.4999)},
                            {between(random, 0.3, 1.5), 1, between(random, 0.3, 0.4999)},
                            {2, std::pow(10, between(random, 0, 2)), between(random, 0.3, 0.4999)}};
  });
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

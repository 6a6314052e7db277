// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/convergence/extrapolation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "problem/error.h"

namespace ciliaval::compare {
namespace {

/// f₀ + α h^p, finest first.
std::vector<convergence::RefinementLevel> levels(double limit, double slope, double p,
                                                 const std::vector<double>& sizes) {
  std::vector<convergence::RefinementLevel> result;
  result.reserve(sizes.size());
  for (const double h : sizes) result.push_back({h, limit + slope * std::pow(h, p)});
  return result;
}

// Oracle: the worked example of Celik et al. (2008), table 1, axial velocity at x/H = 8: N =
// 18,000, 8,000, 4,500 cells in the plane, φ = 6.063, 5.972, 5.863; p = 1.53, φ_ext = 6.1685,
// GCI_fine = 2.2 % (F_s = 1.25, of φ₁), here for the observed order taken as the formal one.
TEST(GridConvergence, IsThatOfThePublishedExample) {
  const std::vector<convergence::RefinementLevel> data{{1 / std::sqrt(18000.0), 6.063},
                                                       {1 / std::sqrt(8000.0), 5.972},
                                                       {1 / std::sqrt(4500.0), 5.863}};
  const convergence::Extrapolation result = convergence::grid_convergence(data, 1.53);
  ASSERT_TRUE(result.conclusive);
  EXPECT_NEAR(*result.order, 1.53, 0.005);
  EXPECT_NEAR(result.limit, 6.1685, 5e-4);
  EXPECT_EQ(result.safety, 1.25);
  EXPECT_NEAR(result.uncertainty / 6.063, 0.022, 5e-4);
}

// Oracle: the sequence's own order and limit.
TEST(GridConvergence, FindsOrderAndLimitOfAPureSequence) {
  for (const double p : {0.5, 1.0, 2.0, 3.7})
    for (const auto& sizes : {std::vector<double>{1, 2, 4}, {0.1, 0.13, 0.31}, {3, 9, 10}}) {
      const convergence::Extrapolation result =
          convergence::grid_convergence(levels(5, -2, p, sizes), p);
      ASSERT_TRUE(result.conclusive) << p;
      EXPECT_NEAR(*result.order, p, 1e-9);
      EXPECT_NEAR(result.limit, 5, 1e-10);
      EXPECT_EQ(result.safety, 1.25);
    }
}

// Out of the asymptotic range: F_s = 3, and no more order in the interval than the scheme has.
TEST(GridConvergence, IsCautiousOutOfTheAsymptoticRange) {
  const std::vector<convergence::RefinementLevel> data = levels(1, 0.1, 4, {1, 2, 4});
  const convergence::Extrapolation result = convergence::grid_convergence(data, 2);
  EXPECT_NEAR(*result.order, 4, 1e-9);
  EXPECT_EQ(result.safety, 3);
  EXPECT_NEAR(result.uncertainty, 3 * std::abs(data[1].value - data[0].value) / 3, 1e-12);
  EXPECT_EQ(convergence::grid_convergence(data).safety, 3) << "no formal order is known";
}

TEST(GridConvergence, GivesNoIntervalWhereItIsNotMonotone) {
  const std::vector<convergence::RefinementLevel> wavy{{1, 1.0}, {2, 1.1}, {4, 1.05}};
  EXPECT_FALSE(convergence::grid_convergence(wavy, 2).conclusive);
  EXPECT_NE(convergence::grid_convergence(wavy, 2).reason.find("monotone"), std::string::npos);
  const std::vector<convergence::RefinementLevel> still{{1, 1.0}, {2, 1.1}, {4, 1.1}};  // e₃₂ = 0
  EXPECT_FALSE(convergence::grid_convergence(still, 2).conclusive);
  const std::vector<convergence::RefinementLevel> diverging{{1, 1.0}, {2, 1.1}, {4, 1.15}};
  EXPECT_FALSE(convergence::grid_convergence(diverging, 2).conclusive);
  const std::vector<convergence::RefinementLevel> four{{1, 1.0}, {2, 1.1}, {4, 1.05}, {8, 1.2}};
  EXPECT_FALSE(convergence::least_squares_convergence(four, 2).conclusive);
}

// Exponential convergence, as of element degrees of a smooth solution: no order, but an interval.
// Oracle: the sequence's own limit; and that one slow change among fast ones gives none.
TEST(GridConvergence, FasterThanAnyOrderHasAnIntervalWithoutAnOrder) {
  std::vector<convergence::RefinementLevel> data;
  for (const double n : {5.0, 4.0, 3.0, 2.0})
    data.push_back({std::exp2(-n), std::pow(10.0, -n * n)});  // limit 0
  const std::vector<convergence::RefinementLevel> three(data.begin(), data.end() - 1);
  for (const convergence::Extrapolation& result :
       {convergence::extrapolate(three), convergence::extrapolate(data)}) {
    ASSERT_TRUE(result.conclusive) << result.reason;
    EXPECT_FALSE(result.order);
    EXPECT_EQ(result.reason, "faster than order 12");
    EXPECT_EQ(result.limit, data[0].value);
    EXPECT_DOUBLE_EQ(result.uncertainty, data[1].value - data[0].value) << "F_s = 3, order 2";
    EXPECT_GT(result.uncertainty, data[0].value);
  }
  EXPECT_DOUBLE_EQ(convergence::grid_convergence(three, 4).uncertainty,
                   (data[1].value - data[0].value) / 5);
  EXPECT_EQ(convergence::grid_convergence(three, 4, 0.5).uncertainty, 0.5) << "agree to rounding";
  data[0].value = data[1].value - (data[2].value - data[1].value);  // the last step is as large
  const convergence::Extrapolation slow = convergence::extrapolate(data);
  EXPECT_TRUE(!slow.conclusive || slow.order) << "an interval without an order";
}

TEST(GridConvergence, ValuesThatAgreeToRoundingAreConverged) {
  const std::vector<convergence::RefinementLevel> data{
      {1, 1.0}, {2, 1.0 + 1e-15}, {4, 1.0 - 1e-15}};
  const convergence::Extrapolation result = convergence::grid_convergence(data, 2, 1e-14);
  EXPECT_TRUE(result.conclusive);
  EXPECT_EQ(result.uncertainty, 1e-14);
  EXPECT_EQ(result.limit, 1.0);
}

// Oracle: the sequence's own order and limit.
TEST(LeastSquaresConvergence, FindsOrderAndLimitOfAPureSequence) {
  for (const double p : {0.7, 1.0, 2.0, 5.0}) {
    const convergence::Extrapolation result =
        convergence::least_squares_convergence(levels(-3, 0.2, p, {1, 1.5, 2, 3, 4}), p);
    ASSERT_TRUE(result.conclusive) << p;
    EXPECT_NEAR(*result.order, p, 1e-5);
    EXPECT_NEAR(result.limit, -3, 1e-6);
    EXPECT_EQ(result.safety, 1.25);
    EXPECT_NEAR(result.uncertainty, 1.25 * 0.2, 1e-5);
  }
}

// The interval holds the limit of sequences with a second term and noise. Oracle: the known limit.
TEST(LeastSquaresConvergence, TheIntervalHoldsTheLimit) {
  std::mt19937 random(7);  // NOLINT(cert-msc51-cpp): the same sequences in every run
  std::uniform_real_distribution<double> unit(-1, 1);
  int conclusive = 0;
  int held = 0;
  for (int i = 0; i < 500; ++i) {
    std::vector<convergence::RefinementLevel> data;
    const double second = 0.3 * unit(random);
    for (const double h : {0.125, 0.25, 0.5, 1.0})
      data.push_back({h, 2 + h * h + second * h * h * h + 1e-3 * unit(random)});
    const convergence::Extrapolation result = convergence::least_squares_convergence(data, 2);
    if (!result.conclusive) continue;
    ++conclusive;
    held += std::abs(data[0].value - 2) <= result.uncertainty;
  }
  std::printf("%d of %d conclusive intervals hold the limit\n", held, conclusive);
  EXPECT_GT(conclusive, 400);
  EXPECT_GE(held, 0.95 * conclusive);
}

TEST(GridConvergence, BadLevelsAreInputErrors) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(convergence::grid_convergence(levels(1, 1, 1, {1, 2})), InputError);
  EXPECT_THROW(convergence::grid_convergence(levels(1, 1, 1, {1, 2, 2})), InputError);
  EXPECT_THROW(convergence::grid_convergence(levels(1, 1, 1, {4, 2, 1})), InputError);
  EXPECT_THROW(convergence::grid_convergence(levels(1, 1, 1, {0, 2, 4})), InputError);
  EXPECT_THROW(convergence::grid_convergence(levels(nan, 1, 1, {1, 2, 4})), InputError);
  EXPECT_THROW(convergence::least_squares_convergence(levels(1, 1, 1, {1, 2, 4})), InputError);
  EXPECT_EQ(convergence::extrapolate(levels(1, 1, 1, {1, 2, 4}), 1).safety, 1.25);
}

// A tolerance that is kept, one that is not, and one whose finest level alone is off.
TEST(KeptTolerances, HoldWhereEachLevelIsWithinItsOwnOfTheFinest) {
  const std::vector<convergence::RefinementLevel> kept{
      {1e-8, 5.0}, {1e-6, 5.0 - 1.9e-6}, {1e-4, 5.0 + 1.9e-4}};
  const convergence::Extrapolation good = convergence::kept_tolerances(kept, 2);
  EXPECT_TRUE(good.conclusive);
  EXPECT_EQ(good.limit, 5);
  EXPECT_DOUBLE_EQ(good.uncertainty, 2e-8);
  EXPECT_FALSE(good.order);
  EXPECT_FALSE(convergence::kept_tolerances(kept, 1).conclusive);
  std::vector<convergence::RefinementLevel> broken = kept;
  broken[1].value = 5.0 - 2.1e-6;
  const convergence::Extrapolation bad = convergence::kept_tolerances(broken, 2);
  EXPECT_FALSE(bad.conclusive);
  EXPECT_THAT(bad.reason, testing::HasSubstr("a tolerance of 1e-06 promises an error below 2e-06"));
  std::vector<convergence::RefinementLevel> off = kept;
  off[0].value = 5.001;
  EXPECT_FALSE(convergence::kept_tolerances(off, 2).conclusive);
  EXPECT_THROW(convergence::kept_tolerances(std::span(kept).first(2), 1), InputError);
  off[0].value = std::nan("");
  EXPECT_THROW(convergence::kept_tolerances(off, 2), InputError);
}

}  // namespace
}  // namespace ciliaval::compare

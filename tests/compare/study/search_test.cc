// SPDX-License-Identifier: LGPL-2.1-or-later
// The search in the unit box. Oracle: functions whose optima and multipliers follow by hand.
#include "compare/study/optimum/search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "problem/error.h"

namespace ciliaval::compare::study::optimum {
namespace {

using testing::ElementsAre;

using Point = std::vector<double>;

TEST(Search, FindsAPeakBetweenTheBounds) {
  const SearchResult result = maximise(
      [](const Point& u) {
        return Trial{-std::pow(u[0] - 0.3, 2) - 2 * std::pow(u[1] - 0.6, 2), {}, true};
      },
      {0.9, 0.1}, {});
  ASSERT_EQ(result.optima.size(), 1u);
  EXPECT_EQ(result.local_searches, 12u);
  const LocalOptimum& best = result.optima.front();
  EXPECT_EQ(best.starts, 12u);
  EXPECT_NEAR(best.u[0], 0.3, 1e-6);
  EXPECT_NEAR(best.u[1], 0.6, 1e-6);
  EXPECT_THAT(best.at_bound, ElementsAre(0, 0));
  EXPECT_LT(best.residual, 1e-6);
}

// u + v on the circle u² + v² = 1/2: (1/2, 1/2), λ = 1/(2u) = 1. A point beside it by t loses t² of
// the gain, and the constraint may be missed by 1e-8: t may be 1e-4, and was 1e-6.
TEST(Search, FindsAPointOnAConstraintAndItsMultiplier) {
  const SearchResult result = maximise(
      [](const Point& u) {
        return Trial{u[0] + u[1], {u[0] * u[0] + u[1] * u[1] - 0.5, u[0] - 0.9}, true};
      },
      {0.1, 0.2}, {});
  ASSERT_EQ(result.optima.size(), 1u);
  const LocalOptimum& best = result.optima.front();
  EXPECT_NEAR(best.u[0], 0.5, 1e-5);
  EXPECT_NEAR(best.u[1], 0.5, 1e-5);
  EXPECT_LE(best.trial.violation(), feasibility);
  EXPECT_NEAR(best.multipliers[0], 1, 1e-5);
  EXPECT_EQ(best.multipliers[1], 0);
  EXPECT_LT(best.residual, 1e-5);
}

// 2u − v + w(1 − w): the corner (1, 0) and w = 1/2, multipliers 2 and 1.
TEST(Search, FindsBoundsAndTheirMultipliers) {
  const SearchResult result = maximise(
      [](const Point& u) {
        return Trial{2 * u[0] - u[1] + u[2] * (1 - u[2]), {}, true};
      },
      {0.5, 0.5, 0.9}, {});
  ASSERT_EQ(result.optima.size(), 1u);
  const LocalOptimum& best = result.optima.front();
  EXPECT_EQ(best.u[0], 1);
  EXPECT_EQ(best.u[1], 0);
  EXPECT_NEAR(best.u[2], 0.5, 1e-6);
  EXPECT_THAT(best.at_bound, ElementsAre(1, -1, 0));
  EXPECT_NEAR(best.bound_multipliers[0], 2, 1e-8);
  EXPECT_NEAR(best.bound_multipliers[1], 1, 1e-8);
  EXPECT_LT(best.residual, 1e-6);
}

// Where a bound, the other and a constraint meet, two of the three are enough: what matters is that
// some non-negative combination is found.
TEST(Search, ACornerThatAConstraintTouchesIsStationary) {
  const SearchResult result = maximise(
      [](const Point& u) {
        return Trial{u[0] + 3 * u[1], {u[0] + u[1] - 2}, true};
      },
      {0.5, 0.5}, {});
  ASSERT_EQ(result.optima.size(), 1u);
  EXPECT_THAT(result.optima.front().u, ElementsAre(1, 1));
  EXPECT_LT(result.optima.front().residual, 1e-8);
}

// Two peaks, the lower one with the wider basin.
TEST(Search, ListsTheDistinctOptimaTheBestFirst) {
  const auto bump = [](double u, double centre, double width) {
    return std::exp(-std::pow((u - centre) / width, 2));
  };
  const TrialFunction function = [&](const Point& u) {
    return Trial{1.2 * bump(u[0], 0.15, 0.1) + bump(u[0], 0.7, 0.25), {}, true};
  };
  const SearchResult result = maximise(function, {0.8}, {});
  ASSERT_EQ(result.optima.size(), 2u);
  EXPECT_NEAR(result.optima[0].u[0], 0.15, 0.01);
  EXPECT_NEAR(result.optima[1].u[0], 0.7, 0.01);
  EXPECT_GT(result.optima[0].trial.gain, result.optima[1].trial.gain);
  EXPECT_EQ(result.optima[0].starts + result.optima[1].starts, 12u);
  // From the start alone there is the nearer one.
  const SearchResult local = maximise(function, {0.8}, {0, 0});
  ASSERT_EQ(local.optima.size(), 1u);
  EXPECT_EQ(local.local_searches, 1u);
  EXPECT_NEAR(local.optima[0].u[0], 0.7, 0.01);
}

// As a cilium that slips off: beyond u + v = 1 there is no gain, but how far beyond is known. The
// gain rises up to there: v = 1 − u, u(1 − u) + 1, the peak at (1/2, 1/2).
TEST(Search, BearsPointsWithoutAGain) {
  const SearchResult result = maximise(
      [](const Point& u) {
        const double g = u[0] + u[1] - 1;
        return g > 1e-6 ? Trial{-10, {g}, false} : Trial{u[0] * u[1] + u[0] + u[1], {g}, true};
      },
      {0.95, 0.9}, {});
  ASSERT_FALSE(result.optima.empty());
  EXPECT_EQ(result.infeasible, 0u);
  EXPECT_NEAR(result.optima[0].u[0], 0.5, 0.01);
  EXPECT_NEAR(result.optima[0].u[1], 0.5, 0.01);
  EXPECT_NEAR(result.optima[0].trial.gain, 1.25, 1e-4);
}

TEST(Search, WithoutAFeasiblePointNamesTheNearest) {
  const SearchResult result = maximise(
      [](const Point& u) {
        return Trial{u[0], {0.5 + std::pow(u[0] - 0.4, 2)}, true};
      },
      {0.9}, {});
  EXPECT_TRUE(result.optima.empty());
  EXPECT_EQ(result.infeasible, result.local_searches);
  EXPECT_NEAR(result.nearest.at(0), 0.4, 0.02);
}

// A kink is an optimum, but no differences show it: it is the result and said not to be stationary.
TEST(Search, AnOptimumThatIsNotStationaryIsSaidToBeNone) {
  const SearchResult result = maximise(
      [](const Point& u) {
        return Trial{std::min(u[0], 1.6 - 3 * u[0]), {}, true};
      },
      {0.9}, {});
  ASSERT_FALSE(result.optima.empty());
  EXPECT_NEAR(result.optima[0].u[0], 0.4, 1e-3);
  EXPECT_GT(result.not_stationary, 0u);
}

TEST(Search, AsksForTheSamePointsAgain) {
  std::vector<Point> first;
  std::vector<Point> second;
  const auto recording = [](std::vector<Point>& points) {
    return [&points](const Point& u) {
      points.push_back(u);
      return Trial{std::sin(9 * u[0]) + std::cos(7 * u[1]) * u[0], {u[0] + u[1] - 1.2}, true};
    };
  };
  maximise(recording(first), {0.2, 0.2}, {});
  maximise(recording(second), {0.2, 0.2}, {});
  EXPECT_EQ(first, second);
  EXPECT_GT(first.size(), 2000u);
}

TEST(Search, WhatTheFunctionThrowsComesThrough) {
  for (const int last : {0, 1, 700, 2300}) {
    int count = 0;
    EXPECT_THROW(maximise(
                     [&](const Point& u) {
                       if (count++ == last) throw FileError("disk full");
                       return Trial{-std::pow(u[0] - 0.3, 4) - u[1] * u[1], {}, true};
                     },
                     {0.9, 0.1}, {}),
                 FileError)
        << last;
  }
}

}  // namespace
}  // namespace ciliaval::compare::study::optimum

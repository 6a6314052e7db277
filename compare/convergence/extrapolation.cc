// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/convergence/extrapolation.h"

#include <fmt/core.h>

#include <Eigen/QR>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "problem/error.h"

namespace ciliaval::compare::convergence {
namespace {

constexpr double least_order = 0.1;
constexpr double largest_order = 12;
constexpr double cautious_order = 2;  // where a formal one is not known

void require_levels(std::span<const RefinementLevel> levels, std::size_t least) {
  if (levels.size() < least)
    throw InputError(fmt::format("an extrapolation needs {} levels of refinement, not {}", least,
                                 levels.size()));
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (!std::isfinite(levels[i].value)) throw InputError("a level's value is not finite");
    if (!(levels[i].size > (i == 0 ? 0 : levels[i - 1].size)) || !std::isfinite(levels[i].size))
      throw InputError("the levels' sizes must be positive and increase, finest first");
  }
}

/// The finest value with the interval `rounding`, if the two finest levels agree to rounding.
std::optional<Extrapolation> converged(std::span<const RefinementLevel> levels, double rounding) {
  if (std::abs(levels[1].value - levels[0].value) > rounding) return std::nullopt;
  return Extrapolation{true, "the finest levels agree to rounding", {}, levels[0].value, rounding,
                       1};
}

bool monotone(std::span<const RefinementLevel> levels) {
  const double direction = levels[1].value - levels[0].value;
  for (std::size_t i = 1; i < levels.size(); ++i)
    if (!((levels[i].value - levels[i - 1].value) * direction > 0)) return false;
  return true;
}

Extrapolation inconclusive(std::span<const RefinementLevel> levels, std::string reason) {
  return {false, std::move(reason), {}, levels.front().value};
}

/// The equation for p at one p, its left side less its right, for the levels from `first` on.
double order_residual(std::span<const RefinementLevel> levels, double p, std::size_t first = 0) {
  levels = levels.subspan(first, 3);
  const double ratio = (levels[2].value - levels[1].value) / (levels[1].value - levels[0].value);
  const double r21 = levels[1].size / levels[0].size;
  const double r32 = levels[2].size / levels[1].size;
  // e₃₂/e₂₁ = r₂₁^p (r₃₂^p − 1)/(r₂₁^p − 1), which grows with p.
  return p * std::log(r21) + std::log(std::expm1(p * std::log(r32))) -
         std::log(std::expm1(p * std::log(r21))) - std::log(ratio);
}

/// True if the changes fall from level to level at least as fast as by the largest order sought.
bool faster_than_any_order(std::span<const RefinementLevel> levels) {
  for (std::size_t i = 0; i + 2 < levels.size(); ++i)
    if (!(order_residual(levels, largest_order, i) <= 0)) return false;
  return true;
}

/// F |e₂₁|/(r₂₁^p − 1).
double interval_of(std::span<const RefinementLevel> levels, double p, double safety) {
  return safety * std::abs(levels[1].value - levels[0].value) /
         (std::pow(levels[1].size / levels[0].size, p) - 1);
}

/// Extrapolation of monotone levels without an order between the limits. If they converge faster,
/// the interval is from the last change and an order that is far too low for them; else
/// inconclusive.
Extrapolation without_order(std::span<const RefinementLevel> levels,
                            std::optional<double> formal_order, double rounding) {
  if (!faster_than_any_order(levels))
    return inconclusive(levels,
                        fmt::format("no order between {} and {} fits", least_order, largest_order));
  constexpr double safety = 3;
  const double interval = interval_of(levels, formal_order.value_or(cautious_order), safety);
  return {true,
          fmt::format("faster than order {}", largest_order),
          {},
          levels[0].value,
          std::max(rounding, interval),
          safety};
}

/// The root of the equation for p.
std::optional<double> observed_order(std::span<const RefinementLevel> levels) {
  const auto residual = [&](double p) { return order_residual(levels, p); };
  if (!(residual(least_order) < 0) || !(residual(largest_order) > 0)) return std::nullopt;
  std::uintmax_t iterations = 200;
  const auto [a, b] =
      boost::math::tools::toms748_solve(residual, least_order, largest_order,
                                        boost::math::tools::eps_tolerance<double>(), iterations);
  return (a + b) / 2;
}

struct Fit {
  double limit = 0;
  double slope = 0;
  double deviation = 0;
};

Fit fit(std::span<const RefinementLevel> levels, double p) {
  const auto n = static_cast<Eigen::Index>(levels.size());
  Eigen::MatrixXd A(n, 2);
  Eigen::VectorXd f(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const RefinementLevel& level = levels[static_cast<std::size_t>(i)];
    A(i, 0) = 1;
    A(i, 1) = std::pow(level.size / levels.back().size, p);
    f[i] = level.value;
  }
  const Eigen::Vector2d x = A.colPivHouseholderQr().solve(f);
  return {x[0], x[1], (f - A * x).norm() / std::sqrt(static_cast<double>(n - 3))};
}

}  // namespace

Extrapolation grid_convergence(std::span<const RefinementLevel> levels,
                               std::optional<double> formal_order, double rounding) {
  require_levels(levels, 3);
  levels = levels.first(3);
  if (const auto result = converged(levels, rounding)) return *result;
  if (!monotone(levels)) return inconclusive(levels, "the convergence is not monotone");
  const auto p = observed_order(levels);
  if (!p) return without_order(levels, formal_order, rounding);
  const double r21 = levels[1].size / levels[0].size;
  const double e21 = levels[1].value - levels[0].value;
  const bool asymptotic = formal_order && std::abs(*p / *formal_order - 1) <= 0.1;
  const double safety = asymptotic ? 1.25 : 3;
  const double interval = interval_of(levels, std::min(*p, formal_order.value_or(*p)), safety);
  return {true,
          asymptotic ? "" : "the order is not in the asymptotic range",
          p,
          levels[0].value - e21 / (std::pow(r21, *p) - 1),
          std::max(rounding, interval),
          safety};
}

Extrapolation least_squares_convergence(std::span<const RefinementLevel> levels,
                                        std::optional<double> formal_order, double rounding) {
  require_levels(levels, 4);
  if (const auto result = converged(levels, rounding)) return *result;
  if (!monotone(levels)) return inconclusive(levels, "the convergence is not monotone");
  std::uintmax_t iterations = 500;
  // The deviation may have more than one minimum: the best of a scan, then Brent's method about it.
  double best = least_order;
  constexpr int steps = 240;
  const double step = (largest_order - least_order) / steps;
  for (int i = 0; i <= steps; ++i) {
    const double p = least_order + i * step;
    if (fit(levels, p).deviation < fit(levels, best).deviation) best = p;
  }
  const double p = boost::math::tools::brent_find_minima(
                       [&](double order) { return fit(levels, order).deviation; },
                       std::max(least_order, best - step), std::min(largest_order, best + step),
                       std::numeric_limits<double>::digits / 2, iterations)
                       .first;
  if (p < least_order + 1e-6 || p > largest_order - 1e-6)
    return without_order(levels, formal_order, rounding);
  const Fit best_fit = fit(levels, p);
  const auto [least, largest] = std::minmax_element(
      levels.begin(), levels.end(),
      [](const RefinementLevel& a, const RefinementLevel& b) { return a.value < b.value; });
  const double mean_difference =
      (largest->value - least->value) / static_cast<double>(levels.size() - 1);
  const bool good = p >= 0.5 && p <= formal_order.value_or(cautious_order) + 0.1 &&
                    best_fit.deviation < mean_difference;
  const double safety = good ? 1.25 : 3;
  const double misfit =
      std::abs(levels.front().value - best_fit.limit -
               best_fit.slope * std::pow(levels.front().size / levels.back().size, p));
  const double interval =
      safety * std::abs(levels.front().value - best_fit.limit) + best_fit.deviation + misfit;
  return {true,
          good ? "" : "the order is not in the asymptotic range, or the levels scatter",
          p,
          best_fit.limit,
          std::max(rounding, interval),
          safety};
}

Extrapolation extrapolate(std::span<const RefinementLevel> levels,
                          std::optional<double> formal_order, double rounding) {
  return levels.size() > 3 ? least_squares_convergence(levels, formal_order, rounding)
                           : grid_convergence(levels, formal_order, rounding);
}

Extrapolation kept_tolerances(std::span<const RefinementLevel> levels, double scale) {
  require_levels(levels, 3);
  const RefinementLevel& finest = levels.front();
  for (const RefinementLevel& level : levels.subspan(1)) {
    const double moved = std::abs(level.value - finest.value);
    if (!(moved <= (level.size + finest.size) * scale))
      return inconclusive(levels, fmt::format("a tolerance of {:.3g} promises an error below "
                                              "{:.2g}, but the finest value is {:.2g} away",
                                              level.size, level.size * scale, moved));
  }
  return {true,
          "all levels are within their tolerances of the finest",
          {},
          finest.value,
          finest.size * scale,
          1};
}

}  // namespace ciliaval::compare::convergence

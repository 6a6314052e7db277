// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/taylor.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <type_traits>

#include "problem/error.h"

namespace ciliaval::analytic::elastica {
namespace {

constexpr std::size_t order = TaylorStep::order;

/// Σ_{k≥1} a_k t^k of several series at once: each waits for its last product, not for the others.
template <class... Series>
std::array<double, sizeof...(Series)> horner(double t, const Series&... series) {
  std::array<double, sizeof...(Series)> sums{};
  for (std::size_t k = order; k > 0; --k) {
    std::size_t i = 0;
    ((sums[i] = (sums[i] + series[k]) * t, ++i), ...);
  }
  return sums;
}

/// A series of pairs, whose two numbers are computed at once.
using Pair = Eigen::Array2d;
using Pairs = std::array<Pair, order + 1>;

/// Coefficient k of a product of series, Σ_{j ≤ k} a_j b_{k−j}.
template <class A, class B>
auto product(const std::array<A, order + 1>& a, const std::array<B, order + 1>& b, std::size_t k) {
  using Value = std::conditional_t<std::is_same_v<A, Pair>, A, B>;
  Value even = a[0] * b[k];
  if (k == 0) return even;
  Value odd = a[1] * b[k - 1];  // two sums, which do not wait for each other
  std::size_t j = 2;
  for (; j < k; j += 2) {
    even += a[j] * b[k - j];
    odd += a[j + 1] * b[k - j - 1];
  }
  if (j == k) even += a[j] * b[0];
  return Value(even + odd);
}

}  // namespace

TaylorStep::TaylorStep(const PlanarState& start, const Flexibility& flexibility, ForceLaw law,
                       double target, double tolerance, double fraction)
    : start_(start), end_(target), width_(target - start.S), flexibility_(flexibility) {
  const double reach = width_;
  // A trial width near the local length scale keeps the coefficients representable.
  const double rate = std::max(std::abs(flexibility.bending * start.moment),
                               std::sqrt(flexibility.bending * std::abs(start.force)));
  if (rate * std::abs(reach) > 8) width_ = std::copysign(8 / rate, reach);
  expand(law);
  while (!finite()) {
    width_ /= 64;
    if (!(std::abs(width_) > 1e-30)) throw SolverError("elastica: the state is not finite");
    expand(law);
  }
  double ratio = 1;
  for (int pass = 0; pass < 100; ++pass) {
    const double remainder = relative_remainder(ratio);
    if (remainder <= tolerance) break;
    const double shrink = std::pow(tolerance / remainder, 1.0 / (order - 3));
    ratio *= std::clamp(0.98 * shrink, 0.02, 0.98);
  }
  complete_ = ratio == 1 && width_ == reach;
  if (complete_) return;
  rescale(ratio * fraction);
  end_ = start.S + width_;
  if (end_ == start.S) throw SolverError("elastica: the step of the integration vanishes");
}

TaylorStep TaylorStep::straight(PlanarState start, ForceLaw law, double target, double extension) {
  start.moment = 0;
  TaylorStep step(start, {.extension = extension}, law, target, 1, 1);
  step.moment_.fill(0);
  return step;
}

void TaylorStep::expand(ForceLaw law) {
  const double tau = width_;
  Series rate{};  // of θ: (k + 1) θ_{k+1}
  const double shear = flexibility_.shear;
  const double extension = flexibility_.extension;
  const PlanarLaw& law_of_bending = flexibility_.law;
  const bool is_rigid = flexibility_.is_rigid();
  const bool has_law = !law_of_bending.is_empty();
  Pairs direction;   // sin θ, cos θ
  Pairs beyond;      // M², and what the law adds to θ' over M
  Pairs factors;     // M², M
  Series rise{};     // z'
  Series stretch{};  // s, of the middle line
  direction[0] = {std::sin(start_.theta), std::sin(start_.phi)};
  theta_[0] = start_.theta;
  w_[0] = start_.w;
  z_[0] = start_.z;
  moment_[0] = start_.moment;
  force_.fill(0);
  force_[0] = start_.force;
  for (std::size_t k = 0; k < order; ++k) {
    const double over = 1 / static_cast<double>(k + 1);
    const double scale = tau * over;
    rate[k] = tau * flexibility_.bending * moment_[k];
    Pair advance = direction[k];  // w', z'
    if (!is_rigid) {
      double axial = force_[0] * direction[k][0];  // H sin θ
      if (law != ForceLaw::constant) axial = product(force_, direction, k)[0];
      stretch[k] = (extension - shear) * axial + (k == 0 ? 1 : 0);
      if (has_law) {
        const double square = product(moment_, moment_, k);
        factors[k] = {square, moment_[k]};
        // M⁴ first, of which the softening is made.
        beyond[k] = {square, 0};
        Pair sums = product(beyond, factors, k);
        beyond[k][1] = 2 * law_of_bending.lengthening * axial + law_of_bending.softening * square +
                       law_of_bending.further_softening * sums[0];
        rate[k] += tau * (sums[1] + beyond[k][1] * moment_[0]);
        stretch[k] += law_of_bending.lengthening * square;
      }
      advance = product(stretch, direction, k);
      advance[0] += shear * force_[k];
    }
    rise[k] = advance[1];
    theta_[k + 1] = over * rate[k];
    w_[k + 1] = scale * advance[0];
    z_[k + 1] = scale * rise[k];
    if (law == ForceLaw::height) force_[k + 1] = -scale * rise[k];
    if (law == ForceLaw::length && k == 0) force_[1] = -tau;
    double torque = force_[0] * rise[k];
    if (law == ForceLaw::height) torque = product(force_, rise, k);
    if (law == ForceLaw::length && k > 0) torque += force_[1] * rise[k - 1];
    moment_[k + 1] = -scale * torque;
    // (sin θ)' = θ' cos θ, (cos θ)' = −θ' sin θ
    const Pair turned = product(rate, direction, k);
    direction[k + 1] = {over * turned[1], -over * turned[0]};
  }
}

/// Largest of the last two terms of any series at t = ratio over the size of its leading terms.
double TaylorStep::relative_remainder(double ratio) const {
  constexpr std::size_t leading = 5;
  const double last = std::pow(ratio, static_cast<double>(order));
  const auto relative = [&](const Series& a, double constant) {
    double size = std::abs(constant);
    double power = 1;
    for (std::size_t k = 1; k < leading; ++k) {
      power *= ratio;
      size = std::max(size, std::abs(a[k]) * power);
    }
    const double tail = std::max(std::abs(a[order]) * last, std::abs(a[order - 1]) * last / ratio);
    if (tail == 0) return 0.0;
    return tail / size;
  };
  const double angle = std::min(std::abs(start_.theta), std::abs(start_.phi));
  return std::max(
      {relative(theta_, angle), relative(moment_, moment_[0]), relative(z_, 0), relative(w_, 0)});
}

void TaylorStep::rescale(double ratio) {
  double power = 1;
  for (std::size_t k = 0; k <= order; ++k) {
    theta_[k] *= power;
    w_[k] *= power;
    z_[k] *= power;
    moment_[k] *= power;
    force_[k] *= power;
    power *= ratio;
  }
  width_ *= ratio;
}

bool TaylorStep::finite() const {
  double sum = 0;
  for (std::size_t k = 0; k <= order; ++k)
    sum += std::abs(theta_[k]) + std::abs(w_[k]) + std::abs(z_[k]) + std::abs(moment_[k]);
  return std::isfinite(sum);
}

PlanarState TaylorStep::at(double S) const {
  const double t = (S - start_.S) / width_;
  const auto [turned, w, z, moment, force] = horner(t, theta_, w_, z_, moment_, force_);
  PlanarState state;
  state.S = S;
  state.theta = start_.theta + turned;
  state.phi = start_.phi - turned;
  state.w = w_[0] + w;
  state.z = z_[0] + z;
  state.moment = moment_[0] + moment;
  state.force = force_[0] + force;
  state.curvature = flexibility_.bending * state.moment +
                    flexibility_.law.of_rotation(state.moment, state.force * std::sin(state.theta));
  return state;
}

double TaylorStep::zero_moment() const {
  // M is monotone in the step (−dM/dS = H dz/dS); Newton from the end, bisection where it leaves.
  double a = start();
  double b = end();
  double S = b;
  const double sign = std::copysign(1.0, moment_[0]);
  for (int iteration = 0; iteration < 200; ++iteration) {
    const auto [turned, rise, force] = horner((S - start_.S) / width_, theta_, moment_, force_);
    const double moment = moment_[0] + rise;
    (sign * moment > 0 ? a : b) = S;
    const double H = force_[0] + force;
    const double stretch =
        1 + (flexibility_.extension - flexibility_.shear) * H * std::sin(start_.theta + turned);
    const double slope = -H * std::sin(start_.phi - turned) * stretch;
    double next = S - moment / slope;
    if (!((next - a) * (next - b) <= 0)) next = std::midpoint(a, b);
    // After a step of the last bits Newton has converged; smaller ones would only go to and fro.
    if (std::abs(next - S) <= 4e-16 * std::max(1.0, std::abs(S)) || a == b) return next;
    S = next;
  }
  return S;
}

void TaylorStep::translate(double w, double z) {
  start_.w += w;
  start_.z += z;
  w_[0] += w;
  z_[0] += z;
}

}  // namespace ciliaval::analytic::elastica

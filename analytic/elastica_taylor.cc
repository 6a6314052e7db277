// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica_taylor.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "problem/error.h"

namespace ciliaval::analytic {
namespace {

/// Σ_{k≥1} a_k t^k
template <class Series>
double horner(const Series& a, double t) {
  double sum = 0;
  for (std::size_t k = a.size() - 1; k > 0; --k) sum = (sum + a[k]) * t;
  return sum;
}

}  // namespace

TaylorStep::TaylorStep(const PlanarState& start, double flexibility, ForceLaw law, double target,
                       double tolerance, double fraction)
    : start_(start), end_(target), width_(target - start.S), flexibility_(flexibility) {
  const double reach = width_;
  // A trial width near the local length scale keeps the coefficients representable.
  const double rate = std::max(std::abs(flexibility * start.moment),
                               std::sqrt(flexibility * std::abs(start.force)));
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

TaylorStep TaylorStep::straight(PlanarState start, ForceLaw law, double target) {
  start.moment = 0;
  TaylorStep step(start, 0, law, target, 1, 1);
  step.moment_.fill(0);
  return step;
}

void TaylorStep::expand(ForceLaw law) {
  const double tau = width_;
  Series sine{};
  Series cosine{};
  sine[0] = std::sin(start_.theta);
  cosine[0] = std::sin(start_.phi);
  theta_[0] = start_.theta;
  w_[0] = start_.w;
  z_[0] = start_.z;
  moment_[0] = start_.moment;
  force_.fill(0);
  force_[0] = start_.force;
  for (std::size_t k = 0; k < order; ++k) {
    const double scale = tau / static_cast<double>(k + 1);
    theta_[k + 1] = scale * flexibility_ * moment_[k];
    w_[k + 1] = scale * sine[k];
    z_[k + 1] = scale * cosine[k];
    if (law == ForceLaw::height) force_[k + 1] = -scale * cosine[k];
    if (law == ForceLaw::length && k == 0) force_[1] = -tau;
    const std::size_t last =
        std::min(k, law == ForceLaw::height ? k : std::size_t{law == ForceLaw::length});
    double torque = 0;
    for (std::size_t j = 0; j <= last; ++j) torque += force_[j] * cosine[k - j];
    moment_[k + 1] = -scale * torque;
    // (sin θ)' = θ' cos θ, (cos θ)' = −θ' sin θ
    double sine_rate = 0;
    double cosine_rate = 0;
    for (std::size_t j = 0; j <= k; ++j) {
      const double rate = static_cast<double>(j + 1) * theta_[j + 1];
      sine_rate += rate * cosine[k - j];
      cosine_rate -= rate * sine[k - j];
    }
    sine[k + 1] = sine_rate / static_cast<double>(k + 1);
    cosine[k + 1] = cosine_rate / static_cast<double>(k + 1);
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
  const double turned = horner(theta_, t);
  PlanarState state;
  state.S = S;
  state.theta = start_.theta + turned;
  state.phi = start_.phi - turned;
  state.w = w_[0] + horner(w_, t);
  state.z = z_[0] + horner(z_, t);
  state.moment = moment_[0] + horner(moment_, t);
  state.force = force_[0] + horner(force_, t);
  state.curvature = flexibility_ * state.moment;
  return state;
}

double TaylorStep::zero_moment() const {
  // M is monotone in the step (−dM/dS = H cos θ); Newton from the start, bisection where it leaves.
  double a = start();
  double b = end();
  double S = b;
  const double sign = std::copysign(1.0, moment_[0]);
  for (int iteration = 0; iteration < 200; ++iteration) {
    const PlanarState state = at(S);
    (sign * state.moment > 0 ? a : b) = S;
    const double slope = -state.force * std::sin(state.phi);
    double next = S - state.moment / slope;
    if (!((next - a) * (next - b) <= 0)) next = std::midpoint(a, b);
    if (std::abs(next - S) <= 1e-16 * std::max(1.0, std::abs(S)) || a == b) return next;
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

}  // namespace ciliaval::analytic

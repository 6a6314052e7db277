// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/point_forces/section.h"

#include <algorithm>
#include <cmath>

#include "problem/error.h"

namespace ciliaval::analytic::elastica::point_forces {
namespace {

constexpr double remainder = 1e-16;  ///< of the last terms of the series
constexpr double longest_trial = 8;  ///< τ times the rate of the solution

/// The derivatives alone.
Eigen::Array4d variation(Eigen::Array4d jet) {
  jet[0] = 0;
  return jet;
}

}  // namespace

Step::Step(const Section& start, double flexibility, const Force& force, double target)
    : start_(start.S), end_(target), flexibility_(flexibility) {
  first_.S = start.S;
  first_.theta = start.theta;
  first_.x = start.x;
  first_.z = start.z;
  first_.moment = start.moment;
  const double kappa = flexibility * start.moment;
  const double g_x = flexibility * force.x;
  const double g_z = flexibility * force.z;
  const double reach = target - start.S;
  const double rate = std::max(std::abs(kappa), std::sqrt(std::hypot(g_x, g_z)));
  trial_ = rate * reach > longest_trial ? longest_trial / rate : reach;
  std::array<Jet, order + 1> sine;
  std::array<Jet, order + 1> cosine;
  std::array<Jet, order + 1> rates;  // τκ
  std::array<Jet, order + 1> rate_variations;
  sine[0] = Jet(std::sin(start.theta), 0, 0, 0);
  cosine[0] = Jet(std::cos(start.theta), 0, 0, 0);
  rates[0] = trial_ * Jet(kappa, 1, 0, 0);
  theta_[0] = x_[0] = z_[0] = Jet::Zero();
  const double square = trial_ * trial_;
  for (std::size_t k = 0; k < order; ++k) {
    const double over = 1 / static_cast<double>(k + 1);
    rate_variations[k] = variation(rates[k]);
    theta_[k + 1] = over * rates[k];
    x_[k + 1] = trial_ * over * sine[k];
    z_[k + 1] = trial_ * over * cosine[k];
    Jet couple = g_z * sine[k] - g_x * cosine[k];
    couple[2] -= cosine[k][0];
    couple[3] += sine[k][0];
    rates[k + 1] = square * over * couple;
    Jet sine_rate = Jet::Zero();
    Jet cosine_rate = Jet::Zero();
    for (std::size_t j = 0; j <= k; ++j) {
      sine_rate += rates[j][0] * cosine[k - j] + cosine[k - j][0] * rate_variations[j];
      cosine_rate += rates[j][0] * sine[k - j] + sine[k - j][0] * rate_variations[j];
    }
    sine[k + 1] = over * sine_rate;
    cosine[k + 1] = -over * cosine_rate;
  }
  double tail = 0;
  for (const auto* series : {&theta_, &x_, &z_})
    for (const std::size_t k : {order - 1, order}) tail = std::max(tail, std::abs((*series)[k][0]));
  if (!std::isfinite(tail)) throw SolverError("elastica: the state is not finite");
  const double ratio =
      tail > remainder ? std::pow(remainder / tail, 1.0 / static_cast<double>(order - 1)) : 1;
  width_ = ratio * trial_;
  complete_ = width_ == reach;
  if (!complete_) end_ = start_ + width_;
  if (!(end_ > start_)) throw SolverError("elastica: the step of the integration vanishes");
}

Step::Jet Step::sum(const std::array<Jet, order + 1>& series, double t) const {
  Jet result = Jet::Zero();
  for (std::size_t k = order; k > 0; --k) result = (result + series[k]) * t;
  return result;
}

Section Step::at(double S) const {
  const double t = (S - start_) / trial_;
  Section section;
  double theta = 0;
  double x = 0;
  double z = 0;
  double rate = 0;  // dθ/dt
  for (std::size_t k = order; k > 0; --k) {
    rate = rate * t + static_cast<double>(k) * theta_[k][0];
    theta = (theta + theta_[k][0]) * t;
    x = (x + x_[k][0]) * t;
    z = (z + z_[k][0]) * t;
  }
  section.S = S;
  section.theta = first_.theta + theta;
  section.x = first_.x + x;
  section.z = first_.z + z;
  section.curvature = rate / trial_;
  return section;
}

void Step::advance(Section& section, const Force& force) const {
  const double t = width_ / trial_;
  const double f = flexibility_;
  const Jet theta = sum(theta_, t);
  const Jet x = sum(x_, t);
  const Jet z = sum(z_, t);
  // fM²/2 + F_x sin θ + F_z cos θ is constant.
  const double constant = f * section.moment * section.moment / 2 +
                          force.x * std::sin(section.theta) + force.z * std::cos(section.theta);
  section.energy += constant * width_ - force.x * x[0] - force.z * z[0];
  if (section.moment_by.size() > 0) {
    // By θ(start): turned by dθ, less what turning the force by dθ, (F_z, −F_x) dθ, does.
    const double g_x = f * force.x;
    const double g_z = f * force.z;
    const auto by_angle = [&](const Jet& jet, double turned) {
      return turned - g_z * jet[2] + g_x * jet[3];
    };
    const auto by = [&](const Jet& jet, double turned) -> Gradient {
      return by_angle(jet, turned) * section.theta_by + f * jet[1] * section.moment_by +
             f * jet[2] * force.x_by + f * jet[3] * force.z_by;
    };
    const Gradient theta_by = by(theta, 1);
    const Gradient x_by = by(x, z[0]);
    const Gradient z_by = by(z, -x[0]);
    section.moment_by += force.z * x_by - force.x * z_by + x[0] * force.z_by - z[0] * force.x_by;
    section.theta_by = theta_by;
    section.x_by += x_by;
    section.z_by += z_by;
  }
  section.moment += force.z * x[0] - force.x * z[0];
  section.theta += theta[0];
  section.x += x[0];
  section.z += z[0];
  section.curvature = f * section.moment;
  section.S = end();
}

}  // namespace ciliaval::analytic::elastica::point_forces

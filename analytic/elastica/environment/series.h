// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "analytic/elastica/environment/dual.h"
#include "problem/error.h"

namespace ciliaval::analytic::elastica::environment {

/// State of a section; forces are those of the part above on the part below.
template <class T>
struct State {
  T S = 0;
  T theta = 0;
  T w = 0;
  T z = 0;
  T moment = 0;
  T along = 0;     ///< H, along e
  T vertical = 0;  ///< V, along z
};

/// Forces on a piece of the rod.
struct Forces {
  double flexibility = 1;  ///< f
  double along = 0;        ///< h, dead force per length, along e
  double vertical = 0;     ///< v, likewise along z
  double per_height = 0;   ///< q, force per height, along e
};

/// A step of the Taylor-series method (Jorba & Zou, Experimental Mathematics 14, 2005) for
///
///     θ′ = f M,  M′ = −H cos θ + V sin θ,  H′ = −h − q cos θ,  V′ = −v,  w′ = sin θ,  z′ = cos θ,
///
/// with the derivatives of the series by the unknowns where T is a Dual, by its end too.
template <class T>
class Series {
 public:
  /// The longest step from `start` towards S = target, in either direction, whose last terms are
  /// below `tolerance` of the leading ones, times `fraction` unless it gets there. Throws
  /// SolverError if the state is not finite.
  Series(const State<T>& start, const Forces& forces, const T& target, double tolerance,
         double fraction)
      : start_(start), target_(target), width_(target - start.S), forces_(forces) {
    using std::abs, std::pow;
    const double reach = std::abs(value_of(width_));
    const double rate =
        std::max(std::abs(forces.flexibility * value_of(start.moment)),
                 std::sqrt(forces.flexibility *
                           (std::abs(value_of(start.along)) + std::abs(value_of(start.vertical)))));
    if (rate * reach > 8) shrink(8 / (rate * reach));
    expand();
    for (int pass = 0; pass < 60; ++pass) {
      const double remainder = last_terms();
      if (remainder <= tolerance) break;
      complete_ = false;
      if (pass == 59 || !std::isfinite(start_finite()))
        throw SolverError("elastica: the state is not finite");
      const double ratio =
          std::isfinite(remainder) ? pow(tolerance / remainder, 1.0 / (order - 3)) : 1.0 / 64;
      shrink(std::clamp(0.98 * ratio, 1.0 / 64, 0.98));
      expand();
    }
    if (!complete_ && fraction < 1) {
      shrink(fraction);
      expand();
    }
  }

  bool complete() const { return complete_; }
  double start() const { return value_of(start_.S); }
  double end() const { return value_of(complete_ ? target_ : start_.S + width_); }
  double flexibility() const { return forces_.flexibility; }

  /// The state at the part t of the step, 0 to 1.
  State<T> at(const T& t) const {
    State<T> state;
    state.S = start_.S + width_ * t;
    state.theta = sum(theta_, t);
    state.w = sum(w_, t);
    state.z = sum(z_, t);
    state.moment = sum(moment_, t);
    state.along = sum(along_, t);
    state.vertical = start_.vertical - width_ * t * forces_.vertical;
    return state;
  }
  T theta_at(double t) const { return sum(theta_, T(t)); }
  State<T> at_end() const { return at(T(1.0)); }

 private:
  static constexpr std::size_t order = 24;
  using Terms = std::array<T, order + 1>;

  static T sum(const Terms& terms, const T& t) {
    T result = terms[order];
    for (std::size_t k = order; k-- > 0;) result = result * t + terms[k];
    return result;
  }
  /// Coefficient k of a product.
  static T product(const Terms& a, const Terms& b, std::size_t k) {
    T result = a[0] * b[k];
    for (std::size_t j = 1; j <= k; ++j) result += a[j] * b[k - j];
    return result;
  }
  void shrink(double ratio) {
    width_ = width_ * T(ratio);
    complete_ = false;
  }
  double start_finite() const {
    return value_of(start_.theta) + value_of(start_.moment) + value_of(start_.along) +
           value_of(start_.vertical);
  }

  void expand() {
    using std::sin, std::cos;
    Terms sine{}, cosine{}, vertical{};
    theta_[0] = start_.theta;
    w_[0] = start_.w;
    z_[0] = start_.z;
    moment_[0] = start_.moment;
    along_[0] = start_.along;
    vertical[0] = start_.vertical;
    vertical[1] = -(width_ * T(forces_.vertical));
    sine[0] = sin(start_.theta);
    cosine[0] = cos(start_.theta);
    Terms rate{};  // of θ
    for (std::size_t k = 0; k < order; ++k) {
      const T over(1 / static_cast<double>(k + 1));
      const T scale = width_ * over;
      rate[k] = width_ * T(forces_.flexibility) * moment_[k];
      theta_[k + 1] = over * rate[k];
      w_[k + 1] = scale * sine[k];
      z_[k + 1] = scale * cosine[k];
      along_[k + 1] = -(scale * T(forces_.per_height) * cosine[k]);
      if (k == 0) along_[1] -= width_ * T(forces_.along);
      moment_[k + 1] = scale * (product(vertical, sine, k) - product(along_, cosine, k));
      sine[k + 1] = over * product(rate, cosine, k);
      cosine[k + 1] = -(over * product(rate, sine, k));
    }
  }

  /// The largest of the last two terms of any series over its leading ones.
  double last_terms() const {
    const auto relative = [](const Terms& a, bool with_constant) {
      constexpr std::size_t leading = 5;
      double size = with_constant ? std::abs(value_of(a[0])) : 0;
      for (std::size_t k = 1; k < leading; ++k) size = std::max(size, std::abs(value_of(a[k])));
      const double tail = std::max(std::abs(value_of(a[order])), std::abs(value_of(a[order - 1])));
      return tail == 0 ? 0.0 : tail / size;
    };
    return std::max({relative(theta_, true), relative(moment_, true), relative(z_, false),
                     std::abs(value_of(w_[order])) / std::abs(value_of(width_))});
  }

  State<T> start_;
  T target_;
  T width_;
  Forces forces_;
  bool complete_ = true;
  Terms theta_{}, w_{}, z_{}, moment_{}, along_{};
};

}  // namespace ciliaval::analytic::elastica::environment

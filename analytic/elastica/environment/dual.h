// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace ciliaval::analytic::elastica::environment {

/// A value with its derivatives by θ, M and H where a descent begins, by the point force and by its
/// place (descent.h).
struct Dual {
  using Derivatives = Eigen::Array<double, 5, 1>;
  double value = 0;
  Derivatives by = Derivatives::Zero();

  Dual() = default;
  Dual(double v) : value(v) {}  // NOLINT: a number is a constant
  Dual(double v, Derivatives derivatives) : value(v), by(std::move(derivatives)) {}
  /// The variable i itself.
  static Dual variable(double v, Eigen::Index i) {
    return {v, Eigen::Matrix<double, 5, 1>::Unit(i).array()};
  }

  Dual& operator+=(const Dual& b) { return *this = {value + b.value, by + b.by}; }
  Dual& operator-=(const Dual& b) { return *this = {value - b.value, by - b.by}; }
};

inline Dual operator+(Dual a, const Dual& b) {
  return a += b;
}
inline Dual operator-(Dual a, const Dual& b) {
  return a -= b;
}
inline Dual operator-(const Dual& a) {
  return {-a.value, -a.by};
}
inline Dual operator*(const Dual& a, const Dual& b) {
  return {a.value * b.value, a.value * b.by + b.value * a.by};
}
inline Dual sin(const Dual& a) {
  return {std::sin(a.value), std::cos(a.value) * a.by};
}
inline Dual cos(const Dual& a) {
  return {std::cos(a.value), -std::sin(a.value) * a.by};
}
inline double value_of(const Dual& a) {
  return a.value;
}
inline double value_of(double a) {
  return a;
}

}  // namespace ciliaval::analytic::elastica::environment

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/continuation/root.h"

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace ciliaval::continuation {

double root(const std::function<double(double)>& function, double a, double b, double f_a,
            double f_b, double accuracy) {
  if (f_a == 0) return a;
  if (f_b == 0) return b;
  if (a > b) {
    std::swap(a, b);
    std::swap(f_a, f_b);
  }
  std::uintmax_t evaluations = 200;
  const auto [left, right] = boost::math::tools::toms748_solve(
      function, a, b, f_a, f_b,
      [accuracy](double l, double r) { return r - l <= 1e-16 + accuracy * std::abs(l); },
      evaluations);
  return std::midpoint(left, right);
}

}  // namespace ciliaval::continuation

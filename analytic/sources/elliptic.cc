// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/sources/elliptic.h"

#include <cmath>
#include <numbers>

namespace ciliaval::analytic::sources {
namespace {

// The mean converges quadratically: a difference of √ε now is one of ε at the next step.
constexpr double half_precision = 1e-8;

}  // namespace

double bulirsch_cel(double kc, double p, double c, double s) {
  double k = kc;
  double root_p = std::sqrt(p);
  s /= root_p;
  double mean = 1;
  double product = k;
  while (true) {
    const double previous_c = c;
    c += s / root_p;
    double g = product / root_p;
    s = 2 * (s + previous_c * g);
    root_p += g;
    g = mean;
    mean += k;
    if (std::abs(g - k) <= half_precision * g) break;
    k = 2 * std::sqrt(product);
    product = k * mean;
  }
  return std::numbers::pi / 2 * (s + c * mean) / (mean * (mean + root_p));
}

}  // namespace ciliaval::analytic::sources

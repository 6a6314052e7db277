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

CompleteElliptic complete_elliptic(double kc, double m) {
  // t = c_n/m, n = 1, 2, …: c₁ = (1 − kc)/2 = m/(2(1 + kc)), c_{n+1} = c_n²/(4a_{n+1}).
  double a = (1 + kc) / 2;
  double b = std::sqrt(kc);
  double t = 0.25 / a;
  double weight = 2;
  double sum = weight * t * t;
  while (m * t > half_precision * a) {
    const double arithmetic = (a + b) / 2;
    b = std::sqrt(a * b);
    a = arithmetic;
    t = m * t * t / (4 * a);
    weight *= 2;
    sum += weight * t * t;
  }
  const double K = std::numbers::pi / (a + b);
  const double C = K * sum;
  const double D = (K + m * C) / 2;
  return {K, K - m * D, D, C};
}

}  // namespace ciliaval::analytic::sources

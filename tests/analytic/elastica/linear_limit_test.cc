// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cases.h"

namespace ciliaval::analytic {
namespace {

/// ∫_a^b (L − S)(s − S)₊ dS
double point_force_integral(double a, double b, double s, double length) {
  b = std::min(b, s);
  if (b <= a) return 0;
  const auto primitive = [&](double S) {
    return length * s * S - (length + s) * S * S / 2 + S * S * S / 3;
  };
  return primitive(b) - primitive(a);
}

/// ∫_a^b (L − S)³/2 dS
double distributed_integral(double a, double b, double length) {
  return (std::pow(length - a, 4) - std::pow(length - b, 4)) / 8;
}

/// Tip deflection of the Euler–Bernoulli beam, w(L) = Σ ∫ (L − S) M(S)/(E_i I) dS with the moment
/// of the straight cilium.
double euler_bernoulli_deflection(const Cilium& cilium, const Load& load) {
  const double length = cilium.length();
  const auto ends = cilium.interfaces();
  double w = 0;
  for (std::size_t i = 0; i < cilium.segments.size(); ++i) {
    double integral = 0;
    if (const auto contact = load.as<ContactLoad>())
      integral = point_force_integral(ends[i], ends[i + 1], contact->height, length);
    else if (const auto section = load.as<SectionLoad>())
      integral = point_force_integral(ends[i], ends[i + 1], section->arclength, length);
    else
      integral = distributed_integral(ends[i], ends[i + 1], length);
    w += magnitude(load) * integral / bending_stiffness(cilium, i);
  }
  return w;
}

double deviation(const Cilium& cilium, const Load& unit, double deflection) {
  const double magnitude = deflection / euler_bernoulli_deflection(cilium, unit);
  const Load load = with_magnitude(unit, magnitude);
  const double w = planar_point(solve(cilium, load), cilium.length()).w;
  return w / euler_bernoulli_deflection(cilium, load) - 1;
}

class ElasticaLinearLimit : public testing::TestWithParam<Load> {};

// Oracle: Euler–Bernoulli in closed form on two segments. The relative error must be c (w/L)² with
// c of order one: halving the load quarters it. Measured ratio 4 ± 0.003 at w/L = 0.02.
TEST_P(ElasticaLinearLimit, IsEulerBernoulliWithAnErrorOfSecondOrder) {
  const Cilium cilium = paper_cilium();
  const double length = cilium.length();
  const double coarse = deviation(cilium, GetParam(), 0.02 * length);
  const double fine = deviation(cilium, GetParam(), 0.01 * length);
  EXPECT_GT(std::abs(coarse), 1e-6);  // geometric nonlinearity is there
  EXPECT_LT(std::abs(coarse), 4 * 0.02 * 0.02);
  EXPECT_NEAR(coarse / fine, 4, 0.01);
  // At w/L = 1e-7 nothing is left but rounding.
  EXPECT_NEAR(deviation(cilium, GetParam(), 1e-7 * length), 0, 2e-13);
}

INSTANTIATE_TEST_SUITE_P(AllLoads, ElasticaLinearLimit,
                         testing::Values(Load(ContactLoad{1, 16e-3, 0}), Load(FlowLoad{1, 0}),
                                         Load(SectionLoad{1, 13e-3, 0}), Load(DeadLoad{1, 0})),
                         [](const auto& instance) { return std::string(type(instance.param)); });

}  // namespace
}  // namespace ciliaval::analytic

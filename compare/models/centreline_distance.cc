// SPDX-License-Identifier: LGPL-2.1-or-later
#include <Eigen/Core>
#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "compare/models/errors.h"
#include "problem/error.h"

namespace ciliaval::compare::models {
namespace {

constexpr double same_length = 1e-9;  ///< relative to L

/// The union of the breaks of both curves, refined until no interval is longer than L/20.
std::vector<double> common_intervals(const Centreline& a, const Centreline& b) {
  std::vector<double> ends = a.breaks();
  ends.insert(ends.end(), b.breaks().begin(), b.breaks().end());
  const double L = std::max(a.length(), b.length());
  for (int i = 1; i < 20; ++i) ends.push_back(L * i / 20);
  std::sort(ends.begin(), ends.end());
  std::vector<double> result;
  for (const double S : ends)
    if (result.empty() || S - result.back() > 1e-12 * L) result.push_back(S);
  return result;
}

/// S as a function of the height z on a curve along which z increases.
class ArclengthOfHeight {
 public:
  explicit ArclengthOfHeight(const Centreline& curve) : curve_(curve) {
    const std::vector<double> ends = common_intervals(curve, curve);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i)
      for (int k = 0; k < 8; ++k) S_.push_back(std::lerp(ends[i], ends[i + 1], k / 8.0));
    S_.push_back(ends.back());
    for (const double S : S_) z_.push_back(curve.at(S).position.z());
  }

  bool increases() const {
    return std::adjacent_find(z_.begin(), z_.end(), std::greater_equal<>()) == z_.end();
  }
  double lowest() const { return z_.front(); }
  double highest() const { return z_.back(); }

  double operator()(double z) const {
    const auto above = std::lower_bound(z_.begin(), z_.end(), z);
    if (above == z_.begin()) return S_.front();
    if (above == z_.end()) return S_.back();
    const auto i = static_cast<std::size_t>(above - z_.begin());
    if (*above == z) return S_[i];
    std::uintmax_t iterations = 100;
    const auto [low, high] = boost::math::tools::toms748_solve(
        [&](double S) { return curve_.at(S).position.z() - z; }, S_[i - 1], S_[i], z_[i - 1] - z,
        z_[i] - z, boost::math::tools::eps_tolerance<double>(50), iterations);
    return (low + high) / 2;
  }

 private:
  const Centreline& curve_;
  std::vector<double> S_;
  std::vector<double> z_;
};

}  // namespace

CurveDistance distance(const Centreline& a, const Centreline& b) {
  const double L = std::max(a.length(), b.length());
  if (std::abs(a.length() - b.length()) > same_length * L)
    throw InputError("centrelines of different lengths have no common material points");
  CurveDistance result;
  const auto consider = [&](double S) {
    const double d = (a.at(S).position - b.at(S).position).norm();
    result.largest = std::max(result.largest, d);
    return d;
  };
  double integral = 0;
  const std::vector<double> ends = common_intervals(a, b);
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const QuadratureRule rule = gauss_legendre(10, ends[i], ends[i + 1]);
    for (std::size_t q = 0; q < rule.nodes.size(); ++q)
      integral += rule.weights[q] * std::pow(consider(rule.nodes[q]), 2);
  }
  for (const double S : ends) consider(S);
  result.rms = std::sqrt(integral / L);
  return result;
}

std::optional<ShapeAgreement> compare_deflection(const Centreline& model,
                                                 const Centreline& reference,
                                                 const Vector3& direction) {
  const ArclengthOfHeight S_model(model);
  const ArclengthOfHeight S_reference(reference);
  if (!S_model.increases() || !S_reference.increases()) return std::nullopt;
  const double bottom = std::max(S_model.lowest(), S_reference.lowest());
  const double top = std::min(S_model.highest(), S_reference.highest());
  constexpr int n = 401;
  Eigen::ArrayXd w_model(n);
  Eigen::ArrayXd w_reference(n);
  for (int i = 0; i < n; ++i) {
    const double z = std::lerp(bottom, top, i / double(n - 1));
    w_model[i] = model.at(S_model(z)).position.dot(direction);
    w_reference[i] = reference.at(S_reference(z)).position.dot(direction);
  }
  const Eigen::ArrayXd from_mean = w_reference - w_reference.mean();
  const Eigen::ArrayXd model_from_mean = w_model - w_model.mean();
  return ShapeAgreement{std::sqrt((w_model - w_reference).square().mean()),
                        std::sqrt(from_mean.square().mean()),
                        (from_mean * model_from_mean).mean() /
                            std::sqrt(from_mean.square().mean() * model_from_mean.square().mean())};
}

}  // namespace ciliaval::compare::models

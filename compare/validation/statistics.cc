// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/validation/statistics.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace ciliaval::compare::validation {

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::bounded:
      return "bounded";
    case Verdict::not_resolved:
      return "not resolved";
    case Verdict::not_known:
      break;
  }
  return "not known";
}

Assessment assess(double simulated, double measured, const Uncertainties& u) {
  Assessment result;
  result.error = simulated - measured;
  result.u_val = std::hypot(u.numerical, u.input, u.measured);
  result.least = std::max(0.0, std::abs(result.error) - 2 * result.u_val);
  result.bound = std::abs(result.error) + 2 * result.u_val;
  if (std::abs(result.error) > 2 * result.u_val) result.verdict = Verdict::bounded;
  return result;
}

std::optional<double> chi_squared(const Eigen::VectorXd& errors, const Eigen::VectorXd& variances,
                                  const Eigen::MatrixXd& contributions) {
  if (errors.size() == 0) return std::nullopt;
  Eigen::MatrixXd V = contributions * contributions.transpose();
  V.diagonal() += variances;
  // Scaled to correlations, whose condition does not depend on the units.
  const Eigen::VectorXd scale = V.diagonal().cwiseSqrt();
  if (!(scale.minCoeff() > 0)) return std::nullopt;
  const Eigen::VectorXd inverse = scale.cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> factor(inverse.asDiagonal() * V * inverse.asDiagonal());
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Eigen::VectorXd reduced = inverse.cwiseProduct(errors);
  const double result = reduced.dot(factor.solve(reduced));
  return std::isfinite(result) ? std::optional(result) : std::nullopt;
}

}  // namespace ciliaval::compare::validation

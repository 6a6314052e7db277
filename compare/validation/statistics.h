// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

/// A model held against measurements, after ASME V&V 20-2009 (docs/guide/validation.md).
namespace ciliaval::compare::validation {

enum class Verdict {
  bounded,       ///< |E| > 2 u_val: the model's error is seen, between two bounds
  not_resolved,  ///< it is not seen, but below a bound
  not_known      ///< the model has no value, or an uncertainty is not known
};
std::string_view to_string(Verdict verdict);

/// The standard uncertainties of E, in its unit.
struct Uncertainties {
  double numerical = 0;  ///< u_num, of the solution of the model's equations
  double input = 0;      ///< u_input, what those of the inputs make of the model's value
  double measured = 0;   ///< u_D
};

struct Assessment {
  double error = 0;                         ///< E = S − D
  double u_val = 0;                         ///< √(u_num² + u_input² + u_D²)
  double least = 0;                         ///< |E| − 2 u_val, or 0: the model's error is above
  double bound = 0;                         ///< |E| + 2 u_val, which it is below
  Verdict verdict = Verdict::not_resolved;  ///< whether |E| > 2 u_val
};

/// S against D (V&V 20, section 1-5): with δ_S = E − … the model's error lies in E ± 2 u_val, to
/// about 95 % where the errors are normal.
Assessment assess(double simulated, double measured, const Uncertainties& u);

/// χ² = Eᵀ V⁻¹ E, V = diag(v) + C Cᵀ: v the variances that are independent from point to point
/// (u_num² + u_D²), C(i, k) what one standard uncertainty of input k makes of point i. An input's
/// error is the same at all points, so it makes no independent differences. None if V is singular.
std::optional<double> chi_squared(const Eigen::VectorXd& errors, const Eigen::VectorXd& variances,
                                  const Eigen::MatrixXd& contributions);

}  // namespace ciliaval::compare::validation

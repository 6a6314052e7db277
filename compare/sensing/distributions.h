// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace ciliaval::compare::sensing {

/// The probability that a χ² of so many degrees of freedom is larger.
double chi_squared_above(double chi_squared, double freedom);

/// The χ² that is passed with this probability.
double chi_squared_limit(double probability, double freedom);

/// The quantile of Student's t.
double student_t_quantile(double freedom, double probability);

}  // namespace ciliaval::compare::sensing

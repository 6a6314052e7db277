// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>

namespace ciliaval::continuation {

/// Root of a function between a and b, where it has the values f_a and f_b of opposite sign, to a
/// relative accuracy, which is at first that of the last digits.
double root(const std::function<double(double)>& function, double a, double b, double f_a,
            double f_b, double accuracy = 1e-15);

}  // namespace ciliaval::continuation

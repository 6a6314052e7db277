// SPDX-License-Identifier: LGPL-2.1-or-later
// Boost's distributions take seconds to compile: here once, for all that need them.
#include "compare/sensing/distributions.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/complement.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace ciliaval::compare::sensing {

using boost::math::complement;

double chi_squared_above(double chi_squared, double freedom) {
  return cdf(complement(boost::math::chi_squared(freedom), chi_squared));
}

double chi_squared_limit(double probability, double freedom) {
  return quantile(complement(boost::math::chi_squared(freedom), probability));
}

double student_t_quantile(double freedom, double probability) {
  return quantile(boost::math::students_t(freedom), probability);
}

}  // namespace ciliaval::compare::sensing

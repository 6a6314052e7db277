// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/sources/field_points.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <vector>

#include "problem/error.h"
#include "problem/support/interruption.h"
#include "problem/types.h"

namespace ciliaval::analytic::sources {

void for_ranges(std::size_t count, std::size_t longest,
                const std::function<void(std::size_t begin, std::size_t end)>& work) {
  if (count <= longest) {
    if (count > 0) work(0, count);
    return;
  }
  const std::size_t ranges = (count + longest - 1) / longest;
  std::vector<std::exception_ptr> errors(ranges);
  tbb::parallel_for(std::size_t{0}, ranges, [&](std::size_t i) {
    try {
      support::check_interruption();
      work(i * longest, std::min(count, (i + 1) * longest));
    } catch (const std::exception&) {  // Interrupted goes on, and TBB begins no other range
      errors[i] = std::current_exception();
    }
  });
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
}

std::string to_string(const Vector3& x) {
  char text[96];
  std::snprintf(text, sizeof text, "(%.9g, %.9g, %.9g) m", x[0], x[1], x[2]);
  return text;
}

void require_finite(const Vector3& x) {
  if (!x.allFinite())
    throw InputError("a field was asked at the point " + to_string(x) + ", which is not finite");
}

void require_finite(const FieldValue& value, const Vector3& x) {
  if (!value.B.allFinite() || !value.uncertainty.allFinite())
    throw SolverError("the field at " + to_string(x) +
                      " is not finite: move the point off the magnet's surface");
}

double rounding_of_offset(const Vector3& x, const Vector3& y) {
  return 4 * epsilon * (x.norm() + y.norm());
}

FieldValue with_rounding(const Vector3& B, const Vector3& x, const Vector3& y) {
  const double relative = 8 * epsilon + 4 * rounding_of_offset(x, y) / (x - y).norm();
  return {B, Vector3::Constant(relative * B.norm())};
}

FieldValue SourceSum::value() const {
  const double rounding = 4 * epsilon * (x_.norm() + std::sqrt(farthest_));
  const double relative = 8 * epsilon + 4 * rounding / std::sqrt(nearest_);
  return {B_, Vector3::Constant(relative * size_)};
}

}  // namespace ciliaval::analytic::sources

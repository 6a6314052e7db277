// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/field_points.h"

#include <cstdio>
#include <limits>

#include "problem/error.h"

namespace ciliaval::analytic {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

}  // namespace

Field field_at(std::span<const Vector3> points,
               const std::function<FieldValue(const Vector3&)>& field) {
  Field result;
  result.B.reserve(points.size());
  result.uncertainty.reserve(points.size());
  for (const Vector3& x : points) {
    if (!x.allFinite())
      throw InputError("a field was asked at the point " + to_string(x) + ", which is not finite");
    const FieldValue value = field(x);
    if (!value.B.allFinite() || !value.uncertainty.allFinite())
      throw SolverError("the field at " + to_string(x) +
                        " is not finite: move the point off the magnet's surface");
    result.B.push_back(value.B);
    result.uncertainty.push_back(value.uncertainty);
  }
  return result;
}

std::string to_string(const Vector3& x) {
  char text[96];
  std::snprintf(text, sizeof text, "(%.9g, %.9g, %.9g) m", x[0], x[1], x[2]);
  return text;
}

double rounding_of_offset(const Vector3& x, const Vector3& y) {
  return 4 * epsilon * (x.norm() + y.norm());
}

FieldValue with_rounding(const Vector3& B, const Vector3& x, const Vector3& y) {
  const double relative = 8 * epsilon + 4 * rounding_of_offset(x, y) / (x - y).norm();
  return {B, Vector3::Constant(relative * B.norm())};
}

}  // namespace ciliaval::analytic

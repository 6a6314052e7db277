// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/rod/end_rectangles.h"

#include <cmath>

#include "analytic/sources/charged_rectangle.h"
#include "problem/error.h"
#include "problem/types.h"

namespace ciliaval::analytic::rod {

sources::FieldValue field_of_end_rectangles(std::span<const RodEnd> ends, const Vector3& x) {
  sources::FieldValue sum;
  for (const RodEnd& end : ends) {
    const RodRectangle& rectangle = end.rectangle.value();
    const double strength = vacuum_permeability * end.magnetization_jump;
    const double rounding =
        sources::rounding_of_offset(x, end.section.centre) + epsilon * end.section.radius;
    Vector3 local = rectangle.axes.transpose() * (x - end.section.centre);
    local.z() += 0.0;  // turns −0 into +0
    const double to_the_edge = sources::distance_from_edge(rectangle.half, local);
    if (to_the_edge <= 2 * rounding)
      throw InputError("the field diverges on the edge of the magnet's end face, at " +
                       sources::to_string(x) + ": move the point off the edge");
    const sources::FieldValue H = sources::charged_rectangle_field(rectangle.half, local);
    const double error = std::abs(strength) * (H.uncertainty.norm() + 4 * epsilon * H.B.norm() +
                                               rounding / (2 * to_the_edge));
    sum += {strength * (rectangle.axes * H.B), Vector3::Constant(error)};
  }
  return sum;
}

}  // namespace ciliaval::analytic::rod

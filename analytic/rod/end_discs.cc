// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/rod/end_discs.h"

#include <cmath>

#include "analytic/sources/charged_disc.h"
#include "problem/error.h"
#include "problem/types.h"

namespace ciliaval::analytic::rod {
namespace {

[[noreturn]] void throw_on_the_rim(const Vector3& x) {
  throw InputError("the field diverges on the rim of the magnet's end face, at " +
                   sources::to_string(x) + ": move the point off the rim");
}

}  // namespace

sources::FieldValue field_of_end_discs(std::span<const RodEnd> ends, const Vector3& x) {
  sources::FieldValue sum;
  for (const RodEnd& end : ends) {
    const sources::Circle& circle = end.section;
    const double R = circle.radius;
    const double strength = vacuum_permeability * end.magnetization_jump;
    const double rounding = sources::rounding_of_offset(x, circle.centre) + epsilon * R;
    const Vector3 offset = x - circle.centre;
    const double zeta = offset.dot(circle.normal) + 0.0;  // turns −0 into +0
    const Vector3 radial = offset - zeta * circle.normal;
    const double rho = radial.norm();
    const double to_the_rim = std::hypot(rho - R, zeta);
    if (to_the_rim <= 2 * rounding) throw_on_the_rim(x);
    const sources::DiscField H = sources::charged_disc_field(rho / R, zeta / R);
    const Vector3 B = strength * (H.radial_over_rho / R * radial + H.axial * circle.normal);
    const double distance = offset.norm();
    const double gradient =
        distance > 3 * R ? 4 * B.norm() / distance : std::abs(strength) / to_the_rim;
    sum += {B, Vector3::Constant(40 * epsilon * B.norm() + gradient * rounding)};
  }
  return sum;
}

DiscsGradient gradient_of_end_discs(std::span<const RodEnd> ends, const Vector3& x) {
  require_off_the_rims(ends, x);
  DiscsGradient sum;
  for (const RodEnd& end : ends) {
    const double R = end.section.radius;
    const Vector3& n = end.section.normal;
    const Vector3 offset = (x - end.section.centre) / R;
    const double zeta = offset.dot(n);
    const Vector3 radial = offset - zeta * n;
    const double rho = radial.norm();
    const Vector3 e = rho > 0 ? Vector3(radial / rho) : Vector3(Vector3::Zero());
    const sources::DiscGradient H = sources::charged_disc_gradient(rho, zeta);
    const Matrix3 mixed = H.mixed_over_rho * n * radial.transpose();
    const Matrix3 axial = n * n.transpose();
    const Matrix3 gradient = vacuum_permeability * end.magnetization_jump / R *
                             (H.radial_over_rho * (Matrix3::Identity() - axial) +
                              (H.radial - H.radial_over_rho) * e * e.transpose() + H.axial * axial +
                              mixed + mixed.transpose());
    sum.value += gradient;
    sum.rounding +=
        gradient.norm() * (40 * epsilon + 6 * sources::rounding_of_offset(x, end.section.centre) /
                                              (R * offset.norm()));
  }
  return sum;
}

void require_off_the_rims(std::span<const RodEnd> ends, const Vector3& x) {
  for (const RodEnd& end : ends) {
    const double rounding =
        sources::rounding_of_offset(x, end.section.centre) + epsilon * end.section.radius;
    if (sources::distance_from_line(end.section, x) <= 2 * rounding) throw_on_the_rim(x);
  }
}

}  // namespace ciliaval::analytic::rod

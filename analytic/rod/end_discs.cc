// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/rod/end_discs.h"

#include <cmath>
#include <limits>

#include "analytic/sources/charged_disc.h"
#include "problem/error.h"

namespace ciliaval::analytic::rod {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

[[noreturn]] void throw_on_the_rim(const Vector3& x) {
  throw InputError("the field diverges on the rim of the magnet's end face, at " +
                   sources::to_string(x) + ": move the point off the rim");
}

}  // namespace

EndDiscs::EndDiscs(std::span<const RodEnd> ends) {
  for (const RodEnd& end : ends)
    discs_.push_back(
        {end.section, vacuum_permeability * end.magnetization_jump, end.section.centre.norm()});
}

sources::FieldValue EndDiscs::field(const Vector3& x) const {
  const double x_norm = x.norm();
  Vector3 B = Vector3::Zero();
  double error = 0;
  for (const Disc& disc : discs_) {
    const double R = disc.circle.radius;
    const double rounding = 4 * epsilon * (x_norm + disc.centre_norm) + epsilon * R;
    const Vector3 offset = x - disc.circle.centre;
    const double zeta = offset.dot(disc.circle.normal) + 0.0;  // turns −0 into +0
    const Vector3 radial = offset - zeta * disc.circle.normal;
    const double rho2 = radial.squaredNorm();
    const double a2 = (rho2 + zeta * zeta) / (R * R);
    sources::DiscField H{};
    double gradient_over_strength = 0;
    if (a2 > 9) {
      H = sources::far_disc_field(zeta / R, a2);
    } else {
      const double rho = std::sqrt(rho2);
      const double to_the_rim = std::hypot(rho - R, zeta);
      if (to_the_rim <= 2 * rounding) throw_on_the_rim(x);
      H = sources::near_disc_field(rho / R, zeta / R);
      gradient_over_strength = 1 / to_the_rim;
    }
    const Vector3 share =
        disc.strength * (H.radial_over_rho / R * radial + H.axial * disc.circle.normal);
    const double size = share.norm();
    B += share;
    const double gradient =
        a2 > 9 ? 4 * size / (R * std::sqrt(a2)) : std::abs(disc.strength) * gradient_over_strength;
    error += 40 * epsilon * size + gradient * rounding;
  }
  return {B, Vector3::Constant(error)};
}

void require_off_the_rims(std::span<const RodEnd> ends, const Vector3& x) {
  for (const RodEnd& end : ends) {
    const double rounding =
        sources::rounding_of_offset(x, end.section.centre) + epsilon * end.section.radius;
    if (sources::distance_from_line(end.section, x) <= 2 * rounding) throw_on_the_rim(x);
  }
}

}  // namespace ciliaval::analytic::rod

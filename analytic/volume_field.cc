// SPDX-License-Identifier: LGPL-2.1-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analytic/charged_disc.h"
#include "analytic/current_loop.h"
#include "analytic/field_models.h"
#include "analytic/field_points.h"
#include "analytic/order_raising.h"
#include "analytic/rod_magnet.h"
#include "analytic/rod_quadrature.h"
#include "problem/error.h"

namespace ciliaval::analytic {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

void require_off_the_rims(const RodMagnet& magnet, const Vector3& x) {
  for (const RodEnd& end : magnet.ends) {
    const double rounding = rounding_of_offset(x, end.section.centre) + epsilon * magnet.radius;
    if (distance_from_line(end.section, x) <= 2 * rounding)
      throw InputError("the field diverges on the rim of the magnet's end face, at " +
                       to_string(x) + ": move the point off the rim");
  }
}

/// Rounding error of a disc's field: 40 ε|B| of the kernel, and the rounding of the offset times
/// the gradient, at most μ₀σ/(2π·distance from the rim) within three radii and 4|B|/distance
/// beyond.
FieldValue field_of_disc(const RodEnd& end, const Vector3& x) {
  const double strength = vacuum_permeability * end.magnetization_jump;
  const Vector3 B = strength * charged_disc_field(end.section, x);
  const double distance = (x - end.section.centre).norm();
  const double gradient = distance > 3 * end.section.radius
                              ? 4 * B.norm() / distance
                              : std::abs(strength) / distance_from_line(end.section, x);
  const double rounding =
      40 * epsilon * B.norm() +
      gradient * (rounding_of_offset(x, end.section.centre) + epsilon * end.section.radius);
  return {B, Vector3::Constant(rounding)};
}

/// B = μ₀ Σ σ H(disc) + μ₀ m of the wedge's reference charge on the end sections.
FieldValue field_of_discs(const RodMagnet& magnet, const Vector3& x) {
  FieldValue sum;
  for (const RodEnd& end : magnet.ends) sum += field_of_disc(end, x);
  if (const auto m = magnetization_at(magnet, x)) {
    const Vector3 inside = vacuum_permeability * *m;
    sum += {inside, Vector3::Constant(40 * epsilon * inside.norm())};
  }
  return sum;
}

/// B = μ₀ ∫ M H(loop at S) dS: each slice of thickness dS and magnetisation M d₃ is a current
/// M dS around its edge. A rounding error δ of the offset, which differs from loop to loop, moves
/// the field of a loop at the distance d by up to I δ/(2πd²), and the integral by Mδ/(2 min d).
FieldValue field_of_loops(const RodMagnet& magnet, double tolerance, const Vector3& x) {
  double rounding = 0;
  const auto distance = [&](const CentrelinePoint& point) {
    const double d = distance_from_line(section(magnet, point), x);
    rounding = std::max(rounding, rounding_of_offset(x, point.position) / (2 * d));
    return d;
  };
  const auto parts = graded_stretches(magnet, distance, 1e-9 * magnet.radius);
  if (!parts)
    throw SolverError("the field of the stacked slices was asked at " + to_string(x) +
                      ", on the magnet's mantle, where it jumps: move the point off the mantle");
  const auto contribution = [&](const RodStretch& part, std::size_t order) {
    const QuadratureRule& rule = unit_gauss_legendre(order);
    const double length = part.end - part.begin;
    Vector3 H = Vector3::Zero();
    for (std::size_t i = 0; i < order; ++i) {
      const CentrelinePoint point = at(magnet, part, part.begin + rule.nodes[i] * length);
      H += rule.weights[i] * current_loop_field(section(magnet, point), x);
    }
    return Vector3(vacuum_permeability * part.magnetization * length * H);
  };
  FieldValue value =
      raise_orders(*parts, contribution, {tolerance, 54, "field of the stacked slices", x});
  double largest = 0;
  for (const RodStretch& part : *parts) largest = std::max(largest, std::abs(part.magnetization));
  value.uncertainty += Vector3::Constant(vacuum_permeability * largest * rounding);
  return value;
}

}  // namespace

Field VolumeField::field(const Cilium& cilium, const Deformation& deformation,
                         std::span<const Vector3> points) const {
  const RodMagnet magnet = rod_magnet(cilium, deformation);
  if (options_.slices == VolumeOptions::Slices::wedge) require_body(magnet);
  return field_at(points, [&](const Vector3& x) {
    require_off_the_rims(magnet, x);
    if (options_.method == Method::quadrature)
      return rod_field_by_quadrature(magnet, options_.slices, options_.tolerance, x);
    return options_.slices == VolumeOptions::Slices::wedge
               ? field_of_discs(magnet, x)
               : field_of_loops(magnet, options_.tolerance, x);
  });
}

}  // namespace ciliaval::analytic

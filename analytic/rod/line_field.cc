// SPDX-License-Identifier: LGPL-2.1-or-later
#include <span>

#include "analytic/rod/field_models.h"
#include "analytic/rod/rod_magnet.h"
#include "analytic/rod/uniform_sums.h"
#include "analytic/sources/adaptive_order.h"
#include "analytic/sources/dipole.h"
#include "analytic/sources/field_points.h"
#include "problem/error.h"

namespace ciliaval::analytic::rod {
namespace {

/// Two poles for each segment stand for its dipoles if these are along the centreline.
bool has_closed_form(const LineOptions& options, const RodMagnet& magnet) {
  return options.method == Method::closed_form && options.push_forward == sources::PushForward::F &&
         !is_transverse(magnet);
}

/// B of a pole q = A (M below − M above) at each end of the magnet.
sources::FieldValue field_of_poles(const RodMagnet& magnet, const Vector3& x) {
  sources::FieldValue sum;
  for (const RodEnd& end : magnet.ends) {
    const Vector3& pole = end.section.centre;
    if ((x - pole).norm() <= sources::rounding_of_offset(x, pole))
      throw InputError("the field of the model `line` diverges at its pole " +
                       sources::to_string(x) + ": move the point, or take the model `volume`");
    sum += sources::with_rounding(sources::pole_field(pole_strength(end), x - pole), x, pole);
  }
  return sum;
}

/// ∫ kernel(m, x − r) over the dipoles m = A (M₁ d₁ + M₂ d₂) dS + A M₃ dr (F) or A M₃ d₃ dS (R) of
/// the centreline.
template <class Kernel>
sources::FieldValue sum_over_dipoles(const RodMagnet& magnet, double area,
                                     const LineOptions& options, const Vector3& x,
                                     const Kernel& kernel) {
  const auto parts = graded_stretches(
      magnet, [&](const CentrelinePoint& point) { return (x - point.position).norm(); },
      1e-9 * magnet.centreline.length());
  if (!parts)
    throw SolverError("the quadrature of the model `line` was asked at " + sources::to_string(x) +
                      ", on the centreline, where it diverges: move the point, or take the model "
                      "`volume`");
  const auto contribution = [&](const RodStretch& part, std::size_t order) {
    const QuadratureRule& rule = sources::unit_gauss_legendre(order);
    const double length = part.end - part.begin;
    Vector3 B = Vector3::Zero();
    for (std::size_t i = 0; i < order; ++i) {
      const CentrelinePoint point = at(magnet, part, part.begin + rule.nodes[i] * length);
      const Vector3 axis =
          options.push_forward == sources::PushForward::F ? point.derivative : point.normal();
      const double volume = area * rule.weights[i] * length;
      B += kernel(Vector3(volume * carried_magnetization(part, point, axis)),
                  Vector3(x - point.position));
    }
    return B;
  };
  return sources::integrate_adaptively(
      *parts, contribution, {options.tolerance, 54, "quadrature of the model `line`", x});
}

}  // namespace

Field LineField::field(const Cilium& cilium, const Deformation& deformation,
                       std::span<const Vector3> points) const {
  const RodMagnet magnet = rod_magnet(cilium, deformation);
  if (options_.method == Method::uniform) return field_of_uniform_line(magnet, options_, points);
  const bool closed_form = has_closed_form(options_, magnet);
  if (closed_form)
    return sources::field_at(points, 4096,
                             [&](const Vector3& x) { return field_of_poles(magnet, x); });
  return sources::field_at(points, 4, [&](const Vector3& x) {
    return sum_over_dipoles(magnet, cilium.area(), options_, x, sources::dipole_field);
  });
}

std::vector<Matrix3> LineField::gradient(const Cilium& cilium, const Deformation& deformation,
                                         std::span<const Vector3> points) const {
  if (options_.method == Method::uniform)
    throw InputError(
        "the gradient of the model `line` was asked by the method `uniform`: take `closed_form` "
        "or `quadrature`");
  const RodMagnet magnet = rod_magnet(cilium, deformation);
  const double area = cilium.area();
  const bool closed_form = has_closed_form(options_, magnet);
  return sources::gradient_at(points, [&](const Vector3& x) {
    Matrix3 sum = Matrix3::Zero();
    if (closed_form)
      for (const RodEnd& end : magnet.ends)
        sum += sources::pole_gradient(pole_strength(end), x - end.section.centre);
    else
      for (int k = 0; k < 3; ++k)
        sum.col(k) = sum_over_dipoles(magnet, area, options_, x, [k](const auto& m, const auto& a) {
                       return Vector3(sources::dipole_gradient(m, a).col(k));
                     }).B;
    return sum;
  });
}

}  // namespace ciliaval::analytic::rod

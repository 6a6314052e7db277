// SPDX-License-Identifier: LGPL-2.1-or-later
#include <optional>
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

sources::AdaptiveOrder demand(const LineOptions& options, const Vector3& x) {
  return {options.tolerance, 54, "quadrature of the model `line`", x};
}

/// ∫ kernel(m, x − r) over the dipoles m = A (M₁ d₁ + M₂ d₂) dS + A M₃ dr (F) or A M₃ d₃ dS (R) of
/// the centreline, as far as the orders bring it; nothing on the centreline, where it diverges.
template <class Kernel>
std::optional<sources::AdaptiveSum> sum_over_dipoles(const RodMagnet& magnet,
                                                     const LineOptions& options, const Vector3& x,
                                                     const Kernel& kernel) {
  const auto parts = graded_stretches(
      magnet, [&](const CentrelinePoint& point) { return (x - point.position).norm(); },
      1e-9 * magnet.centreline.length());
  if (!parts) return std::nullopt;
  const auto contribution = [&](const RodStretch& part, std::size_t order) {
    const QuadratureRule& rule = sources::unit_gauss_legendre(order);
    const double length = part.end - part.begin;
    sources::SourceSum sum(x);
    for (std::size_t i = 0; i < order; ++i) {
      const CentrelinePoint point = at(magnet, part, part.begin + rule.nodes[i] * length);
      const Vector3 axis =
          options.push_forward == sources::PushForward::F ? point.derivative : point.normal();
      const double volume = magnet.area * rule.weights[i] * length;
      sum.add(kernel(Vector3(volume * carried_magnetization(part, point, axis)),
                     Vector3(x - point.position)),
              point.position);
    }
    return sum.value();
  };
  return sources::sum_adaptively(*parts, contribution, demand(options, x));
}

/// The sum over the dipoles to its tolerance.
template <class Kernel>
sources::FieldValue quadrature(const RodMagnet& magnet, const LineOptions& options,
                               const Vector3& x, const Kernel& kernel) {
  const auto sum = sum_over_dipoles(magnet, options, x, kernel);
  if (!sum)
    throw SolverError("the quadrature of the model `line` was asked at " + sources::to_string(x) +
                      ", on the centreline, where it diverges: move the point, or take the model "
                      "`volume`");
  sources::require_reached(*sum, demand(options, x));
  return sum->value;
}

/// B of the sum over the dipoles, to which the rounding of the ends belongs.
sources::FieldValue with_ends(const RodMagnet& magnet, sources::FieldValue value,
                              const Vector3& x) {
  value.uncertainty += Vector3::Constant(rounding_of_poles(magnet, x));
  return value;
}

/// B of the poles. Where they cancel, far from a magnet that is short beside the distance, B is
/// that of the dipoles between them.
sources::FieldValue field_of_poles_or_dipoles(const RodMagnet& magnet, const LineOptions& options,
                                              const Vector3& x) {
  const sources::FieldValue poles = field_of_poles(magnet, x);
  if (sources::is_within(poles, options.tolerance)) return poles;
  const auto dipoles = sum_over_dipoles(magnet, options, x, sources::dipole_field);
  if (!dipoles || !(dipoles->reached <= options.tolerance)) return poles;
  return with_ends(magnet, dipoles->value, x);
}

/// Derivative of the field of the poles; where they cancel, of that of the dipoles.
Matrix3 gradient_of_poles(const RodMagnet& magnet, const LineOptions& options, const Vector3& x) {
  Matrix3 sum = Matrix3::Zero();
  double rounding = 0;
  for (const RodEnd& end : magnet.ends) {
    const Vector3& pole = end.section.centre;
    const Matrix3 gradient = sources::pole_gradient(pole_strength(end), x - pole);
    sum += gradient;
    rounding += gradient.norm() *
                (8 * epsilon + 3 * sources::rounding_of_offset(x, pole) / (x - pole).norm());
  }
  if (rounding <= options.tolerance * sum.norm()) return sum;
  Matrix3 far;
  for (int k = 0; k < 3; ++k) {
    const auto column = sum_over_dipoles(magnet, options, x, [k](const auto& m, const auto& a) {
      return Vector3(sources::dipole_gradient(m, a).col(k));
    });
    if (!column || !(column->reached <= options.tolerance)) return sum;
    far.col(k) = column->value.B;
  }
  return far;
}

}  // namespace

Field LineField::field(const Cilium& cilium, const Deformation& deformation,
                       std::span<const Vector3> points) const {
  const RodMagnet magnet = rod_magnet(cilium, deformation);
  if (options_.method == Method::uniform) return field_of_uniform_line(magnet, options_, points);
  const bool closed_form = has_closed_form(options_, magnet);
  return sources::field_at(points, closed_form ? 4096 : 4, [&](const Vector3& x) {
    return closed_form
               ? field_of_poles_or_dipoles(magnet, options_, x)
               : with_ends(magnet, quadrature(magnet, options_, x, sources::dipole_field), x);
  });
}

std::vector<Matrix3> LineField::gradient(const Cilium& cilium, const Deformation& deformation,
                                         std::span<const Vector3> points) const {
  if (options_.method == Method::uniform)
    throw InputError(
        "the gradient of the model `line` was asked by the method `uniform`: take `closed_form` "
        "or `quadrature`");
  const RodMagnet magnet = rod_magnet(cilium, deformation);
  const bool closed_form = has_closed_form(options_, magnet);
  return sources::gradient_at(points, [&](const Vector3& x) {
    if (closed_form) return gradient_of_poles(magnet, options_, x);
    Matrix3 sum;
    for (int k = 0; k < 3; ++k)
      sum.col(k) = quadrature(magnet, options_, x, [k](const auto& m, const auto& a) {
                     return Vector3(sources::dipole_gradient(m, a).col(k));
                   }).B;
    return sum;
  });
}

}  // namespace ciliaval::analytic::rod

// SPDX-License-Identifier: LGPL-2.1-or-later
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "analytic/rod/field_models.h"
#include "analytic/rod/rod_magnet.h"
#include "analytic/rod/uniform_sums.h"
#include "analytic/sources/adaptive_order.h"
#include "analytic/sources/dipole.h"
#include "analytic/sources/field_points.h"
#include "problem/error.h"

namespace ciliaval::analytic::rod {
namespace {

/// A pole q = πR²(M below − M above) at an end of the magnet.
struct Pole {
  Vector3 position;      ///< m
  double strength;       ///< μ₀q/4π, T·m²
  double position_norm;  ///< m
};

std::vector<Pole> poles_of(const RodMagnet& magnet, double area) {
  std::vector<Pole> poles;
  for (const RodEnd& end : magnet.ends)
    poles.push_back({end.section.centre,
                     vacuum_permeability / (4 * std::numbers::pi) * area * end.magnetization_jump,
                     end.section.centre.norm()});
  return poles;
}

/// B = Σ μ₀q a/(4πa³), |B| of each to 8 ε and the rounding of the offset times 4|B|/a.
sources::FieldValue field_of_poles(std::span<const Pole> poles, const Vector3& x) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const double x_norm = x.norm();
  Vector3 B = Vector3::Zero();
  double error = 0;
  for (const Pole& pole : poles) {
    const Vector3 offset = x - pole.position;
    const double rounding = 4 * epsilon * (x_norm + pole.position_norm);
    const double a = offset.norm();
    if (a <= rounding)
      throw InputError("the field of the model `line` diverges at its pole " +
                       sources::to_string(x) + ": move the point, or take the model `volume`");
    const double inverse = 1 / a;
    const double size = pole.strength * inverse * inverse;
    B += size * inverse * offset;
    error += std::abs(size) * (8 * epsilon + 4 * rounding * inverse);
  }
  return {B, Vector3::Constant(error)};
}

/// ∫ dB over the dipoles M πR² dr (F) or M πR² d₃ dS (R) of the centreline.
sources::FieldValue field_of_dipoles(const RodMagnet& magnet, double area,
                                     const LineOptions& options, const Vector3& x) {
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
      const double strength = part.magnetization * area * rule.weights[i] * length;
      B += sources::dipole_field(strength * axis, x - point.position);
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
  const bool closed_form =
      options_.method == Method::closed_form && options_.push_forward == sources::PushForward::F;
  if (closed_form) {
    const std::vector<Pole> poles = poles_of(magnet, cilium.area());
    return sources::field_at(points, 4096,
                             [&](const Vector3& x) { return field_of_poles(poles, x); });
  }
  return sources::field_at(points, 4, [&](const Vector3& x) {
    return field_of_dipoles(magnet, cilium.area(), options_, x);
  });
}

}  // namespace ciliaval::analytic::rod

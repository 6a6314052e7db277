// SPDX-License-Identifier: LGPL-2.1-or-later

#include "analytic/rod/field_models.h"
#include "analytic/rod/rod_magnet.h"
#include "analytic/sources/adaptive_order.h"
#include "analytic/sources/dipole.h"
#include "analytic/sources/field_points.h"
#include "problem/error.h"

namespace ciliaval::analytic::rod {
namespace {

/// ∫ r dS and ∫ (M₁ d₁ + M₂ d₂) dS + M₃ ∫ dr or ∫ d₃ dS over a stretch. r is a polynomial, on which
/// Gauss–Legendre is exact; dᵢ is a normalised one, to which twice the nodes and eight more bring
/// it to rounding error.
struct StretchIntegrals {
  Vector3 position = Vector3::Zero();
  Vector3 magnetization = Vector3::Zero();
};

StretchIntegrals integrate(const RodMagnet& magnet, const RodStretch& stretch,
                           sources::PushForward push_forward) {
  const std::size_t nodes = magnet.centreline.pieces()[stretch.piece].S.size();
  const QuadratureRule rule = gauss_legendre(2 * nodes + 8, stretch.begin, stretch.end);
  StretchIntegrals integrals;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const CentrelinePoint point = at(magnet, stretch, rule.nodes[i]);
    integrals.position += rule.weights[i] * point.position;
    integrals.magnetization +=
        rule.weights[i] * carried_magnetization(stretch, point,
                                                push_forward == sources::PushForward::R
                                                    ? point.normal()
                                                    : Vector3(Vector3::Zero()));
  }
  if (push_forward == sources::PushForward::F)
    integrals.magnetization +=
        stretch.magnetization.z() *
        (at(magnet, stretch, stretch.end).position - at(magnet, stretch, stretch.begin).position);
  return integrals;
}

std::vector<sources::Dipole> dipoles(const Cilium& cilium, const RodMagnet& magnet,
                                     sources::PushForward push_forward) {
  std::vector<sources::Dipole> result;
  for (std::size_t i = 0; i < magnet.stretches.size(); ++i) {
    const RodStretch& stretch = magnet.stretches[i];
    if (i == 0 || magnet.stretches[i - 1].segment != stretch.segment)
      result.push_back({Vector3::Zero(), Vector3::Zero()});
    const StretchIntegrals integrals = integrate(magnet, stretch, push_forward);
    result.back().position += integrals.position / cilium.segments[stretch.segment].length;
    result.back().moment += magnet.area * integrals.magnetization;
  }
  return result;
}

}  // namespace

std::vector<Matrix3> DipoleField::gradient(const Cilium& cilium, const Deformation& deformation,
                                           std::span<const Vector3> points) const {
  const RodMagnet magnet = rod_magnet(cilium, deformation);
  const std::vector<sources::Dipole> sources = dipoles(cilium, magnet, options_.push_forward);
  return sources::gradient_at(points, [&](const Vector3& x) {
    Matrix3 sum = Matrix3::Zero();
    for (const sources::Dipole& dipole : sources)
      sum += sources::dipole_gradient(dipole.moment, x - dipole.position);
    return sum;
  });
}

Field DipoleField::field(const Cilium& cilium, const Deformation& deformation,
                         std::span<const Vector3> points) const {
  const RodMagnet magnet = rod_magnet(cilium, deformation);
  const std::vector<sources::Dipole> sources = dipoles(cilium, magnet, options_.push_forward);
  return sources::field_at(points, 4096, [&](const Vector3& x) {
    sources::FieldValue sum{Vector3::Zero(), Vector3::Constant(rounding_of_poles(magnet, x))};
    for (const sources::Dipole& dipole : sources) {
      const Vector3 offset = x - dipole.position;
      if (offset.norm() <= 1e-12 * cilium.length())
        throw InputError("the field of the dipole diverges at its own position " +
                         sources::to_string(x) + ": move the point, or take the model `volume`");
      sum +=
          sources::with_rounding(sources::dipole_field(dipole.moment, offset), x, dipole.position);
    }
    return sum;
  });
}

}  // namespace ciliaval::analytic::rod

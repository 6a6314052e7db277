// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/forces/wrench.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "analytic/body/mesh_field.h"
#include "analytic/rod/field_models.h"
#include "problem/error.h"
#include "problem/surroundings/magnets/field.h"

namespace ciliaval::analytic::forces {
namespace {

using surroundings::magnets::Magnet;

constexpr double tolerance = 1e-11;
constexpr std::size_t highest_order = 96;

/// The sums over the charges of one order, with those of the terms' sizes.
struct Sums {
  Wrench wrench;
  double force_size = 0;
  double torque_size = 0;
};

Sums sums(const std::vector<PointCharge>& charges, const PointsField& field, const Vector3& about) {
  std::vector<Vector3> points;
  points.reserve(charges.size());
  for (const PointCharge& charge : charges) points.push_back(charge.position);
  const std::vector<Vector3> B = field(points);
  Sums result;
  for (std::size_t i = 0; i < charges.size(); ++i) {
    const Vector3 force = charges[i].strength * B[i];
    const Vector3 torque = (points[i] - about).cross(force);
    result.wrench.force += force;
    result.wrench.torque += torque;
    result.force_size += force.norm();
    result.torque_size += torque.norm();
  }
  return result;
}

PointsField field_of(const Cilium& cilium, const Deformation& deformation) {
  return [&](std::span<const Vector3> points) {
    if (deformation.body)
      return body::MeshField({.tolerance = 1e-10}).field(cilium, deformation, points).B;
    return rod::VolumeField().field(cilium, deformation, points).B;
  };
}

Charges charges_of_cilium(const Cilium& cilium, const Deformation& deformation) {
  return deformation.body ? charges_of(*deformation.body)
                          : charges_of(rod::rod_magnet(cilium, deformation));
}

}  // namespace

Wrench& Wrench::operator+=(const Wrench& other) {
  force += other.force;
  torque += other.torque;
  force_error += other.force_error;
  torque_error += other.torque_error;
  return *this;
}

Wrench wrench(const Charges& charges, const PointsField& field, const Vector3& about) {
  constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();
  std::optional<Sums> last;
  for (std::size_t order = 4; order <= highest_order; order += order / 2) {
    Sums now = sums(charges(order), field, about);
    if (last) {
      Wrench& found = now.wrench;
      const double force_change = (found.force - last->wrench.force).norm();
      const double torque_change = (found.torque - last->wrench.torque).norm();
      found.force_error = force_change + rounding * now.force_size;
      found.torque_error = torque_change + rounding * now.torque_size;
      if (force_change <= std::max(tolerance * found.force.norm(), rounding * now.force_size) &&
          torque_change <= std::max(tolerance * found.torque.norm(), rounding * now.torque_size))
        return found;
    }
    last = now;
  }
  throw SolverError(
      "the force between two magnets cannot be brought to its accuracy: they are too near to each "
      "other");
}

Wrench wrench_on_cilium(const Cilium& cilium, const Deformation& deformation,
                        const std::vector<Magnet>& magnets) {
  const PointsField field = [&](std::span<const Vector3> points) {
    std::vector<Vector3> B(points.size(), Vector3::Zero());
    for (std::size_t i = 0; i < points.size(); ++i)
      for (const Magnet& magnet : magnets) B[i] += surroundings::magnets::jet(magnet, points[i]).B;
    return B;
  };
  return wrench(charges_of_cilium(cilium, deformation), field, Vector3::Zero());
}

Wrench wrench_on_magnet(const Cilium& cilium, const Deformation& deformation,
                        const Magnet& magnet) {
  return wrench(charges_of(magnet), field_of(cilium, deformation), magnet.position);
}

}  // namespace ciliaval::analytic::forces

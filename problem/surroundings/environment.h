// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "problem/cilium.h"
#include "problem/types.h"

namespace ciliaval::surroundings {

/// How a deformed magnet's magnetisation enters its energy in the field B₀, per reference volume.
enum class MagneticEnergy {
  F,  ///< −(F·M)·B₀, M carried along by the deformation (Zhao et al., JMPS 124, 2019)
  R   ///< −(R·M)·B₀, M turned by the polar rotation (Danas & Reis, JMPS 191, 2024)
};

/// What surrounds the cilium, besides what its load says: weight and buoyancy, and a magnetic
/// field. By default there is nothing.
struct Environment {
  Vector3 gravity = Vector3::Zero();        ///< g, m/s²
  double fluid_density = 0;                 ///< ρ_f, kg/m³
  Vector3 uniform_field = Vector3::Zero();  ///< B₀, T
  MagneticEnergy magnetic_energy = MagneticEnergy::F;

  bool operator==(const Environment& other) const = default;
};

/// Whether nothing acts on the cilium.
bool is_empty(const Environment& environment);
/// Gravity and field by the factor; the fluid's density stays.
Environment scaled(const Environment& environment, double factor);
/// (1−t)·from + t·to in gravity and field; the rest is that of `to`.
Environment interpolate(const Environment& from, const Environment& to, double t);
/// The same turned by the angle (rad) about the z axis.
Environment turned(const Environment& environment, double angle);
/// The component along n (a unit vector) of gravity over |g|, or of the field over |B₀|, whichever
/// is larger: 0 if the environment lies in the plane across n.
double component(const Environment& environment, const Vector3& n);

/// (ρ − ρ_f) g of a segment, N/m³: weight and buoyancy per volume. The fluid's pressure squeezes
/// the cilium besides, by p/K, which is left out (docs/theory/environment.md).
Vector3 weight_per_volume(const Environment& environment, const Segment& segment);
/// M A B₀ of a segment, N: by the law F a uniform field pulls a magnet's upper end face by this
/// and its lower one by as much the other way, however it is bent.
Vector3 pole_force(const Environment& environment, const Cilium& cilium, std::size_t segment);
/// The sum of the pole forces at each of Cilium::interfaces(), N.
std::vector<Vector3> pole_forces(const Environment& environment, const Cilium& cilium);

/// Throws InputError if a number is not finite, the fluid's density is negative, or a segment has
/// no density where there is gravity.
void require_valid(const Environment& environment, const Cilium& cilium);

}  // namespace ciliaval::surroundings

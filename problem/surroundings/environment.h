// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "problem/centreline.h"
#include "problem/cilium.h"
#include "problem/surroundings/magnets/field.h"
#include "problem/surroundings/magnets/magnet.h"
#include "problem/types.h"

namespace ciliaval::surroundings {

/// Law by which a deformed magnet's magnetisation enters its energy in the field B₀, per reference
/// volume.
enum class MagneticEnergy {
  F,  ///< −(F·M)·B₀, M carried along by the deformation (Zhao et al., JMPS 124, 2019)
  R   ///< −(R·M)·B₀, M turned by the polar rotation (Danas & Reis, JMPS 191, 2024)
};

/// "F" or "R".
std::string_view name(MagneticEnergy energy);

/// Surroundings of the cilium, besides its load: weight and buoyancy, a magnetic field, and magnets
/// at rest beside it. By default there is nothing.
struct Environment {
  Vector3 gravity = Vector3::Zero();        ///< g, m/s²
  double fluid_density = 0;                 ///< ρ_f, kg/m³
  Vector3 uniform_field = Vector3::Zero();  ///< B₀, T
  MagneticEnergy magnetic_energy = MagneticEnergy::F;
  std::vector<magnets::Magnet> magnets{};

  bool operator==(const Environment& other) const = default;
};

/// True if nothing acts on the cilium.
bool is_empty(const Environment& environment);
/// Gravity, field and the magnets' magnetisation by the factor; the fluid's density stays.
Environment scaled(const Environment& environment, double factor);
/// (1−t)·from + t·to in gravity and in the fields, that of the magnets, too, whose one set fades
/// while the other grows; the rest is that of `to`.
Environment interpolate(const Environment& from, const Environment& to, double t);
/// The same turned by the angle (rad) about the z axis.
Environment turned(const Environment& environment, double angle);
/// The component along n (a unit vector) of gravity over |g|, of the field over |B₀|, or of a
/// magnet's moment, place or nearest axis, whichever is largest: 0 if the environment is its own
/// image in the plane through the origin across n.
double component(const Environment& environment, const Vector3& n);

/// (ρ − ρ_f) g of a segment, N/m³: weight and buoyancy per volume. The fluid's pressure squeezes
/// the cilium besides, by p/K, which is left out (docs/theory/environment.md).
Vector3 weight_per_volume(const Environment& environment, const Segment& segment);
/// B of the magnets and its derivatives at x. Throws SolverError inside one of them.
magnets::FieldJet field_of_magnets(const Environment& environment, const Vector3& x);

/// M A B₀ of a segment, N: by the law F a uniform field pulls a magnet's upper end face by this
/// and its lower one by as much the other way, however it is bent.
Vector3 pole_force(const Environment& environment, const Cilium& cilium, std::size_t segment);
/// The sum of the pole forces at each of Cilium::interfaces(), N.
std::vector<Vector3> pole_forces(const Environment& environment, const Cilium& cilium);

/// The name of a magnet that a section of the bent cilium touches, if there is one.
std::optional<std::string> touched_magnet(const Environment& environment, const Cilium& cilium,
                                          const Centreline& centreline);

/// Throws InputError if a number is not finite, the fluid's density is negative, a segment has no
/// density where there is gravity, or a magnet is none or touches the straight cilium.
void require_valid(const Environment& environment, const Cilium& cilium);

}  // namespace ciliaval::surroundings

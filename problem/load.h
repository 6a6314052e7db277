// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "problem/cilium.h"
#include "problem/types.h"

namespace ciliaval {

/// Horizontal force that stays at the current height z = h while the cilium slides under it (paper,
/// Eq. 1–2).
struct ContactLoad {
  static constexpr std::string_view type = "contact";
  double force = 0;    ///< F, N
  double height = 0;   ///< h, m
  double azimuth = 0;  ///< φ, rad
};

/// Horizontal force q per unit current height over the whole cilium: drag on the projected area
/// (paper, Eq. 3–4, 10–11).
struct FlowLoad {
  static constexpr std::string_view type = "flow";
  double force_per_height = 0;  ///< q, N/m
  double azimuth = 0;           ///< φ, rad
};

/// Horizontal dead force spread evenly over the material cross-section at reference arc length S.
struct SectionLoad {
  static constexpr std::string_view type = "section";
  double force = 0;      ///< F, N
  double arclength = 0;  ///< S, m
  double azimuth = 0;    ///< φ, rad
};

/// Horizontal dead force per reference length over the whole cilium, spread evenly over the
/// section.
struct DeadLoad {
  static constexpr std::string_view type = "dead";
  double force_per_length = 0;  ///< q, N/m
  double azimuth = 0;           ///< φ, rad
};

/// Displacement control of the contact point (the test bench): whatever point of the cilium is at
/// the current height z = h is pushed aside to the deflection δ along e. The contact force is that
/// of ContactLoad, horizontal and at z = h; its amount is a result (MechanicsStep::applied_force).
///
/// Any δ is valid. One that is larger than the cilium can reach is a slip-off, not an error of the
/// input: a bench that drives its probe on sees the cilium let go, the δ where it does so is the
/// model's to find (MechanicsStep::slip_off_displacement) and differs from model to model.
struct ProbeLoad {
  static constexpr std::string_view type = "probe";
  double displacement = 0;  ///< δ, m
  double height = 0;        ///< h, m
  double azimuth = 0;       ///< φ, rad
};

/// One step of a load path.
using Load = std::variant<ContactLoad, FlowLoad, SectionLoad, DeadLoad, ProbeLoad>;

/// Loads that the cilium bears one after the other, all of one type.
using LoadPath = std::vector<Load>;

std::string_view type(const Load& load);
double azimuth(const Load& load);
/// e = (cos φ, sin φ, 0), the direction of the load.
Vector3 direction(const Load& load);
/// The force F (N), the force per length q (N/m) or the displacement δ (m), whichever the type has.
double magnitude(const Load& load);
/// Unit of the magnitude: "N", "N/m" or "m".
std::string_view magnitude_unit(const Load& load);
/// h of a load that acts at a current height (contact, probe), m.
std::optional<double> contact_height(const Load& load);
/// The same load with another magnitude.
Load with_magnitude(const Load& load, double magnitude);
/// (1−t)·from + t·to in every parameter, for load stepping. Throws InputError if the types differ.
Load interpolate(const Load& from, const Load& to, double t);

/// Throws InputError if the load is not one the cilium can bear in the models' sense: magnitude
/// finite and not negative (turn the azimuth by 180° instead), 0 < h < L, 0 < S ≤ L.
void require_valid(const Load& load, const Cilium& cilium);

}  // namespace ciliaval

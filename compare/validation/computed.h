// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "compare/input/measurement/measurement.h"
#include "compare/models/run.h"
#include "problem/solid_body.h"

namespace ciliaval::compare::validation {

/// A model's value of a measurand, SI.
struct Computed {
  std::optional<double> value;      ///< S; none where the model has none
  std::optional<double> numerical;  ///< u_num as the model states it; none: not known
  std::string note;                 ///< why there is no value
};

/// Value of a measurand of the end section at a step. Rods: x = r + X d₁ + Y d₂, the section's own
/// directors; a solid: the material point (X, Y, L). The deflection is the displacement along
/// `direction`. u_num follows from the tip's position, and from the section's angle times the
/// distance of the point from the centre. A number is the one in the table of results
/// (results::Quantity).
Computed computed(const input::measurement::Measurand& measurand, const models::MechanicsRun& run,
                  std::size_t step, const Vector3& direction);

/// Value of a measurand at a sensor: u_num is the field model's, with the part that it inherits
/// from the shape. `mechanics` is the run of the field's shape; for readings it is not used.
Computed computed(const input::measurement::Measurand& measurand, const models::FieldRun& run,
                  const models::MechanicsRun& mechanics, std::size_t step);

/// The current place of a material point of a body; none if no cell holds it. A point that lies up
/// to a hundredth of a cell outside is taken for one on the surface, which a mesh rounds.
std::optional<Vector3> material_point(const SolidBody& body, const Vector3& reference);

}  // namespace ciliaval::compare::validation

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/models/registry.h"
#include "compare/models/run.h"
#include "compare/validation/input_number.h"

namespace ciliaval::compare::validation {

/// Model whose derivatives give u_input.
enum class Sensitivities {
  quick,  ///< of quick models: a slow one has those of the most detailed quick one
  own     ///< each model's own, which solves a slow one twice for each input
};

/// Model whose derivatives are taken: the model itself, or, if it is slow and `whose` says so, the
/// most detailed quick one that takes the load. For a pair of models each of the two.
struct Stand {
  std::string mechanics;
  std::string field;  ///< empty: of the shape

  std::string name() const { return field.empty() ? mechanics : mechanics + "/" + field; }
  auto operator<=>(const Stand&) const = default;
};
/// The stand-in for a model or a pair; none if no such model takes the load. `field` is empty for a
/// measurand of the shape.
std::optional<Stand> stand_in(const std::string& mechanics, const std::string& field,
                              Sensitivities whose, const input::Case& problem,
                              std::span<const models::MechanicsEntry> mechanics_entries,
                              std::span<const models::FieldEntry> field_entries);

/// [input][measurement]: what one standard uncertainty of an input makes of a model's value, SI, by
/// central differences (S(+h u) − S(−h u))/(2h), h = Input::step. None where a shifted model has no
/// value.
using Contributions = std::vector<std::vector<std::optional<double>>>;

/// Contributions to the values of each stand, of its own measurands: of the shape or of the field.
std::map<Stand, Contributions> contributions(
    const input::Case& problem, const std::vector<Input>& inputs, const std::vector<Stand>& stands,
    std::span<const models::MechanicsEntry> mechanics_entries,
    std::span<const models::FieldEntry> field_entries, const Progress& progress);

}  // namespace ciliaval::compare::validation

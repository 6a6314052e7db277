// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <set>
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

/// Results on the cases with an input shifted to its lower and to its upper side.
struct Shifted {
  std::size_t input = 0;  ///< its number
  double width = 0;       ///< from side to side, in standard uncertainties
  std::map<std::string, std::array<models::MechanicsRun, 2>> shapes;  ///< by the model's id
  std::map<Stand, std::array<models::FieldRun, 2>> fields;            ///< of the pairs
};
/// Solves the models of the stands with each input shifted by h = Input::step, for the central
/// differences (S(+h u) − S(−h u))/(2h), and hands the results over, input by input.
void for_each_input(const input::Case& problem, const std::vector<Input>& inputs,
                    const std::set<Stand>& stands,
                    std::span<const models::MechanicsEntry> mechanics_entries,
                    std::span<const models::FieldEntry> field_entries, const Progress& progress,
                    const std::function<void(const Shifted&)>& use);

/// [input][measurement]: what one standard uncertainty of an input makes of a model's value, SI.
/// None where a shifted model has no value.
using Contributions = std::vector<std::vector<std::optional<double>>>;

/// Contributions to the values of each stand, of its own measurands: of the shape or of the field.
std::map<Stand, Contributions> contributions(
    const input::Case& problem, const std::vector<Input>& inputs, const std::set<Stand>& stands,
    std::span<const models::MechanicsEntry> mechanics_entries,
    std::span<const models::FieldEntry> field_entries, const Progress& progress);

}  // namespace ciliaval::compare::validation

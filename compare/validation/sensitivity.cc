// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/validation/sensitivity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "compare/validation/computed.h"

namespace ciliaval::compare::validation {
namespace {

using models::FieldEntry;
using models::MechanicsEntry;
using Row = std::vector<std::optional<double>>;  ///< one for each measurement

/// The id itself if its entry will do, or the last quick one that will.
template <class Entry, class Will>
std::optional<std::string> stand_in(const std::string& id, Sensitivities whose,
                                    std::span<const Entry> entries, const Will& will) {
  std::optional<std::string> last;
  for (const Entry& entry : entries) {
    const bool is_itself = entry.id == id;
    if (!will(entry) || !(entry.is_quick() || (is_itself && whose == Sensitivities::own))) continue;
    last = entry.id;
    if (is_itself) return id;
  }
  return last;
}

/// The values of a shifted case, of each stand with these mechanics.
std::map<Stand, Row> values_of(const input::Case& problem, const input::Case& shifted_case,
                               const MechanicsEntry& mechanics, const std::set<Stand>& stands,
                               std::span<const FieldEntry> fields) {
  const auto& measured = problem.measured.measurements;
  const models::MechanicsRun run = models::run_mechanics(mechanics, shifted_case, fields);
  std::map<Stand, Row> result;
  for (const Stand& stand : stands) {
    if (stand.mechanics != mechanics.id) continue;
    Row& row = result[stand];
    row.resize(measured.size());
    std::optional<models::FieldRun> field;
    if (!stand.field.empty())
      field = models::run_field(stand.field,
                                *models::entry_of(fields, stand.field).make(problem.options), run,
                                shifted_case);
    for (std::size_t m = 0; m < measured.size(); ++m) {
      if (measured[m].measurand.is_field() != field.has_value()) continue;
      const std::size_t step = measured[m].step;
      // Along the stated load's direction, however the shift has turned the load.
      row[m] =
          (field ? computed(measured[m].measurand, *field, run, step)
                 : computed(measured[m].measurand, run, step, direction(problem.load_path[step])))
              .value;
    }
  }
  return result;
}

}  // namespace

std::optional<Stand> stand_in(const std::string& mechanics, const std::string& field,
                              Sensitivities whose, const input::Case& problem,
                              std::span<const MechanicsEntry> mechanics_entries,
                              std::span<const FieldEntry> field_entries) {
  const auto shape = stand_in(
      mechanics, whose, mechanics_entries,
      [&](const MechanicsEntry& entry) { return models::fault_of(entry, problem).empty(); });
  if (!shape) return std::nullopt;
  if (field.empty()) return Stand{*shape, {}};
  const auto magnet = stand_in(field, whose, field_entries, [](const FieldEntry&) { return true; });
  if (!magnet) return std::nullopt;
  return Stand{*shape, *magnet};
}

std::map<Stand, Contributions> contributions(const input::Case& problem,
                                             const std::vector<Input>& inputs,
                                             const std::vector<Stand>& stands,
                                             std::span<const MechanicsEntry> mechanics_entries,
                                             std::span<const FieldEntry> field_entries,
                                             const Progress& progress) {
  const std::set<Stand> all(stands.begin(), stands.end());
  std::set<std::string> shapes;
  for (const Stand& stand : all) shapes.insert(stand.mechanics);
  std::map<Stand, Contributions> result;
  std::size_t done = 0;
  for (const Input& input : inputs) {
    const std::array<input::Case, 2> sides{shifted(problem, input, -input.step),
                                           shifted(problem, input, input.step)};
    for (const std::string& id : shapes) {
      if (progress)
        progress({fmt::format("sensitivities of {} to {}", id, input.number.path), done++,
                  inputs.size() * shapes.size()});
      const MechanicsEntry& entry = models::entry_of(mechanics_entries, id);
      std::map<Stand, Row> lower = values_of(problem, sides[0], entry, all, field_entries);
      for (auto& [stand, upper] : values_of(problem, sides[1], entry, all, field_entries)) {
        Row& row = lower[stand];
        for (std::size_t m = 0; m < row.size(); ++m)
          row[m] = row[m] && upper[m] ? std::optional((*upper[m] - *row[m]) / (2 * input.step))
                                      : std::nullopt;
        result[stand].push_back(std::move(row));
      }
    }
  }
  for (const Stand& stand : all) result[stand];  // without inputs there are none
  return result;
}

}  // namespace ciliaval::compare::validation

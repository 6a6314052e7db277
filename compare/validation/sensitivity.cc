// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/validation/sensitivity.h"

#include <fmt/format.h>

#include "compare/validation/computed.h"

namespace ciliaval::compare::validation {
namespace {

using models::FieldEntry;
using models::MechanicsEntry;

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

void for_each_input(const input::Case& problem, const std::vector<Input>& inputs,
                    const std::set<Stand>& stands,
                    std::span<const MechanicsEntry> mechanics_entries,
                    std::span<const FieldEntry> field_entries, const Progress& progress,
                    const std::function<void(const Shifted&)>& use) {
  std::set<std::string> shapes;
  for (const Stand& stand : stands) shapes.insert(stand.mechanics);
  std::size_t done = 0;
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    const Input& input = inputs[k];
    const std::array<input::Case, 2> sides{shifted(problem, input, -input.step),
                                           shifted(problem, input, input.step)};
    Shifted runs{k, 2 * input.step, {}, {}};
    for (const std::string& id : shapes) {
      if (progress)
        progress({fmt::format("sensitivities of {} to {}", id, input.number.path), done++,
                  inputs.size() * shapes.size()});
      const MechanicsEntry& entry = models::entry_of(mechanics_entries, id);
      for (const std::size_t i : {0, 1})
        runs.shapes[id].at(i) = models::run_mechanics(entry, sides.at(i), field_entries);
    }
    for (const Stand& stand : stands) {
      if (stand.field.empty()) continue;
      const auto field = models::entry_of(field_entries, stand.field).make(problem.options);
      for (const std::size_t i : {0, 1})
        runs.fields[stand].at(i) = models::run_field(
            stand.field, *field, runs.shapes.at(stand.mechanics).at(i), sides.at(i));
    }
    use(runs);
  }
}

std::map<Stand, Contributions> contributions(const input::Case& problem,
                                             const std::vector<Input>& inputs,
                                             const std::set<Stand>& stands,
                                             std::span<const MechanicsEntry> mechanics_entries,
                                             std::span<const FieldEntry> field_entries,
                                             const Progress& progress) {
  std::map<Stand, Contributions> result;
  for (const Stand& stand : stands) result[stand];  // without inputs there are none
  const auto add = [&](const Shifted& runs) {
    for (auto& [stand, rows] : result) {
      auto& row = rows.emplace_back();
      for (const auto& measured : problem.measured.measurements) {
        const auto value = [&, &by = stand](std::size_t side) -> std::optional<double> {
          if (measured.measurand.is_field() == by.field.empty()) return std::nullopt;
          const models::MechanicsRun& shape = runs.shapes.at(by.mechanics).at(side);
          if (!by.field.empty())
            return computed(measured.measurand, runs.fields.at(by).at(side), shape, measured.step)
                .value;
          // Along the stated load's direction, however the shift has turned the load.
          return computed(measured.measurand, shape, measured.step,
                          direction(problem.load_path[measured.step]))
              .value;
        };
        const std::optional<double> lower = value(0);
        const std::optional<double> upper = value(1);
        row.push_back(lower && upper ? std::optional((*upper - *lower) / runs.width)
                                     : std::nullopt);
      }
    }
  };
  for_each_input(problem, inputs, stands, mechanics_entries, field_entries, progress, add);
  return result;
}

}  // namespace ciliaval::compare::validation

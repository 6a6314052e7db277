// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/environment/environment.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "compare/input/case_sections.h"
#include "compare/input/environment/magnet.h"

namespace ciliaval::compare::input::environment {
namespace {

using surroundings::Environment;

constexpr std::size_t most_fields = 1000;

/// The field, or the fields of a list.
std::vector<Vector3> read_fields(const toml::node& node, Faults& faults) {
  const toml::array* list = node.as_array();
  if (list != nullptr && (list->empty() || list->size() > most_fields)) {
    faults.add(place(node), fmt::format("'{}' lists {} fields: a path has 1 to {} of [x, y, z]",
                                        uniform_field.name, list->size(), most_fields));
    return {};
  }
  if (list == nullptr || !list->front().is_array()) {
    const auto field = read_point(node, uniform_field, faults);
    return field ? std::vector{*field} : std::vector<Vector3>{};
  }
  std::vector<Vector3> fields;
  for (const toml::node& element : *list)
    if (const auto field = read_point(element, uniform_field, faults)) fields.push_back(*field);
  return fields;
}

/// What is there without what it goes with.
void check_companions(Section& table, const toml::node* pull, const toml::node* field,
                      const toml::node* magnets) {
  const auto needs = [&](std::string_view key, const toml::node* companion,
                         std::string_view companion_key) {
    const toml::node* node = table.find(key);
    if (node != nullptr && companion == nullptr)
      table.faults().add(place(*node),
                         fmt::format("'{}' goes with '{}', which is missing", key, companion_key));
  };
  needs(fluid_density.name, pull, gravity.name);
  needs(magnetic_energy, field != nullptr ? field : magnets, uniform_field.name);
  if (pull == nullptr && field == nullptr && magnets == nullptr)
    table.faults().add(table.where(), fmt::format("[{}] needs '{}', '{}' or [[{}]]", table_name,
                                                  gravity.name, uniform_field.name, magnet_table));
}

}  // namespace

std::vector<Environment> read_environment(Section& root) {
  Section table = root.section(table_name);
  if (!table.exists()) return {};
  Faults& faults = table.faults();
  const toml::node* pull = table.find(gravity.name);
  const toml::node* field = table.find(uniform_field.name);
  check_companions(table, pull, field, table.find("magnet"));
  Environment all;
  if (pull != nullptr) all.gravity = read_point(*pull, gravity, faults).value_or(Vector3::Zero());
  all.fluid_density = table.value(fluid_density).value_or(0);
  if (const toml::node* node = table.find(magnetic_energy))
    if (const auto name = read_choice(*node, magnetic_energy, energy_names, faults))
      all.magnetic_energy = *name == energy_names[0] ? surroundings::MagneticEnergy::F
                                                     : surroundings::MagneticEnergy::R;
  const auto magnets = read_magnets(table);
  table.finish();
  std::vector<Vector3> fields(1, Vector3::Zero());
  if (field != nullptr) fields = read_fields(*field, faults);
  if (fields.size() > 1 && magnets.size() > 1 && fields.size() != magnets.size())
    faults.add(place(*field), fmt::format("'{}' lists {} fields, but a magnet's position {} points",
                                          uniform_field.name, fields.size(), magnets.size()));
  std::vector<Environment> result(std::max(fields.size(), magnets.size()), all);
  for (std::size_t i = 0; i < result.size() && !fields.empty(); ++i) {
    result[i].uniform_field = fields[std::min(i, fields.size() - 1)];
    if (!magnets.empty()) result[i].magnets = magnets[std::min(i, magnets.size() - 1)];
  }
  return result;
}

bool put_into(const std::vector<Environment>& environments, LoadPath& path) {
  if (environments.empty()) return true;
  if (path.size() == 1) path.resize(environments.size(), path.front());
  if (environments.size() != 1 && environments.size() != path.size()) return false;
  for (std::size_t i = 0; i < path.size(); ++i)
    path[i].set_environment(environments[environments.size() == 1 ? 0 : i]);
  return true;
}

LoadPath path_of(const std::vector<Environment>& environments) {
  const auto horizontal = [](const Vector3& v) { return v.head<2>().norm(); };
  const auto& strongest = *std::ranges::max_element(
      environments, {}, [&](const Environment& e) { return horizontal(e.uniform_field); });
  std::vector<Vector3> candidates{strongest.uniform_field, strongest.gravity};
  for (const surroundings::magnets::Magnet& magnet : strongest.magnets) {
    candidates.push_back(magnet.position);
    candidates.push_back(surroundings::magnets::moment(magnet));
  }
  const auto first =
      std::ranges::find_if(candidates, [&](const Vector3& v) { return horizontal(v) > 0; });
  const Vector3 across = first == candidates.end() ? Vector3(Vector3::Zero()) : *first;
  const double azimuth = horizontal(across) > 0 ? std::atan2(across.y(), across.x()) : 0;
  LoadPath path{EnvironmentLoad{1, azimuth}};
  put_into(environments, path);
  return path;
}

std::string to_toml(const LoadPath& path) {
  const auto& first = path.front().environment();
  const bool is_left_out = std::ranges::all_of(path, [](const Load& load) {
    return !load.is<EnvironmentLoad>() && load.environment() == Environment{};
  });
  if (is_left_out) return {};
  std::string text = fmt::format("\n[{}]\n", table_name);
  const bool has_gravity = !first.gravity.isZero(0) || first.fluid_density != 0;
  if (has_gravity)
    text += fmt::format("{} = {}\n{} = \"{}\"\n", gravity.name,
                        format_vector(first.gravity, gravity.quantity), fluid_density.name,
                        format_quantity(first.fluid_density, fluid_density.quantity));
  const bool varies = std::ranges::any_of(path, [&](const Load& load) {
    return load.environment().uniform_field != first.uniform_field;
  });
  const std::string magnets = magnets_to_toml(path);
  const bool has_field = varies || !first.uniform_field.isZero(0) ||
                         first.magnetic_energy != surroundings::MagneticEnergy::F;
  if ((has_gravity || !magnets.empty()) && !has_field) return text + magnets;
  std::vector<std::string> fields;
  for (const Load& load : path)
    fields.push_back(format_vector(load.environment().uniform_field, uniform_field.quantity));
  text += varies ? fmt::format("{} = [{}]\n", uniform_field.name, fmt::join(fields, ", "))
                 : fmt::format("{} = {}\n", uniform_field.name, fields.front());
  return text + fmt::format("{} = \"{}\"\n", magnetic_energy, name(first.magnetic_energy)) +
         magnets;
}

}  // namespace ciliaval::compare::input::environment

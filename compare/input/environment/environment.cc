// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/environment/environment.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "compare/input/case_sections.h"

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
void check_companions(Section& table, const toml::node* pull, const toml::node* field) {
  const auto needs = [&](std::string_view key, const toml::node* companion,
                         std::string_view companion_key) {
    const toml::node* node = table.find(key);
    if (node != nullptr && companion == nullptr)
      table.faults().add(place(*node),
                         fmt::format("'{}' goes with '{}', which is missing", key, companion_key));
  };
  needs(fluid_density.name, pull, gravity.name);
  needs(magnetic_energy, field, uniform_field.name);
  if (pull == nullptr && field == nullptr)
    table.faults().add(table.where(), fmt::format("[{}] needs '{}' or '{}'", table_name,
                                                  gravity.name, uniform_field.name));
}

std::string vector_text(const Vector3& v, const Quantity& quantity) {
  return fmt::format("[\"{}\", \"{}\", \"{}\"]", format_quantity(v.x(), quantity),
                     format_quantity(v.y(), quantity), format_quantity(v.z(), quantity));
}

}  // namespace

std::vector<Environment> read_environment(Section& root) {
  Section table = root.section(table_name);
  if (!table.exists()) return {};
  Faults& faults = table.faults();
  const toml::node* pull = table.find(gravity.name);
  const toml::node* field = table.find(uniform_field.name);
  check_companions(table, pull, field);
  Environment all;
  if (pull != nullptr) all.gravity = read_point(*pull, gravity, faults).value_or(Vector3::Zero());
  all.fluid_density = table.value(fluid_density).value_or(0);
  if (const toml::node* node = table.find(magnetic_energy))
    if (const auto name = read_choice(*node, magnetic_energy, energy_names, faults))
      all.magnetic_energy = *name == energy_names[0] ? surroundings::MagneticEnergy::F
                                                     : surroundings::MagneticEnergy::R;
  table.finish();
  if (field == nullptr) return {all};
  std::vector<Environment> result;
  for (const Vector3& one : read_fields(*field, faults)) {
    result.push_back(all);
    result.back().uniform_field = one;
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
  const Vector3& across =
      horizontal(strongest.uniform_field) > 0 ? strongest.uniform_field : strongest.gravity;
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
                        vector_text(first.gravity, gravity.quantity), fluid_density.name,
                        format_quantity(first.fluid_density, fluid_density.quantity));
  const bool varies = std::ranges::any_of(path, [&](const Load& load) {
    return load.environment().uniform_field != first.uniform_field;
  });
  const bool has_field = varies || !first.uniform_field.isZero(0) ||
                         first.magnetic_energy != surroundings::MagneticEnergy::F;
  if (has_gravity && !has_field) return text;
  std::vector<std::string> fields;
  for (const Load& load : path)
    fields.push_back(vector_text(load.environment().uniform_field, uniform_field.quantity));
  text += varies ? fmt::format("{} = [{}]\n", uniform_field.name, fmt::join(fields, ", "))
                 : fmt::format("{} = {}\n", uniform_field.name, fields.front());
  return text + fmt::format("{} = \"{}\"\n", magnetic_energy, name(first.magnetic_energy));
}

}  // namespace ciliaval::compare::input::environment

// SPDX-License-Identifier: LGPL-2.1-or-later
// The table [load] of a case file.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compare/input/case_sections.h"
#include "compare/input/described.h"
#include "compare/input/environment/environment.h"
#include "problem/description/surface.h"
#include "problem/error.h"

namespace ciliaval::compare::input {
namespace {

/// Content of a table [load].
struct StatedLoad {
  std::vector<Load> path;
  std::vector<LoadStatement::Values> stated_by;  ///< of each step, if the magnitude is stated so
  std::optional<SweepWay> way;                   ///< of a sweep whose places no list tells
};

/// Reads how a sweep goes its way; none if lists say it.
std::optional<SweepWay> read_way(Section& table, const PathLength& length) {
  SweepWay way;
  const auto& fields = description::fields<SweepWay>();
  read(table, fields, way);
  if (length.listed.empty()) return way;
  for (const auto& field : fields)
    if (const toml::node* node = table.find(field.name))
      table.faults().add(place(*node), fmt::format("'{}' contradicts the list '{}', which tells "
                                                   "each place of the sweep: leave it out",
                                                   field.name, length.listed));
  return std::nullopt;
}

/// Reads the table of a load whose type is missing or unknown: which keys it should have cannot be
/// told, but those that some type has must be right by themselves.
void read_any_type(Section& table, PathLength& length) {
  std::set<std::string_view> names;  // types share keys
  const auto read_one = [&](const description::Key& key) {
    const toml::node* node = names.insert(key.name).second ? table.find(key.name) : nullptr;
    if (node != nullptr) read_values(*node, key, length, table.faults());
  };
  for (const LoadType* type : load_types()) {
    for (const description::Key& key : type->keys()) read_one(key);
    if (type->statement)
      for (const auto& parameter : type->statement->parameters) read_one(parameter);
  }
  read_way(table, length);
  table.finish();
}

/// True if the file states the magnitude by other parameters. Adds the contradictions among them.
bool is_stated_by_others(Section& table, const LoadType& type) {
  if (!type.statement) return false;
  Faults& faults = table.faults();
  const std::string_view direct_key = type.parameters.front().name;
  const std::string_view other_key = type.statement->parameters.front().name;
  const toml::node* direct = table.find(direct_key);
  const toml::node* other = table.find(other_key);
  if (direct == nullptr && other == nullptr)
    faults.add(table.where(), fmt::format("[load] of type '{}' needs '{}' or '{}'", type.name,
                                          direct_key, other_key));
  if (direct == nullptr) return other != nullptr;
  if (other != nullptr)
    faults.add(place(*other),
               fmt::format("'{}' contradicts '{}': give one of them", other_key, direct_key));
  for (const auto& parameter : type.statement->parameters)
    if (const toml::node* node = table.find(parameter.name); node != nullptr && other == nullptr)
      faults.add(place(*node), fmt::format("'{}' goes with '{}'; '{}' says the force already",
                                           parameter.name, other_key, direct_key));
  return other != nullptr;
}

/// Reads [surface], which a sweep needs and no other load has.
std::shared_ptr<const surroundings::Surface> read_surface(Section& root,
                                                          const std::filesystem::path& folder,
                                                          const std::optional<std::string>& type,
                                                          Case& c) {
  constexpr std::string_view name = "surface";
  if (type == SweepLoad::type().name) {
    Section table = require_section(root, name);
    if (!table.exists()) return nullptr;
    auto [stated, made] = sweep::read_surface(table, folder);
    if (made) c.surface = std::move(stated);
    return made;
  }
  if (root.table()->contains(name) && type)
    root.faults().add(place(*root.find(name)),
                      fmt::format("[surface] goes with the load type '{}', not '{}'",
                                  SweepLoad::type().name, *type));
  return nullptr;
}

/// Reads the keys of a type.
StatedLoad read_type(Section& table, const LoadType& type, PathLength& length) {
  // Only if it is there: find() would make it a valid key in the messages about others.
  if (type.result && table.table()->contains(type.result->first))
    table.faults().add(place(*table.find(type.result->first)), std::string(type.result->second));
  const bool by_others = is_stated_by_others(table, type);
  StatedLoad load{{Load(type)}, {}, {}};
  read(table, type.keys(!by_others), load.path, length);
  for (const LoadTable& settings : type.tables) {
    Section sub = table.section(settings.name);
    if (!sub.exists()) continue;
    read(sub, settings.keys, load.path, length);
    sub.finish();
  }
  if (by_others) {
    load.stated_by.emplace_back();
    for (const auto& parameter : type.statement->parameters)
      load.stated_by.front().push_back(std::get<double>(parameter.initial));
    read(table, type.statement->parameters, load.stated_by, length);
  } else if (type.statement) {
    for (const auto& parameter : type.statement->parameters)
      if (const toml::node* node = table.find(parameter.name))
        read_values(*node, parameter, length, table.faults());
  }
  if (&type == &SweepLoad::type()) load.way = read_way(table, length);
  return load;
}

/// The path of the case, from right keys.
void set_path(StatedLoad load, const std::shared_ptr<const surroundings::Surface>& surface,
              Case& c) {
  c.load_path = std::move(load.path);
  c.stated_by = std::move(load.stated_by);
  const auto all_steps = [&c](std::size_t count) {
    c.load_path.resize(count, c.load_path.front());
    if (!c.stated_by.empty()) c.stated_by.resize(count, c.stated_by.front());
  };
  all_steps(std::max(c.load_path.size(), c.stated_by.size()));
  for (Load& step : c.load_path) step.set_surface(surface);
  if (load.way) {
    load.way->travel = c.load_path.front().as<SweepLoad>().value().travel;
    c.load_path = sweep_path(with_travel(c.load_path.front(), 0), *load.way);
    all_steps(c.load_path.size());
  }
  set_stated_magnitudes(c);
}

}  // namespace

std::vector<double> stated_values(const Case& c, std::string_view parameter) {
  std::vector<double> values;
  if (c.stated_by.empty()) return values;
  const auto& parameters = c.load_path.front().type().statement->parameters;
  const auto found =
      std::ranges::find(parameters, parameter, &description::Field<LoadStatement::Values>::name);
  for (const LoadStatement::Values& step : c.stated_by)
    if (found != parameters.end()) values.push_back(found->number(step));
  return values;
}

void set_stated_magnitudes(Case& c) {
  for (std::size_t i = 0; i < std::min(c.stated_by.size(), c.load_path.size()); ++i) {
    Load& load = c.load_path[i];
    load = with_magnitude(load, load.type().statement->magnitude(c.stated_by[i], c.cilium));
  }
}

void set_surface(Case& c, const surroundings::StatedSurface& stated) {
  const auto made = surface_of(stated);
  c.surface = stated;
  for (Load& load : c.load_path) load.set_surface(made);
}

void read_load(Section& root, const std::filesystem::path& folder, Case& c) {
  Faults& faults = root.faults();
  const std::size_t before = faults.size();
  const bool is_alone = root.find("load") == nullptr;
  PathLength length;
  PathLength length_around{.takes_one_for_all = true};
  const std::vector<surroundings::Environment> around =
      environment::read_environment(root, length_around);
  const bool has_environment = root.table()->contains(environment::table_name);
  root.find("surface");
  if (is_alone && has_environment) {
    if (faults.size() == before) c.load_path = environment::path_of(around);
    return;
  }
  Section table = require_section(root, "load");
  if (!table.exists()) return;
  const toml::node* node = table.require(keys().load_type.name);
  std::optional<std::string> type;
  std::vector<std::string_view> names;
  for (const LoadType* known : load_types()) names.push_back(known->name);
  if (node != nullptr) type = read_choice(*node, keys().load_type.name, names, faults);
  const auto surface = read_surface(root, folder, type, c);
  if (!type) return read_any_type(table, length);
  Section typed(table.table(), fmt::format("[load] of type '{}'", *type), "load", table.where(),
                faults);
  typed.find(keys().load_type.name);
  StatedLoad load = read_type(typed, *find_load_type(*type), length);
  typed.finish();
  if (*type == EnvironmentLoad::type().name && !has_environment)
    faults.add(place(*node), fmt::format("the load type '{}' needs the table [{}]", *type,
                                         environment::table_name));
  if (faults.size() != before) return;
  try {
    set_path(std::move(load), surface, c);
  } catch (const InputError& fault) {  // what such a cilium does not take
    const auto& first = find_load_type(*type)->statement.value().parameters.front();
    faults.add(place(*typed.find(first.name)), fault.what());
    return;
  }
  if (!environment::put_into(around, c.load_path))
    faults.add(length_around.where,
               fmt::format("'{}' lists {} values, but the load has {} steps: list one, or one for "
                           "each step",
                           length_around.listed, around.size(), c.load_path.size()));
  if (!c.stated_by.empty()) c.stated_by.resize(c.load_path.size(), c.stated_by.front());
}

void snap_to_interfaces(const Cilium& cilium, LoadPath& path) {
  constexpr double rounding = 1e-12;  // of the length; sums of a thousand lengths stay below it
  for (Load& load : path)
    for (std::size_t i = 0; i < load.values().size(); ++i) {
      if (load.type().parameters[i].site != LoadParameter::Site::arclength) continue;
      for (const double end : cilium.interfaces())
        if (end > 0 && std::abs(load.values()[i] - end) <= rounding * cilium.length())
          load.set_value(i, end);
    }
}

}  // namespace ciliaval::compare::input

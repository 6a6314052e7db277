// SPDX-License-Identifier: LGPL-2.1-or-later
// The table [load] of a case file.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compare/input/case_sections.h"
#include "compare/input/environment/environment.h"
#include "problem/error.h"

namespace ciliaval::compare::input {
namespace {

constexpr std::size_t most_steps = 1000;  ///< each one writes files of every model, 1 MB and more

/// One key's values along the load path: one value stands for every step.
struct Values {
  std::vector<double> value;
  bool is_list = false;

  double at(std::size_t step) const { return value[is_list ? step : 0]; }
};

/// Reads the keys of a load and watches that their lists have the same length.
class PathReader {
 public:
  explicit PathReader(Section& table) : table_(&table) {}

  /// The values of a parameter; its fallback, if it has one, stands for a missing key.
  Values read(const LoadParameter& parameter) {
    const QuantityKey& k = parameter.key;
    const toml::node* node = k.fallback.empty() ? table_->require(k.name) : table_->find(k.name);
    if (node == nullptr) return k.fallback.empty() ? Values{} : Values{{parameter.fallback}};
    Faults& faults = table_->faults();
    Values values;
    const auto read_one = [&](const toml::node& element) {
      if (const auto value = read_value(element, k.name, k.quantity, k.range, faults))
        values.value.push_back(*value);
    };
    const toml::array* list = node->as_array();
    if (list == nullptr) {
      read_one(*node);
      return values;
    }
    values.is_list = true;
    if (list->empty() || list->size() > most_steps) {
      faults.add(place(*node), fmt::format("'{}' lists {} values: a load path has 1 to {} steps",
                                           k.name, list->size(), most_steps));
      return values;
    }
    if (!listed_.empty() && list->size() != steps_)
      faults.add(place(*node),
                 fmt::format("'{}' lists {} values, but '{}' lists {}: all lists of a "
                             "load path have the same length",
                             k.name, list->size(), listed_, steps_));
    listed_ = k.name;
    steps_ = list->size();
    for (const toml::node& element : *list) read_one(element);
    return values;
  }
  std::size_t steps() const { return steps_; }
  std::string_view listed() const { return listed_; }

 private:
  Section* table_;
  std::size_t steps_ = 1;
  std::string_view listed_;  ///< the key whose list set steps_
};

/// Reads how a sweep goes its way; none if lists say it.
std::optional<SweepWay> read_way(Section& table, const PathReader& reader) {
  SweepWay way;
  unsigned int samples = 101;
  table.read(key::samples.name, key::samples.range, samples);
  way.samples = samples;
  if (const toml::node* node = table.find(key::sweep_return)) {
    if (const auto* flag = node->as_boolean())
      way.there_and_back = flag->get();
    else
      table.faults().add(place(*node), fmt::format("'{}' must be true or false, found {}",
                                                   key::sweep_return, describe(*node)));
  }
  if (reader.listed().empty()) return way;
  for (const std::string_view name : {key::samples.name, key::sweep_return})
    if (const toml::node* node = table.find(name))
      table.faults().add(place(*node), fmt::format("'{}' contradicts the list '{}', which tells "
                                                   "each place of the sweep: leave it out",
                                                   name, reader.listed()));
  return std::nullopt;
}

/// Reads the table of a load whose type is missing or unknown: which keys it should have cannot be
/// told, but those that some type has must be right by themselves.
void read_any_type(Section& table) {
  PathReader reader(table);
  std::set<std::string_view> names;  // types share keys
  const auto read = [&](LoadParameter parameter) {
    if (!names.insert(parameter.key.name).second) return;
    parameter.key.fallback = "none";  // no key is missing from a type that is not known
    reader.read(parameter);
  };
  for (const LoadType* type : load_types()) {
    std::for_each(type->parameters.begin(), type->parameters.end(), read);
    if (type->statement)
      std::for_each(type->statement->parameters.begin(), type->statement->parameters.end(), read);
  }
  read_way(table, reader);
  table.finish();
}

/// Whether the file states the magnitude by other parameters; adds the contradictions among them.
bool is_stated_by_others(Section& table, const LoadType& type) {
  if (!type.statement) return false;
  Faults& faults = table.faults();
  const std::string_view direct_key = type.parameters.front().key.name;
  const std::string_view other_key = type.statement->parameters.front().key.name;
  const toml::node* direct = table.find(direct_key);
  const toml::node* other = table.find(other_key);
  if (direct == nullptr && other == nullptr)
    faults.add(table.where(), fmt::format("[load] of type '{}' needs '{}' or '{}'", type.name,
                                          direct_key, other_key));
  if (direct == nullptr) return other != nullptr;
  if (other != nullptr)
    faults.add(place(*other),
               fmt::format("'{}' contradicts '{}': give one of them", other_key, direct_key));
  for (const LoadParameter& parameter : type.statement->parameters)
    if (const toml::node* node = table.find(parameter.key.name);
        node != nullptr && other == nullptr)
      faults.add(place(*node), fmt::format("'{}' goes with '{}'; '{}' says the force already",
                                           parameter.key.name, other_key, direct_key));
  return other != nullptr;
}

/// From travel 0 to that of the load.
LoadPath along(SweepWay way, Load load) {
  way.travel = load.as<SweepLoad>().value().travel;
  load.set_value(1, 0);
  return sweep_path(load, way);
}

/// Reads [surface], which a sweep needs and no other load has.
void read_surface(Section& root, const std::filesystem::path& folder,
                  const std::optional<std::string>& type, Case& c) {
  constexpr std::string_view name = "surface";
  if (type == SweepLoad::type().name) {
    Section table = require_section(root, name);
    if (table.exists()) c.surface = sweep::read_surface(table, folder);
  } else if (root.table()->contains(name)) {
    const toml::node* node = root.find(name);
    if (type)
      root.faults().add(place(*node), fmt::format("[surface] goes with the load type '{}', not "
                                                  "'{}'",
                                                  SweepLoad::type().name, *type));
  }
}

/// Reads the keys of a type; the steps are made once all keys are right.
std::function<void(Case&)> read_steps(Section& table, const LoadType& type, PathReader& reader) {
  // Only if it is there: find() would make it a valid key in the messages about others.
  if (type.result && table.table()->contains(type.result->first))
    table.faults().add(place(*table.find(type.result->first)), std::string(type.result->second));
  const bool stated = is_stated_by_others(table, type);
  std::vector<Values> values;
  std::vector<Values> statement;
  for (const LoadParameter& parameter : type.parameters)
    values.push_back(stated && values.empty() ? Values{{0.0}} : reader.read(parameter));
  if (type.statement)
    for (const LoadParameter& parameter : type.statement->parameters)
      statement.push_back(reader.read(parameter));
  const std::optional<SweepWay> way =
      &type == &SweepLoad::type() ? read_way(table, reader) : std::nullopt;
  Faults& faults = table.faults();
  const toml::node* first =
      stated ? table.find(type.statement->parameters.front().key.name) : nullptr;
  return [=, &type, &reader, &faults](Case& c) {
    for (std::size_t i = 0; i < reader.steps(); ++i) {
      std::vector<double> of_step;
      of_step.reserve(values.size());
      for (const Values& v : values) of_step.push_back(v.at(i));
      c.load_path.emplace_back(type, of_step, c.surface.surface);
    }
    if (way) c.load_path = along(*way, c.load_path.front());
    if (!stated) return;
    for (const Values& v : statement) {
      c.stated_by.emplace_back();
      for (std::size_t i = 0; i < c.load_path.size(); ++i) c.stated_by.back().push_back(v.at(i));
    }
    try {
      set_stated_magnitudes(c);
    } catch (const InputError& fault) {  // what such a cilium does not take
      faults.add(place(*first), fault.what());
    }
  };
}

}  // namespace

std::span<const double> stated_values(const Case& c, std::string_view parameter) {
  if (c.stated_by.empty()) return {};
  const std::vector<LoadParameter>& parameters = c.load_path.front().type().statement->parameters;
  for (std::size_t p = 0; p < parameters.size(); ++p)
    if (parameters[p].key.name == parameter) return c.stated_by[p];
  return {};
}

void set_stated_magnitudes(Case& c) {
  if (c.stated_by.empty()) return;
  for (std::size_t i = 0; i < c.load_path.size(); ++i) {
    std::vector<double> values;
    for (const std::vector<double>& along_path : c.stated_by) values.push_back(along_path[i]);
    Load& load = c.load_path[i];
    load = with_magnitude(load, load.type().statement->magnitude(values, c.cilium));
  }
}

void read_load(Section& root, const std::filesystem::path& folder, Case& c) {
  Faults& faults = root.faults();
  const std::size_t before = faults.size();
  const bool is_alone = root.find("load") == nullptr;
  const std::vector<surroundings::Environment> around = environment::read_environment(root);
  const bool has_environment = root.table()->contains(environment::table_name);
  root.find("surface");
  if (is_alone && has_environment) {
    if (faults.size() == before) c.load_path = environment::path_of(around);
    return;
  }
  Section table = require_section(root, "load");
  if (!table.exists()) return;
  const toml::node* node = table.require("type");
  std::optional<std::string> type;
  std::vector<std::string_view> names;
  for (const LoadType* known : load_types()) names.push_back(known->name);
  if (node != nullptr) type = read_choice(*node, "type", names, faults);
  read_surface(root, folder, type, c);
  if (!type) return read_any_type(table);
  Section typed(table.table(), fmt::format("[load] of type '{}'", *type), "load", table.where(),
                faults);
  typed.find("type");
  PathReader reader(typed);
  const std::function<void(Case&)> make_steps = read_steps(typed, *find_load_type(*type), reader);
  typed.finish();
  if (*type == EnvironmentLoad::type().name && !has_environment)
    faults.add(place(*node), fmt::format("the load type '{}' needs the table [{}]", *type,
                                         environment::table_name));
  if (faults.size() != before) return;
  make_steps(c);
  if (environment::put_into(around, c.load_path)) {
    for (std::vector<double>& stated : c.stated_by)
      stated.resize(c.load_path.size(), stated.front());
  } else {
    const toml::node* field = root.table()->at_path("environment.uniform_field").node();
    const auto list = field == nullptr ? nullptr : field->as_array();
    if (list != nullptr && list->size() == around.size() && list->front().is_array())
      faults.add(place(*field),
                 fmt::format("'uniform_field' lists {} fields, but the load has {} steps: list one "
                             "field, or one for each step",
                             around.size(), c.load_path.size()));
    else
      faults.add(place(*root.table()->at_path("environment.magnet").node()),
                 fmt::format("a magnet's 'position' lists {} points, but the load has {} steps: "
                             "list one point, or one for each step",
                             around.size(), c.load_path.size()));
  }
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

// SPDX-License-Identifier: LGPL-2.1-or-later
// The table [load] of a case file.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>

#include "compare/input/case_sections.h"

namespace ciliaval::compare {
namespace {

constexpr std::size_t most_steps = 1000;  ///< each one writes files of every model, 1 MB and more

constexpr std::array<std::string_view, 5> load_types{
    ContactLoad::type, FlowLoad::type, SectionLoad::type, DeadLoad::type, ProbeLoad::type};

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

  /// The values under the key; its fallback, if it has one, stands for a missing key.
  Values read(const QuantityKey& k, double fallback);
  Values require(const QuantityKey& k);
  std::size_t steps() const { return steps_; }

 private:
  Values read(const QuantityKey& k, const toml::node& node);

  Section* table_;
  std::size_t steps_ = 1;
  std::string_view listed_;  ///< the key whose list set steps_
};

Values PathReader::read(const QuantityKey& k, double fallback) {
  const toml::node* node = table_->find(k.name);
  return node == nullptr ? Values{{fallback}} : read(k, *node);
}

Values PathReader::require(const QuantityKey& k) {
  const toml::node* node = table_->require(k.name);
  return node == nullptr ? Values{} : read(k, *node);
}

Values PathReader::read(const QuantityKey& k, const toml::node& node) {
  Faults& faults = table_->faults();
  Values values;
  const toml::array* list = node.as_array();
  if (list == nullptr) {
    if (const auto value = read_value(node, k.name, k.quantity, k.range, faults))
      values.value.push_back(*value);
    return values;
  }
  values.is_list = true;
  if (list->empty() || list->size() > most_steps) {
    faults.add(place(node), fmt::format("'{}' lists {} values: a load path has 1 to {} steps",
                                        k.name, list->size(), most_steps));
    return values;
  }
  if (!listed_.empty() && list->size() != steps_)
    faults.add(place(node), fmt::format("'{}' lists {} values, but '{}' lists {}: all lists of a "
                                        "load path have the same length",
                                        k.name, list->size(), listed_, steps_));
  listed_ = k.name;
  steps_ = list->size();
  for (const toml::node& element : *list)
    if (const auto value = read_value(element, k.name, k.quantity, k.range, faults))
      values.value.push_back(*value);
  return values;
}

/// Reads the table of a load whose type is missing or unknown: which keys it should have cannot be
/// told, but those that some type has must be right by themselves.
void read_any_type(Section& table) {
  PathReader reader(table);
  for (const QuantityKey* k :
       {&key::load_force, &key::height, &key::force_per_height, &key::velocity, &key::density,
        &key::drag_coefficient, &key::arclength, &key::force_per_length, &key::displacement,
        &key::azimuth})
    reader.read(*k, 0);
  table.finish();
}

/// The steps, each made by the function from its index.
LoadPath path(std::size_t steps, const std::function<Load(std::size_t)>& step) {
  LoadPath result;
  result.reserve(steps);
  for (std::size_t i = 0; i < steps; ++i) result.push_back(step(i));
  return result;
}

/// A reader of one load type reads its keys and returns what makes a step of them, to be called if
/// there was no fault.
using StepMaker = std::function<Load(std::size_t)>;

StepMaker read_contact(PathReader& reader) {
  const Values force = reader.require(key::load_force);
  const Values height = reader.require(key::height);
  const Values azimuth = reader.read(key::azimuth, 0);
  return [=](std::size_t i) { return ContactLoad{force.at(i), height.at(i), azimuth.at(i)}; };
}

StepMaker read_section(PathReader& reader) {
  const Values force = reader.require(key::load_force);
  const Values arclength = reader.require(key::arclength);
  const Values azimuth = reader.read(key::azimuth, 0);
  return [=](std::size_t i) { return SectionLoad{force.at(i), arclength.at(i), azimuth.at(i)}; };
}

StepMaker read_dead(PathReader& reader) {
  const Values force_per_length = reader.require(key::force_per_length);
  const Values azimuth = reader.read(key::azimuth, 0);
  return [=](std::size_t i) { return DeadLoad{force_per_length.at(i), azimuth.at(i)}; };
}

StepMaker read_probe(Section& table, PathReader& reader) {
  // Only if it is there: find() would make it a valid key in the messages about others.
  if (table.table()->contains(key::load_force.name))
    table.faults().add(place(*table.find(key::load_force.name)),
                       "'force' is a result of the load type 'probe', whose 'displacement' is "
                       "given: leave it out or use the type 'contact'");
  const Values displacement = reader.require(key::displacement);
  const Values height = reader.require(key::height);
  const Values azimuth = reader.read(key::azimuth, 0);
  return [=](std::size_t i) { return ProbeLoad{displacement.at(i), height.at(i), azimuth.at(i)}; };
}

/// The contradictions among the keys of a flow.
void check_flow_keys(Section& table) {
  Faults& faults = table.faults();
  const toml::node* q = table.find(key::force_per_height.name);
  const toml::node* v = table.find(key::velocity.name);
  if (q == nullptr && v == nullptr)
    faults.add(table.where(), "[load] of type 'flow' needs 'force_per_height' or 'velocity'");
  if (q == nullptr) return;
  if (v != nullptr)
    faults.add(place(*v), "'velocity' contradicts 'force_per_height': give one of them");
  for (const std::string_view name : {key::density.name, key::drag_coefficient.name})
    if (const toml::node* node = table.find(name); node != nullptr && v == nullptr)
      faults.add(place(*node), fmt::format("'{}' goes with 'velocity'; 'force_per_height' says "
                                           "the force already",
                                           name));
}

StepMaker read_flow(Section& table, PathReader& reader, Case& c) {
  check_flow_keys(table);
  const bool by_velocity = table.find(key::velocity.name) != nullptr;
  const bool by_force = table.find(key::force_per_height.name) != nullptr;
  const Values force = by_force ? reader.require(key::force_per_height) : Values{{0.0}};
  const Values velocity = reader.read(key::velocity, 0);
  const Values density = reader.read(key::density, default_fluid_density);
  const Values drag = reader.read(key::drag_coefficient, default_drag_coefficient);
  const Values azimuth = reader.read(key::azimuth, 0);
  const double d = c.cilium.diameter;
  return [=, &c](std::size_t i) {
    if (!by_velocity) return FlowLoad{force.at(i), azimuth.at(i)};
    c.flow_velocity.push_back(velocity.at(i));
    c.flow_density.push_back(density.at(i));
    c.flow_drag_coefficient.push_back(drag.at(i));
    return FlowLoad{drag_per_height(velocity.at(i), density.at(i), drag.at(i), d), azimuth.at(i)};
  };
}

}  // namespace

double drag_per_height(double velocity, double density, double drag_coefficient, double diameter) {
  return density * velocity * velocity * drag_coefficient * diameter / 2;
}

bool read_load(Section& root, Case& c) {
  Faults& faults = root.faults();
  const std::size_t before = faults.size();
  Section table = root.section("load");
  if (!table.exists()) {
    if (root.find("load") == nullptr) faults.add({}, "the table [load] is missing");
    return false;
  }
  const toml::node* node = table.require("type");
  std::optional<std::string> type;
  if (node != nullptr) type = read_choice(*node, "type", load_types, {}, faults);
  if (!type) {
    read_any_type(table);
    return false;
  }

  Section typed(table.table(), fmt::format("[load] of type '{}'", *type), "load", table.where(),
                faults);
  typed.find("type");
  PathReader reader(typed);
  StepMaker step;
  if (*type == ContactLoad::type) step = read_contact(reader);
  if (*type == SectionLoad::type) step = read_section(reader);
  if (*type == DeadLoad::type) step = read_dead(reader);
  if (*type == ProbeLoad::type) step = read_probe(typed, reader);
  if (*type == FlowLoad::type) step = read_flow(typed, reader, c);
  typed.finish();
  if (faults.size() != before) return false;
  c.load_path = path(reader.steps(), step);
  return true;
}

void snap_to_interfaces(const Cilium& cilium, LoadPath& path) {
  constexpr double rounding = 1e-12;  // of the length; sums of a thousand lengths stay below it
  for (Load& load : path) {
    auto* section = std::get_if<SectionLoad>(&load);
    if (section == nullptr) continue;
    for (const double end : cilium.interfaces())
      if (end > 0 && std::abs(section->arclength - end) <= rounding * cilium.length())
        section->arclength = end;
  }
}

}  // namespace ciliaval::compare

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/schema/keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <tuple>
#include <utility>

#include "compare/input/case_sections.h"
#include "compare/input/described.h"
#include "compare/input/environment/environment.h"
#include "compare/input/measurement/measurement.h"
#include "compare/input/sweep/signal.h"
#include "problem/description/cilium.h"
#include "problem/description/environment.h"
#include "problem/description/surface.h"
#include "problem/load.h"

namespace ciliaval::compare::input::schema {
namespace {

using Kind = Key::Kind;

Key choice(std::vector<std::string_view> choices, Key key, Kind kind = Kind::choice) {
  key.kind = kind;
  key.choices = std::move(choices);
  return key;
}

Key only_with(std::vector<std::string_view> values, Key key) {
  key.with = std::move(values);
  return key;
}

Key of_key(std::string_view table, const description::Key& k) {
  Key key;
  static_cast<description::Key&>(key) = k;
  key.table = table;
  key.text = k.doc;
  if (k.fallback.empty() && k.absence != description::Key::Absence::fault)
    key.fallback = fmt::format("`{}`", to_toml(k, k.initial));
  const std::array kinds{Kind::flag, Kind::whole_number, Kind::quantity,  Kind::text,
                         Kind::pair, Kind::point,        Kind::quantities};  // as Value has them
  key.kind = kinds.at(k.initial.index());
  if (key.kind == Kind::text && k.longest == 0) key.kind = Kind::file;
  if (!k.choices.empty()) key.kind = Kind::choice;
  if (k.is_of_any_kind) key.kind = key.kind == Kind::pair ? Kind::any_pair : Kind::any;
  if (k.may_be_axial) key.kind = Kind::quantities;
  if (k.is_along_path) key.kind = key.kind == Kind::point ? Kind::points : Kind::quantities;
  return key;
}

/// The values of the table's choice with which the field goes; all: none.
template <class Owner>
std::vector<std::string_view> values_with(const description::Field<Owner>& field,
                                          const description::Fields<Owner>& fields) {
  std::vector<std::string_view> values;
  const auto choice = std::ranges::find_if(
      fields, [](const auto& key) { return !key.choices.empty() && !key.condition; });
  if (!field.condition || choice == fields.end()) return values;
  for (const std::string_view value : choice->choices) {
    Owner owner{};
    choice->set(owner, std::string(value));
    if (field.belongs(owner)) values.push_back(value);
  }
  return values;
}

template <class Owner>
void add_table(std::vector<Key>& keys, std::string_view table,
               const description::Fields<Owner>& fields) {
  for (const description::Field<Owner>& field : fields)
    keys.push_back(only_with(values_with(field, fields), of_key(table, field)));
}

/// "`mesh` takes `calculix` and `solid` only".
std::string limits_of_pairs(const Models& models) {
  std::string bodies;
  for (const MechanicsEntry& entry : models.mechanics)
    if (entry.has_body) bodies += fmt::format("{}`{}`", bodies.empty() ? "" : " and ", entry.id);
  std::string text;
  for (const FieldEntry& entry : models.fields)
    if (entry.has_body) text += fmt::format("; `{}` takes {} only", entry.id, bodies);
  return text;
}

/// The parameters of all load types, each once, the azimuth last.
void add_load(std::vector<Key>& all) {
  std::vector<std::string_view> types;
  for (const LoadType* type : load_types()) types.push_back(type->name);
  all.push_back(choice(types, of_key("load", keys().load_type)));
  const auto& [samples, there_and_back] =
      std::tie(description::fields<SweepWay>().at(0), description::fields<SweepWay>().at(1));
  all.push_back(only_with({SweepLoad::type().name}, of_key("load", there_and_back)));
  const auto add = [&](const auto& parameters, std::string_view type, bool last) {
    for (const description::Key& parameter : parameters) {
      if ((&parameter == &parameters.back() && parameter.quantity.unit == quantity::angle.unit) !=
          last)
        continue;
      const auto known = std::ranges::find_if(
          all, [&](const Key& k) { return k.table == "load" && k.name == parameter.name; });
      if (known != all.end())
        known->with.push_back(type);
      else
        all.push_back(only_with({type}, of_key("load", parameter)));
    }
  };
  for (const bool last : {false, true})
    for (const LoadType* type : load_types()) {
      add(type->parameters, type->name, last);
      add(type->settings, type->name, last);
      if (type->statement) add(type->statement->parameters, type->name, last);
    }
  all.push_back(only_with({SweepLoad::type().name}, of_key("load", samples)));
  std::set<std::string_view> tables;  // types share them
  for (const LoadType* type : load_types())
    for (const LoadTable& table : type->tables)
      if (tables.insert(table.name).second)
        add_table(all, fmt::format("load.{}", table.name), table.keys);
}

void add_models(const Models& models, std::vector<Key>& all) {
  all.push_back(choice(ids(models.mechanics), of_key("models", keys().mechanics), Kind::choices));
  all.push_back(choice(ids(models.fields), of_key("models", keys().fields), Kind::choices));
  all.back().text += limits_of_pairs(models) + '.';
  models.for_each([&](const auto& entry) {
    for (const Option& option : entry.options) all.push_back(of_key("models." + entry.id, option));
    for (const description::Key& key : entry.tables.keys)
      all.push_back(of_key(entry.tables.name, key));
  });
  all.push_back(of_key(external::table_name, keys().external_name));
  all.push_back(of_key(external::table_name, keys().centrelines));
  all.back().kind = Kind::files;
  add_table(all, external::table_name, description::fields<external::ExternalModel>());
}

}  // namespace

std::vector<Key> all_keys(const Models& models) {
  std::vector<Key> all{of_key("case", keys().case_name), of_key("case", keys().title)};
  add_table(all, "cilium", description::fields<Cilium>());
  add_table(all, "cilium.section", description::fields<CrossSection>());
  add_table(all, "cilium.segment", description::fields<Segment>());
  add_load(all);
  add_table(all, environment::table_name, description::fields<surroundings::Environment>());
  add_table(all, environment::magnet_table, description::fields<surroundings::magnets::Magnet>());
  add_table(all, "surface", description::fields<surroundings::StatedSurface>());
  add_table(all, "signal", description::fields<sweep::SignalOptions>());
  all.push_back(of_key("sensor", keys().sensor_name));
  all.push_back(of_key("sensor", keys().sensor_position));
  all.push_back(choice({axis_names().begin(), axis_names().end()},
                       of_key("sensor", keys().sensor_axes), Kind::choices));
  all.push_back(of_key("sensor", keys().sensor_rotation));
  all.push_back(of_key("sensor", keys().sensor_gain));
  all.push_back(choice({component_names().begin(), component_names().end()},
                       of_key("sensor", keys().sensor_components), Kind::choices));
  for (const external::ReadingKey& key : external::reading_keys())
    all.push_back(of_key("readings", key));
  add_models(models, all);
  for (const description::Key* key : measurement::measurement_keys())
    all.push_back(of_key(measurement::measurement_table, *key));
  for (const description::Key* key : measurement::input_keys())
    all.push_back(of_key(measurement::input_table, *key));
  return all;
}

}  // namespace ciliaval::compare::input::schema

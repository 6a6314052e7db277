// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/schema/keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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

Key text(std::string_view table, std::string_view name, std::string_view fallback, std::string doc,
         std::string_view example = "") {
  return {.table = std::string(table),
          .name = std::string(name),
          .example = std::string(example),
          .fallback = std::string(fallback),
          .doc = std::move(doc)};
}

Key of_kind(Kind kind, Key key) {
  key.kind = kind;
  return key;
}

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
  const std::string initial = fmt::format("`{}`", to_toml(k, k.initial));
  const bool is_required = k.absence == description::Key::Absence::fault;
  Key key = text(table, k.name,
                 !k.fallback.empty() ? k.fallback
                 : is_required       ? ""
                                     : initial,
                 std::string(k.doc));
  key.quantity = k.quantity;
  key.range = k.range;
  key.choices = k.choices;
  const std::array kinds{Kind::flag, Kind::whole_number, Kind::quantity,  Kind::text,
                         Kind::pair, Kind::point,        Kind::quantities};  // as Value has them
  key.kind = kinds.at(k.initial.index());
  if (key.kind == Kind::text && k.longest == 0) key.kind = Kind::file;
  if (!k.choices.empty()) key.kind = Kind::choice;
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
void add_load(std::vector<Key>& keys) {
  std::vector<std::string_view> types;
  for (const LoadType* type : load_types()) types.push_back(type->name);
  keys.push_back(
      choice(types, text("load", "type", "", "What the load is and does as the cilium bends.")));
  const auto& [samples, there_and_back] =
      std::tie(description::fields<SweepWay>().at(0), description::fields<SweepWay>().at(1));
  keys.push_back(only_with({SweepLoad::type().name}, of_key("load", there_and_back)));
  const auto add = [&](const auto& parameters, std::string_view type, bool last) {
    for (const description::Key& parameter : parameters) {
      if ((&parameter == &parameters.back() && parameter.quantity.unit == quantity::angle.unit) !=
          last)
        continue;
      const auto known = std::ranges::find_if(
          keys, [&](const Key& k) { return k.table == "load" && k.name == parameter.name; });
      if (known != keys.end())
        known->with.push_back(type);
      else
        keys.push_back(only_with({type}, of_key("load", parameter)));
    }
  };
  for (const bool last : {false, true})
    for (const LoadType* type : load_types()) {
      add(type->parameters, type->name, last);
      if (type->statement) add(type->statement->parameters, type->name, last);
    }
  keys.push_back(only_with({SweepLoad::type().name}, of_key("load", samples)));
}

void add_sensor_and_readings(std::vector<Key>& keys) {
  keys.push_back(text("sensor", "name", "its number",
                      "`[[sensor]]`, a table for each sensor with its `position`: the name in "
                      "tables, files and headers of readings; letters, digits, `.`, `_`, `-`, not "
                      "digits alone."));
  keys.push_back(of_key("sensor", sensor_position()));
  keys.push_back(text("readings", "map", "none",
                      "Of `ciliaval sense`, as its option `--map`: the columns of a file of "
                      "readings (docs/guide/sensing.md).",
                      R"("bx=Ch 1, by=Ch 2, bz=Ch 3")"));
  keys.push_back(text("readings", "unit", "none",
                      "As `--unit`: T, mT, uT, nT, G, mG or LSB, of columns that state none.",
                      R"("mG")"));
  keys.push_back(text("readings", "scale", "none",
                      "As `--scale`: the flux density of an LSB, `\"6842 LSB/G\"`, or three for "
                      "x, y, z.",
                      R"("0.15 uT")"));
  keys.push_back(text("readings", "unloaded", "none",
                      "As `--unloaded`: the readings of the straight cilium by time, `\"rows "
                      "1..20\"`, or `\"model\"`.",
                      R"("0 s..1 s")"));
}

void add_models(const Models& models, std::vector<Key>& keys) {
  keys.push_back(
      choice(ids(models.mechanics),
             text("models", "mechanics", "", "The mechanics models to run, at least one."),
             Kind::choices));
  keys.push_back(choice(ids(models.fields),
                        text("models", "fields", "none",
                             fmt::format("The field models to run on the deformation of each "
                                         "mechanics model{}.",
                                         limits_of_pairs(models))),
                        Kind::choices));
  models.for_each([&](const auto& entry) {
    for (const Option& option : entry.options) keys.push_back(of_key("models." + entry.id, option));
    for (const description::Key& key : entry.tables.keys)
      keys.push_back(of_key(entry.tables.name, key));
  });
  const auto of_external = [](std::string_view name, std::string_view fallback, std::string doc) {
    return text(external::table_name, name, fallback, std::move(doc));
  };
  keys.push_back(of_external("name", "",
                             "Name of an external model (docs/guide/referees.md), not that of a "
                             "model; a plain file name."));
  keys.push_back(of_kind(
      Kind::files, of_external("centrelines", "none",
                               "CSV files with a centreline each, one for each load step, "
                               "beside the case file unless absolute; these or `readings`.")));
  add_table(keys, external::table_name, description::fields<external::ExternalModel>());
}

void add_measurements(std::vector<Key>& keys) {
  const auto measured = [&](Kind kind, std::string_view name, std::string_view fallback,
                            std::string doc, std::string_view example = "") -> Key& {
    keys.push_back(of_kind(
        kind, text(measurement::measurement_table, name, fallback, std::move(doc), example)));
    return keys.back();
  };
  measured(Kind::text, "quantity", "",
           "What was measured (docs/guide/validation.md): `tip.x`, `tip.y`, `tip.z`, "
           "`tip.deflection`, `tip.theta`, or at a sensor `B.NAME.x`, `dB.NAME.x` …",
           R"("tip.deflection")");
  keys.push_back(of_key(measurement::measurement_table, measurement::point_key()));
  measured(Kind::whole_number, "step", "that of the only step",
           "Load step of `value`, counted from 0.");
  measured(Kind::any, "value", "`file`", "The measured value.", "3.2 mm");
  measured(Kind::file, "file", "`value`",
           "CSV file with the values, beside the case file unless absolute: a row for each load "
           "step.");
  measured(Kind::text, "column", "`\"value\"`", "`file`: name of the column with the values.");
  measured(
      Kind::text, "load", "a column in the load's unit, else `\"in order\"`",
      "`file`: the column with the load of each row, which names its step; `\"x [mT]\"` states "
      "its unit. `\"in order\"`: the rows are the load steps in their order.",
      R"("field [mT]")");
  measured(Kind::any, "scale", "a unit in the header",
           "`file`: what a 1 is in a column without a unit.", "17.2 mm");
  measured(Kind::any, "uncertainty", "a column of the `file`",
           "Standard uncertainty u_D of each value: reading, datum, repeats; or a part of it, "
           "`\"2 %\"`.",
           "0.1 mm");
  measured(Kind::text, "source", "", "Where the values are from.");
  measured(Kind::flag, "fitted", "`false`",
           "Whether parameters of the case were fitted to these values.");
  const auto input = [&](Kind kind, std::string_view name, std::string_view fallback,
                         std::string doc, std::string_view example = "") {
    keys.push_back(
        of_kind(kind, text(measurement::input_table, name, fallback, std::move(doc), example)));
  };
  input(Kind::text, "number", "",
        "A number of the case, named as in a study (docs/guide/studies.md); of load and "
        "environment at every step.",
        R"("cilium.segment.base.young_modulus")");
  input(Kind::any, "uncertainty", "",
        "Its standard uncertainty, in its unit or as a part of it, `\"2 %\"`.", "0.05 MPa");
  input(Kind::text, "source", "none", "Where it is from.");
}

}  // namespace

std::vector<Key> all_keys(const Models& models) {
  std::vector<Key> keys{
      text("case", "name", "",
           "Name of the results' folder: letters, digits, `.`, `_`, `-`, not starting with `.` or "
           "`-`, at most 100."),
      text("case", "title", "the name", "A line for people, at most 200 characters.")};
  add_table(keys, "cilium", description::fields<Cilium>());
  add_table(keys, "cilium.section", description::fields<CrossSection>());
  add_table(keys, "cilium.segment", description::fields<Segment>());
  add_load(keys);
  add_table(keys, environment::table_name, description::fields<surroundings::Environment>());
  add_table(keys, environment::magnet_table, description::fields<surroundings::magnets::Magnet>());
  add_table(keys, "surface", description::fields<surroundings::StatedSurface>());
  add_table(keys, "signal", description::fields<signal::SignalOptions>());
  add_sensor_and_readings(keys);
  add_models(models, keys);
  add_measurements(keys);
  return keys;
}

}  // namespace ciliaval::compare::input::schema

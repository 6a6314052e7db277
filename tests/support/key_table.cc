// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/support/key_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <variant>
#include <vector>

#include "compare/input/case_keys.h"
#include "compare/input/sweep/signal.h"
#include "compare/input/sweep/surface.h"
#include "problem/load.h"

namespace ciliaval::test {
namespace {

using namespace compare::input;

/// A key whose value is text or a list of texts.
struct TextKey {
  std::string_view table;
  std::string_view name;
  std::string value;  ///< what may stand there
  std::string_view fallback;
  std::string doc;
};

/// "`contact`, `flow` or `probe`".
std::string in_code(const std::vector<std::string_view>& names, std::string_view last = ", ") {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += fmt::format("{}`{}`", i == 0 ? "" : i + 1 < names.size() ? ", " : last, names[i]);
  return text;
}

/// "`mesh` takes `calculix` and `solid` only".
std::string limits_of_pairs(const Models& models) {
  std::vector<std::string_view> bodies;
  for (const MechanicsEntry& entry : models.mechanics)
    if (entry.has_body) bodies.push_back(entry.id);
  std::string text;
  for (const FieldEntry& entry : models.fields)
    if (entry.has_body)
      text += fmt::format("; `{}` takes {} only", entry.id, in_code(bodies, " and "));
  return text;
}

std::vector<TextKey> text_keys(const Models& models) {
  std::vector<std::string_view> loads;
  for (const LoadType* type : load_types()) loads.push_back(type->name);
  return {
      {"case", "name", "text", "",
       "Name of the results' folder: letters, digits, `.`, `_`, `-`, not starting with `.` or `-`, "
       "at most 100."},
      {"case", "title", "text", "the name", "A line for people, at most 200 characters."},
      {"case", "references", "text", "none",
       "Number and checksum of the references in the case's baseline, as `check` states them."},
      {"cilium.segment", "name", "text", "", "Name of the segment, different from the others'."},
      {"load", "type", in_code(loads, " or "), "",
       "What the load is and does as the cilium bends."},
      {"load", key::sweep_return, "`true` or `false`", "`false`",
       "`sweep`: whether the surface goes back again over the same places."},
      {"surface", "profile", in_code(sweep::profile_names(), " or "), "",
       "The surface of a `sweep`: z = L - interference - p(x - travel), x along the azimuth; p "
       "counts towards the cilium."},
      {"surface", "path", "file name", "",
       "`file`: CSV with `x` and `height`, at least four rows; x counts along the way that the "
       "tip goes over the surface, from the place over the base at the start."},
      {"signal", "seed", "whole number", "1", "Of the noise; each sensor has its own."},
      {"signal", "order", "whole number", "4 (the paper's)", "Of the filter, 1 to 20."},
      {"signal", "phase", in_code(sweep::phase_names(), " or "), "causal",
       "A filter in the logger, or one of the whole record that shifts nothing."},
      {"models", "mechanics", "list of " + in_code(ids(models.mechanics)), "",
       "The mechanics models to run, at least one."},
      {"models", "fields", "list of " + in_code(ids(models.fields)), "none",
       fmt::format("The field models to run on the deformation of each mechanics model{}.",
                   limits_of_pairs(models))},
      {key::external_table, "name", "text", "",
       "Name of an external model (docs/guide/referees.md), not that of a model; a plain file "
       "name."},
      {key::external_table, "centrelines", "list of file names", "none",
       "CSV files with a centreline each, one for each load step, beside the case file unless "
       "absolute; these or `readings`."},
      {key::external_table, "readings", "file name", "none",
       "CSV file with the readings of every load step and sensor."},
      {key::external_table, "background", "file name", "none",
       "CSV file with the ambient field at each azimuth, to be taken off the readings."},
  };
}

const std::vector<const QuantityKey*>& quantity_keys() {
  static const std::vector<const QuantityKey*> keys = [] {
    std::vector<const QuantityKey*> all{&key::diameter, &key::segment_length, &key::young_modulus,
                                        &key::poisson_ratio, &key::magnetization};
    const auto add = [&](const std::vector<LoadParameter>& parameters, bool last) {
      for (const LoadParameter& parameter : parameters)
        if ((parameter.key.name == "azimuth") == last &&
            std::none_of(all.begin(), all.end(), [&](const QuantityKey* k) {
              return k->table == parameter.key.table && k->name == parameter.key.name;
            }))
          all.push_back(&parameter.key);
    };
    for (const bool last : {false, true})
      for (const LoadType* type : load_types()) {
        add(type->parameters, last);
        if (type->statement) add(type->statement->parameters, last);
      }
    all.push_back(&key::samples);
    for (const sweep::ProfileKind& kind : sweep::profile_kinds())
      for (const QuantityKey& k : kind.keys) all.push_back(&k);
    all.insert(all.end(), {&sweep::friction, &sweep::tilt});
    for (const QuantityKey& k : sweep::signal_keys()) all.push_back(&k);
    all.insert(all.end(), {&key::position, &key::tip_uncertainty, &key::field_uncertainty});
    return all;
  }();
  return keys;
}

std::string row(std::string_view table, std::string_view name, std::string_view value,
                std::string_view range, std::string_view fallback, std::string_view doc) {
  return fmt::format("| `{}.{}` | {} | {} | {} | {} |\n", table, name, value, range,
                     fallback.empty() ? "required" : fallback, doc);
}

std::string row(const QuantityKey& k) {
  const std::string value = k.quantity.unit.empty()
                                ? std::string(k.quantity.name)
                                : fmt::format("{}, `\"{}\"`", k.quantity.name, k.quantity.example);
  return row(k.table, k.name, value, describe(k.range, k.quantity), k.fallback, k.doc);
}

std::string row(std::string_view model, const Option& option) {
  const OptionValue fallback = option.get(ModelOptions{});
  std::string value = "`true` or `false`";
  std::string range;
  if (!option.choices.empty()) {
    value = fmt::format("`{}`", fmt::join(option.choices, "` or `"));
  } else if (std::holds_alternative<std::string>(fallback)) {
    value = "file name";
  } else if (!std::holds_alternative<bool>(fallback)) {
    const bool whole = std::holds_alternative<unsigned int>(fallback);
    value = whole ? "whole number" : option.quantity.name;
    if (std::holds_alternative<std::array<double, 2>>(fallback)) value = "two plain numbers";
    range = describe(option.range, option.quantity);
  }
  return row(fmt::format("models.{}", model), option.name, value, range,
             fmt::format("`{}`", to_toml(option, fallback)), option.doc);
}

}  // namespace

std::string key_table(const Models& models) {
  std::string table =
      "| key | value | range | default | meaning |\n| --- | --- | --- | --- | --- |\n";
  const std::vector<TextKey> texts = text_keys(models);
  const auto add = [&](std::string_view part) {
    for (const TextKey& k : texts)
      if (k.table == part) table += row(k.table, k.name, k.value, "", k.fallback, k.doc);
    for (const QuantityKey* k : quantity_keys())
      if (k->table == part) table += row(*k);
  };
  for (const std::string_view part :
       {"case", "cilium", "cilium.segment", "load", "surface", "signal", "sensor", "models"})
    add(part);
  models.for_each([&](const auto& entry) {
    for (const Option& option : entry.options) table += row(entry.id, option);
    for (const QuantityKey* k : entry.tables.keys) table += row(*k);
  });
  add(key::external_table);
  return table;
}

}  // namespace ciliaval::test

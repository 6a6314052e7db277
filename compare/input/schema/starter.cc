// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/schema/starter.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "compare/input/case_sections.h"
#include "compare/input/described.h"
#include "compare/input/units.h"

namespace ciliaval::compare::input::schema {
namespace {

constexpr const char* top =
    R"(# A case of CiliaVal. `ciliaval validate {0}.toml` checks it, `ciliaval run {0}.toml` runs it.
# All keys: docs/guide/cases.md. Statements behind a # show the default, or another choice.
[case]
name = "{0}"                     # of the folder of results
title = "{0}: a first case"

[cilium]
diameter = "3 mm"

[[cilium.segment]]               # from the base to the tip, one table for each segment
name = "base"
length = "3 mm"
young_modulus = "0.1 MPa"
poisson_ratio = 0.49             # rubber is near 0.49; less than 0.5

[[cilium.segment]]
name = "magnet"
length = "17 mm"
young_modulus = "3 MPa"
poisson_ratio = 0.49
magnetization = "75 kA/m"        # B_r/mu_0 along the axis, towards the tip

)";

constexpr const char* sensor = R"(
[[sensor]]                       # where the field is computed, one table for each sensor
name = "below"
position = ["0 mm", "0 mm", "-2 mm"]   # x, y, z; the cilium stands on z = 0, along +z

)";

constexpr const char* surface = R"(
[surface]                        # what passes over the tip: docs/guide/sweep.md
profile = "flat"
friction = 0.3
)";

constexpr const char* field = R"(
[environment]                    # weight, a fluid, a uniform field: docs/guide/sweep.md
uniform_field = ["2 mT", "0 mT", "0 mT"]   # a list of fields makes a path of load steps
)";

std::string quoted(const Quantity& quantity, std::string_view value) {
  return quantity.unit.empty() ? std::string(value) : fmt::format("\"{}\"", value);
}

/// A value that suits the cilium of this file.
std::string value_of(const description::Key& key) {
  if (!key.choices.empty()) return fmt::format("\"{}\"", key.choices.front());
  return quoted(key.quantity, key.quantity.example);
}
std::string value_of(const LoadParameter& parameter) {
  if (parameter.site == LoadParameter::Site::height) return "\"16 mm\"";
  if (parameter.site == LoadParameter::Site::arclength) return "\"20 mm\"";
  return value_of(static_cast<const description::Key&>(parameter));
}

/// The default where it is a value; else an example.
template <class Parameter>
std::string line(const Parameter& parameter, bool is_comment) {
  const std::string_view fallback = parameter.fallback;
  const bool is_value = !fallback.empty() && fallback.front() >= '0' && fallback.front() <= '9';
  const std::string statement =
      fmt::format("{}{} = {}", is_comment ? "# " : "", parameter.name,
                  is_value ? quoted(parameter.quantity, fallback) : value_of(parameter));
  return fmt::format("{:<32} # {}\n", statement, parameter.doc);
}

std::string load_table(const LoadType& load) {
  std::vector<std::string_view> others;
  for (const LoadType* type : load_types())
    if (type != &load) others.push_back(type->name);
  std::string text = fmt::format(
      "[load]                           # lists of the same length make a path of load steps\n"
      "{:<32} # {}\n# other types: {}\n",
      fmt::format("type = \"{}\"", load.name), load.description, fmt::join(others, ", "));
  for (const LoadParameter& parameter : load.parameters)
    text += line(parameter, &parameter != &load.parameters.front() && !parameter.fallback.empty());
  for (const auto& setting : load.settings) text += line(setting, true);
  if (load.statement)
    for (const auto& parameter : load.statement->parameters) text += line(parameter, true);
  return text;
}

/// The models that take a moment, or all if there are none.
template <class Entries, class Takes>
std::string models_line(std::string_view name, const Entries& entries, const Takes& takes) {
  std::vector<std::string> chosen;
  std::string others;
  for (const auto& entry : entries) {
    if (takes(entry) && !entry.is_slow)
      chosen.push_back(fmt::format("\"{}\"", entry.id));
    else if (takes(entry))
      others += fmt::format("# \"{}\": {}\n", entry.id, entry.description);
  }
  return fmt::format("{} = [{}]\n{}", name, fmt::join(chosen, ", "), others);
}

/// The options by which the rods leave out least.
std::string corrections(const Models& models) {
  std::string text;
  for (const MechanicsEntry& entry : models.mechanics) {
    if (!entry.correct) continue;
    const ModelOptions stated;
    ModelOptions best;
    entry.correct(best);
    text += fmt::format("\n[models.{}]\n", entry.id);
    for (const Option& option : entry.options)
      if (option.get(best) != option.get(stated))
        text += fmt::format("{:<32} # as stiff as bonded sections are; {} in the paper\n",
                            fmt::format("{} = {}", option.name, to_toml(option, option.get(best))),
                            to_toml(option, option.get(stated)));
  }
  return text;
}

}  // namespace

std::string starter_case(const std::string& name, const LoadType& load, const Models& models) {
  const auto takes_load = [&](const MechanicsEntry& entry) {
    return entry.loads.empty() || std::ranges::find(entry.loads, &load) != entry.loads.end();
  };
  // Not all rods take them under what is around the cilium, and none under a surface.
  const bool corrections_reach = &load != &SweepLoad::type() && &load != &EnvironmentLoad::type();
  const auto is_of_rods = [](const FieldEntry& entry) { return !entry.has_body; };
  std::string text = fmt::format(fmt::runtime(top), name) + load_table(load);
  if (&load == &SweepLoad::type()) text += surface;
  if (&load == &EnvironmentLoad::type()) text += field;
  return text + sensor + "[models]                         # `ciliaval list` says what they are\n" +
         models_line(keys().mechanics.name, models.mechanics, takes_load) +
         models_line(keys().fields.name, models.fields, is_of_rods) +
         (corrections_reach ? corrections(models) : "");
}

}  // namespace ciliaval::compare::input::schema

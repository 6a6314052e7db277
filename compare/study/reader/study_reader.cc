// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/study/reader/study_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "compare/input/case_sections.h"
#include "compare/input/case_syntax.h"
#include "compare/input/described.h"
#include "compare/input/external/background.h"
#include "compare/models/registry.h"
#include "compare/study/reader/reading.h"
#include "problem/error.h"
#include "problem/support/words.h"

namespace ciliaval::compare::study::reader {
namespace {

namespace fs = std::filesystem;

constexpr Range sensor_range{0, 1e6, false, "sensors are counted from 0"};
constexpr Range noise_range{0, 100, true, unit_slip};
constexpr Range rotation_range{0, std::numbers::pi / 2, true,
                               "under a horizontal force the tip's rotation stays below 90 deg"};

/// Calls f with each number of the case that [fixed] or [tolerances] has, the place of its key and
/// its value: they stand under the case's own keys, as nested tables.
void for_numbers(const toml::table& table, const std::string& prefix, const Reading& reading,
                 input::Faults& faults,
                 const std::function<void(const CaseNumber&, input::Place, const toml::node&)>& f) {
  for (const auto& [key, node] : table) {
    const std::string path = prefix + std::string(key.str());
    if (const toml::table* inner = node.as_table())
      for_numbers(*inner, path + ".", reading, faults, f);
    else if (const CaseNumber* number = find_number(reading, path, input::place(key), faults))
      f(*number, input::place(key), node);
  }
}

/// [fixed].
void read_fixed(const toml::table& table, Reading& reading, input::Faults& faults) {
  const auto read = [&](const CaseNumber& number, input::Place where, const toml::node& node) {
    check_contradiction(reading.study, number, where, faults);
    if (const auto value = read_number(node, number.path, number, faults))
      reading.study.fixed.push_back({number, *value});
  };
  for_numbers(table, "", reading, faults, read);
}

/// A part of the nominal value: "5 %"; none if the text is no percentage.
std::optional<double> percentage(const toml::node& node) {
  const auto* text = node.as_string();
  if (text == nullptr) return std::nullopt;
  double value = 0;
  const char* const last = text->get().data() + text->get().size();
  const auto [end, error] = std::from_chars(text->get().data(), last, value);
  const std::string_view rest(end, static_cast<std::size_t>(last - end));
  if (error != std::errc() || rest.find_first_not_of(" %") != std::string_view::npos ||
      std::count(rest.begin(), rest.end(), '%') != 1)
    return std::nullopt;
  return value / 100;
}

/// One standard deviation, a quantity or a percentage of the nominal value.
void read_deviation(const toml::node& node, Tolerance& tolerance, input::Faults& faults) {
  const CaseNumber& number = tolerance.number;
  const double largest = std::max(std::abs(number.range.lower), std::abs(number.range.upper));
  const Range range{0, largest, true, "a standard deviation is positive"};
  if (const auto part = percentage(node)) {
    tolerance.deviation = std::abs(*part * tolerance.nominal);
    if (!(*part > 0 && tolerance.deviation > 0))
      faults.add(input::place(node),
                 fmt::format("'{}': a percentage is positive, and of a value that is "
                             "not zero",
                             number.path));
  } else if (const auto value =
                 input::read_value(node, number.path, number.quantity, range, faults)) {
    tolerance.deviation = *value;
    tolerance.unit = unit_of(node);
  }
  const double reach = 2 * tolerance_step * tolerance.deviation;
  for (const double moved : {tolerance.nominal - reach, tolerance.nominal + reach})
    if (!number.range.contains(moved))
      faults.add(input::place(node),
                 fmt::format("'{}' moved by half of its tolerance is {}, but must be "
                             "{}",
                             number.path, input::format_quantity(moved, number.quantity),
                             input::describe(number.range, number.quantity)));
}

/// [tolerances].
void read_tolerances(const toml::table& table, Reading& reading, input::Faults& faults) {
  const input::Case nominal = with_settings(reading.base, reading.study.fixed);
  const auto read = [&](const CaseNumber& number, input::Place where, const toml::node& node) {
    if (number.is_whole_number())
      return faults.add(where,
                        fmt::format("'{}' is a whole number: it has no tolerance", number.path));
    Tolerance tolerance{number, number.number(nominal), 0, {}, 1};
    const std::size_t before = faults.size();
    read_deviation(node, tolerance, faults);
    if (faults.size() != before) return;
    if (tolerance.unit.empty())
      tolerance.unit = number.quantity.unit;
    else
      tolerance.unit_size = input::parse_quantity("1 " + tolerance.unit, number.quantity);
    reading.study.tolerances.push_back(std::move(tolerance));
  };
  for_numbers(table, "", reading, faults, read);
}

/// Every pair of models that can be formed.
std::vector<std::string> all_pairs() {
  std::vector<std::string> pairs;
  for (const models::MechanicsEntry& mechanics : models::mechanics_models())
    for (const models::FieldEntry& field : models::field_models())
      if (!field.has_body || mechanics.has_body)
        pairs.push_back(fmt::format("{}/{}", mechanics.id, field.id));
  return pairs;
}

/// The texts of a list that is not empty.
std::vector<std::string> read_some(const toml::node& node, std::string_view name,
                                   std::span<const std::string_view> choices,
                                   input::Faults& faults) {
  if (const toml::array* list = node.as_array(); list != nullptr && list->empty())
    faults.add(input::place(node),
               fmt::format("'{}' must be a list, such as [\"{}\"], found an empty one", name,
                           choices.front()));
  return input::read_choices(node, name, choices, faults);
}

void read_pairs(input::Section& table, Study& study) {
  const toml::node* node = table.require("pairs");
  if (node == nullptr) return;
  const std::vector<std::string> names = all_pairs();
  const std::vector<std::string_view> choices(names.begin(), names.end());
  for (const std::string& text : read_some(*node, "pairs", choices, table.faults())) {
    const std::size_t slash = text.find('/');
    study.pairs.push_back({text.substr(0, slash), text.substr(slash + 1)});
  }
}

/// The outputs that [study] lists, and those that the optimisation needs, in their own order.
void read_outputs(input::Section& table, Study& study) {
  std::set<Output> asked{Output::dB_x, Output::dB_y, Output::dB_z, Output::dB_norm};
  if (const toml::node* node = table.find("outputs")) {
    std::vector<std::string_view> choices;
    for (const Output output : all_outputs()) choices.push_back(id(output));
    const std::vector<std::string> ids = read_some(*node, "outputs", choices, table.faults());
    asked.clear();
    for (const Output output : all_outputs())
      if (std::find(ids.begin(), ids.end(), id(output)) != ids.end()) asked.insert(output);
  }
  if (study.optimisation) {
    asked.insert(study.optimisation->goal);
    for (const Limit& limit : study.optimisation->limits) asked.insert(limit.output);
  }
  study.outputs.assign(asked.begin(), asked.end());
}

/// A quantity that goes with an output.
std::optional<double> read_companion(input::Section& table, std::string_view name,
                                     const Quantity& quantity, const Range& range, bool needed,
                                     std::string_view with) {
  input::Faults& faults = table.faults();
  const toml::node* node = table.find(name);
  if (node == nullptr) {
    if (needed)
      faults.add(table.where(),
                 fmt::format("{} needs '{}', such as \"{}\"", with, name, quantity.example));
    return std::nullopt;
  }
  if (!needed) faults.add(input::place(*node), fmt::format("'{}' goes with {} only", name, with));
  return input::read_value(*node, name, quantity, range, faults);
}

/// The sensor of the study: the one that it names, or the only one.
void choose_sensor(input::Section& table, input::Case& base) {
  input::Faults& faults = table.faults();
  std::size_t index = 0;
  const toml::node* node = table.find("sensor");
  if (node != nullptr && node->is_string()) {
    const auto names = input::sensor_names(base);
    const auto named = std::ranges::find(names, *node->value<std::string>());
    index = static_cast<std::size_t>(named - names.begin());
  } else if (node != nullptr) {
    index = input::read_whole_number(*node, "sensor", sensor_range, faults).value_or(0);
  }
  if (node == nullptr && base.sensors.size() > 1)
    faults.add(table.where(),
               fmt::format("the case has {} sensors: 'sensor' says which one, from 0 or by name",
                           base.sensors.size()));
  if (base.sensors.empty())
    faults.add(table.where(), "the case has no [sensor], so there is no field to study");
  else if (index >= base.sensors.size())
    faults.add(input::place(*node),
               fmt::format("the case has no sensor {}: they are {}",
                           node->is_string() ? input::in_quotes(*node->value<std::string>())
                                             : std::to_string(index),
                           input::external::sensor_list(input::sensor_names(base))));
  else {
    base.sensors = {base.sensors[index]};
    if (!base.sensor_names.empty()) base.sensor_names = {base.sensor_names[index]};
  }
}

/// The case that [study] names, read; throws InputError with the case file's own faults.
bool read_base(input::Section& table, const fs::path& file, input::Case& base) {
  input::Faults& faults = table.faults();
  const toml::node* node = table.require("case");
  const std::optional<std::string> name =
      node != nullptr ? input::read_text(*node, "case", faults) : std::nullopt;
  if (!name) return false;
  const fs::path path = (file.parent_path() / *name).lexically_normal();
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {
    faults.add(input::place(*node),
               fmt::format("there is no case file '{}': a name without a leading / "
                           "is looked for beside the study file",
                           path.string()));
    return false;
  }
  base = input::read_case(path, models::known());
  base.external.clear();
  return true;
}

void read_study_table(input::Section& table, Reading& reading) {
  input::Faults& faults = table.faults();
  Study& study = reading.study;
  input::read_name_and_title(table, study.name, study.title);
  if (const toml::node* node = table.find("combine")) {
    if (study.optimisation)
      faults.add(input::place(*node),
                 "'combine' goes with the values of parameters, not with [optimise]");
    constexpr std::array<std::string_view, 2> choices{"product", "zip"};
    study.is_zipped = input::read_choice(*node, "combine", choices, faults) == choices[1];
  }
  read_pairs(table, study);
  read_outputs(table, study);
  study.noise = read_companion(table, "noise", quantity::flux_density, noise_range,
                               study.asks_for(Output::resolution), "the output 'resolution'");
  description::Key model_uncertainty;
  model_uncertainty.name = "model_uncertainty";
  model_uncertainty.initial = study.optimisation.has_value();
  study.has_model_uncertainty = std::get<bool>(model_uncertainty.initial);
  if (const toml::node* node = table.find(model_uncertainty.name))
    if (const auto value = input::read_value(*node, model_uncertainty, faults))
      study.has_model_uncertainty = std::get<bool>(*value);
  if (reading.numbers.empty()) {  // there is no case
    for (const std::string_view key : {"sensor", "rotation"}) table.find(key);
    return;
  }
  choose_sensor(table, reading.base);
  const bool slips = contact_height(reading.base.load_path.front()).has_value();
  study.rotation = read_companion(
      table, "rotation", quantity::angle, rotation_range, study.asks_for(Output::range) && !slips,
      "the output 'range' of a load that has no slip-off (flow, section, dead, environment)");
}

/// Makes one load step of the case's: they must be the same but for what the study sets.
void reduce_to_one_step(Study& study, input::Place where, input::Faults& faults) {
  input::Case& base = study.base;
  // The tolerances are those of the case with its fixed numbers alone.
  const input::Case set = study.case_at(study.tolerances.empty() ? 0 : study.point_count());
  const auto differs = [&](const Load& step) { return !(step == set.load_path.front()); };
  if (base.load_path.front().is<SweepLoad>() && base.load_path.size() > 1) {
    faults.add(where, fmt::format("the case is a sweep of {} samples, a study's points are one: "
                                  "list one place, travel = [\"0 mm\"]",
                                  base.load_path.size()));
    return;
  }
  const auto has_another_field = [&](const Load& step) {
    return !(step.environment() == set.load_path.front().environment());
  };
  if (std::ranges::any_of(set.load_path, has_another_field)) {
    faults.add(where, fmt::format("the case lists {} fields, a study's points have one: list one "
                                  "'uniform_field' in [environment]",
                                  base.load_path.size()));
    return;
  }
  if (std::any_of(set.load_path.begin(), set.load_path.end(), differs)) {
    const LoadParameter& magnitude_key = base.load_path.front().type().parameters.front();
    faults.add(where, fmt::format("the case has {} load steps, a study's points one: say which "
                                  "load under [fixed], such as load.{} = \"{}\"",
                                  base.load_path.size(), magnitude_key.name,
                                  magnitude_key.quantity.example));
    return;
  }
  base.load_path.resize(1);
  if (!base.stated_by.empty()) base.stated_by.resize(1);
}

/// Checks each point as a case file would be; the first that cannot be is a fault.
void check_points(const Study& study, input::Place where, input::Faults& faults) {
  const toml::table root =
      input::parse_toml(input::to_toml(study.base, models::known()), study.name);
  for (std::size_t i = 0; i < study.all_points(); ++i) {
    const input::Case c = study.case_at(i);
    std::string fault;
    input::Faults of_point;
    input::check_together(root, c, models::known(), {true, true, true}, of_point);
    if (!of_point.empty()) fault = of_point.first();
    try {
      require_valid(c.cilium);
      for (const Load& load : c.load_path) require_valid(load, c.cilium);
    } catch (const InputError& error) {
      if (fault.empty()) fault = error.what();
    }
    if (fault.empty()) continue;
    faults.add(where, fmt::format("at {}: {}", study.describe(i), fault));
    return;
  }
}

constexpr Range evaluations_range{0, 1e6, false, "a search must end"};
constexpr Range starts_range{0, 1000, false, "a search must end"};

/// [optimise.at_least] or [optimise.at_most].
void read_limits(input::Section& parent, std::string_view key, bool is_lower, Reading& reading) {
  static constexpr Range positive{0, 1e12, true, "magnitudes are limited, and they are positive"};
  input::Section table = parent.section(key);
  if (!table.exists()) return;
  std::vector<Limit>& limits = reading.study.optimisation->limits;
  for (const Output output : all_outputs()) {
    const toml::node* node = table.find(id(output));
    if (node == nullptr || reading.numbers.empty()) continue;
    const auto value =
        input::read_value(*node, id(output), quantity_of(output, reading.base.load_path.front()),
                          positive, table.faults());
    if (!value) continue;
    for (const Limit& other : limits)
      if (other.output == output && other.value >= *value)
        table.faults().add(input::place(*node),
                           fmt::format("'{}' cannot be at least {:g} and at most {:g}", id(output),
                                       other.value, *value));
    limits.push_back({output, is_lower, *value});
  }
  table.finish();
}

/// [optimise]: the goal, the limits and the search's options. The case has been read.
void read_optimisation(input::Section& table, Reading& reading) {
  input::Faults& faults = table.faults();
  Optimisation& optimisation = reading.study.optimisation.emplace();
  // The smallest resolution would be wanted, which is the largest sensitivity.
  std::vector<std::string_view> goals;
  for (const Output output : all_outputs())
    if (output != Output::resolution) goals.push_back(id(output));
  if (const toml::node* node = table.require("maximise"))
    if (const auto goal = input::read_choice(*node, "maximise", goals, faults))
      for (const Output output : all_outputs())
        if (id(output) == *goal) optimisation.goal = output;
  table.read("global_evaluations", evaluations_range, optimisation.global_evaluations);
  table.read("starts", starts_range, optimisation.starts);
  read_limits(table, "at_least", true, reading);
  read_limits(table, "at_most", false, reading);
  table.finish();
}

/// Conditions between tables that are right one by one.
void check_study(Study& study, input::Place where, input::Faults& faults) {
  if (study.is_zipped)
    for (const Parameter& p : study.parameters)
      if (p.values.size() != study.parameters.front().values.size()) {
        faults.add(where,
                   fmt::format("with combine = \"zip\" all parameters have as many values: "
                               "'{}' has {}, '{}' {}",
                               study.parameters.front().name,
                               study.parameters.front().values.size(), p.name, p.values.size()));
        return;
      }
  double points = 1;  // the product may be beyond a whole number's range
  for (const Parameter& p : study.parameters)
    points = study.is_zipped ? static_cast<double>(p.values.size())
                             : points * static_cast<double>(p.values.size());
  if (points > static_cast<double>(most_points)) {
    faults.add(where, fmt::format("the study has {:g} points, more than {}", points, most_points));
    return;
  }
  const std::size_t before = faults.size();
  reduce_to_one_step(study, where, faults);
  if (faults.size() == before) check_points(study, where, faults);
}

/// The same of an optimisation: the points that are checked are the corners of its bounds.
void check_optimisation(Study& study, input::Place where, input::Faults& faults) {
  Study corners = study;
  corners.parameters = study.optimisation->parameters;
  check_study(corners, where, faults);
  study.base = std::move(corners.base);
}

/// [tolerances] and [[parameter]], or the parameters of [optimise].
void read_varied(input::Section& root, const input::Section& tolerances, Reading& reading) {
  input::Faults& faults = root.faults();
  if (reading.study.optimisation) {
    if (tolerances.exists())
      faults.add(tolerances.where(),
                 "[tolerances] are of one design: put the one that [optimise] finds under [fixed] "
                 "of another study");
    return read_parameters(root, reading);
  }
  if (tolerances.exists()) read_tolerances(*tolerances.table(), reading, faults);
  if (root.find("parameter") != nullptr || !tolerances.exists() || tolerances.table()->empty())
    read_parameters(root, reading);
}

}  // namespace

Study read_study(const fs::path& file) {
  const toml::table root_table =
      input::parse_toml(input::read_toml_file(file, "study"), file.string());
  constexpr std::string_view header_name = "study";
  if (!root_table.contains(header_name) && root_table.contains("cilium"))
    throw InputError(fmt::format("{0}: is a case, not a study: `ciliaval run {0}`", file.string()));
  input::Faults faults;
  input::Section root(&root_table, "the study file", "", {}, faults);
  Reading reading;
  input::Section header = input::require_section(root, header_name);
  if (header.exists() && read_base(header, file, reading.base))
    reading.numbers = case_numbers(reading.base);
  input::Section optimise = root.section("optimise");
  if (optimise.exists()) read_optimisation(optimise, reading);
  if (header.exists()) read_study_table(header, reading);
  header.finish();
  const input::Section fixed = root.section("fixed");
  const input::Section tolerances = root.section("tolerances");
  if (!reading.numbers.empty()) {
    // The paths of the sensor are those of the one that was chosen.
    reading.numbers = case_numbers(reading.base);
    if (fixed.exists()) read_fixed(*fixed.table(), reading, faults);
    read_varied(root, tolerances, reading);
  } else {
    root.find("parameter");
  }
  root.finish();
  Study& study = reading.study;
  study.base = std::move(reading.base);
  study.base.mechanics = study.mechanics();
  study.base.fields.clear();
  for (const ModelPair& pair : study.pairs)
    if (std::find(study.base.fields.begin(), study.base.fields.end(), pair.field) ==
        study.base.fields.end())
      study.base.fields.push_back(pair.field);
  if (faults.empty())
    (study.optimisation ? check_optimisation : check_study)(study, header.where(), faults);
  if (!faults.empty()) throw InputError(faults.report(file.string()));
  return std::move(reading.study);
}

std::vector<fs::path> files_of_study(const fs::path& file) {
  const toml::table root = input::parse_toml(input::read_toml_file(file, "study"), file.string());
  const auto name = root["study"]["case"].value<std::string>();
  if (!name) throw InputError(fmt::format("{}: [study] names no case", file.string()));
  const fs::path problem = (file.parent_path() / *name).lexically_normal();
  std::vector<fs::path> files{file, problem};
  for (fs::path& named :
       input::named_files(models::known(), input::read_case(problem, models::known())))
    files.push_back(std::move(named));
  return files;
}

}  // namespace ciliaval::compare::study::reader

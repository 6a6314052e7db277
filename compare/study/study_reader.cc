// SPDX-License-Identifier: LGPL-2.1-or-later
// A study file read and checked.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <system_error>
#include <utility>

#include "compare/case_sections.h"
#include "compare/case_syntax.h"
#include "compare/study/study.h"
#include "problem/error.h"
#include "problem/words.h"

namespace ciliaval::compare::study {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_points = 1'000'000;
constexpr std::size_t longest_name = 40;  ///< of a parameter, bytes
constexpr std::array<std::string_view, 4> range_keys{"from", "to", "count", "spacing"};
constexpr Range count_range{2, 100'000, false, "a range has two ends, and a study must end"};
constexpr Range sensor_range{0, 1e6, false, "sensors are counted from 0"};
constexpr Range noise_range{0, 100, true, key::unit_slip};
constexpr Range rotation_range{0, std::numbers::pi / 2, true,
                               "under a horizontal force the tip's rotation stays below 90 deg"};

/// What is read of a study while its faults are gathered.
struct Reading {
  Study study;
  Case base;  ///< the case file's
  std::vector<CaseNumber> numbers;
};

/// The number of this path, or a fault.
const CaseNumber* find_number(const Reading& reading, const std::string& path, Place where,
                              Faults& faults) {
  std::vector<std::string_view> paths;
  for (const CaseNumber& number : reading.numbers) {
    if (number.path == path) return &number;
    paths.push_back(number.path);
  }
  std::string advice = did_you_mean(path, paths);
  if (advice.empty()) advice = fmt::format(" (there are {})", fmt::join(paths, ", "));
  faults.add(where, fmt::format("the case has no number {}{}", in_quotes(path), advice));
  return nullptr;
}

/// A value of a number of the case, or a fault.
std::optional<double> read_number(const toml::node& node, std::string_view name,
                                  const CaseNumber& number, Faults& faults) {
  if (!number.is_whole) return read_value(node, name, number.quantity, number.range, faults);
  const auto whole = read_whole_number(node, name, number.range, faults);
  return whole ? std::optional<double>(*whole) : std::nullopt;
}

/// Adds a fault if something else sets the same already.
void check_contradiction(const Study& study, const CaseNumber& number, Place where,
                         Faults& faults) {
  const auto refuse = [&](const CaseNumber& other) {
    if (other.sets == number.sets)
      faults.add(where, other.path == number.path
                            ? fmt::format("'{}' is set twice", number.path)
                            : fmt::format("'{}' contradicts '{}': set one of them", number.path,
                                          other.path));
  };
  for (const Setting& setting : study.fixed) refuse(setting.number);
  for (const Parameter& parameter : study.parameters) refuse(parameter.number);
}

/// A value under a dotted path of the case's keys.
using Leaf =
    std::function<void(const std::string& path, const toml::key& key, const toml::node& node)>;

/// The values of [fixed] and [tolerances] stand under the case's own keys, as nested tables.
void for_leaves(const toml::table& table, const std::string& prefix, const Leaf& leaf) {
  for (const auto& [key, node] : table) {
    const std::string path =
        prefix.empty() ? std::string(key.str()) : fmt::format("{}.{}", prefix, key.str());
    if (const toml::table* inner = node.as_table())
      for_leaves(*inner, path, leaf);
    else
      leaf(path, key, node);
  }
}

/// [fixed].
void read_fixed(const toml::table& table, Reading& reading, Faults& faults) {
  for_leaves(table, "", [&](const std::string& path, const toml::key& key, const toml::node& node) {
    const CaseNumber* number = find_number(reading, path, place(key), faults);
    if (number == nullptr) return;
    check_contradiction(reading.study, *number, place(key), faults);
    if (const auto value = read_number(node, path, *number, faults))
      reading.study.fixed.push_back({*number, *value});
  });
}

/// The unit of a quantity that has been read: what follows the number.
std::string unit_of(const toml::node& node) {
  const auto* text = node.as_string();
  if (text == nullptr) return {};
  std::string_view rest = text->get();
  const auto skip = [&](std::string_view characters) {
    rest.remove_prefix(std::min(rest.find_first_not_of(characters), rest.size()));
  };
  skip(" +-0123456789._");
  if (rest.size() > 1 && (rest[0] == 'e' || rest[0] == 'E') &&
      std::string_view("+-0123456789").find(rest[1]) != std::string_view::npos) {
    rest.remove_prefix(1);
    skip("+-0123456789");
  }
  skip(" ");
  return std::string(rest);
}

/// The value with 15 significant digits, which a person would have written: 0.3, not
/// 0.30000000000000004.
double rounded(double value) {
  return std::stod(fmt::format("{:.15g}", value));
}

/// The values from one end to the other, both included.
std::vector<double> spaced(double from, double to, unsigned int count, bool logarithmic) {
  std::vector<double> values(count);
  for (unsigned int i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) / (count - 1);
    values[i] = rounded(logarithmic ? from * std::pow(to / from, t) : from + t * (to - from));
  }
  values.front() = from;
  values.back() = to;
  return values;
}

/// `from`, `to`, `count`, `spacing`.
void read_range(Section& table, Parameter& parameter) {
  Faults& faults = table.faults();
  const std::size_t before = faults.size();
  const auto end = [&](std::string_view key) {
    const toml::node* node = table.require(key);
    if (node == nullptr) return std::optional<double>();
    if (parameter.unit.empty()) parameter.unit = unit_of(*node);
    return read_number(*node, key, parameter.number, faults);
  };
  const auto from = end("from");
  const auto to = end("to");
  std::optional<unsigned int> count;
  if (const toml::node* node = table.require("count"))
    count = read_whole_number(*node, "count", count_range, faults);
  if (const toml::node* node = table.find("spacing")) {
    constexpr std::array<std::string_view, 2> spacings{"linear", "logarithmic"};
    parameter.is_logarithmic = read_choice(*node, "spacing", spacings, {}, faults) == spacings[1];
  }
  if (!from || !to || !count || faults.size() != before) return;
  if (*from == *to)
    faults.add(place(*table.find("to")), "'from' and 'to' are the same: there is nothing to vary");
  else if (parameter.is_logarithmic && !(*from * *to > 0))
    faults.add(place(*table.find("spacing")),
               "a logarithmic range has both ends of one sign, and none at zero");
  else
    parameter.values = spaced(*from, *to, *count, parameter.is_logarithmic);
  for (const double v : parameter.values)
    if (parameter.number.is_whole && v != std::floor(v)) {
      faults.add(place(*table.find("count")),
                 fmt::format("'{}' is a whole number, but the range has {:g}: list its 'values'",
                             parameter.number.path, v));
      return;
    }
}

/// `values`.
void read_values(const toml::node& node, Parameter& parameter, Faults& faults) {
  const toml::array* list = node.as_array();
  if (list == nullptr || list->empty() || list->size() > most_points) {
    faults.add(place(node), fmt::format("'values' must be a list of 1 to {} values, found {}",
                                        most_points, describe(node)));
    return;
  }
  parameter.unit = unit_of(list->front());
  for (const toml::node& element : *list) {
    const auto value = read_number(element, "values", parameter.number, faults);
    if (!value) continue;
    if (std::find(parameter.values.begin(), parameter.values.end(), *value) !=
        parameter.values.end())
      faults.add(place(element), "the value is listed twice");
    parameter.values.push_back(*value);
  }
}

void read_parameter(Section& table, Reading& reading) {
  Faults& faults = table.faults();
  const std::size_t before = faults.size();
  const toml::node* path_node = table.require("path");
  const toml::node* name = table.find("name");
  const toml::node* values = table.find("values");
  const std::optional<std::string> path =
      path_node != nullptr ? read_text(*path_node, "path", faults) : std::nullopt;
  const CaseNumber* number =
      path ? find_number(reading, *path, place(*path_node), faults) : nullptr;
  if (number == nullptr) {  // which values it may have cannot be told
    for (const std::string_view key : range_keys) table.find(key);
    table.finish();
    return;
  }
  Parameter parameter{*number, path->substr(path->find_last_of('.') + 1), {}, 1, {}, false};
  check_contradiction(reading.study, *number, place(*path_node), faults);
  if (name != nullptr)
    parameter.name = read_line(*name, "name", longest_name, faults).value_or(parameter.name);
  const bool has_range = table.table()->contains("from") || table.table()->contains("to");
  if (values != nullptr && has_range)
    faults.add(place(*values), "'values' contradicts 'from' and 'to': give one of them");
  if (values == nullptr && !has_range)
    faults.add(table.where(), "[[parameter]] needs 'values', or 'from', 'to' and 'count'");
  if (values != nullptr) {
    read_values(*values, parameter, faults);
    for (const std::string_view key : range_keys) table.find(key);
  } else {
    read_range(table, parameter);
  }
  table.finish();
  if (faults.size() != before) return;
  if (!parameter.unit.empty())
    parameter.unit_size = parse_quantity("1 " + parameter.unit, number->quantity);
  reading.study.parameters.push_back(std::move(parameter));
}

void read_parameters(Section& root, bool has_tolerances, Reading& reading) {
  Faults& faults = root.faults();
  const toml::node* node = root.find("parameter");
  const toml::array* list = node != nullptr ? node->as_array() : nullptr;
  if (node == nullptr && has_tolerances) return;
  if (list == nullptr || list->empty()) {
    faults.add(node != nullptr ? place(*node) : Place{},
               "a study varies one parameter or more: write [[parameter]] with 'path' and "
               "'values', or [tolerances]");
    return;
  }
  for (const toml::node& element : *list) {
    if (!element.is_table()) {
      faults.add(place(element),
                 fmt::format("expected a table [[parameter]], found {}", describe(element)));
      continue;
    }
    Section table(element.as_table(), "[[parameter]]", "parameter", place(element), faults);
    read_parameter(table, reading);
  }
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
void read_deviation(const toml::node& node, Tolerance& tolerance, Faults& faults) {
  const CaseNumber& number = tolerance.number;
  const double largest = std::max(std::abs(number.range.lower), std::abs(number.range.upper));
  const Range range{0, largest, true, "a standard deviation is positive"};
  if (const auto part = percentage(node)) {
    tolerance.deviation = std::abs(*part * tolerance.nominal);
    if (!(*part > 0 && tolerance.deviation > 0))
      faults.add(place(node), fmt::format("'{}': a percentage is positive, and of a value that is "
                                          "not zero",
                                          number.path));
  } else if (const auto value = read_value(node, number.path, number.quantity, range, faults)) {
    tolerance.deviation = *value;
    tolerance.unit = unit_of(node);
  }
  const double reach = 2 * tolerance_step * tolerance.deviation;
  for (const double moved : {tolerance.nominal - reach, tolerance.nominal + reach})
    if (!number.range.contains(moved))
      faults.add(place(node), fmt::format("'{}' moved by half of its tolerance is {}, but must be "
                                          "{}",
                                          number.path, format_quantity(moved, number.quantity),
                                          describe(number.range, number.quantity)));
}

/// [tolerances].
void read_tolerances(const toml::table& table, Reading& reading, Faults& faults) {
  const Case nominal = with_settings(reading.base, reading.study.fixed);
  for_leaves(table, "", [&](const std::string& path, const toml::key& key, const toml::node& node) {
    const CaseNumber* number = find_number(reading, path, place(key), faults);
    if (number == nullptr) return;
    if (number->is_whole)
      return faults.add(place(key),
                        fmt::format("'{}' is a whole number: it has no tolerance", path));
    Tolerance tolerance{*number, number->get(nominal), 0, {}, 1};
    const std::size_t before = faults.size();
    read_deviation(node, tolerance, faults);
    if (faults.size() != before) return;
    if (tolerance.unit.empty())
      tolerance.unit = number->quantity.unit;
    else
      tolerance.unit_size = parse_quantity("1 " + tolerance.unit, number->quantity);
    reading.study.tolerances.push_back(std::move(tolerance));
  });
}

/// Every pair of models that can be formed.
std::vector<std::string> all_pairs() {
  std::vector<std::string> pairs;
  for (const std::string_view mechanics : mechanics_ids())
    for (const std::string_view field : field_ids())
      if (field != "mesh" || mechanics == "solid" || mechanics == "calculix")
        pairs.push_back(fmt::format("{}/{}", mechanics, field));
  return pairs;
}

/// The texts of a list, each one of the choices and none twice; an empty list is a fault.
std::vector<std::string> read_choices(const toml::node& node, std::string_view name,
                                      std::span<const std::string_view> choices, Faults& faults) {
  std::vector<std::string> texts;
  const toml::array* list = node.as_array();
  if (list == nullptr || list->empty()) {
    faults.add(place(node),
               fmt::format("'{}' must be a list, such as [\"{}\"], found {}", name, choices.front(),
                           list == nullptr ? describe(node) : "an empty one"));
    return texts;
  }
  for (const toml::node& element : *list) {
    const std::optional<std::string> text = read_choice(element, name, choices, {}, faults);
    if (!text) continue;
    if (std::find(texts.begin(), texts.end(), *text) != texts.end())
      faults.add(place(element), fmt::format("'{}' lists {} twice", name, in_quotes(*text)));
    else
      texts.push_back(*text);
  }
  return texts;
}

void read_pairs(Section& table, Study& study) {
  const toml::node* node = table.require("pairs");
  if (node == nullptr) return;
  const std::vector<std::string> names = all_pairs();
  const std::vector<std::string_view> choices(names.begin(), names.end());
  for (const std::string& text : read_choices(*node, "pairs", choices, table.faults())) {
    const std::size_t slash = text.find('/');
    study.pairs.push_back({text.substr(0, slash), text.substr(slash + 1)});
  }
}

void read_outputs(Section& table, Study& study) {
  study.outputs = {Output::dB_x, Output::dB_y, Output::dB_z, Output::dB_norm};
  const toml::node* node = table.find("outputs");
  if (node == nullptr) return;
  std::vector<std::string_view> choices;
  for (const Output output : all_outputs()) choices.push_back(id(output));
  const std::vector<std::string> ids = read_choices(*node, "outputs", choices, table.faults());
  study.outputs.clear();
  for (const Output output : all_outputs())
    if (std::find(ids.begin(), ids.end(), id(output)) != ids.end()) study.outputs.push_back(output);
}

/// A quantity that goes with an output.
std::optional<double> read_companion(Section& table, std::string_view name,
                                     const Quantity& quantity, const Range& range, bool needed,
                                     std::string_view with) {
  Faults& faults = table.faults();
  const toml::node* node = table.find(name);
  if (node == nullptr) {
    if (needed)
      faults.add(table.where(),
                 fmt::format("{} needs '{}', such as \"{}\"", with, name, quantity.example));
    return std::nullopt;
  }
  if (!needed) faults.add(place(*node), fmt::format("'{}' goes with {} only", name, with));
  return read_value(*node, name, quantity, range, faults);
}

/// The sensor of the study: the one that it names, or the only one.
void choose_sensor(Section& table, Case& base) {
  Faults& faults = table.faults();
  std::size_t index = 0;
  const toml::node* node = table.find("sensor");
  if (node != nullptr) index = read_whole_number(*node, "sensor", sensor_range, faults).value_or(0);
  if (node == nullptr && base.sensors.size() > 1)
    faults.add(table.where(),
               fmt::format("the case has {} sensors: 'sensor' says which one, from 0",
                           base.sensors.size()));
  if (base.sensors.empty())
    faults.add(table.where(), "the case has no [sensor], so there is no field to study");
  else if (index >= base.sensors.size())
    faults.add(place(*node), fmt::format("the case has no sensor {}: they are 0 to {}", index,
                                         base.sensors.size() - 1));
  else
    base.sensors = {base.sensors[index]};
}

/// The case that [study] names, read; throws InputError with the case file's own faults.
bool read_base(Section& table, const fs::path& file, Case& base) {
  Faults& faults = table.faults();
  const toml::node* node = table.require("case");
  const std::optional<std::string> name =
      node != nullptr ? read_text(*node, "case", faults) : std::nullopt;
  if (!name) return false;
  const fs::path path = (file.parent_path() / *name).lexically_normal();
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {
    faults.add(place(*node), fmt::format("there is no case file '{}': a name without a leading / "
                                         "is looked for beside the study file",
                                         path.string()));
    return false;
  }
  base = read_case(path);
  base.external.clear();
  return true;
}

void read_study_table(Section& table, Reading& reading) {
  Faults& faults = table.faults();
  Study& study = reading.study;
  read_name_and_title(table, study.name, study.title);
  if (const toml::node* node = table.find("combine")) {
    constexpr std::array<std::string_view, 2> choices{"product", "zip"};
    study.is_zipped = read_choice(*node, "combine", choices, {}, faults) == choices[1];
  }
  read_pairs(table, study);
  read_outputs(table, study);
  study.noise = read_companion(table, "noise", quantity::flux_density, noise_range,
                               study.asks_for(Output::resolution), "the output 'resolution'");
  if (reading.numbers.empty()) {  // there is no case
    for (const std::string_view key : {"sensor", "rotation"}) table.find(key);
    return;
  }
  choose_sensor(table, reading.base);
  const bool slips = contact_height(reading.base.load_path.front()).has_value();
  study.rotation = read_companion(
      table, "rotation", quantity::angle, rotation_range, study.asks_for(Output::range) && !slips,
      "the output 'range' of a load that has no slip-off (flow, section, dead)");
}

bool is_same(const Load& a, const Load& b) {
  const auto arclength = [](const Load& load) {
    const auto* section = std::get_if<SectionLoad>(&load);
    return section != nullptr ? section->arclength : 0;
  };
  return magnitude(a) == magnitude(b) && azimuth(a) == azimuth(b) &&
         contact_height(a) == contact_height(b) && arclength(a) == arclength(b);
}

/// Makes one load step of the case's: they must be the same but for what the study sets.
void reduce_to_one_step(Study& study, Place where, Faults& faults) {
  Case& base = study.base;
  // The tolerances are those of the case with its fixed numbers alone.
  const Case set = study.case_at(study.tolerances.empty() ? 0 : study.point_count());
  const auto differs = [&](const Load& step) { return !is_same(step, set.load_path.front()); };
  if (std::any_of(set.load_path.begin(), set.load_path.end(), differs)) {
    faults.add(where, fmt::format("the case has {} load steps, a study's points one: say which "
                                  "load under [fixed], such as load.{} = \"{}\"",
                                  base.load_path.size(), key::load_force.name,
                                  key::load_force.quantity.example));
    return;
  }
  base.load_path.resize(1);
  for (std::vector<double>* values :
       {&base.flow_velocity, &base.flow_density, &base.flow_drag_coefficient})
    if (!values->empty()) values->erase(values->begin() + 1, values->end());
}

/// Checks each point as a case file would be; the first that cannot be is a fault.
void check_points(const Study& study, Place where, Faults& faults) {
  const toml::table root = parse_toml(to_toml(study.base), study.name);
  for (std::size_t i = 0; i < study.all_points(); ++i) {
    const Case c = study.case_at(i);
    std::string fault;
    Faults of_point;
    check_together(root, c, {true, true, true}, of_point);
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

/// What must hold among tables of which each is right by itself.
void check_study(Study& study, Place where, Faults& faults) {
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

}  // namespace

Study read_study(const fs::path& file) {
  const toml::table root_table = parse_toml(read_toml_file(file, "study"), file.string());
  Faults faults;
  Section root(&root_table, "the study file", "", {}, faults);
  Reading reading;
  Section header = require_section(root, "study");
  if (header.exists() && read_base(header, file, reading.base))
    reading.numbers = case_numbers(reading.base);
  if (header.exists()) read_study_table(header, reading);
  header.finish();
  const Section fixed = root.section("fixed");
  const Section tolerances = root.section("tolerances");
  if (!reading.numbers.empty()) {
    // The paths of the sensor are those of the one that was chosen.
    reading.numbers = case_numbers(reading.base);
    if (fixed.exists()) read_fixed(*fixed.table(), reading, faults);
    if (tolerances.exists()) read_tolerances(*tolerances.table(), reading, faults);
    read_parameters(root, tolerances.exists() && !tolerances.table()->empty(), reading);
  } else {
    root.find("parameter");
  }
  root.finish();
  Study& study = reading.study;
  study.base = std::move(reading.base);
  study.base.mechanics = study.mechanics();
  study.base.fields.clear();
  for (const Pair& pair : study.pairs)
    if (std::find(study.base.fields.begin(), study.base.fields.end(), pair.field) ==
        study.base.fields.end())
      study.base.fields.push_back(pair.field);
  if (faults.empty()) check_study(study, header.where(), faults);
  if (!faults.empty()) throw InputError(faults.report(file.string()));
  return std::move(reading.study);
}

}  // namespace ciliaval::compare::study

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/measurement/measurement.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "compare/input/case_sections.h"
#include "compare/input/described.h"
#include "compare/results/quantity.h"
#include "problem/support/words.h"

namespace ciliaval::compare::input::measurement {
namespace {

constexpr std::size_t longest_name = 300;         ///< of a file, bytes
constexpr std::size_t most_tables = most_values;  ///< a file's values are written back as tables
constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};

using description::any_quantity_key;
using description::text_key;

struct MeasurementKeys {
  description::Key quantity =
      text_key("quantity",
               "What was measured (docs/guide/validation.md): `tip.x`, `tip.y`, `tip.z`, "
               "`tip.deflection`, `tip.theta`, a number of the results such as `slip_off_force`, "
               "or at a sensor `B.NAME.x`, `dB.NAME.x` …",
               "", R"("tip.deflection")");
  description::Field<Measurand> point = description::optional(
      description::field(&Measurand::point, "point", quantity::length,
                         {-100, 100, false, unit_slip},
                         "`tip.…`: the point `[X, Y]` of the end section that was measured, from "
                         "its centre."),
      "the centre");
  description::Key step = [] {
    description::Key key =
        text_key("step", "Load step of `value`, counted from 0.", "that of the only step");
    key.initial = 0U;
    return key;
  }();
  description::Key value = any_quantity_key("value", "The measured value.", "`file`", "3.2 mm");
  description::Key file =
      text_key("file",
               "CSV file with the values, beside the case file unless absolute: a row for each "
               "load step.",
               "`value`", "", 0);
  description::Key column =
      text_key("column", "`file`: name of the column with the values.", "`\"value\"`");
  description::Key load =
      text_key("load",
               "`file`: the column with the load of each row, which names its step; `\"x [mT]\"` "
               "states its unit. `\"in order\"`: the rows are the load steps in their order.",
               "a column in the load's unit, else `\"in order\"`", R"("field [mT]")");
  description::Key scale =
      any_quantity_key("scale", "`file`: what a 1 is in a column without a unit.",
                       "a unit in the header", "17.2 mm");
  description::Key uncertainty =
      any_quantity_key("uncertainty",
                       "Standard uncertainty u_D of each value: reading, datum, repeats; or a part "
                       "of it, `\"2 %\"`.",
                       "a column of the `file`", "0.1 mm");
  description::Key source = text_key("source", "Where the values are from.");
  description::Key fitted = [] {
    description::Key key = text_key(
        "fitted", "Whether parameters of the case were fitted to these values.", "`false`");
    key.initial = false;
    return key;
  }();
};
const MeasurementKeys& of_measurement() {
  static const MeasurementKeys keys;
  return keys;
}

description::Key range_key() {
  description::Key key =
      any_quantity_key("range", "In place of that: between these ends every value is as likely.",
                       "`uncertainty`", R"(["0", "0.6"])");
  key.initial = std::array<double, 2>{};
  return key;
}
struct InputKeys {
  description::Key number =
      text_key("number",
               "A number of the case, named as in a study (docs/guide/studies.md); of load and "
               "environment at every step.",
               "", R"("cilium.segment.base.young_modulus")");
  description::Key uncertainty = any_quantity_key(
      "uncertainty", "Its standard uncertainty, in its unit or as a part of it, `\"2 %\"`.",
      "`range`", "0.05 MPa");
  description::Key range = range_key();
  description::Key source = text_key("source", "Where it is from.", "none");
};
const InputKeys& of_input() {
  static const InputKeys keys;
  return keys;
}

std::optional<std::string> read_line(const toml::node& node, const description::Key& key,
                                     Faults& faults) {
  return input::read_line(node, key.name, key.longest, faults);
}

Range range_of(const Measurand& measurand) {
  if (measurand.quantity().unit == quantity::angle.unit)
    return {-2 * std::numbers::pi, 2 * std::numbers::pi, false, "an angle is from +z"};
  return {-100, 100, false, unit_slip};
}

/// "B.left.x" taken apart: what, which sensor, which component; empty parts where there is none.
struct Parts {
  std::string_view what;
  std::string_view sensor;
  std::string_view component;
};
Parts parts_of(std::string_view name) {
  const auto first = name.find('.');
  const auto last = name.rfind('.');
  if (first == std::string_view::npos) return {name, {}, {}};
  return {name.substr(0, first),
          first == last ? std::string_view{} : name.substr(first + 1, last - first - 1),
          name.substr(last + 1)};
}

std::optional<std::size_t> axis_of(std::string_view component) {
  const auto found = std::ranges::find(axes, component);
  if (found == axes.end()) return std::nullopt;
  return static_cast<std::size_t>(found - axes.begin());
}

/// A quantity of one number that models compute and people can measure; angles are `tip.theta`.
bool is_measured(const results::Quantity& quantity) {
  return quantity.components.empty() && quantity.is_accepted && !quantity.is_estimate &&
         quantity.kind.unit != quantity::angle.unit;
}

/// The names that a case may measure, of very many sensors those of the first.
std::vector<std::string> valid_names(const Case& c) {
  constexpr std::size_t most_sensors = 4;
  std::vector<std::string> names{"tip.x", "tip.y", "tip.z", "tip.deflection", "tip.theta"};
  for (std::size_t s = 0; s < std::min(c.sensors.size(), most_sensors); ++s)
    for (const char* what : {"B", "dB"})
      for (const std::string_view axis : axes)
        names.push_back(fmt::format("{}.{}.{}", what, sensor_name(c, s), axis));
  for (const results::Quantity& quantity : results::quantities())
    if (is_measured(quantity)) names.emplace_back(quantity.name);
  return names;
}

std::optional<Measurand> measurand_of(std::string_view name, const Case& c) {
  using Kind = Measurand::Kind;
  const Parts parts = parts_of(name);
  Measurand result;
  result.name = name;
  const auto& numbers = results::quantities();
  const auto number = std::ranges::find(numbers, name, &results::Quantity::name);
  if (number != numbers.end() && is_measured(*number)) {
    result.kind = Kind::number;
    result.index = static_cast<std::size_t>(number - numbers.begin());
    return result;
  }
  const auto axis = axis_of(parts.component);
  result.axis = axis.value_or(0);
  if (parts.what == "tip" && parts.sensor.empty()) {
    result.kind = axis                              ? Kind::position
                  : parts.component == "deflection" ? Kind::deflection
                                                    : Kind::angle;
    if (axis || parts.component == "deflection" || parts.component == "theta") return result;
  }
  if (!axis || (parts.what != "B" && parts.what != "dB")) return std::nullopt;
  result.kind = parts.what == "B" ? Kind::B : Kind::dB;
  const std::vector<std::string> sensors = sensor_names(c);
  const auto sensor = std::ranges::find(sensors, parts.sensor);
  if (sensor == sensors.end()) return std::nullopt;
  result.sensor = static_cast<std::size_t>(sensor - sensors.begin());
  return result;
}

/// The measurand, or a fault.
std::optional<Measurand> read_quantity(const toml::node& node, const Case& c, Faults& faults) {
  const std::optional<std::string> name = read_text(node, of_measurement().quantity.name, faults);
  if (!name) return std::nullopt;
  std::optional<Measurand> measurand = measurand_of(*name, c);
  const Parts parts = parts_of(*name);
  if (!measurand) {
    const std::vector<std::string> valid = valid_names(c);
    const std::vector<std::string_view> candidates(valid.begin(), valid.end());
    const std::string without = c.sensors.empty() && (parts.what == "B" || parts.what == "dB")
                                    ? "; a field needs a place: add [sensor] with 'position'"
                                    : support::did_you_mean(*name, candidates);
    faults.add(place(node),
               fmt::format("'quantity' cannot be {} (valid: {}{}){}", in_quotes(*name),
                           fmt::join(valid, ", "), c.sensors.size() > 4 ? ", …" : "", without));
  } else if (measurand->is_field() && c.fields.empty() && c.external.empty()) {
    faults.add(place(node), fmt::format("{} needs a field model: list one in 'fields' of [models]",
                                        in_quotes(*name)));
    return std::nullopt;
  }
  return measurand;
}

/// True if the section, a tube's hole included, holds the point, to rounding.
bool is_in_section(const std::array<double, 2>& point, const Cilium& cilium) {
  constexpr double rounding = 1 + 1e-9;
  const auto [x, y] = point;
  if (!cilium.is_rectangular()) return std::hypot(x, y) <= rounding * cilium.radius();
  const double c = std::cos(cilium.section.orientation);
  const double s = std::sin(cilium.section.orientation);
  return std::abs(c * x + s * y) <= rounding * cilium.section.width / 2 &&
         std::abs(c * y - s * x) <= rounding * cilium.section.height / 2;
}

/// The point [X, Y] of the end section.
void read_point_of_end(const toml::node& node, const Case& c, bool case_is_right,
                       Measurand& measurand, Faults& faults) {
  using Kind = Measurand::Kind;
  if (measurand.kind != Kind::position && measurand.kind != Kind::deflection)
    return faults.add(place(node), "'point' goes with tip.x, tip.y, tip.z and tip.deflection");
  const auto value = read_value(node, of_measurement().point, faults);
  if (!value) return;
  of_measurement().point.set(measurand, *value);
  if (case_is_right && !is_in_section(measurand.point, c.cilium))
    faults.add(place(node), "'point' lies outside the end section");
}

/// A standard uncertainty: absolute, or relative as a percentage.
struct Uncertainty {
  std::optional<double> absolute;
  std::optional<double> relative;
};
Uncertainty read_uncertainty(const toml::node& node, const Measurand& measurand, Faults& faults) {
  const std::string_view name = of_measurement().uncertainty.name;
  constexpr std::string_view reason =
      "it is the standard uncertainty u_D of the value, and nothing is measured without one";
  if (const auto* text = node.as_string();
      text != nullptr && support::trimmed(text->get()).ends_with('%')) {
    const auto percent =
        read_value(node, name, quantity::percentage, {0, 1000, true, reason}, faults);
    return {std::nullopt, percent ? std::optional(*percent / 100) : std::nullopt};
  }
  return {read_value(node, name, measurand.quantity(), {0, 100, true, reason}, faults),
          std::nullopt};
}

void refuse_with(Section& table, const description::Key& other,
                 std::initializer_list<const description::Key*> keys) {
  for (const description::Key* key : keys)
    if (const toml::node* node = table.find(key->name))
      table.faults().add(place(*node), fmt::format("'{}' goes with '{}'", key->name, other.name));
}

/// The step of a single value: required unless there is only one.
std::size_t read_step(Section& table, const Case& c, bool case_is_right) {
  const bool is_single = case_is_right && c.load_path.size() == 1;
  const std::string_view key = of_measurement().step.name;
  const toml::node* node = is_single ? table.find(key) : table.require(key);
  if (node == nullptr) return 0;
  const auto last = static_cast<double>(case_is_right ? c.load_path.size() - 1 : 100000);
  return read_whole_number(*node, key, {0, last, false, "the load steps are counted from 0"},
                           table.faults())
      .value_or(0);
}

void read_file(Section& table, const std::filesystem::path& folder, const Uncertainty& uncertainty,
               Measurement all, const Case& c, std::vector<MeasuredFile>& files) {
  Faults& faults = table.faults();
  MeasuredFile result;
  result.at = c.measured.measurements.size();
  result.all = std::move(all);
  result.uncertainty = uncertainty.absolute;
  result.relative_uncertainty = uncertainty.relative;
  const MeasurementKeys& keys = of_measurement();
  if (const auto name =
          input::read_line(*table.find(keys.file.name), keys.file.name, longest_name, faults))
    result.path = std::filesystem::absolute(folder / *name).lexically_normal();
  if (const toml::node* node = table.find(keys.column.name))
    result.column = read_line(*node, keys.column, faults).value_or("");
  if (const toml::node* node = table.find(keys.load.name))
    result.load = read_line(*node, keys.load, faults).value_or("");
  if (const toml::node* node = table.find(keys.scale.name))
    result.scale = read_value(*node, keys.scale.name, result.all.measurand.quantity(),
                              range_of(result.all.measurand), faults);
  files.push_back(std::move(result));
}

void read_measurement(Section& table, const std::filesystem::path& folder, bool case_is_right,
                      Case& c, std::vector<MeasuredFile>& files) {
  Faults& faults = table.faults();
  Measurement result;
  const MeasurementKeys& keys = of_measurement();
  const toml::node* name = table.require(keys.quantity.name);
  for (const description::Key* key : measurement_keys()) table.find(key->name);
  const toml::node* uncertainty = table.find(keys.uncertainty.name);
  if (const toml::node* node = table.require(keys.source.name))
    result.source = read_line(*node, keys.source, faults).value_or("");
  if (const toml::node* node = table.find(keys.fitted.name))
    result.fitted = std::get<bool>(read_value(*node, keys.fitted, faults).value_or(false));
  const auto measurand = name == nullptr ? std::nullopt : read_quantity(*name, c, faults);
  if (!measurand) return;  // what the values are is not known
  result.measurand = *measurand;
  if (const toml::node* node = table.find(keys.point.name))
    read_point_of_end(*node, c, case_is_right, result.measurand, faults);
  const Uncertainty u = uncertainty == nullptr
                            ? Uncertainty{}
                            : read_uncertainty(*uncertainty, result.measurand, faults);
  const toml::node* value = table.find(keys.value.name);
  const toml::node* file = table.find(keys.file.name);
  if ((value == nullptr) == (file == nullptr))
    return faults.add(table.where(),
                      fmt::format("{} needs either 'value' or 'file'", table.name()));
  if (file != nullptr) {
    refuse_with(table, keys.value, {&keys.step});
    return read_file(table, folder, u, result, c, files);
  }
  refuse_with(table, keys.file, {&keys.column, &keys.load, &keys.scale});
  table.require(keys.uncertainty.name);
  result.step = read_step(table, c, case_is_right);
  const auto measured =
      read_value(*value, keys.value.name, measurand->quantity(), range_of(*measurand), faults);
  result.value = measured.value_or(0);
  result.uncertainty = u.absolute.value_or(u.relative.value_or(0) * std::abs(result.value));
  if (measured && u.relative && result.uncertainty == 0)
    faults.add(place(*uncertainty),
               "'uncertainty': a part of zero is zero: state it in the unit of the value");
  c.measured.measurements.push_back(std::move(result));
}

void read_input(Section& table, std::string_view file, std::vector<InputUncertainty>& inputs) {
  Faults& faults = table.faults();
  const InputKeys& keys = of_input();
  InputUncertainty result;
  const auto at = [&](const toml::node& node, const description::Key& key) {
    return fmt::format("{}:{}:{}: {} {}", file, place(node).line, place(node).column, table.name(),
                       key.name);
  };
  if (const toml::node* node = table.require(keys.number.name)) {
    result.number = read_line(*node, keys.number, faults).value_or("");
    result.number_place = at(*node, keys.number);
  }
  const toml::node* range = table.find(keys.range.name);
  const description::Key& key = range != nullptr ? keys.range : keys.uncertainty;
  const auto read_one = [&](const toml::node& node) {
    result.is_plain = result.is_plain || node.is_number();
    result.uncertainty.push_back(node.is_number() ? format_number(node.value<double>().value_or(0))
                                                  : read_line(node, key, faults).value_or(""));
  };
  if (range != nullptr) {
    result.uncertainty_place = at(*range, key);
    const toml::array* ends = range->as_array();
    if (ends == nullptr || ends->size() != 2)
      faults.add(place(*range),
                 "'range' is the two ends of a range, as in [\"0.08 MPa\", \"0.12 "
                 "MPa\"]");
    else
      for (const toml::node& end : *ends) read_one(end);
    if (const toml::node* both = table.find(keys.uncertainty.name))
      faults.add(place(*both), "'uncertainty' and 'range' say the same: leave out one of the two");
  } else if (const toml::node* node = table.require(keys.uncertainty.name)) {
    result.uncertainty_place = at(*node, key);
    read_one(*node);
  }
  if (const toml::node* node = table.find(keys.source.name))
    result.source = read_line(*node, keys.source, faults).value_or("");
  inputs.push_back(std::move(result));
}

std::string quantity_text(double value, const Quantity& quantity) {
  const std::string text = format_quantity(value, quantity);
  return quantity.unit.empty() ? text : fmt::format("\"{}\"", text);
}

/// `key = value`.
std::string line(const description::Key& key, std::string_view value) {
  return fmt::format("{} = {}\n", key.name, value);
}

std::string to_toml(const Measurement& m) {
  const MeasurementKeys& keys = of_measurement();
  const Measurand& what = m.measurand;
  const Quantity& quantity = what.quantity();
  std::string text = fmt::format("\n[[{}]]\n", measurement_table);
  text += line(keys.quantity, toml_text(what.name));
  if (what.point != std::array<double, 2>{})
    text += line(keys.point, input::to_toml(keys.point, keys.point.get(what)));
  text += line(keys.step, fmt::to_string(m.step));
  text += line(keys.value, quantity_text(m.value, quantity));
  text += line(keys.uncertainty, quantity_text(m.uncertainty, quantity));
  text += line(keys.source, toml_text(m.source));
  return text + line(keys.fitted, fmt::to_string(m.fitted));
}

std::string to_toml(const InputUncertainty& input) {
  const InputKeys& keys = of_input();
  std::string text = fmt::format("\n[[{}]]\n", input_table);
  text += line(keys.number, toml_text(input.number));
  const auto one = [&](const std::string& value) {
    return input.is_plain ? value : toml_text(value);
  };
  if (input.uncertainty.size() == 2)
    text += line(keys.range,
                 fmt::format("[{}, {}]", one(input.uncertainty[0]), one(input.uncertainty[1])));
  else
    text += line(keys.uncertainty, one(input.uncertainty.front()));
  return input.source.empty() ? text : text + line(keys.source, toml_text(input.source));
}

}  // namespace

std::vector<const description::Key*> measurement_keys() {
  const MeasurementKeys& k = of_measurement();
  return {&k.quantity, &k.point, &k.step,        &k.value,  &k.file,  &k.column,
          &k.load,     &k.scale, &k.uncertainty, &k.source, &k.fitted};
}

std::vector<const description::Key*> input_keys() {
  const InputKeys& k = of_input();
  return {&k.number, &k.uncertainty, &k.range, &k.source};
}

const Quantity& Measurand::quantity() const {
  if (kind == Kind::number) return results::quantities().at(index).kind;
  if (kind == Kind::angle) return ciliaval::quantity::angle;
  return is_field() ? ciliaval::quantity::flux_density : ciliaval::quantity::length;
}

std::vector<MeasuredFile> read_measurements(Section& root, std::string_view file,
                                            bool case_is_right, Case& c) {
  std::vector<MeasuredFile> files;
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  root.tables(measurement_table, 0, most_tables,
              [&](Section& table) { read_measurement(table, folder, case_is_right, c, files); });
  root.tables(input_table, 0, most_tables,
              [&](Section& table) { read_input(table, file, c.measured.inputs); });
  return files;
}

std::string to_toml(const Statement& statement) {
  std::string text;
  for (const Measurement& m : statement.measurements) text += to_toml(m);
  for (const InputUncertainty& input : statement.inputs) text += to_toml(input);
  return text;
}

}  // namespace ciliaval::compare::input::measurement

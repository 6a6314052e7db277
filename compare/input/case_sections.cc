// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/case_sections.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

#include "compare/input/described.h"
#include "problem/description/cilium.h"
#include "problem/support/words.h"

namespace ciliaval::compare::input {
namespace {

constexpr std::size_t most_segments = 1000;
constexpr std::size_t most_sensors = 10000;
constexpr std::size_t longest_title = 200;  ///< bytes
constexpr std::size_t longest_name = 100;

void read_segments(Section& cilium, std::vector<Segment>& segments) {
  cilium.require("segment");
  cilium.tables("segment", 1, most_segments, [&](Section& table) {
    Segment segment;
    read(table, description::fields<Segment>(), segment);
    const bool known = std::any_of(segments.begin(), segments.end(),
                                   [&](const Segment& s) { return s.name == segment.name; });
    if (known && !segment.name.empty())
      table.faults().add(
          place(*table.find("name")),
          fmt::format("the segment name {} is already taken", in_quotes(segment.name)));
    segments.push_back(std::move(segment));
  });
}

void read_options(Section& models, const Models& known, ModelOptions& options) {
  known.for_each([&](const auto& entry) {
    Section table = models.section(entry.id);
    read(table, entry.options, options);
    if (entry.tables.read) entry.tables.read(table, options);
    table.finish();
  });
}

/// Diameter, and [cilium.section] where it is not the full circle.
void read_cross_section(Section& cilium, Cilium& result) {
  Faults& faults = cilium.faults();
  CrossSection& section = result.section;
  Section table = cilium.section("section");
  const std::size_t before = faults.size();
  if (table.exists()) read(table, description::fields<CrossSection>(), section);
  table.finish();
  const toml::node* diameter = cilium.find(description::diameter_key);
  if (section.shape == CrossSection::Shape::rectangle) {
    if (diameter != nullptr)
      faults.add(place(*diameter), "a rectangle has 'width' and 'height' in place of 'diameter'");
    return;
  }
  if (faults.size() != before && diameter == nullptr) return;  // it may be a rectangle
  read(cilium, description::fields<Cilium>(), result);
  if (const toml::node* hole = table.find(description::inner_diameter_key);
      hole != nullptr && diameter != nullptr && result.diameter > 0 &&
      section.inner_diameter >= result.diameter)
    faults.add(place(*hole), fmt::format("the hole of a tube is narrower than its 'diameter', {}",
                                         format_quantity(result.diameter, quantity::length)));
}

/// `axes`, `rotation` and `components` of a chip.
Chip read_chip(Section& table) {
  Faults& faults = table.faults();
  Chip chip;
  if (const toml::node* node = table.find(keys().sensor_axes.name)) {
    chip.axes = read_choices(*node, keys().sensor_axes.name, axis_names(), faults);
    std::string letters;
    for (const std::string& axis : chip.axes) letters += axis.back();
    std::ranges::sort(letters);
    if (letters != "xyz")
      faults.add(place(*node),
                 "'axes' has where the chip's own x, y and z point in the case, such as [\"+y\", "
                 "\"-x\", \"+z\"]: each of x, y, z once");
  }
  if (const toml::node* node = table.find(keys().sensor_rotation.name))
    if (const auto value = read_value(*node, keys().sensor_rotation, faults))
      chip.rotation = std::get<Vector3>(*value);
  if (const toml::node* node = table.find(keys().sensor_gain.name))
    if (const auto value = read_value(*node, keys().sensor_gain, faults))
      chip.gain = std::get<double>(*value);
  if (const toml::node* node = table.find(keys().sensor_components.name)) {
    chip.components = read_choices(*node, keys().sensor_components.name, component_names(), faults);
    if (chip.components.empty())
      faults.add(place(*node), "'components' is empty: name one of x, y, z or more");
  }
  return chip;
}

/// [[sensor]]: the sensors by name.
void read_named_sensors(Section& root, Case& c) {
  root.tables("sensor", 1, most_sensors, [&](Section& table) {
    Faults& faults = table.faults();
    std::string name;
    if (const toml::node* node = table.require(keys().sensor_name.name)) {
      name = read_text(*node, keys().sensor_name.name, faults).value_or("unknown");
      const bool is_number = name.find_first_not_of("0123456789") == std::string::npos;
      if (!is_plain_file_name(name) || is_number)
        faults.add(place(*node),
                   fmt::format("the sensor name {} must be letters, digits, '.', '_' and '-', not "
                               "digits alone, which are a sensor's number",
                               in_quotes(name)));
      if (std::ranges::any_of(c.sensor_names, [&](const std::string& other) {
            return support::equal_but_case(name, other);
          }))
        faults.add(place(*node),
                   fmt::format("the sensor name {} is already taken", in_quotes(name)));
    }
    std::optional<Vector3> point;
    if (const toml::node* node = table.require(keys().sensor_position.name))
      point = read_point(*node, keys().sensor_position, faults);
    c.sensor_names.push_back(std::move(name));
    c.sensors.push_back(point.value_or(Vector3::Zero()));
    c.chips.push_back(read_chip(table));
  });
}

}  // namespace

bool is_plain_file_name(std::string_view name) {
  constexpr const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-";
  return !name.empty() && name.size() <= longest_name && name.front() != '.' &&
         name.front() != '-' && name.find_first_not_of(plain) == std::string_view::npos;
}

std::optional<Vector3> read_point(const toml::node& node, const description::Key& k,
                                  Faults& faults) {
  const toml::array* list = node.as_array();
  if (list == nullptr || list->size() != 3) {
    const std::string what =
        k.quantity.name == quantity::length.name
            ? "be a point: a point has three coordinates, such as [\"0 mm\", \"0 mm\", "
              "\"-1.55 mm\"]"
            : fmt::format("have three components along x, y and z, each {} {} such as \"{}\"",
                          k.quantity.article, k.quantity.name, k.quantity.example);
    faults.add(place(node),
               fmt::format("'{}' must {}; found {}", k.name, what,
                           list == nullptr ? describe(node) : fmt::format("{}", list->size())));
    return std::nullopt;
  }
  Vector3 point = Vector3::Zero();
  bool right = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto value = read_value((*list)[i], k.name, k.quantity, k.range, faults);
    point[static_cast<Eigen::Index>(i)] = value.value_or(0);
    right = right && value;
  }
  return right ? std::optional<Vector3>(point) : std::nullopt;
}

std::span<const std::string_view> axis_names() {
  static constexpr std::array<std::string_view, 6> names{"+x", "-x", "+y", "-y", "+z", "-z"};
  return names;
}

std::span<const std::string_view> component_names() {
  static constexpr std::array<std::string_view, 3> names{"x", "y", "z"};
  return names;
}

const Keys& keys() {
  using description::text_key;
  static const Keys all = [] {
    Keys k;
    k.case_name = text_key("name",
                           "Name of the results' folder: letters, digits, `.`, `_`, `-`, not "
                           "starting with `.` or `-`, at most 100.",
                           "", "", longest_name);
    k.title = text_key("title", "A line for people, at most 200 characters.", "the name", "",
                       longest_title);
    k.sensor_name = text_key("name",
                             "`[[sensor]]`, a table for each sensor with its `position`: the name "
                             "in tables, files and headers of readings; letters, digits, `.`, `_`, "
                             "`-`, not digits alone.",
                             "its number");
    k.sensor_position.name = "position";
    k.sensor_position.quantity = quantity::length;
    k.sensor_position.range = {-1000, 1000, false,
                               "a sensor farther away is taken for a slip in the unit"};
    k.sensor_position.doc =
        "The point `[x, y, z]` where the field is computed, or a list of points; required if "
        "`fields` are asked for.";
    k.sensor_position.initial = Vector3(Vector3::Zero());
    k.sensor_position.fallback = "none";
    k.sensor_axes = text_key(
        "axes",
        "Of `ciliaval sense`: where the chip's own x, y and z, in which it is read, point in the "
        "case.",
        "as the case's", R"(["+y", "-x", "+z"])");
    k.sensor_rotation = text_key(
        "rotation",
        "Of `ciliaval sense`: the turn of these axes about the case's z, or about its x, then its "
        "y, then its z.",
        "0 deg", R"(["0 deg", "1 deg", "30 deg"])");
    k.sensor_rotation.initial = Vector3(Vector3::Zero());
    k.sensor_rotation.may_be_axial = true;
    k.sensor_rotation.quantity = quantity::angle;
    k.sensor_rotation.range = {-2 * std::numbers::pi, 2 * std::numbers::pi, false, unit_slip};
    k.sensor_gain =
        text_key("gain", "Of `ciliaval sense`: what the chip reads over the field that there is.",
                 "1", "1.02");
    k.sensor_gain.initial = 1.0;
    k.sensor_gain.quantity = quantity::number;
    k.sensor_gain.range = {0.01, 100, false, "a gain beyond is taken for a slip"};
    k.sensor_components =
        text_key("components", "Of `ciliaval sense`: which of its own x, y, z the chip reads.",
                 "all", R"(["x", "z"])");
    k.load_type = text_key("type", "What the load is and does as the cilium bends.");
    k.mechanics = text_key("mechanics", "The mechanics models to run, at least one.");
    k.fields = text_key(
        "fields", "The field models to run on the deformation of each mechanics model", "none");
    k.external_name = text_key("name",
                               "Name of an external model (docs/guide/referees.md), not that of a "
                               "model; a plain file name.");
    k.centrelines = text_key("centrelines",
                             "CSV files with a centreline each, one for each load step, beside the "
                             "case file unless absolute; these or `readings`.",
                             "none");
    return k;
  }();
  return all;
}

std::optional<std::string> read_line(const toml::node& node, std::string_view name,
                                     std::size_t longest, Faults& faults) {
  std::optional<std::string> text = read_text(node, name, faults);
  if (!text) return std::nullopt;
  std::string_view fault;
  if (text->find_first_not_of(' ') == std::string::npos) fault = "must not be empty";
  if (has_control_character(*text)) fault = "must not have line breaks or control characters";
  if (text->size() > longest) fault = "is too long";
  if (fault.empty()) return text;
  faults.add(place(node), fmt::format("'{}' {} (at most {} bytes)", name, fault, longest));
  return std::nullopt;
}

Section require_section(Section& root, std::string_view key) {
  Section section = root.section(key);
  if (!section.exists() && root.find(key) == nullptr)
    root.faults().add({}, fmt::format("the table [{}] is missing", key));
  return section;
}

void read_name_and_title(Section& table, std::string& name, std::string& title) {
  Faults& faults = table.faults();
  if (const toml::node* node = table.require(keys().case_name.name)) {
    name = read_text(*node, keys().case_name.name, faults).value_or("unknown");
    if (!is_plain_file_name(name))
      faults.add(place(*node),
                 fmt::format("the {} name {} must be a plain file name, because the results go "
                             "to a folder of that name: letters, digits, '.', '_' and '-', not "
                             "starting with '.' or '-', 1 to {} characters",
                             table.path(), in_quotes(name), longest_name));
  }
  title = name;
  const description::Key& title_key = keys().title;
  if (const toml::node* node = table.find(title_key.name))
    title = read_line(*node, title_key.name, title_key.longest, faults).value_or("");
}

void read_header(Section& root, Case& c) {
  Section table = require_section(root, "case");
  read_name_and_title(table, c.name, c.title);
  table.finish();
}

void read_cilium(Section& root, Case& c) {
  Section table = require_section(root, "cilium");
  read_cross_section(table, c.cilium);
  read_segments(table, c.cilium.segments);
  table.finish();
}

void read_sensor(Section& root, Case& c) {
  Faults& faults = root.faults();
  if (const toml::node* node = root.find("sensor"); node != nullptr && node->is_array())
    return read_named_sensors(root, c);
  Section table = root.section("sensor");
  if (const toml::node* node = table.require(keys().sensor_position.name)) {
    const toml::array* list = node->as_array();
    if (list == nullptr || list->empty() || list->size() > most_sensors) {
      faults.add(place(*node),
                 fmt::format("'position' must be a point, such as [\"0 mm\", \"0 mm\", \"-1.55 "
                             "mm\"], or a list of 1 to {} points, found {}",
                             most_sensors,
                             list == nullptr ? describe(*node)
                                             : fmt::format("a list of {}", list->size())));
    } else if (std::any_of(list->begin(), list->end(),
                           [](const toml::node& n) { return n.is_array(); })) {
      for (const toml::node& element : *list) {
        if (const auto p = read_point(element, keys().sensor_position, faults))
          c.sensors.push_back(*p);
      }
    } else if (const std::optional<Vector3> p = read_point(*list, keys().sensor_position, faults)) {
      c.sensors.push_back(*p);
    }
  }
  c.chips.assign(c.sensors.size(), read_chip(table));
  table.finish();
}

void read_models(Section& root, const Models& known, Case& c) {
  Faults& faults = root.faults();
  const std::vector<std::string_view> mechanics = ids(known.mechanics);
  Section table = require_section(root, "models");
  const std::string_view list = keys().mechanics.name;
  if (const toml::node* node = table.require(list)) {
    const std::size_t faults_before = faults.size();
    c.mechanics = read_choices(*node, list, mechanics, faults);
    if (c.mechanics.empty() && faults.size() == faults_before)
      faults.add(place(*node), fmt::format("'{}' is empty: name at least one of {}", list,
                                           fmt::join(mechanics, ", ")));
  }
  if (const toml::node* node = table.find(keys().fields.name))
    c.fields = read_choices(*node, keys().fields.name, ids(known.fields), faults);
  read_options(table, known, c.options);
  read_external(table, known, c.external);
  table.finish();
}

}  // namespace ciliaval::compare::input

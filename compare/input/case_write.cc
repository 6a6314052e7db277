// SPDX-License-Identifier: LGPL-2.1-or-later
// A case written back as TOML.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "compare/input/case.h"
#include "compare/input/case_sections.h"
#include "compare/input/described.h"
#include "compare/input/environment/environment.h"
#include "problem/cilium.h"
#include "problem/description/cilium.h"

namespace ciliaval::compare::input {
namespace {

std::string list(const std::vector<std::string>& texts) {
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

std::string value(const QuantityKey& k, double v) {
  const std::string text = format_quantity(v, k.quantity);
  return k.quantity.unit.empty() ? text : fmt::format("\"{}\"", text);
}

std::string line(const QuantityKey& k, double v) {
  return fmt::format("{} = {}\n", k.name, value(k, v));
}

/// The values of a key along a load path: one value, if all are the same and another key's list
/// tells the number of steps.
enum class Listed { if_they_differ, always };
std::string line(const QuantityKey& k, const std::vector<double>& values,
                 Listed listed = Listed::if_they_differ) {
  const bool same = std::all_of(values.begin(), values.end(), [&](double v) {
    return v == values.front() && std::signbit(v) == std::signbit(values.front());
  });
  if (values.size() == 1 || (same && listed == Listed::if_they_differ))
    return line(k, values.front());
  std::vector<std::string> texts;
  texts.reserve(values.size());
  for (const double v : values) texts.push_back(value(k, v));
  return fmt::format("{} = {}\n", k.name, list(texts));
}

/// Of a sweep whose path sweep_path() makes: the way, in place of lists.
std::optional<SweepWay> regular_way(const LoadPath& path) {
  if (!path.front().is<SweepLoad>() || path.size() < 2) return std::nullopt;
  const SweepWay way = sweep_way(path);
  if (path != sweep_path(path.front(), way)) return std::nullopt;
  return way;
}

/// The parameters of the load path; its first one is always a list, which tells the number of
/// steps, unless a sweep's number of samples does.
std::string parameters(const Case& c) {
  const LoadType& type = c.load_path.front().type();
  const std::optional<SweepWay> way = regular_way(c.load_path);
  std::string text;
  const auto add = [&](const QuantityKey& k, const std::vector<double>& values, bool is_first) {
    const bool is_travel = k.name == SweepLoad::travel_key;
    if (way) return text += line(k, is_travel ? way->travel : values.front()), void();
    text += line(k, values, is_first ? Listed::always : Listed::if_they_differ);
  };
  for (std::size_t p = 0; p < c.stated_by.size(); ++p)
    add(type.statement->parameters[p].key, c.stated_by[p], p == 0);
  for (std::size_t p = c.stated_by.empty() ? 0 : 1; p < type.parameters.size(); ++p) {
    std::vector<double> values;
    for (const Load& load : c.load_path) values.push_back(load.values()[p]);
    add(type.parameters[p].key, values, p == 0);
  }
  if (way)
    text += fmt::format("{} = {}\n{} = {}\n", key::samples.name, way->samples, key::sweep_return,
                        way->there_and_back);
  return text;
}

std::string cilium(const Case& c) {
  std::string text = "\n[cilium]\n" + lines(description::fields<Cilium>(), c.cilium);
  if (c.cilium.section.shape != CrossSection::Shape::circle)
    text += "\n[cilium.section]\n" + lines(description::fields<CrossSection>(), c.cilium.section);
  for (const Segment& segment : c.cilium.segments)
    text += "\n[[cilium.segment]]\n" + lines(description::fields<Segment>(), segment);
  return text;
}

std::string sensor(const Case& c) {
  if (c.sensors.empty()) return {};
  std::vector<std::string> points;
  const bool named = !c.sensor_names.empty();
  for (const Vector3& p : c.sensors) {
    std::vector<std::string> coordinates;
    for (const double x : p) coordinates.push_back(value(key::position, x));
    points.push_back(list(coordinates));
  }
  if (named) {
    std::string text;
    for (std::size_t s = 0; s < points.size(); ++s)
      text += fmt::format("\n[[sensor]]\nname = {}\nposition = {}\n", toml_text(sensor_name(c, s)),
                          points[s]);
    return text;
  }
  return fmt::format("\n[sensor]\nposition = {}\n",
                     points.size() == 1 ? points.front() : list(points));
}

std::string readings(const external::ReadingOptions& options) {
  std::string text;
  for (const auto& [key, value] : external::reading_keys)
    if (const auto& stated = options.*value; stated.given())
      text += fmt::format("{} = {}\n", key, toml_text(stated.text));
  return text.empty() ? text : "\n[readings]\n" + text;
}

std::string external(const external::ExternalModel& model) {
  std::string text =
      fmt::format("\n[[{}]]\nname = {}\n", key::external_table, toml_text(model.name));
  std::vector<std::string> files;
  for (const std::filesystem::path& file : model.centreline_files)
    files.push_back(toml_text(file.string()));
  if (!files.empty()) text += fmt::format("centrelines = {}\n", list(files));
  if (!model.readings_file.empty())
    text += fmt::format("readings = {}\n", toml_text(model.readings_file.string()));
  if (!model.background_file.empty())
    text += fmt::format("background = {}\n", toml_text(model.background_file.string()));
  if (model.tip_uncertainty) text += line(key::tip_uncertainty, *model.tip_uncertainty);
  if (model.field_uncertainty) text += line(key::field_uncertainty, *model.field_uncertainty);
  return text;
}

std::string models(const Case& c, const Models& known) {
  const auto ids = [](const std::vector<std::string>& names) {
    return names.empty() ? "[]" : fmt::format("[\"{}\"]", fmt::join(names, "\", \""));
  };
  std::string text =
      fmt::format("\n[models]\nmechanics = {}\nfields = {}\n", ids(c.mechanics), ids(c.fields));
  known.for_each([&](const auto& entry) {
    if (!entry.options.empty()) text += fmt::format("\n[models.{}]\n", entry.id);
    text += lines(entry.options, c.options);
    if (entry.tables.write) text += entry.tables.write(c.options);
  });
  for (const external::ExternalModel& given : c.external) text += external(given);
  return text;
}

}  // namespace

std::string to_toml(const Case& c, const Models& known) {
  std::string text =
      fmt::format("[case]\nname = {}\ntitle = {}\n", toml_text(c.name), toml_text(c.title));
  text += cilium(c);
  if (!c.load_path.empty()) {
    text += fmt::format("\n[load]\ntype = \"{}\"\n", type(c.load_path.front()));
    text += parameters(c) + environment::to_toml(c.load_path);
  }
  if (c.surface.surface) text += sweep::to_toml(c.surface);
  if (c.signal) text += sweep::to_toml(*c.signal);
  return text + sensor(c) + readings(c.readings) + models(c, known) +
         measurement::to_toml(c.measured);
}

}  // namespace ciliaval::compare::input

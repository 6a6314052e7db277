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
#include "problem/description/surface.h"

namespace ciliaval::compare::input {
namespace {

std::string list(const std::vector<std::string>& texts) {
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

/// Way of a sweep whose path sweep_path() makes, written in place of lists; none of another path.
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
  LoadPath path = c.load_path;
  std::vector<LoadStatement::Values> stated = c.stated_by;
  if (way) {
    path = {with_travel(path.front(), way->travel)};
    stated.resize(std::min<std::size_t>(stated.size(), 1));
  }
  // A sweep of one place is told by a list, too.
  const bool is_listed = path.size() > 1 || (path.front().is<SweepLoad>() && !way);
  const Listed first = is_listed ? Listed::first_key : Listed::if_they_differ;
  std::string text;
  if (!stated.empty())
    text +=
        lines(type.statement->parameters, std::span<const LoadStatement::Values>(stated), first);
  text += lines(type.keys(stated.empty()), std::span<const Load>(path),
                stated.empty() ? first : Listed::if_they_differ);
  for (const LoadTable& table : type.tables)
    if (const std::string keys = lines(table.keys, path.front()); !keys.empty())
      text += fmt::format("\n[load.{}]\n{}", table.name, keys);
  return way ? text + lines(description::fields<SweepWay>(), *way) : text;
}

std::string cilium(const Case& c) {
  std::string text = "\n[cilium]\n" + lines(description::fields<Cilium>(), c.cilium);
  if (c.cilium.section.shape != CrossSection::Shape::circle)
    text += "\n[cilium.section]\n" + lines(description::fields<CrossSection>(), c.cilium.section);
  for (const Segment& segment : c.cilium.segments)
    text += "\n[[cilium.segment]]\n" + lines(description::fields<Segment>(), segment);
  return text;
}

std::string texts(const std::vector<std::string>& all) {
  return all.empty() ? "[]" : fmt::format("[\"{}\"]", fmt::join(all, "\", \""));
}

std::string chip(const Case& c, std::size_t sensor) {
  if (sensor >= c.chips.size()) return {};
  const Chip& chip = c.chips[sensor];
  std::string text;
  if (!chip.axes.empty()) text += fmt::format("axes = {}\n", texts(chip.axes));
  if (!chip.rotation.isZero(0))
    text += fmt::format("rotation = {}\n", to_toml(keys().sensor_rotation, chip.rotation));
  if (chip.gain != 1) text += fmt::format("gain = {}\n", format_number(chip.gain));
  if (!chip.components.empty()) text += fmt::format("components = {}\n", texts(chip.components));
  return text;
}

std::string sensor(const Case& c) {
  if (c.sensors.empty()) return {};
  std::vector<std::string> points;
  const bool named = !c.sensor_names.empty();
  for (const Vector3& p : c.sensors) {
    points.push_back(to_toml(keys().sensor_position, p));
  }
  if (named) {
    std::string text;
    for (std::size_t s = 0; s < points.size(); ++s)
      text += fmt::format("\n[[sensor]]\nname = {}\nposition = {}\n{}",
                          toml_text(sensor_name(c, s)), points[s], chip(c, s));
    return text;
  }
  return fmt::format("\n[sensor]\nposition = {}\n{}",
                     points.size() == 1 ? points.front() : list(points), chip(c, 0));
}

std::string readings(const external::ReadingOptions& options) {
  std::string text;
  for (const external::ReadingKey& key : external::reading_keys())
    if (const auto& stated = options.*key.option; stated.given())
      text += fmt::format("{} = {}\n", key.name, toml_text(stated.text));
  return text.empty() ? text : "\n[readings]\n" + text;
}

std::string external(const external::ExternalModel& model) {
  std::string text =
      fmt::format("\n[[{}]]\nname = {}\n", external::table_name, toml_text(model.name));
  std::vector<std::string> files;
  for (const std::filesystem::path& file : model.centreline_files)
    files.push_back(toml_text(file.string()));
  if (!files.empty()) text += fmt::format("centrelines = {}\n", list(files));
  text += lines(description::fields<external::ExternalModel>(), model);
  return text;
}

std::string models(const Case& c, const Models& known) {
  std::string text =
      fmt::format("\n[models]\nmechanics = {}\nfields = {}\n", texts(c.mechanics), texts(c.fields));
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
  if (c.surface)
    text += "\n[surface]\n" + lines(description::fields<surroundings::StatedSurface>(), *c.surface);
  if (c.signal) text += sweep::to_toml(*c.signal);
  return text + sensor(c) + readings(c.readings) + models(c, known) +
         measurement::to_toml(c.measured);
}

}  // namespace ciliaval::compare::input

// SPDX-License-Identifier: LGPL-2.1-or-later
// Conditions between the tables of a case file.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "compare/input/case_sections.h"
#include "problem/cilium.h"
#include "problem/error.h"

namespace ciliaval::compare::input {
namespace {

constexpr double longest_cilium = 100;  ///< m
constexpr double most_slender = 1e5;    ///< length over diameter: bounds the graded quadratures
constexpr std::size_t most_rows =
    200000;  ///< of results; a row takes about 3 kB of memory in a run

bool asks_for(const std::vector<std::string>& ids, std::string_view id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

/// Place of the value of a dotted path; of a path that is not in the file, its table's place.
Place place_of(const toml::table& root, std::string path) {
  while (!path.empty()) {
    if (const toml::node* node = root.at_path(path).node()) return place(*node);
    const std::size_t end = path.find_last_of(".[");
    path.resize(end == std::string::npos ? 0 : end);
  }
  return {};
}

/// Dotted path of an id in a list of ids.
std::string path_of_id(std::string_view list, const std::vector<std::string>& ids,
                       std::string_view id) {
  const auto at = std::find(ids.begin(), ids.end(), id) - ids.begin();
  return fmt::format("models.{}[{}]", list, at);
}

void check_load(const Case& c, const Report& report) {
  const double length = c.cilium.length();
  for (std::size_t i = 0; i < c.load_path.size(); ++i) {
    const std::optional<double> height = contact_height(c.load_path[i]);
    if (height && !(*height > 0 && *height < length))
      report(fmt::format("load.height[{}]", i),
             fmt::format("the contact height {:g} m must lie between the base and the tip of the "
                         "cilium, which is {:g} m high",
                         *height, length));
    const TouchLaw& touch = c.load_path[i].touch();
    if (height && touch.radius >= *height)
      report(
          "load.touch.radius",
          fmt::format("the pin reaches the floor: its radius {:g} m must be less than its height "
                      "{:g} m",
                      touch.radius, *height));
    if (!touch.is_plain() && c.load_path[i].slip_off_point() == SlipOffPoint::rim)
      report("load.slip_off",
             "slip_off = 'rim' is of a horizontal force: leave it out, or [load.touch]");
    const std::optional<double> arclength = loaded_arclength(c.load_path[i]);
    if (arclength && *arclength > length)
      report(fmt::format("load.arclength[{}]", i),
             fmt::format("the loaded section at arc length {:g} m lies beyond the tip at {:g} m",
                         *arclength, length));
    const auto sweep = c.load_path[i].as<SweepLoad>();
    if (sweep && sweep->interference >= length)
      report(fmt::format("load.{}[{}]", c.stated_by.empty() ? "interference" : "clearance", i),
             fmt::format("the interference {:g} m must be less than the length of the cilium, "
                         "{:g} m",
                         sweep->interference, length));
  }
}

/// True if an environment acts at any step.
template <class Acts>
bool any_environment(const LoadPath& path, const Acts& acts) {
  return std::ranges::any_of(path, [&](const Load& load) { return acts(load.environment()); });
}

bool has_environment(const LoadPath& path) {
  return any_environment(path, [](const auto& e) { return !surroundings::is_empty(e); });
}

/// Weight needs densities, a field a magnet, and magnets a place beside the cilium.
void check_environment(const Case& c, const Report& report) {
  const auto has_weight = [](const surroundings::Environment& e) { return !e.gravity.isZero(0); };
  const auto has_field = [](const auto& e) { return !e.uniform_field.isZero(0); };
  for (std::size_t i = 0; i < c.cilium.segments.size(); ++i)
    if (any_environment(c.load_path, has_weight) && c.cilium.segments[i].density == 0)
      report(fmt::format("cilium.segment[{}]", i),
             fmt::format("the segment '{}' needs a 'density', for [environment] has a 'gravity'",
                         c.cilium.segments[i].name));
  if (any_environment(c.load_path, has_field) && !has_magnet(c.cilium))
    report("environment.uniform_field",
           "'uniform_field' needs a magnet: no [[cilium.segment]] has a 'magnetization'");
  const auto& magnets = c.load_path.front().environment().magnets;
  if (!magnets.empty() && !has_magnet(c.cilium))
    report("environment.magnet[0]",
           "[[environment.magnet]] needs a magnet: no [[cilium.segment]] has a 'magnetization'");
  for (std::size_t i = 0; i < magnets.size(); ++i)
    if (any_environment(c.load_path, [&](const surroundings::Environment& e) {
          return surroundings::magnets::distance_from_upright_cylinder(
                     e.magnets[i], c.cilium.radius(), c.cilium.length()) == 0;
        }))
      report(fmt::format("environment.magnet[{}].position", i),
             fmt::format("the magnet {} touches the straight cilium: move it away",
                         in_quotes(magnets[i].name)));
  if (has_environment(c.load_path) && c.load_path.front().is<SweepLoad>())
    report("environment", fmt::format("no model takes an environment beside the load type '{}': "
                                      "leave out one of the two",
                                      SweepLoad::type().name));
}

/// The places of a profile in a file that the tip needs at least: from over the base at the start
/// to over the base at the end, if it hangs straight.
void check_profile(const Case& c, const Report& report) {
  if (!c.surface || !c.surface->sampled) return;
  const surroundings::SampledProfile& profile = *c.surface->sampled;
  double travel = 0;
  for (const Load& load : c.load_path)
    travel = std::max(travel, load.as<SweepLoad>().value().travel);
  if (travel > -profile.first() || profile.last() < 0)
    report("surface.path",
           fmt::format("the profile goes from x = {:g} m to {:g} m, but the sweep from 0 m to {:g} "
                       "m; a bent cilium touches it up to its own length before",
                       -profile.last(), -profile.first(), travel));
}

/// A record is of a sweep, whose surface moves from sample to sample.
void check_signal(const Case& c, const Report& report) {
  constexpr double longest_record = 1e6;  ///< samples, rows of signal.csv
  if (!c.signal) return;
  if (!c.load_path.front().is<SweepLoad>())
    return report("signal",
                  fmt::format("[signal] goes with the load type '{}'", SweepLoad::type().name));
  if (c.fields.empty()) report("signal", "[signal] needs 'fields' in [models] and a [sensor]");
  double way = 0;
  for (std::size_t i = 1; i < c.load_path.size(); ++i) {
    const double step = std::abs(c.load_path[i].as<SweepLoad>().value().travel -
                                 c.load_path[i - 1].as<SweepLoad>().value().travel);
    if (step == 0)
      return report(fmt::format("load.travel[{}]", i),
                    "[signal] needs a time for each sample: the travel stays the same here");
    way += step;
  }
  const double seconds = way / c.load_path.front().as<SweepLoad>().value().speed;
  const double intervals = seconds * c.signal->sampling_rate * (1 + 1e-12);
  if (const std::size_t least = c.signal->least_samples();
      !(1 + std::floor(intervals) > static_cast<double>(least)))
    report(
        "signal.sampling_rate",
        fmt::format(
            "the sweep takes {:g} s, of which this rate makes {:g} sample{}: the record needs more "
            "than {}",
            seconds, 1 + std::floor(intervals), intervals < 1 ? "" : "s", least));
  if (seconds * c.signal->sampling_rate > longest_record)
    report("signal.sampling_rate",
           fmt::format("the sweep takes {:g} s, of which this rate makes {:g} samples, more than "
                       "{:g}",
                       seconds, seconds * c.signal->sampling_rate, longest_record));
}

/// Checks that the case suits a rectangle or a tube.
void check_section(const Case& c, const Report& report) {
  if (c.cilium.section.shape == CrossSection::Shape::circle) return;
  const Load& first = c.load_path.front();
  if (first.is<SweepLoad>())
    return report("load.type",
                  "a sweep is of a cilium of circular section: leave out [cilium.section]");
  if (!c.cilium.is_rectangular()) return;
  for (std::size_t i = 0; i < c.load_path.size(); ++i) {
    const std::string path = i == 0 ? "load.azimuth" : fmt::format("load.azimuth[{}]", i);
    try {
      c.cilium.extent(azimuth(c.load_path[i]));
    } catch (const InputError& fault) {
      return report(path, fault.what());
    }
    if (azimuth(c.load_path[i]) != azimuth(first))
      return report(path, "a rectangular cilium takes a path of one azimuth");
  }
}

/// The loads that the models take, and what they find with their own options.
void check_models(const Case& c, const Models& known, const RightTables& right,
                  const Report& report) {
  known.for_each([&](const auto& entry) {
    const bool is_mechanics = asks_for(c.mechanics, entry.id);
    const bool is_asked_for = is_mechanics || asks_for(c.fields, entry.id);
    const auto& loads = entry.loads;
    if (is_asked_for && right.load && !loads.empty() &&
        std::find(loads.begin(), loads.end(), &c.load_path.front().type()) == loads.end()) {
      std::vector<std::string_view> names;
      names.reserve(loads.size());
      for (const LoadType* type : loads) names.push_back(type->name);
      report(path_of_id(keys().mechanics.name, c.mechanics, entry.id),
             fmt::format("{0} takes the load types '{1}', not '{2}': leave out '{0}', or state the "
                         "load as one of those",
                         entry.id, fmt::join(names, "', '"), type(c.load_path.front())));
    } else if (is_mechanics && right.load && !entry.takes_environment &&
               has_environment(c.load_path)) {
      report(
          path_of_id(keys().mechanics.name, c.mechanics, entry.id),
          fmt::format("{0} takes no [environment]: leave out '{0}', or the environment", entry.id));
    } else if (is_mechanics && right.load && !entry.takes_touch &&
               !c.load_path.front().touch().is_plain()) {
      report(
          "load.touch",
          fmt::format("{0} takes a force that is horizontal and on the axis: leave out '{0}', or "
                      "[load.touch]",
                      entry.id));
    }
    if (is_asked_for && right.cilium && !entry.takes_sections &&
        c.cilium.section.shape != CrossSection::Shape::circle)
      report(path_of_id(is_mechanics ? keys().mechanics.name : keys().fields.name,
                        is_mechanics ? c.mechanics : c.fields, entry.id),
             fmt::format("{0} takes circular sections only: leave out '{0}', or [cilium.section]",
                         entry.id));
    if (entry.check) entry.check({c, is_asked_for, right.cilium, right.load, report});
  });
}

/// The mechanics models of the case that give a body.
std::size_t bodies(const Case& c, const Models& known) {
  return static_cast<std::size_t>(std::count_if(
      known.mechanics.begin(), known.mechanics.end(), [&](const MechanicsEntry& entry) {
        return entry.has_body && asks_for(c.mechanics, entry.id);
      }));
}

void check_fields(const Case& c, const Models& known, bool cilium_is_right, const Report& report) {
  if (c.fields.empty()) return;
  if (cilium_is_right && !has_magnet(c.cilium))
    report("models.fields", "'fields' need a magnet: no [[cilium.segment]] has a 'magnetization'");
  std::vector<std::string_view> with_body;
  for (const MechanicsEntry& entry : known.mechanics)
    if (entry.has_body) with_body.push_back(entry.id);
  for (const FieldEntry& entry : known.fields)
    if (entry.has_body && asks_for(c.fields, entry.id) && bodies(c, known) == 0)
      report(path_of_id(keys().fields.name, c.fields, entry.id),
             fmt::format("the field model '{}' needs the body of a solid: add one of {} to "
                         "'mechanics'",
                         entry.id, fmt::join(with_body, ", ")));
}

std::size_t pairs(std::size_t n) {
  return n * (n - 1) / 2;  // none of 0
}

/// The figures of a run: B and ΔB of each field run at each sensor, straight and at each step, and
/// the comparisons of each pair of runs (compare/models/errors.h): of mechanics five a step, of
/// fields six components at each sensor a step and over the path.
void check_size(const Case& c, const Models& known, const Report& report) {
  const std::size_t steps = c.load_path.size();
  const std::size_t sensors = c.sensors.size();
  std::size_t mechanics = c.mechanics.size();
  std::size_t readings = 0;
  for (const external::ExternalModel& model : c.external) {
    if (!model.centreline_files.empty()) ++mechanics;
    if (!model.readings_file.empty()) ++readings;
  }
  std::size_t runs = readings;
  for (const FieldEntry& entry : known.fields)
    if (asks_for(c.fields, entry.id)) runs += entry.has_body ? bodies(c, known) : mechanics;
  const std::size_t rows =
      5 * pairs(mechanics) * steps + (runs + 6 * pairs(runs)) * sensors * (steps + 1);
  if (rows > most_rows)
    report("sensor.position",
           fmt::format("{} sensor points, {} steps and {} pairs of mechanics and field model "
                       "with {} comparisons among them make {} rows of results, more than {}: "
                       "list fewer points, steps or models",
                       sensors, steps, runs, pairs(runs), rows, most_rows));
}

}  // namespace

void check_together(const toml::table& root, const Case& c, const Models& known,
                    const RightTables& right, Faults& faults) {
  std::string last;  // one value that stands for all steps is told once
  const Report report = [&](const std::string& path, const std::string& fault) {
    if (fault != last || root.at_path(path)) faults.add(place_of(root, path), fault);
    last = fault;
  };
  if (right.cilium && c.cilium.length() > longest_cilium)
    report("cilium.segment",
           fmt::format("the segments are {:g} m long together; more than {:g} m is taken for a "
                       "slip in the unit",
                       c.cilium.length(), longest_cilium));
  else if (right.cilium && c.cilium.length() > most_slender * c.cilium.thickness())
    report(c.cilium.is_rectangular() ? "cilium.section" : "cilium.diameter",
           fmt::format("the cilium is {:g} diameters long; more than {:g} is taken for a slip "
                       "in the unit",
                       c.cilium.length() / c.cilium.thickness(), most_slender));
  if (right.cilium && right.load) check_section(c, report);
  if (right.cilium && right.load) check_load(c, report);
  if (right.cilium && right.load) check_environment(c, report);
  if (right.load) check_profile(c, report);
  if (right.load) check_signal(c, report);
  if (right.models) check_models(c, known, right, report);
  if (right.load && right.models) check_external(c, report);
  if (right.models && !c.fields.empty() && !root.contains("sensor"))
    report("models.fields", "'fields' need a place: add [sensor] with 'position'");
  if (right.models) check_fields(c, known, right.cilium, report);
  if (right.load && right.models) check_size(c, known, report);
}

}  // namespace ciliaval::compare::input

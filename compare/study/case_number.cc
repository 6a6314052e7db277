// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/study/case_number.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>

#include "compare/input/case_sections.h"
#include "compare/input/environment/environment.h"
#include "compare/input/environment/magnet.h"
#include "compare/models/registry.h"

namespace ciliaval::compare::study {
namespace {

using Order = CaseNumber::Order;

CaseNumber plain(std::string path, const QuantityKey& k,
                 std::function<double(const input::Case&)> get,
                 std::function<void(input::Case&, double)> set) {
  std::string sets = path;
  return {std::move(path), k.quantity,      k.range,        std::string(k.doc), false,
          Order::plain,    std::move(sets), std::move(get), std::move(set)};
}

void append_segments(const input::Case& c, std::vector<CaseNumber>& all) {
  static constexpr Range proportion_range{0, 1, true, "a segment is a part of the cilium"};
  using Member = std::pair<const QuantityKey*, double Segment::*>;
  const std::array<Member, 5> members{{{&input::key::segment_length, &Segment::length},
                                       {&input::key::young_modulus, &Segment::young_modulus},
                                       {&input::key::poisson_ratio, &Segment::poisson_ratio},
                                       {&input::key::magnetization, &Segment::magnetization},
                                       {&input::key::density, &Segment::density}}};
  for (std::size_t i = 0; i < c.cilium.segments.size(); ++i) {
    const std::string table = "cilium.segment." + c.cilium.segments[i].name;
    for (const auto& [k, member] : members) {
      if (k == &input::key::density && c.cilium.segments[i].density == 0) continue;
      all.push_back(plain(
          fmt::format("{}.{}", table, k->name), *k,
          [=, m = member](const input::Case& x) { return x.cilium.segments[i].*m; },
          [=, m = member](input::Case& x, double v) { x.cilium.segments[i].*m = v; }));
    }
    if (c.cilium.segments.size() < 2) continue;
    all.push_back(
        {table + ".proportion", quantity::number, proportion_range,
         "The segment's length over the cilium's, which stays.", false, Order::proportion,
         "cilium.segment.*.proportion",
         [=](const input::Case& x) { return x.cilium.segments[i].length / x.cilium.length(); },
         [=](input::Case& x, double v) {
           const double total = x.cilium.length();
           const double others = total - x.cilium.segments[i].length;
           for (Segment& s : x.cilium.segments) s.length *= total * (1 - v) / others;
           x.cilium.segments[i].length = total * v;
         }});
  }
}

void append_cilium(const input::Case& c, std::vector<CaseNumber>& all) {
  static constexpr Range ratio_range{0.1, 1e4, false, "a cilium is longer than it is thick"};
  if (c.cilium.is_rectangular()) {
    const auto side = [&](const QuantityKey& k, double CrossSection::*member) {
      all.push_back(plain(
          fmt::format("{}.{}", k.table, k.name), k,
          [=](const input::Case& x) { return x.cilium.section.*member; },
          [=](input::Case& x, double v) { x.cilium.section.*member = v; }));
    };
    side(input::key::section_width, &CrossSection::width);
    side(input::key::section_height, &CrossSection::height);
  } else {
    all.push_back(plain(
        "cilium.diameter", input::key::diameter,
        [](const input::Case& x) { return x.cilium.diameter; },
        [](input::Case& x, double v) { x.cilium.diameter = v; }));
  }
  append_segments(c, all);
  all.push_back({"cilium.length", quantity::length, length_range,
                 "The total length, the segments in proportion.", false, Order::total_length,
                 "cilium.length", [](const input::Case& x) { return x.cilium.length(); },
                 [](input::Case& x, double v) {
                   const double total = x.cilium.length();
                   for (Segment& s : x.cilium.segments) s.length *= v / total;
                 }});
  if (c.cilium.is_rectangular()) return;
  all.push_back({"cilium.aspect_ratio", quantity::number, ratio_range,
                 "The total length over the diameter, by the diameter.", false, Order::aspect_ratio,
                 "cilium.diameter",
                 [](const input::Case& x) { return x.cilium.length() / x.cilium.diameter; },
                 [](input::Case& x, double v) { x.cilium.diameter = x.cilium.length() / v; }});
}

/// The parameters of all steps' loads, or those that state their magnitude in its place.
void append_load(const input::Case& c, std::vector<CaseNumber>& all) {
  const LoadType& type = c.load_path.front().type();
  for (std::size_t p = 0; p < c.stated_by.size(); ++p) {
    const QuantityKey& k = type.statement->parameters[p].key;
    all.push_back(plain(
        fmt::format("load.{}", k.name), k,
        [=](const input::Case& x) { return x.stated_by[p].front(); },
        [=](input::Case& x, double v) {
          std::fill(x.stated_by[p].begin(), x.stated_by[p].end(), v);
        }));
  }
  for (std::size_t p = c.stated_by.empty() ? 0 : 1; p < type.parameters.size(); ++p) {
    const QuantityKey& k = type.parameters[p].key;
    if (k.name == SweepLoad::travel_key) continue;  // it tells the steps of a sweep apart
    all.push_back(plain(
        fmt::format("load.{}", k.name), k,
        [=](const input::Case& x) { return x.load_path.front().values()[p]; },
        [=](input::Case& x, double v) {
          for (Load& load : x.load_path) load.set_value(p, v);
        }));
  }
}

/// The numbers of a sweep's surface.
void append_surface(const input::Case& c, std::vector<CaseNumber>& all) {
  if (!c.surface.surface) return;
  for (const QuantityKey& k : input::sweep::keys(*c.surface.surface))
    all.push_back(plain(
        fmt::format("surface.{}", k.name), k,
        [=](const input::Case& x) { return input::sweep::value(*x.surface.surface, k.name); },
        [=](input::Case& x, double v) {
          x.surface.surface = input::sweep::with_value(*x.surface.surface, k.name, v);
          for (Load& load : x.load_path) load = Load(load.type(), load.values(), x.surface.surface);
        }));
}

/// A number of the environment, set at all steps.
CaseNumber around(const std::string& path, const QuantityKey& k,
                  const std::function<double&(surroundings::Environment&)>& number) {
  return plain(
      path, k,
      [=](const input::Case& x) {
        surroundings::Environment environment = x.load_path.front().environment();
        return number(environment);
      },
      [=](input::Case& x, double v) {
        for (Load& load : x.load_path) {
          surroundings::Environment environment = load.environment();
          number(environment) = v;
          load.set_environment(environment);
        }
      });
}

/// Gravity and field by their components, the field unless it tells the steps apart.
void append_environment(const input::Case& c, std::vector<CaseNumber>& all) {
  using surroundings::Environment;
  const Environment& first = c.load_path.front().environment();
  const bool is_path = std::ranges::any_of(c.load_path, [&](const Load& load) {
    return load.environment().uniform_field != first.uniform_field;
  });
  const auto append = [&all](const QuantityKey& k, Vector3 Environment::*vector) {
    for (const auto& [name, axis] : {std::pair("x", 0), std::pair("y", 1), std::pair("z", 2)})
      all.push_back(around(fmt::format("environment.{}.{}", k.name, name), k,
                           [=, a = axis](Environment& e) -> double& { return (e.*vector)[a]; }));
  };
  if (!first.gravity.isZero(0)) {
    append(input::environment::gravity, &Environment::gravity);
    all.push_back(around("environment.fluid_density", input::environment::fluid_density,
                         [](Environment& e) -> double& { return e.fluid_density; }));
  }
  if (!is_path && !first.uniform_field.isZero(0))
    append(input::environment::uniform_field, &Environment::uniform_field);
}

/// Sizes and magnetisation of the magnets beside the cilium, and the places that do not tell the
/// steps apart.
void append_magnets(const input::Case& c, std::vector<CaseNumber>& all) {
  using namespace input::environment;
  using surroundings::magnets::Magnet;
  using surroundings::magnets::Shape;
  const auto& magnets = c.load_path.front().environment().magnets;
  for (std::size_t i = 0; i < magnets.size(); ++i) {
    const std::string path = fmt::format("{}.{}", magnet_table, magnets[i].name);
    const auto append = [&](const std::string& name, const QuantityKey& k,
                            const std::function<double&(Magnet&)>& number) {
      all.push_back(
          around(fmt::format("{}.{}", path, name), k,
                 [=](surroundings::Environment& e) -> double& { return number(e.magnets.at(i)); }));
    };
    const bool stays = std::ranges::all_of(c.load_path, [&](const Load& load) {
      return load.environment().magnets.at(i).position == magnets[i].position;
    });
    for (const auto& [name, axis] : {std::pair("x", 0), std::pair("y", 1), std::pair("z", 2)})
      if (stays)
        append(fmt::format("position.{}", name), magnet_position,
               [a = axis](Magnet& m) -> double& { return m.position[a]; });
    if (magnets[i].shape != Shape::cuboid)
      append("diameter", magnet_diameter, [](Magnet& m) -> double& { return m.diameter; });
    if (magnets[i].shape == Shape::cylinder)
      append("length", magnet_length, [](Magnet& m) -> double& { return m.length; });
    append("magnetization", magnet_magnetization,
           [](Magnet& m) -> double& { return m.magnetization.z(); });
  }
}

void append_options(const input::Case& c, std::vector<CaseNumber>& all) {
  models::known().for_each([&](const auto& entry) {
    for (const input::Option& option : entry.options) {
      if (!input::belongs(option, c.options) || !option.number(c.options)) continue;
      const std::string path = fmt::format("models.{}.{}", entry.id, option.name);
      all.push_back({path, option.quantity, option.range, std::string(option.doc),
                     option.is_whole_number(), Order::plain, path,
                     [option](const input::Case& x) { return option.number(x.options).value(); },
                     [option](input::Case& x, double v) { option.set_number(x.options, v); }});
    }
  });
}

}  // namespace

std::vector<CaseNumber> case_numbers(const input::Case& c) {
  std::vector<CaseNumber> all;
  append_cilium(c, all);
  append_load(c, all);
  append_environment(c, all);
  append_magnets(c, all);
  append_surface(c, all);
  if (!c.sensors.empty())
    for (const auto& [name, axis] : {std::pair("x", 0), std::pair("y", 1), std::pair("z", 2)})
      all.push_back(plain(
          fmt::format("sensor.position.{}", name), input::key::position,
          [a = axis](const input::Case& x) { return x.sensors.front()[a]; },
          [a = axis](input::Case& x, double v) { x.sensors.front()[a] = v; }));
  append_options(c, all);
  return all;
}

input::Case with_settings(input::Case c, const std::vector<Setting>& settings) {
  for (const Order order :
       {Order::plain, Order::total_length, Order::proportion, Order::aspect_ratio})
    for (const Setting& setting : settings)
      if (setting.number.order == order) setting.number.set(c, setting.value);
  input::set_stated_magnitudes(c);
  input::snap_to_interfaces(c.cilium, c.load_path);
  return c;
}

}  // namespace ciliaval::compare::study

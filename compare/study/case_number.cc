// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/study/case_number.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "compare/input/case_sections.h"
#include "compare/input/environment/environment.h"
#include "compare/input/environment/magnet.h"
#include "compare/models/registry.h"
#include "problem/description/cilium.h"

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

/// The numbers of a described part of the case that it has. Of a vector along an axis the component
/// along it.
template <class Part, class Access>
void append_numbers(const description::Fields<Part>& fields, const std::string& table,
                    const input::Case& c, const Access& part, std::vector<CaseNumber>& all) {
  using description::Key;
  for (const description::Field<Part>& field : fields) {
    const bool is_left_out =
        field.absence == Key::Absence::nothing && field.get(part(c)) == field.initial;
    if (!(field.is_number() || field.may_be_axial) || !field.belongs(part(c)) || is_left_out)
      continue;
    const std::string path = fmt::format("{}.{}", table, field.name);
    CaseNumber number{path,
                      field.quantity,
                      field.range,
                      std::string(field.doc),
                      field.is_whole_number(),
                      Order::plain,
                      path,
                      {},
                      {}};
    if (field.may_be_axial) {
      number.get = [=](const input::Case& x) { return std::get<Vector3>(field.get(part(x))).z(); };
      number.set = [=](input::Case& x, double v) {
        auto vector = std::get<Vector3>(field.get(part(x)));
        vector.z() = v;
        field.set(part(x), vector);
      };
    } else {
      number.get = [=](const input::Case& x) { return field.number(part(x)); };
      number.set = [=](input::Case& x, double v) { field.set_number(part(x), v); };
    }
    all.push_back(std::move(number));
  }
}

void append_segments(const input::Case& c, std::vector<CaseNumber>& all) {
  static constexpr Range proportion_range{0, 1, true, "a segment is a part of the cilium"};
  for (std::size_t i = 0; i < c.cilium.segments.size(); ++i) {
    const std::string table = "cilium.segment." + c.cilium.segments[i].name;
    append_numbers(
        description::fields<Segment>(), table,
        c, [i](auto& x) -> auto& { return x.cilium.segments[i]; }, all);
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
  append_numbers(
      description::fields<Cilium>(), "cilium", c, [](auto& x) -> auto& { return x.cilium; }, all);
  append_numbers(
      description::fields<CrossSection>(), "cilium.section", c,
      [](auto& x) -> auto& { return x.cilium.section; }, all);
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
    append_numbers(
        entry.options, "models." + entry.id, c, [](auto& x) -> auto& { return x.options; }, all);
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

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/study/case_number.h"

#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

#include "compare/input/case_sections.h"
#include "compare/input/environment/environment.h"
#include "compare/models/registry.h"
#include "problem/description/cilium.h"
#include "problem/description/environment.h"
#include "problem/description/surface.h"

namespace ciliaval::compare::study {
namespace {

using description::Fields;
using input::Case;
using Order = CaseNumber::Order;

/// Structs of the case that a table describes: of each load step, or one.
template <class T>
struct Part {
  std::function<std::vector<T>(const Case&)> get;
  std::function<void(Case&, const std::vector<T>&)> set;
};

/// A part that is there once; `member` gives a reference to it.
template <class T, class Member>
Part<T> one(const Member& member) {
  return {[=](const Case& c) { return std::vector<T>{member(c)}; },
          [=](Case& c, const std::vector<T>& parts) { member(c) = parts.front(); }};
}

/// Number described by the key, without its accessors.
CaseNumber number_of(const description::Key& key, std::string path) {
  CaseNumber number;
  static_cast<description::Key&>(number) = key;
  if (!number.is_number()) number.initial = 0.0;  // a component of a vector
  number.path = number.sets = std::move(path);
  return number;
}

/// The number that a field is of the part, or a component of it; set at all steps.
template <class T>
CaseNumber number_of(const description::Field<T>& field, std::optional<Eigen::Index> axis,
                     const Part<T>& part, std::string path) {
  using description::Value;
  CaseNumber number = number_of(field, std::move(path));
  number.condition = nullptr;
  number.get = [=](const Case& c) {
    const Value value = field.get(part.get(c).front());
    return axis ? Value(std::get<Vector3>(value)[*axis]) : value;
  };
  number.set = [=](Case& c, const Value& value) {
    std::vector<T> steps = part.get(c);
    for (T& step : steps) {
      if (!axis) {
        field.set(step, value);
        continue;
      }
      auto vector = std::get<Vector3>(field.get(step));
      vector[*axis] = std::get<double>(value);
      field.set(step, vector);
    }
    part.set(c, steps);
  };
  return number;
}

enum class Varying { all, but_what_tells_the_steps_apart };

/// The numbers of a part of the case that it states. A vector gives its components, a vector along
/// an axis the one along it.
template <class T>
void append_numbers(const Fields<T>& fields, const std::string& table, const Case& c,
                    const Part<T>& part, std::vector<CaseNumber>& all,
                    Varying varying = Varying::but_what_tells_the_steps_apart) {
  using description::Key;
  const std::vector<T> steps = part.get(c);
  for (const description::Field<T>& field : fields) {
    if (!field.in_place_of.empty() || !field.belongs(steps.front())) continue;
    const auto at_all_steps = [&](const description::Value& value) {
      return std::ranges::all_of(steps, [&](const T& step) { return field.get(step) == value; });
    };
    if (field.absence == Key::Absence::nothing && at_all_steps(field.initial)) continue;
    if (!field.word.empty() && at_all_steps(description::Key::stands_for_word)) continue;
    if (varying != Varying::all && !at_all_steps(field.get(steps.front()))) continue;
    const std::string path = fmt::format("{}.{}", table, field.name);
    if (field.is_number() || field.may_be_axial)
      all.push_back(number_of(
          field, field.is_number() ? std::nullopt : std::optional<Eigen::Index>(2), part, path));
    else if (std::holds_alternative<Vector3>(field.initial))
      for (Eigen::Index axis = 0; axis < 3; ++axis)
        all.push_back(number_of(field, axis, part, fmt::format("{}.{}", path, "xyz"[axis])));
  }
}

/// A number made of several of the case.
CaseNumber derived(std::string path, const Quantity& quantity, const Range& range,
                   std::string_view doc, Order order, std::string sets,
                   const std::function<double(const Case&)>& get,
                   const std::function<void(Case&, double)>& set) {
  CaseNumber number;
  number.path = std::move(path);
  number.quantity = quantity;
  number.range = range;
  number.doc = doc;
  number.initial = 0.0;
  number.order = order;
  number.sets = std::move(sets);
  number.get = [=](const Case& c) { return description::Value(get(c)); };
  number.set = [=](Case& c, const description::Value& value) { set(c, std::get<double>(value)); };
  return number;
}

void append_segments(const Case& c, std::vector<CaseNumber>& all) {
  static constexpr Range proportion_range{0, 1, true, "a segment is a part of the cilium"};
  for (std::size_t i = 0; i < c.cilium.segments.size(); ++i) {
    const std::string table = "cilium.segment." + c.cilium.segments[i].name;
    append_numbers(description::fields<Segment>(), table, c,
                   one<Segment>([i](auto& x) -> auto& { return x.cilium.segments[i]; }), all);
    if (c.cilium.segments.size() < 2) continue;
    all.push_back(derived(
        table + ".proportion", quantity::number, proportion_range,
        "The segment's length over the cilium's, which stays.", Order::proportion,
        "cilium.segment.*.proportion",
        [=](const Case& x) { return x.cilium.segments[i].length / x.cilium.length(); },
        [=](Case& x, double v) {
          const double total = x.cilium.length();
          const double others = total - x.cilium.segments[i].length;
          for (Segment& s : x.cilium.segments) s.length *= total * (1 - v) / others;
          x.cilium.segments[i].length = total * v;
        }));
  }
}

void append_cilium(const Case& c, std::vector<CaseNumber>& all) {
  static constexpr Range ratio_range{0.1, 1e4, false, "a cilium is longer than it is thick"};
  append_numbers(description::fields<Cilium>(), "cilium", c,
                 one<Cilium>([](auto& x) -> auto& { return x.cilium; }), all);
  append_numbers(description::fields<CrossSection>(), "cilium.section", c,
                 one<CrossSection>([](auto& x) -> auto& { return x.cilium.section; }), all);
  append_segments(c, all);
  all.push_back(derived(
      "cilium.length", quantity::length, length_range,
      "The total length, the segments in proportion.", Order::total_length, "cilium.length",
      [](const Case& x) { return x.cilium.length(); },
      [](Case& x, double v) {
        const double total = x.cilium.length();
        for (Segment& s : x.cilium.segments) s.length *= v / total;
      }));
  if (c.cilium.is_rectangular()) return;
  all.push_back(derived(
      "cilium.aspect_ratio", quantity::number, ratio_range,
      "The total length over the diameter, by the diameter.", Order::aspect_ratio,
      "cilium.diameter", [](const Case& x) { return x.cilium.length() / x.cilium.diameter; },
      [](Case& x, double v) { x.cilium.diameter = x.cilium.length() / v; }));
}

/// The parameters of the load, or those that state its magnitude in its place.
void append_load(const Case& c, std::vector<CaseNumber>& all) {
  const LoadType& type = c.load_path.front().type();
  if (!c.stated_by.empty())
    append_numbers(
        type.statement->parameters, "load", c,
        Part<LoadStatement::Values>{[](const Case& x) { return x.stated_by; },
                                    [](Case& x, const auto& steps) { x.stated_by = steps; }},
        all, Varying::all);
  const Part<Load> steps{[](const Case& x) { return x.load_path; },
                         [](Case& x, const auto& path) { x.load_path = path; }};
  append_numbers(
      type.keys(c.stated_by.empty()), "load", c, steps, all,
      c.load_path.front().is<SweepLoad>() ? Varying::but_what_tells_the_steps_apart : Varying::all);
  for (const LoadTable& table : type.tables)
    append_numbers(table.keys, fmt::format("load.{}", table.name), c, steps, all);
}

/// The numbers of a sweep's surface.
void append_surface(const Case& c, std::vector<CaseNumber>& all) {
  using surroundings::StatedSurface;
  if (!c.surface) return;
  append_numbers(
      description::fields<StatedSurface>(), "surface", c,
      Part<StatedSurface>{[](const Case& x) { return std::vector{x.surface.value()}; },
                          [](Case& x, const auto& of) { input::set_surface(x, of.front()); }},
      all);
}

/// The environments of the steps.
Part<surroundings::Environment> environments() {
  using surroundings::Environment;
  return {[](const Case& c) {
            std::vector<Environment> steps;
            for (const Load& load : c.load_path) steps.push_back(load.environment());
            return steps;
          },
          [](Case& c, const std::vector<Environment>& steps) {
            for (std::size_t i = 0; i < steps.size(); ++i) c.load_path[i].set_environment(steps[i]);
          }};
}

/// Gravity, field, and the magnets beside the cilium.
void append_environment(const Case& c, std::vector<CaseNumber>& all) {
  using surroundings::Environment;
  using surroundings::magnets::Magnet;
  Fields<Environment> fields = description::fields<Environment>();
  if (c.load_path.front().environment().gravity.isZero(0))
    std::erase_if(fields, [](const auto& field) { return field.quantity.unit == "kg/m^3"; });
  append_numbers(fields, std::string(input::environment::table_name), c, environments(), all);
  const auto& magnets = c.load_path.front().environment().magnets;
  for (std::size_t i = 0; i < magnets.size(); ++i)
    append_numbers(description::fields<Magnet>(),
                   fmt::format("{}.{}", input::environment::magnet_table, magnets[i].name), c,
                   Part<Magnet>{[i](const Case& x) {
                                  std::vector<Magnet> steps;
                                  for (const Environment& step : environments().get(x))
                                    steps.push_back(step.magnets.at(i));
                                  return steps;
                                },
                                [i](Case& x, const std::vector<Magnet>& steps) {
                                  auto around = environments().get(x);
                                  for (std::size_t k = 0; k < steps.size(); ++k)
                                    around[k].magnets.at(i) = steps[k];
                                  environments().set(x, around);
                                }},
                   all);
}

/// The place of the first sensor.
void append_sensor(const Case& c, std::vector<CaseNumber>& all) {
  if (c.sensors.empty()) return;
  description::Field<Vector3> place;
  static_cast<description::Key&>(place) = input::keys().sensor_position;
  place.get = [](const Vector3& point) { return description::Value(point); };
  place.set = [](Vector3& point, const description::Value& v) { point = std::get<Vector3>(v); };
  append_numbers({place}, "sensor", c,
                 one<Vector3>([](auto& x) -> auto& { return x.sensors.front(); }), all);
}

void append_options(const Case& c, std::vector<CaseNumber>& all) {
  models::known().for_each([&](const auto& entry) {
    append_numbers(entry.options, "models." + entry.id, c,
                   one<input::ModelOptions>([](auto& x) -> auto& { return x.options; }), all);
  });
}

}  // namespace

std::vector<CaseNumber> case_numbers(const input::Case& c) {
  std::vector<CaseNumber> all;
  append_cilium(c, all);
  append_load(c, all);
  append_environment(c, all);
  append_surface(c, all);
  append_sensor(c, all);
  append_options(c, all);
  return all;
}

input::Case with_settings(input::Case c, const std::vector<Setting>& settings) {
  for (const Order order :
       {Order::plain, Order::total_length, Order::proportion, Order::aspect_ratio})
    for (const Setting& setting : settings)
      if (setting.number.order == order) setting.number.set_number(c, setting.value);
  input::set_stated_magnitudes(c);
  input::snap_to_interfaces(c.cilium, c.load_path);
  return c;
}

}  // namespace ciliaval::compare::study

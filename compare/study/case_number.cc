// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/study/case_number.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

#include "compare/input/case_sections.h"

namespace ciliaval::compare::study {
namespace {

using Order = CaseNumber::Order;

CaseNumber plain(std::string path, const QuantityKey& k, std::function<double(const Case&)> get,
                 std::function<void(Case&, double)> set) {
  std::string sets = path;
  return {std::move(path), k.quantity,      k.range,        std::string(k.doc), false,
          Order::plain,    std::move(sets), std::move(get), std::move(set)};
}

void append_segments(const Case& c, std::vector<CaseNumber>& all) {
  static constexpr Range proportion_range{0, 1, true, "a segment is a part of the cilium"};
  using Member = std::pair<const QuantityKey*, double Segment::*>;
  const std::array<Member, 4> members{{{&key::segment_length, &Segment::length},
                                       {&key::young_modulus, &Segment::young_modulus},
                                       {&key::poisson_ratio, &Segment::poisson_ratio},
                                       {&key::magnetization, &Segment::magnetization}}};
  for (std::size_t i = 0; i < c.cilium.segments.size(); ++i) {
    const std::string table = "cilium.segment." + c.cilium.segments[i].name;
    for (const auto& [k, member] : members)
      all.push_back(plain(
          fmt::format("{}.{}", table, k->name), *k,
          [=, m = member](const Case& x) { return x.cilium.segments[i].*m; },
          [=, m = member](Case& x, double v) { x.cilium.segments[i].*m = v; }));
    if (c.cilium.segments.size() < 2) continue;
    all.push_back({table + ".proportion", quantity::number, proportion_range,
                   "The segment's length over the cilium's, which stays.", false, Order::proportion,
                   "cilium.segment.*.proportion",
                   [=](const Case& x) { return x.cilium.segments[i].length / x.cilium.length(); },
                   [=](Case& x, double v) {
                     const double total = x.cilium.length();
                     const double others = total - x.cilium.segments[i].length;
                     for (Segment& s : x.cilium.segments) s.length *= total * (1 - v) / others;
                     x.cilium.segments[i].length = total * v;
                   }});
  }
}

void append_cilium(const Case& c, std::vector<CaseNumber>& all) {
  static constexpr Range ratio_range{0.1, 1e4, false, "a cilium is longer than it is thick"};
  all.push_back(plain(
      "cilium.diameter", key::diameter, [](const Case& x) { return x.cilium.diameter; },
      [](Case& x, double v) { x.cilium.diameter = v; }));
  append_segments(c, all);
  all.push_back({"cilium.length", quantity::length, key::length_range,
                 "The total length, the segments in proportion.", false, Order::total_length,
                 "cilium.length", [](const Case& x) { return x.cilium.length(); },
                 [](Case& x, double v) {
                   const double total = x.cilium.length();
                   for (Segment& s : x.cilium.segments) s.length *= v / total;
                 }});
  all.push_back({"cilium.aspect_ratio", quantity::number, ratio_range,
                 "The total length over the diameter, by the diameter.", false, Order::aspect_ratio,
                 "cilium.diameter",
                 [](const Case& x) { return x.cilium.length() / x.cilium.diameter; },
                 [](Case& x, double v) { x.cilium.diameter = x.cilium.length() / v; }});
}

/// A number of all steps' loads of type T.
template <class T>
CaseNumber of_load(const QuantityKey& k, double T::*member) {
  return plain(
      fmt::format("load.{}", k.name), k,
      [=](const Case& x) { return std::get<T>(x.load_path.front()).*member; },
      [=](Case& x, double v) {
        for (Load& load : x.load_path) std::get<T>(load).*member = v;
      });
}

/// A number of a flow that is given by its velocity.
CaseNumber of_flow(const QuantityKey& k, std::vector<double> Case::*member) {
  return plain(
      fmt::format("load.{}", k.name), k, [=](const Case& x) { return (x.*member).front(); },
      [=](Case& x, double v) { std::fill((x.*member).begin(), (x.*member).end(), v); });
}

void append_load(const Case& c, std::vector<CaseNumber>& all) {
  const Load& load = c.load_path.front();
  if (std::holds_alternative<ContactLoad>(load)) {
    all.push_back(of_load(key::load_force, &ContactLoad::force));
    all.push_back(of_load(key::height, &ContactLoad::height));
    all.push_back(of_load(key::azimuth, &ContactLoad::azimuth));
  } else if (std::holds_alternative<SectionLoad>(load)) {
    all.push_back(of_load(key::load_force, &SectionLoad::force));
    all.push_back(of_load(key::arclength, &SectionLoad::arclength));
    all.push_back(of_load(key::azimuth, &SectionLoad::azimuth));
  } else if (std::holds_alternative<DeadLoad>(load)) {
    all.push_back(of_load(key::force_per_length, &DeadLoad::force_per_length));
    all.push_back(of_load(key::azimuth, &DeadLoad::azimuth));
  } else if (std::holds_alternative<ProbeLoad>(load)) {
    all.push_back(of_load(key::displacement, &ProbeLoad::displacement));
    all.push_back(of_load(key::height, &ProbeLoad::height));
    all.push_back(of_load(key::azimuth, &ProbeLoad::azimuth));
  } else {
    if (c.flow_velocity.empty()) {
      all.push_back(of_load(key::force_per_height, &FlowLoad::force_per_height));
    } else {
      all.push_back(of_flow(key::velocity, &Case::flow_velocity));
      all.push_back(of_flow(key::density, &Case::flow_density));
      all.push_back(of_flow(key::drag_coefficient, &Case::flow_drag_coefficient));
    }
    all.push_back(of_load(key::azimuth, &FlowLoad::azimuth));
  }
}

void append_knobs(const Case& c, std::vector<CaseNumber>& all) {
  for (const Knob& knob : knobs()) {
    const KnobValue value = knob.get(c.options);
    const bool is_whole = std::holds_alternative<unsigned int>(value);
    if (!belongs(knob, c.options) || !(is_whole || std::holds_alternative<double>(value))) continue;
    const std::string path = fmt::format("models.{}.{}", knob.model, knob.name);
    all.push_back(
        {path, knob.quantity, knob.range, std::string(knob.doc), is_whole, Order::plain, path,
         [knob, is_whole](const Case& x) {
           const KnobValue v = knob.get(x.options);
           return is_whole ? std::get<unsigned int>(v) : std::get<double>(v);
         },
         [knob, is_whole](Case& x, double v) {
           knob.set(x.options, is_whole ? KnobValue(static_cast<unsigned int>(v)) : KnobValue(v));
         }});
  }
}

}  // namespace

std::vector<CaseNumber> case_numbers(const Case& c) {
  std::vector<CaseNumber> all;
  append_cilium(c, all);
  append_load(c, all);
  if (!c.sensors.empty())
    for (const auto& [name, axis] : {std::pair("x", 0), std::pair("y", 1), std::pair("z", 2)})
      all.push_back(plain(
          fmt::format("sensor.position.{}", name), key::position,
          [a = axis](const Case& x) { return x.sensors.front()[a]; },
          [a = axis](Case& x, double v) { x.sensors.front()[a] = v; }));
  append_knobs(c, all);
  return all;
}

Case with_settings(Case c, const std::vector<Setting>& settings) {
  for (const Order order :
       {Order::plain, Order::total_length, Order::proportion, Order::aspect_ratio})
    for (const Setting& setting : settings)
      if (setting.number.order == order) setting.number.set(c, setting.value);
  for (std::size_t i = 0; i < c.flow_velocity.size(); ++i)
    std::get<FlowLoad>(c.load_path[i]).force_per_height = drag_per_height(
        c.flow_velocity[i], c.flow_density[i], c.flow_drag_coefficient[i], c.cilium.diameter);
  snap_to_interfaces(c.cilium, c.load_path);
  return c;
}

}  // namespace ciliaval::compare::study

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/environment/environment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

#include "compare/input/case_sections.h"
#include "problem/description/environment.h"

namespace ciliaval::compare::input::environment {
namespace {

using description::Fields;
using surroundings::Environment;
using surroundings::magnets::Magnet;
using surroundings::magnets::Shape;

constexpr std::size_t most_magnets = 100;

/// Weight and fluid, or field and energy: what is written if one of the two is stated.
Fields<Environment> pair_of(std::size_t first) {
  const auto& all = description::fields<Environment>();
  Fields<Environment> pair{all.at(first), all.at(first + 1)};
  for (auto& field : pair) field.absence = description::Key::Absence::its_initial_value;
  return pair;
}

bool is_stated(const Fields<Environment>& pair, std::span<const Environment> path) {
  return std::ranges::any_of(path, [&](const Environment& environment) {
    return std::ranges::any_of(
        pair, [&](const auto& field) { return field.get(environment) != field.initial; });
  });
}

/// A key is stated without the key that it depends on.
void check_companions(Section& table, bool has_magnets) {
  const auto& fields = description::fields<Environment>();
  const auto& [gravity, fluid, field, energy] =
      std::tie(fields.at(0), fields.at(1), fields.at(2), fields.at(3));
  const bool has_gravity = table.find(gravity.name) != nullptr;
  const bool has_field = table.find(field.name) != nullptr;
  const auto needs = [&](const description::Key& key, bool has_other,
                         const description::Key& other) {
    if (const toml::node* node = table.find(key.name); node != nullptr && !has_other)
      table.faults().add(
          place(*node), fmt::format("'{}' goes with '{}', which is missing", key.name, other.name));
  };
  needs(fluid, has_gravity, gravity);
  needs(energy, has_field || has_magnets, field);
  if (!has_gravity && !has_field && !has_magnets)
    table.faults().add(table.where(), fmt::format("[{}] needs '{}', '{}' or [[{}]]", table_name,
                                                  gravity.name, field.name, magnet_table));
}

/// Faults of a magnet whose keys are right one by one.
void check_magnet(Section& table, const Magnet& magnet, const std::vector<Magnet>& others) {
  const auto refuse = [&](std::initializer_list<std::string_view> keys, std::string_view fault) {
    for (const std::string_view key : keys)
      if (const toml::node* node = table.find(key))
        table.faults().add(place(*node), std::string(fault));
  };
  if (std::ranges::find(others, magnet.name, &Magnet::name) != others.end())
    refuse({"name"}, fmt::format("the magnet name {} is already taken", in_quotes(magnet.name)));
  if (std::abs(magnet.rotation.norm() - 1) > 1e-9) {
    refuse({description::axis_key}, "'axis' must point somewhere: it is zero");
    refuse({description::rotation_key},
           "'rotation' must be a unit quaternion [w, x, y, z], such as [0.8, 0, 0.6, 0]");
  }
  if (magnet.magnetization.isZero(0))
    refuse({description::magnetization_key, description::remanence_key},
           "a magnet's magnetisation is zero");
  if (magnet.shape == Shape::cylinder && !magnet.magnetization.head<2>().isZero(0))
    refuse({description::magnetization_key},
           "a cylinder is magnetised along its axis only: across it the field has no closed form "
           "here; take a cuboid or a ball");
}

/// The magnets of each step; one set where no position is listed.
std::vector<std::vector<Magnet>> read_magnets(Section& environment, PathLength& length) {
  std::vector<std::vector<Magnet>> steps(1);
  environment.tables("magnet", 1, most_magnets, [&](Section& table) {
    const std::size_t before = table.faults().size();
    std::vector<Magnet> path(1);
    read(table, description::fields<Magnet>(), path, length);
    if (table.faults().size() == before) check_magnet(table, path.front(), steps.front());
    const std::size_t count = std::max(steps.size(), path.size());
    path.resize(count, path.front());
    steps.resize(count, steps.front());
    for (std::size_t i = 0; i < count; ++i) steps[i].push_back(path[i]);
  });
  return steps;
}

}  // namespace

std::vector<Environment> read_environment(Section& root, PathLength& length) {
  Section table = root.section(table_name);
  if (!table.exists()) return {};
  std::vector<Environment> result(1);
  read(table, description::fields<Environment>(), result, length);
  check_companions(table, table.find("magnet") != nullptr);
  const auto magnets = read_magnets(table, length);
  table.finish();
  result.resize(std::max(result.size(), magnets.size()), result.front());
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i].magnets = magnets[magnets.size() == 1 ? 0 : std::min(i, magnets.size() - 1)];
  return result;
}

bool put_into(const std::vector<Environment>& environments, LoadPath& path) {
  if (environments.empty()) return true;
  if (path.size() == 1) path.resize(environments.size(), path.front());
  if (environments.size() != 1 && environments.size() != path.size()) return false;
  for (std::size_t i = 0; i < path.size(); ++i)
    path[i].set_environment(environments[environments.size() == 1 ? 0 : i]);
  return true;
}

LoadPath path_of(const std::vector<Environment>& environments) {
  const auto horizontal = [](const Vector3& v) { return v.head<2>().norm(); };
  const auto& strongest = *std::ranges::max_element(
      environments, {}, [&](const Environment& e) { return horizontal(e.uniform_field); });
  std::vector<Vector3> candidates{strongest.uniform_field, strongest.gravity};
  for (const surroundings::magnets::Magnet& magnet : strongest.magnets) {
    candidates.push_back(magnet.position);
    candidates.push_back(surroundings::magnets::moment(magnet));
  }
  const auto first =
      std::ranges::find_if(candidates, [&](const Vector3& v) { return horizontal(v) > 0; });
  const Vector3 across = first == candidates.end() ? Vector3(Vector3::Zero()) : *first;
  const double azimuth = horizontal(across) > 0 ? std::atan2(across.y(), across.x()) : 0;
  LoadPath path{EnvironmentLoad{1, azimuth}};
  put_into(environments, path);
  return path;
}

std::string to_toml(const LoadPath& path) {
  std::vector<Environment> steps;
  bool is_left_out = true;
  for (const Load& load : path) {
    steps.push_back(load.environment());
    is_left_out = is_left_out && !load.is<EnvironmentLoad>() && steps.back() == Environment{};
  }
  if (is_left_out) return {};
  std::string text = fmt::format("\n[{}]\n", table_name);
  const std::span<const Environment> all(steps);
  const bool has_weight = is_stated(pair_of(0), all);
  const std::size_t magnets = steps.front().magnets.size();
  if (has_weight) text += lines(pair_of(0), all);
  if (is_stated(pair_of(2), all) || (!has_weight && magnets == 0)) text += lines(pair_of(2), all);
  for (std::size_t i = 0; i < magnets; ++i) {
    std::vector<Magnet> along;
    along.reserve(steps.size());
    for (const Environment& step : steps) along.push_back(step.magnets.at(i));
    text += fmt::format("\n[[{}]]\n", magnet_table) +
            lines(description::fields<Magnet>(), std::span<const Magnet>(along));
  }
  return text;
}

}  // namespace ciliaval::compare::input::environment

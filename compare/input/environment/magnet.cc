// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/environment/magnet.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "compare/input/case_sections.h"
#include "problem/field_model.h"
#include "problem/support/rotation.h"
#include "problem/support/words.h"

namespace ciliaval::compare::input::environment {
namespace {

using surroundings::magnets::Magnet;
using surroundings::magnets::Shape;

constexpr std::size_t most_magnets = 100;
constexpr std::size_t most_positions = 1000;
constexpr std::size_t longest_name = 100;
constexpr std::array<std::string_view, 3> shape_names{"ball", "cylinder", "cuboid"};

std::optional<Quaternion> read_rotation(const toml::node& node, Faults& faults) {
  const toml::array* list = node.as_array();
  Eigen::Vector4d q = Eigen::Vector4d::Zero();
  bool is_right = list != nullptr && list->size() == 4;
  for (std::size_t i = 0; is_right && i < 4; ++i) {
    const auto value = read_value((*list)[i], magnet_rotation.name, magnet_rotation.quantity,
                                  magnet_rotation.range, faults);
    if (!value) return std::nullopt;
    q[static_cast<Eigen::Index>(i)] = *value;
  }
  if (is_right && std::abs(q.norm() - 1) < 1e-9) return Quaternion(q[0], q[1], q[2], q[3]);
  faults.add(place(node), fmt::format("'{}' must be a unit quaternion [w, x, y, z], such as "
                                      "[0.8, 0, 0.6, 0]",
                                      magnet_rotation.name));
  return std::nullopt;
}

void read_pose(Section& table, Magnet& magnet) {
  Faults& faults = table.faults();
  const toml::node* axis = table.find(magnet_axis.name);
  const toml::node* rotation = table.find(magnet_rotation.name);
  if (axis != nullptr && rotation != nullptr)
    faults.add(place(*rotation), "'rotation' takes the place of 'axis': leave out one of the two");
  if (rotation != nullptr)
    magnet.rotation = read_rotation(*rotation, faults).value_or(Quaternion::Identity());
  if (axis == nullptr || rotation != nullptr) return;
  const auto direction = read_point(*axis, magnet_axis, faults);
  if (direction && direction->isZero(0))
    faults.add(place(*axis), "'axis' must point somewhere: it is zero");
  else if (direction)
    magnet.rotation = support::turn_to(*direction);
}

void read_magnetization(Section& table, Magnet& magnet) {
  Faults& faults = table.faults();
  const toml::node* remanence = table.find(magnet_remanence.name);
  const toml::node* node = table.find(magnet_magnetization.name);
  if ((remanence == nullptr) == (node == nullptr)) {
    faults.add(node == nullptr ? table.where() : place(*remanence),
               fmt::format("a magnet needs 'magnetization' or 'remanence'{}",
                           node == nullptr ? "" : ", not both"));
    return;
  }
  if (remanence != nullptr)
    magnet.magnetization.z() = read_value(*remanence, magnet_remanence.name,
                                          magnet_remanence.quantity, magnet_remanence.range, faults)
                                   .value_or(1) /
                               vacuum_permeability;
  else if (node->is_array())
    magnet.magnetization =
        read_point(*node, magnet_magnetization, faults).value_or(Vector3::UnitZ());
  else
    magnet.magnetization.z() =
        read_value(*node, magnet_magnetization.name, magnet_magnetization.quantity,
                   magnet_magnetization.range, faults)
            .value_or(1);
  const toml::node& stated = remanence != nullptr ? *remanence : *node;
  if (magnet.magnetization.isZero(0)) faults.add(place(stated), "a magnet's magnetisation is zero");
  if (magnet.shape == Shape::cylinder && !magnet.magnetization.head<2>().isZero(0))
    faults.add(place(stated),
               "a cylinder is magnetised along its axis only: across it the field has no closed "
               "form here; take a cuboid or a ball");
}

void read_size(Section& table, Magnet& magnet) {
  if (magnet.shape != Shape::cuboid) magnet.diameter = table.value(magnet_diameter).value_or(1e-3);
  if (magnet.shape == Shape::cylinder) magnet.length = table.value(magnet_length).value_or(1e-3);
  if (magnet.shape != Shape::cuboid) return;
  if (const toml::node* node = table.require(magnet_edges.name))
    magnet.edges =
        read_point(*node, magnet_edges, table.faults()).value_or(Vector3::Constant(1e-3));
}

/// The centre, or the centres of a path.
std::vector<Vector3> read_positions(Section& table) {
  const toml::node* node = table.require(magnet_position.name);
  if (node == nullptr) return {};
  const toml::array* list = node->as_array();
  if (list == nullptr || list->empty() || !list->front().is_array()) {
    const auto point = read_point(*node, magnet_position, table.faults());
    return point ? std::vector{*point} : std::vector<Vector3>{};
  }
  if (list->size() > most_positions)
    table.faults().add(place(*node), fmt::format("'position' lists {} points: at most {}",
                                                 list->size(), most_positions));
  std::vector<Vector3> points;
  for (const toml::node& element : *list)
    if (const auto point = read_point(element, magnet_position, table.faults()))
      points.push_back(*point);
  return points;
}

std::string magnet_to_toml(const LoadPath& path, std::size_t index) {
  const Magnet& m = path.front().environment().magnets[index];
  std::vector<std::string> positions;
  for (const Load& load : path)
    positions.push_back(
        format_vector(load.environment().magnets.at(index).position, quantity::length));
  const bool stays = std::ranges::all_of(
      positions, [&](const std::string& position) { return position == positions.front(); });
  std::string text =
      fmt::format("\n[[{}]]\nname = {}\nshape = \"{}\"\nposition = {}\n", magnet_table,
                  toml_text(m.name), surroundings::magnets::name(m.shape),
                  stays ? positions.front() : fmt::format("[{}]", fmt::join(positions, ", ")));
  const Quaternion& q = m.rotation;
  if (q.coeffs() != Quaternion::Identity().coeffs())
    text += fmt::format("rotation = [{}, {}, {}, {}]\n", q.w(), q.x(), q.y(), q.z());
  if (m.shape == Shape::cuboid)
    text += fmt::format("edges = {}\n", format_vector(m.edges, quantity::length));
  else
    text += fmt::format("diameter = \"{}\"\n", format_quantity(m.diameter, quantity::length));
  if (m.shape == Shape::cylinder)
    text += fmt::format("length = \"{}\"\n", format_quantity(m.length, quantity::length));
  return text + fmt::format("magnetization = {}\n",
                            format_vector(m.magnetization, quantity::magnetization));
}

}  // namespace

std::vector<std::vector<Magnet>> read_magnets(Section& environment) {
  if (environment.find("magnet") == nullptr) return {};
  Faults& faults = environment.faults();
  std::vector<std::vector<Magnet>> steps(1);
  environment.tables("magnet", 1, most_magnets, [&](Section& table) {
    Magnet magnet;
    if (const toml::node* node = table.require("name")) {
      magnet.name = read_line(*node, "name", longest_name, faults).value_or("");
      if (std::ranges::any_of(steps.front(),
                              [&](const Magnet& other) { return other.name == magnet.name; }))
        faults.add(place(*node),
                   fmt::format("the magnet name {} is already taken", in_quotes(magnet.name)));
    }
    std::optional<std::string> shape;
    if (const toml::node* node = table.require("shape"))
      shape = read_choice(*node, "shape", shape_names, faults);
    if (shape)
      magnet.shape =
          static_cast<Shape>(std::ranges::find(shape_names, *shape) - shape_names.begin());
    read_pose(table, magnet);
    read_magnetization(table, magnet);
    if (shape)
      read_size(table, magnet);
    else
      for (const auto* k : {&magnet_diameter, &magnet_length, &magnet_edges}) table.find(k->name);
    const std::vector<Vector3> positions = read_positions(table);
    if (positions.size() > 1 && steps.size() == 1) steps.resize(positions.size(), steps.front());
    if (positions.size() > 1 && positions.size() != steps.size())
      faults.add(place(*table.find(magnet_position.name)),
                 fmt::format("'position' lists {} points, but that of another magnet {}",
                             positions.size(), steps.size()));
    for (std::size_t i = 0; i < steps.size(); ++i) {
      if (!positions.empty()) magnet.position = positions[std::min(i, positions.size() - 1)];
      steps[i].push_back(magnet);
    }
  });
  return steps;
}

std::string magnets_to_toml(const LoadPath& path) {
  std::string text;
  for (std::size_t i = 0; i < path.front().environment().magnets.size(); ++i)
    text += magnet_to_toml(path, i);
  return text;
}

}  // namespace ciliaval::compare::input::environment

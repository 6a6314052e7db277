// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/serialization/array_wrapper.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/utility.hpp>
#include <boost/serialization/vector.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "problem/mechanics_model.h"

// Serialisation of loads and results, for checkpoints and pickles. Each type is taken apart by
// structured bindings: a member that is added to it and forgotten here does not compile.
namespace boost::serialization {

template <class Archive, class T>
void serialize(Archive& archive, std::optional<T>& value, unsigned int /*version*/) {
  bool there = value.has_value();
  archive& there;
  if (there && !value) value.emplace();
  if (there)
    archive&* value;
  else
    value.reset();
}

template <class Archive>
void serialize(Archive& archive, ciliaval::surroundings::magnets::Magnet& magnet,
               unsigned int /*version*/) {
  auto& [name, shape, position, rotation, diameter, length, edges, magnetization] = magnet;
  archive& name& shape& position& rotation.coeffs() & diameter& length& edges& magnetization;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::surroundings::Environment& environment,
               unsigned int /*version*/) {
  auto& [gravity, fluid_density, field, energy, magnets] = environment;
  archive& gravity& fluid_density& field& energy& magnets;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::Load& load, unsigned int /*version*/) {
  std::string type(load.type().name);
  archive& type;
  if (const ciliaval::LoadType* saved = ciliaval::find_load_type(type); saved != &load.type())
    load = ciliaval::Load(*saved);
  for (std::size_t i = 0; i < load.values().size(); ++i) {
    double value = load.values()[i];
    archive& value;
    load.set_value(i, value);
  }
  ciliaval::SlipOffPoint slip_off_point = load.slip_off_point();
  archive& slip_off_point;
  load.set_slip_off_point(slip_off_point);
  ciliaval::TouchLaw touch = load.touch();
  auto& [law, friction, at, radius] = touch;
  archive& law& friction& at& radius;
  load.set_touch(touch);
  ciliaval::surroundings::Environment environment = load.environment();
  archive& environment;
  load.set_environment(environment);
}

template <class Archive, int rows, int columns>
void serialize(Archive& archive, Eigen::Matrix<double, rows, columns>& matrix,
               unsigned int /*version*/) {
  static_assert(rows > 0 && columns > 0);
  archive& make_array(matrix.data(), static_cast<std::size_t>(matrix.size()));
}

template <class Archive>
void serialize(Archive& archive, ciliaval::SurfaceContact& contact, unsigned int /*version*/) {
  auto& [state, where, normal_force, friction_force, point, elastic_energy, surface_work,
         friction_work, energy_lost] = contact;
  archive& state& where& normal_force& friction_force& elastic_energy& surface_work& friction_work&
      energy_lost& point;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::ProbeContact& touch, unsigned int /*version*/) {
  auto& [vertical_force, base_moment, displacement, state] = touch;
  archive& vertical_force& base_moment& displacement& state;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::continuation::ApproachToFold& at,
               unsigned int /*version*/) {
  auto& [fraction, smallest_eigenvalue] = at;
  archive& fraction& smallest_eigenvalue;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::continuation::PullIn& pull_in,
               unsigned int /*version*/) {
  auto& [fraction, load, magnet, tip, tip_angle, approach] = pull_in;
  archive& fraction& load& magnet& tip& tip_angle& approach;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::MechanicsStep& step, unsigned int /*version*/) {
  auto& [load, status, message, deformation, applied_force, slip_off_force, slip_off_displacement,
         slip_off_uncertainty, slip_off_point, contact_arclength, touch, contact, tip_uncertainty,
         tip_angle_uncertainty, applied_force_uncertainty, unstable_modes, smallest_eigenvalue,
         pull_in, unknowns, iterations, seconds] = step;
  static_cast<void>(deformation);  // rebuilt from the state
  // Estimated anew.
  static_cast<void>(tip_uncertainty);
  static_cast<void>(tip_angle_uncertainty);
  static_cast<void>(applied_force_uncertainty);
  archive& load& status& message& applied_force& slip_off_force& slip_off_displacement&
      slip_off_uncertainty& slip_off_point& contact_arclength& touch& contact& unstable_modes&
          smallest_eigenvalue& pull_in& unknowns& iterations& seconds;
}

}  // namespace boost::serialization

namespace ciliaval::support {

/// The values, one after the other, as bytes.
inline std::string serialized(const auto&... values) {
  std::ostringstream stream;
  {
    boost::archive::binary_oarchive archive(stream);
    (archive << ... << values);
  }
  return std::move(stream).str();
}

/// Reads the first of the values that were serialised together. Throws std::exception if the bytes
/// are others.
void deserialize(const std::string& bytes, auto&... values) {
  std::istringstream stream(bytes);
  boost::archive::binary_iarchive archive(stream);
  (archive >> ... >> values);
}

}  // namespace ciliaval::support

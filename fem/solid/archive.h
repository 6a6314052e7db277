// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/serialization/array_wrapper.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/utility.hpp>
#include <boost/serialization/vector.hpp>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "fem/solid/equilibrium/load_path.h"
#include "problem/deformation.h"
#include "problem/mechanics_model.h"

// What a state consists of. Each type is taken apart by structured bindings: a member that is added
// to it and forgotten here does not compile.
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
void serialize(Archive& archive, ciliaval::Load& load, unsigned int /*version*/) {
  std::size_t type = load.index();
  archive& type;
  if (type != load.index()) {
    static const std::array<ciliaval::Load, 5> loads{ciliaval::ContactLoad{}, ciliaval::FlowLoad{},
                                                     ciliaval::SectionLoad{}, ciliaval::DeadLoad{},
                                                     ciliaval::ProbeLoad{}};
    static_assert(std::variant_size_v<ciliaval::Load> == loads.size());
    load = loads.at(type);
  }
  std::visit(
      [&archive](auto& l) {
        if constexpr (
            requires { l.height; } || requires { l.arclength; }) {
          auto& [magnitude, place, azimuth] = l;
          archive& magnitude& place& azimuth;
        } else {
          auto& [magnitude, azimuth] = l;
          archive& magnitude& azimuth;
        }
      },
      load);
}

template <class Archive>
void serialize(Archive& archive, ciliaval::fem::SolidState& state, unsigned int /*version*/) {
  auto& [displacement, pressure] = state;
  auto unknowns = displacement.size();
  std::size_t elements = pressure.size();
  archive& unknowns& elements;
  if (unknowns != displacement.size()) displacement.reinit(unknowns);
  pressure.resize(elements);
  archive& make_array(displacement.begin(), unknowns);
  for (auto& coefficients : pressure)
    archive& make_array(coefficients.data(), static_cast<std::size_t>(coefficients.size()));
}

/// Vectors or matrices of fixed size as the numbers that they are.
template <class Archive, int rows, int columns>
void serialize_numbers(Archive& archive, std::vector<Eigen::Matrix<double, rows, columns>>& all) {
  std::size_t size = all.size();
  archive& size;
  all.resize(size);
  if (size > 0) archive& make_array(all.front().data(), size * rows * columns);
}

template <class Archive>
void serialize(Archive& archive, ciliaval::SectionState& state, unsigned int /*version*/) {
  auto& [position, rotation, curvature, forces] = state;
  auto& [force, moment] = forces;
  archive& make_array(rotation.coeffs().data(), 4);
  for (ciliaval::Vector3* vector : {&position, &curvature, &force, &moment})
    archive& make_array(vector->data(), 3);
}

template <class Archive>
void serialize(Archive& archive, ciliaval::Centreline::Piece& piece, unsigned int /*version*/) {
  auto& [S, states] = piece;
  archive& S& states;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::SolidCell& cell, unsigned int /*version*/) {
  auto& [segment, magnetization, reference, current, jacobian, cauchy_stress] = cell;
  archive& segment& make_array(magnetization.data(), 3) & jacobian;
  serialize_numbers(archive, reference);
  serialize_numbers(archive, current);
  serialize_numbers(archive, cauchy_stress);
}

template <class Archive>
void serialize(Archive& archive, ciliaval::ChargedFace& face, unsigned int /*version*/) {
  auto& [magnetization_jump, reference, current] = face;
  archive& make_array(magnetization_jump.data(), 3);
  serialize_numbers(archive, reference);
  serialize_numbers(archive, current);
}

/// Of a solid: there is a body.
template <class Archive>
void serialize(Archive& archive, ciliaval::Deformation& deformation, unsigned int /*version*/) {
  auto& [centreline, shared_body] = deformation;
  if constexpr (Archive::is_saving::value) {
    const auto& [nodes, cells, charged_faces] = *shared_body;
    archive << centreline.pieces() << nodes.nodes() << cells << charged_faces;
  } else {
    std::vector<ciliaval::Centreline::Piece> pieces;
    std::vector<double> places;
    ciliaval::SolidBody body;
    auto& [nodes, cells, charged_faces] = body;
    archive >> pieces >> places >> cells >> charged_faces;
    nodes = ciliaval::LagrangeBasis(std::move(places));
    centreline = ciliaval::Centreline(std::move(pieces));
    shared_body = std::make_shared<const ciliaval::SolidBody>(std::move(body));
  }
}

template <class Archive>
void serialize(Archive& archive, ciliaval::fem::Equilibrium& equilibrium, unsigned int /*v*/) {
  auto& [load, state, applied_force] = equilibrium;
  archive& load& state& applied_force;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::fem::Ramp& ramp, unsigned int /*version*/) {
  auto& [start, target, reached, step, cuts, overshoots, iterations, unguided] = ramp;
  archive& start& target& reached& step& cuts& overshoots& iterations& unguided;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::fem::LoadPathState& state, unsigned int /*version*/) {
  auto& [current, previous, slipped, ramp] = state;
  archive& current& previous& slipped& ramp;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::MechanicsStep& step, unsigned int /*version*/) {
  auto& [load, status, message, deformation, applied_force, slip_off_force, slip_off_displacement,
         contact_arclength, tip_uncertainty, unknowns, iterations, seconds] = step;
  static_cast<void>(deformation);  // rebuilt from the state
  archive& load& status& message& applied_force& slip_off_force& slip_off_displacement&
      contact_arclength& tip_uncertainty& unknowns& iterations& seconds;
}

}  // namespace boost::serialization

namespace ciliaval::fem {

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

}  // namespace ciliaval::fem

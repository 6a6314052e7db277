// SPDX-License-Identifier: LGPL-2.1-or-later
#include "python/core/pickle.h"

#include <boost/serialization/array.hpp>
#include <cstddef>
#include <exception>
#include <memory>
#include <utility>

#include "compare/output/provenance.h"
#include "problem/error.h"
#include "problem/mechanics_model.h"
#include "problem/support/archive.h"

// A member that is added to one of these types and forgotten here does not compile.
namespace boost::serialization {

template <class Archive>
void serialize(Archive& archive, ciliaval::Segment& segment, unsigned int /*version*/) {
  auto& [name, length, E, nu, M, density, transverse] = segment;
  archive& name& length& E& nu& M& density& transverse;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::CrossSection& section, unsigned int /*version*/) {
  auto& [shape, width, height, inner_diameter, orientation] = section;
  archive& shape& width& height& inner_diameter& orientation;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::Cilium& cilium, unsigned int /*version*/) {
  auto& [diameter, segments, section] = cilium;
  archive& diameter& segments& section;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::SectionState& state, unsigned int /*version*/) {
  auto& [position, rotation, curvature, forces] = state;
  auto& [force, moment] = forces;
  archive& position& rotation.coeffs() & curvature& force& moment;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::Centreline::Piece& piece, unsigned int /*version*/) {
  auto& [S, states] = piece;
  archive& S& states;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::Centreline& centreline, unsigned int /*version*/) {
  std::vector<ciliaval::Centreline::Piece> pieces = centreline.pieces();
  archive& pieces;
  if (Archive::is_loading::value && !pieces.empty())
    centreline = ciliaval::Centreline(std::move(pieces));
}

template <class Archive>
void serialize(Archive& archive, ciliaval::SolidCell& cell, unsigned int /*version*/) {
  auto& [segment, magnetization, reference, current, jacobian, stress] = cell;
  archive& segment& magnetization& reference& current& jacobian& stress;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::ChargedFace& face, unsigned int /*version*/) {
  auto& [jump, reference, current] = face;
  archive& jump& reference& current;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::SolidBody& body, unsigned int /*version*/) {
  auto& [basis, cells, charged_faces] = body;
  std::vector<double> nodes = basis.nodes();
  archive& nodes& cells& charged_faces;
  if (Archive::is_loading::value) basis = ciliaval::LagrangeBasis(std::move(nodes));
}

template <class Archive>
void serialize(Archive& archive, ciliaval::Deformation& deformation, unsigned int /*version*/) {
  auto& [centreline, body] = deformation;
  bool has_body = body != nullptr;
  archive& centreline& has_body;
  if (!has_body) return;
  ciliaval::SolidBody content = body ? *body : ciliaval::SolidBody{};
  archive& content;
  if (Archive::is_loading::value)
    body = std::make_shared<const ciliaval::SolidBody>(std::move(content));
}

template <class Archive>
void serialize(Archive& archive, ciliaval::ErrorPart& part, unsigned int /*version*/) {
  auto& [direction, finer, coarser, factor] = part;
  archive& direction& finer& coarser& factor;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::MechanicsResult& result, unsigned int /*version*/) {
  auto& [undeformed, steps, companions, error_parts, algebraic_error] = result;
  archive& undeformed& steps& companions& error_parts& algebraic_error;
  // The archive of a step leaves these out, for the solid makes them anew.
  for (ciliaval::MechanicsStep& step : steps)
    archive& step.deformation& step.tip_uncertainty& step.tip_angle_uncertainty& step
        .applied_force_uncertainty;
}

}  // namespace boost::serialization

namespace ciliaval::python::core {
namespace py = pybind11;

template <class T>
py::bytes packed(const T& value) {
  return support::serialized(value);
}

template <class T>
T unpacked(const py::bytes& bytes) {
  T value;
  try {
    support::deserialize(bytes, value);
  } catch (const std::exception& error) {
    throw InputError(std::string("the pickle is damaged: ") + error.what());
  }
  return value;
}

std::string build() {
  return compare::output::version_line();
}

void require_own_build(const std::string& other) {
  if (other != build())
    throw InputError("this was pickled by " + other + ", but here is " + build() +
                     ": a pickle is read by the build that made it");
}

#define CILIAVAL_PICKLE(T)             \
  template py::bytes packed(const T&); \
  template T unpacked(const py::bytes&);
CILIAVAL_PICKLE(Segment)
CILIAVAL_PICKLE(Cilium)
CILIAVAL_PICKLE(Load)
CILIAVAL_PICKLE(MechanicsResult)
CILIAVAL_PICKLE(surroundings::Environment)
CILIAVAL_PICKLE(surroundings::magnets::Magnet)
#undef CILIAVAL_PICKLE

}  // namespace ciliaval::python::core

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/centreline.h"

#include <utility>

#include "problem/lagrange.h"

namespace ciliaval::fem::beam {
namespace {

/// Shorter elements (relative to L) are left out: their nodes would coincide to rounding error.
constexpr double shortest_piece = 1e-12;

Centreline::Piece piece(const System& system, const State& state, std::size_t element) {
  const ReferenceElement& reference = system.reference_element();
  const std::size_t p = system.mesh().degree;
  const ElementData data = system.element_data(state, {}, element);
  const LagrangeBasis gauss(reference.points);
  std::vector<double> weights(p);
  Centreline::Piece result;
  for (std::size_t a = 0; a < reference.n_nodes(); ++a) {
    const std::size_t node = element * p + a;
    SectionState section;
    section.position = state.position[node];
    section.rotation = state.rotation[node];
    gauss.values(reference.nodes[a], weights);
    for (std::size_t g = 0; g < p; ++g) {
      const Vector3& force = state.force[element * p + g];
      const Vector3& moment = state.moment[element * p + g];
      section.forces.force += weights[g] * force;
      section.forces.moment += weights[g] * moment;
      section.curvature +=
          weights[g] * (data.section.moment_strain(force, moment) + data.kappa0[g] / data.length);
    }
    section.forces.force = section.rotation * section.forces.force;
    section.forces.moment = section.rotation * section.forces.moment;
    section.curvature = section.rotation * section.curvature;
    result.S.push_back(system.node_arclength(state, node));
    result.states.push_back(section);
  }
  return result;
}

}  // namespace

Centreline centreline(const System& system, const State& state) {
  std::vector<Centreline::Piece> pieces;
  for (std::size_t e = 0; e < system.mesh().n_elements(); ++e) {
    const double length = system.vertex_arclength(state, e + 1) - system.vertex_arclength(state, e);
    if (length <= shortest_piece * system.length_scale()) continue;
    pieces.push_back(piece(system, state, e));
    if (pieces.size() > 1) pieces.back().S.front() = pieces[pieces.size() - 2].S.back();
  }
  pieces.front().S.front() = system.mesh().vertices.front();
  pieces.back().S.back() = system.mesh().vertices.back();
  return Centreline(std::move(pieces));
}

}  // namespace ciliaval::fem::beam

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "fem/solid/discretisation/assembly.h"
#include "fem/solid/discretisation/space.h"
#include "fem/solid/equilibrium/newton.h"
#include "fem/solid/loads/dead_forces.h"
#include "problem/error.h"

namespace ciliaval::fem::solid {

/// A block [0, a] × [0, b] × [0, c] of one material; boundary ids 0…5: −x, +x, −y, +y, −z, +z.
struct Block {
  dealii::Triangulation<3> triangulation;
  dealii::MappingQ<3> mapping{discretisation::element_degree};
  std::vector<material::Hyperelastic> materials;

  Block(const material::Hyperelastic& material, const std::vector<unsigned int>& cells,
        const Vector3& size = Vector3::Ones(), double distortion = 0)
      : materials{material} {
    dealii::GridGenerator::subdivided_hyper_rectangle(triangulation, cells, dealii::Point<3>(),
                                                      dealii::Point<3>(size[0], size[1], size[2]),
                                                      true);
    for (const auto& cell : triangulation.active_cell_iterators()) cell->set_material_id(0);
    if (distortion > 0) dealii::GridTools::distort_random(distortion, triangulation, true, 7);
  }
};

inline material::Hyperelastic neo_hooke(double young_modulus, double poisson_ratio) {
  return material::Hyperelastic::neo_hooke(young_modulus / (2 * (1 + poisson_ratio)),
                                           young_modulus / (3 * (1 - 2 * poisson_ratio)));
}

/// Calls visit(X, element, a) for every node of every element, a lexicographic.
template <typename Visit>
void for_each_node(const discretisation::SolidSpace& space, const Visit& visit) {
  const auto& points = space.scalar_element().get_unit_support_points();
  for (const discretisation::SolidElement& element : space.elements()) {
    for (unsigned int a = 0; a < discretisation::element_nodes; ++a) {
      const auto X = space.mapping().transform_unit_to_real_cell(element.cell, points[a]);
      visit(Vector3(X[0], X[1], X[2]), element, space.lexicographic()[a]);
    }
  }
}

/// Nodal forces ∫ N_a t(X, N) dA of a traction t, N/m², on a part of the boundary with the outward
/// normal N.
inline discretisation::Vector traction(
    const discretisation::SolidSpace& space, dealii::types::boundary_id boundary,
    const std::function<Vector3(const Vector3& X, const Vector3& N)>& t) {
  const dealii::QGauss<2> gauss(discretisation::element_degree + 2);
  dealii::FEFaceValues<3> values(space.mapping(), space.scalar_element(), gauss,
                                 dealii::update_values | dealii::update_JxW_values |
                                     dealii::update_quadrature_points |
                                     dealii::update_normal_vectors);
  const auto vector = [](const dealii::Tensor<1, 3>& x) { return Vector3(x[0], x[1], x[2]); };
  discretisation::Vector forces(space.unknowns());
  for (const discretisation::SolidElement& element : space.elements()) {
    for (const unsigned int face : element.cell->face_indices()) {
      if (!element.cell->face(face)->at_boundary() ||
          element.cell->face(face)->boundary_id() != boundary)
        continue;
      values.reinit(element.cell, face);
      for (unsigned int q = 0; q < gauss.size(); ++q) {
        const Vector3 f =
            values.JxW(q) * t(vector(values.quadrature_point(q)), vector(values.normal_vector(q)));
        for (unsigned int a = 0; a < discretisation::element_nodes; ++a)
          for (unsigned int c = 0; c < 3; ++c)
            forces[element.dofs[c * discretisation::element_nodes + space.lexicographic()[a]]] +=
                values.shape_value(a, q) * f[c];
      }
    }
  }
  return forces;
}

/// Solves with Dirichlet conditions and dead nodal forces, in `steps` equal steps of both. `guess`
/// is a displacement from whose nine tenths the inner nodes start.
inline discretisation::SolidState find_equilibrium(
    const discretisation::SolidSpace& space,
    const std::vector<discretisation::DirichletCondition>& conditions,
    const discretisation::Vector& forces, int steps, equilibrium::NewtonResult* last = nullptr,
    const std::function<Vector3(const Vector3&)>& guess = {}) {
  equilibrium::Newton newton(space, increment_constraints(space, conditions),
                             solvers::SolverKind::automatic, MPI_COMM_SELF);
  discretisation::SolidState state = space.undeformed();
  if (guess) {
    for_each_node(
        space, [&](const Vector3& X, const discretisation::SolidElement& element, unsigned int a) {
          const Vector3 u = 0.9 * guess(X);
          for (unsigned int c = 0; c < 3; ++c)
            state.displacement[element.dofs[c * discretisation::element_nodes + a]] = u[c];
        });
  }
  for (int step = 1; step <= steps; ++step) {
    const double factor = static_cast<double>(step) / steps;
    prescribe(space, conditions, state, factor);
    discretisation::Vector scaled(forces);
    scaled *= factor;
    const equilibrium::NewtonResult result =
        newton.solve(loads::dead_forces(scaled), state, {.tolerance = 1e-11});
    if (!result.converged) throw SolverError("Newton: " + result.reason);
    if (last != nullptr) *last = result;
  }
  return state;
}

/// Largest difference between the nodal displacements and a field.
template <typename Field>
double nodal_error(const discretisation::SolidSpace& space, const discretisation::SolidState& state,
                   const Field& field) {
  double error = 0;
  for_each_node(
      space, [&](const Vector3& X, const discretisation::SolidElement& element, unsigned int a) {
        const Vector3 u = nodal_displacements(element, state.displacement).row(a).transpose();
        error = std::max(error, (u - field(X)).norm());
      });
  return error;
}

}  // namespace ciliaval::fem::solid

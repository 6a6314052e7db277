// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <sys/resource.h>

#include <memory>
#include <utility>
#include <vector>

#include "fem/parallel.h"
#include "fem/solid/discretisation/assembly.h"
#include "fem/solid/equilibrium/load_path.h"
#include "fem/solid/loads/external_forces.h"
#include "fem/solid/solvers/linear_solver.h"
#include "meshes/cylinder/cylinder_mesh.h"
#include "tests/bench/paper_cilium.h"

namespace ciliaval::fem::solid {

/// Layers in diameters; they grow by 0.3 with the distance.
inline meshes::cylinder::CylinderMeshOptions mesh_options(unsigned int square_cells,
                                                          unsigned int rings, double ring_ratio,
                                                          double finest_layer,
                                                          double coarsest_layer) {
  meshes::cylinder::CylinderMeshOptions options;
  options.square_cells = square_cells;
  options.rings = rings;
  options.ring_ratio = ring_ratio;
  options.finest_layer = finest_layer;
  options.coarsest_layer = coarsest_layer;
  options.growth = 0.3;
  return options;
}

/// Whole meshes of the paper's cilium, from 20,000 to 5,000,000 unknowns, with cells of nearly the
/// same shape.
inline const std::vector<meshes::cylinder::CylinderMeshOptions> mesh_family{
    mesh_options(4, 1, 1, 0.11, 0.4),          mesh_options(4, 3, 0.7, 0.07, 0.25),
    mesh_options(6, 4, 0.8, 0.05, 0.15),       mesh_options(8, 5, 0.85, 0.036, 0.11),
    mesh_options(10, 7, 0.87, 0.025, 0.066),   mesh_options(14, 9, 0.9, 0.0185, 0.05),
    mesh_options(18, 11, 0.92, 0.0145, 0.0385)};
inline constexpr std::size_t million = 4;  ///< of 1,000,000 unknowns

/// The tangent on such a mesh without load (E₂/E₁ = 30), the nodal forces of 1 mN at 16 mm; in
/// parts, if there are several ranks.
class Discretised {
 public:
  Discretised(const meshes::cylinder::CylinderMeshOptions& mesh, double poisson_ratio) {
    start_mpi();
    const Cilium cilium = paper_cilium(poisson_ratio);
    triangulation_ = meshes::cylinder::make_cylinder(cilium, mesh, MPI_COMM_WORLD);
    mapping_ = meshes::cylinder::cylinder_mapping(*triangulation_, discretisation::element_degree);
    std::vector<material::Hyperelastic> materials;
    for (const Segment& segment : cilium.segments)
      materials.push_back(
          material::Hyperelastic::neo_hooke(segment.shear_modulus(), segment.bulk_modulus()));
    space = std::make_unique<discretisation::SolidSpace>(*triangulation_, *mapping_, materials);
    std::vector<discretisation::DirichletCondition> conditions{{.boundary = meshes::base_id}};
    if (mesh.half)
      conditions.push_back({.boundary = meshes::symmetry_id, .components = {false, true, false}});
    constraints = increment_constraints(*space, conditions);
    using discretisation::Extent;
    quadrature_ = std::make_unique<discretisation::ExtrudedQuadrature>(
        *space, mesh.half ? Extent::half : Extent::whole);
    external_ = loads::external_forces(
        *space, *quadrature_, cilium,
        ContactLoad{.force = 1e-3, .height = 16e-3, .azimuth = mesh.half ? 0 : 0.5}, 0.5e-3);
    forces = loads::forces_at(space->undeformed().displacement, *space, external_);
    constraints.set_zero(forces);
  }

  /// Assembles the tangent in the solver.
  void assemble(solvers::LinearSolver& solver) const {
    const discretisation::SolidState state = space->undeformed();
    discretisation::TangentMatrix& tangent = solver.new_tangent();
    add_stiffness(*space, state, *internal_forces(*space, state), tangent, solver.cells());
    discretisation::Vector unused = space->vector();
    external_(state.displacement, unused, &tangent);
  }

  std::unique_ptr<discretisation::SolidSpace> space;
  dealii::AffineConstraints<double> constraints;
  discretisation::Vector forces;

 private:
  std::unique_ptr<dealii::Triangulation<3>> triangulation_;
  std::unique_ptr<dealii::MappingQCache<3>> mapping_;
  std::unique_ptr<discretisation::ExtrudedQuadrature> quadrature_;
  loads::ExternalForces external_;
};

/// Largest memory of the process so far.
inline double gigabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024 / 1e9;
}

}  // namespace ciliaval::fem::solid

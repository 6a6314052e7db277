// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/fe/mapping_q_cache.h>
#include <deal.II/grid/tria.h>

#include <memory>
#include <optional>
#include <span>

#include "fem/solid/discretisation/space.h"
#include "fem/solid/equilibrium/load_path.h"
#include "fem/solid/equilibrium/newton.h"
#include "fem/solid/loads/height_loads.h"
#include "fem/solid/material/hyperelastic.h"
#include "fem/solid/postprocessing/mantle.h"
#include "meshes/cylinder/cylinder_mesh.h"
#include "meshes/mesh_file.h"
#include "problem/cilium.h"
#include "problem/deformation.h"
#include "problem/mechanics_model.h"

namespace ciliaval::fem::solid {

struct LevelOptions {
  equilibrium::LoadPathOptions path{};
  solvers::SolverKind solver = solvers::SolverKind::automatic;
  MPI_Comm communicator = MPI_COMM_WORLD;
  bool beam_guess = true;       ///< start the coarsest level from the beam's solution
  bool may_be_in_parts = true;  ///< where it is solved iteratively, each rank has a part of it
};

/// Equilibria of a level and of the coarser one under the same load.
struct EquilibriumPair {
  const equilibrium::Equilibrium* own;
  const equilibrium::Equilibrium* coarse;
};

/// The discretised cilium on one mesh, in that mesh's frame, with its solvers, which are made with
/// the first load.
class Level {
 public:
  /// `coarser` gives the initial guesses; without it, the beam gives them if options.beam_guess.
  /// The coarser level must outlive the level.
  Level(const Cilium& cilium, const meshes::cylinder::CylinderMeshOptions& mesh,
        std::span<const material::Hyperelastic> materials, const LevelOptions& options,
        Level* coarser);
  /// On the user's mesh, which has no coarser level. Throws as meshes::gmsh::read_gmsh().
  Level(const Cilium& cilium, const meshes::MeshFile& mesh,
        std::span<const material::Hyperelastic> materials, const LevelOptions& options);
  Level(const Level&) = delete;
  Level& operator=(const Level&) = delete;

  /// Brings the level into equilibrium with the load, whose azimuth is from the mesh's x axis (0 on
  /// a half mesh).
  equilibrium::LoadPathOutcome advance(const Load& load, const Progress& progress);

  /// The state of the load path; null before the first load.
  const equilibrium::LoadPathState* state() const { return solver_ ? &solver_->state() : nullptr; }
  /// States as a checkpoint keeps them, on the first rank: of a mesh that may be in parts, cell by
  /// cell in the whole mesh's order, so that any number of ranks can take them up. Collective.
  discretisation::SolidState to_keep(const discretisation::SolidState& state) const;
  equilibrium::Equilibrium to_keep(const equilibrium::Equilibrium& equilibrium) const;
  equilibrium::LoadPathState to_keep(const equilibrium::LoadPathState& state) const;
  /// From what was kept, on all ranks. Throws CheckpointError if it is not of a mesh of this size.
  discretisation::SolidState restored(discretisation::SolidState kept) const;
  equilibrium::Equilibrium restored(equilibrium::Equilibrium kept) const;
  /// Goes on from there; without a state, goes back to before the first load.
  void restore(std::optional<equilibrium::LoadPathState> kept);

  /// The level's state, or another one of its mesh, in the frame of the cilium, turned by
  /// `azimuth`.
  Deformation deformation(double azimuth) const;
  Deformation deformation(const equilibrium::Equilibrium& equilibrium, double azimuth) const;
  /// Deformation of a state whose loads act on the surface alone.
  Deformation deformation(const discretisation::SolidState& state, double azimuth) const;
  Deformation undeformed(double azimuth) const;

  /// Compression of the mantle in the level's state.
  postprocessing::MantleCompression mantle_compression() const;
  postprocessing::MantleCompression mantle_compression(
      const discretisation::SolidState& state) const;
  double applied_force() const { return solver().current().applied_force; }
  /// Second variation at the level's state in all displacements of the whole body, with the
  /// smallest eigenvalue over that of the straight cilium without loads. None if the load has no
  /// potential, or as Newton::second_variation(), whose errors it throws.
  std::optional<equilibrium::SecondVariation> second_variation() {
    return second_variation(solver().current());
  }
  /// The last equilibrium before a magnet pulls the cilium in, with the smallest eigenvalue on the
  /// way there, of an outcome of advance() with the status pulled_in. `mesh_azimuth` as of
  /// deformation(). Throws SolverError if the cilium touches a magnet there.
  continuation::PullIn pull_in(const equilibrium::LoadPathOutcome& outcome, double mesh_azimuth);
  std::size_t unknowns() const { return space_->unknowns(); }

  // For solvers that make their own way, apart from the level's load path.
  const Cilium& cilium() const { return cilium_; }
  const LevelOptions& options() const { return options_; }
  const discretisation::SolidSpace& space() const { return *space_; }
  const discretisation::ExtrudedQuadrature& quadrature() const { return *quadrature_; }
  equilibrium::Newton& newton();
  /// Throws CheckpointError if it is not a state of a mesh of this size.
  void require_own(const discretisation::SolidState& state) const;

 private:
  /// Decides whether a mesh of so many unknowns may be in parts, and on which ranks.
  MPI_Comm ranks_of_mesh(double unknowns);
  /// The space on the triangulation and its mapping.
  void discretise(discretisation::Extent extent, std::span<const material::Hyperelastic> materials);
  void start_from_rest(const Load& first);
  /// Second variation at an equilibrium of the level, as above.
  std::optional<equilibrium::SecondVariation> second_variation(const equilibrium::Equilibrium& now);
  /// From the coarser level, which it solves under the load; without one, from the beam.
  equilibrium::Guess initial_guess(const Load& load, const Progress& progress) const;
  /// The coarser level's equilibrium with the load, interpolated, and corrected by the levels'
  /// difference under the last two loads (the nearest first), which is small and smooth in the
  /// load.
  equilibrium::Guess guess(const Load& load, const equilibrium::Equilibrium& coarse,
                           std::span<const EquilibriumPair> behind) const;
  /// The beam's solution, if the options say so.
  equilibrium::Guess guess(const Load& load) const;
  const equilibrium::LoadPathSolver& solver() const { return *solver_; }
  Deformation deformation(const discretisation::SolidState& state, const loads::SpreadLoad& load,
                          double azimuth) const;

  Cilium cilium_;
  LevelOptions options_;
  Level* coarser_ = nullptr;
  bool may_be_in_parts_ = false;
  std::unique_ptr<dealii::Triangulation<3>> triangulation_;
  std::unique_ptr<dealii::MappingQCache<3>> mapping_;
  std::unique_ptr<discretisation::SolidSpace> space_;
  std::unique_ptr<discretisation::ExtrudedQuadrature> quadrature_;
  std::unique_ptr<equilibrium::Newton> newton_;
  std::unique_ptr<equilibrium::LoadPathSolver> solver_;
  std::optional<double> eigenvalue_at_rest_;
};

}  // namespace ciliaval::fem::solid

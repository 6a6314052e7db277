// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/fe/mapping_q_cache.h>
#include <deal.II/grid/tria.h>

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "fem/solid/fibres.h"
#include "fem/solid/equilibrium/load_path.h"
#include "fem/solid/material/hyperelastic.h"
#include "fem/solid/equilibrium/newton.h"
#include "fem/solid/discretisation/space.h"
#include "meshes/cylinder/cylinder_mesh.h"
#include "meshes/mesh_file.h"
#include "problem/cilium.h"
#include "problem/deformation.h"
#include "problem/mechanics_model.h"

namespace ciliaval::fem {

struct LevelOptions {
  LoadPathOptions path{};
  SolverKind solver = SolverKind::automatic;
  bool beam_guess = true;  ///< start the coarsest level from the beam's solution
};

/// Equilibria of a level and of the coarser one under the same load.
struct EquilibriumPair {
  const Equilibrium* own;
  const Equilibrium* coarse;
};
/// Those that two levels go on from, the last one first; at most two.
std::vector<EquilibriumPair> pairs(const LoadPathState* own, const LoadPathState* coarse);

/// The discretised cilium on one mesh, in the frame of that mesh, with its solvers, which are made
/// with the first load and belong to the ranks that work together then (RankAlone). Its members
/// refer to one another: it stays where it is made.
class Level {
 public:
  /// `coarser` gives the first guesses, and with its own tip the estimate of the error; without
  /// it, the beam gives them if options.beam_guess. Cilium and coarser level must outlive the
  /// level.
  Level(const Cilium& cilium, const meshes::CylinderMeshOptions& mesh,
        std::span<const Hyperelastic> materials, const LevelOptions& options, Level* coarser);
  /// On the user's mesh, which is whole: loads of any azimuth, no coarser level and no estimate of
  /// the error. Throws as meshes::read_gmsh().
  Level(const Cilium& cilium, const meshes::MeshFile& mesh, std::span<const Hyperelastic> materials,
        const LevelOptions& options);
  Level(const Level&) = delete;
  Level& operator=(const Level&) = delete;

  /// Brings the level into equilibrium with the load, whose azimuth is from the mesh's x axis (0 on
  /// a half mesh). Calls `on_equilibrium` after each one on the way (LoadPathSolver::advance()).
  LoadPathOutcome advance(const Load& load, const Progress& progress,
                          const std::function<void()>& on_equilibrium = {});

  /// The first guess of a load: the coarser level's equilibrium with it, transferred, and
  /// corrected by what separates the levels under two loads behind (the nearest first), which
  /// changes less than the states do, and smoothly with the load.
  Guess guess(const Load& load, const Equilibrium& coarse,
              std::span<const EquilibriumPair> behind) const;
  /// Without a coarser level: the beam's solution, if the options say so.
  Guess guess(const Load& load) const;
  /// The equilibrium found from the guess alone (LoadPathSolver::solve()). state() stays.
  std::optional<Equilibrium> solve(const Load& load, Guess guess, int& iterations,
                                   const Progress& progress);
  /// Goes on from an equilibrium as if advance() had found it; it replaces one under an equal load.
  void go_to(Equilibrium equilibrium);
  /// Begins the way to the next load, which advance() goes.
  void set_out(const Load& load);

  /// What the level goes on from; null before the first load.
  const LoadPathState* state() const { return solver_ ? &solver_->state() : nullptr; }
  /// Without a state, goes back to before the first load. Throws CheckpointError if it is not the
  /// state of a mesh of this size.
  void restore(std::optional<LoadPathState> state);

  /// The level's state, or another one of its mesh, in the frame of the cilium, turned by
  /// `azimuth`.
  Deformation deformation(double azimuth) const;
  Deformation deformation(const Equilibrium& equilibrium, double azimuth) const;
  Deformation undeformed(double azimuth) const;

  /// Estimate of the distance of the tip from that of the exact solution, m: what separates it from
  /// the coarser level's, by Richardson's rule for the order 1.5 of the finest layer's thickness
  /// (docs/solid.md). Empty without a coarser level or if that is not at the same load.
  std::optional<double> tip_uncertainty() const;

  double applied_force() const { return solver().current().applied_force; }
  std::size_t unknowns() const { return space_->unknowns(); }
  bool solved_directly() const {
    return chosen(options_.solver, space_->unknowns()) == SolverKind::direct;
  }

 private:
  /// What all constructors end with: the space on the triangulation and its mapping.
  void discretise(Extent extent, std::span<const Hyperelastic> materials);
  Newton& newton();
  void start_from_rest(const Load& first);
  Guess first_guess(const Load& load, const Progress& progress) const;
  const LoadPathSolver& solver() const { return *solver_; }
  Deformation deformation(const SolidState& state, const SpreadLoad& load, double azimuth) const;
  Vector3 tip() const;

  const Cilium& cilium_;
  LevelOptions options_;
  double finest_layer_ = 0;  ///< in diameters; of use only with a coarser level
  Level* coarser_ = nullptr;
  dealii::Triangulation<3> triangulation_;
  std::unique_ptr<dealii::MappingQCache<3>> mapping_;
  std::unique_ptr<SolidSpace> space_;
  std::unique_ptr<Fibres> fibres_;
  std::unique_ptr<Newton> newton_;
  std::unique_ptr<LoadPathSolver> solver_;
};

}  // namespace ciliaval::fem

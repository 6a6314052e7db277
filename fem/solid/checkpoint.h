// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <mpi.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "fem/solid/equilibrium/load_path.h"
#include "fem/solid/solid.h"
#include "meshes/cylinder/cylinder_mesh.h"
#include "problem/mechanics_model.h"

namespace ciliaval::fem::solid {

/// What a solution depends on, a name and a value each: a checkpoint of other facts is refused.
using Facts = std::vector<std::pair<std::string, std::string>>;

/// Cilium, loads, options and meshes (the content of the user's file, if there is one, wherever it
/// lies), but not max_iterations and max_cutbacks: those may be raised
/// to go on after a failure.
Facts solid_facts(const Cilium& cilium, const LoadPath& path, const SolidOptions& options,
                  std::span<const meshes::cylinder::CylinderMeshOptions> meshes);

/// What distinguishes the facts of a checkpoint from those asked for, the first three; empty if
/// nothing does.
std::string difference(const Facts& saved, const Facts& asked);

/// The solid's checkpoint: the states that the levels go on from in `path`, the state of the
/// finished step i in `path`.i (docs/guide/restart.md). Rank 0 reads and writes; unless another
/// thing is said, the functions are collective. All do nothing if the path is empty. Throws
/// CheckpointError.
class SolidCheckpoint {
 public:
  SolidCheckpoint(Checkpoint files, Facts facts, MPI_Comm communicator);

  /// Reads and verifies all files; the number of finished steps. Not collective.
  std::size_t verify() const;

  /// Reads what was saved: steps() and the levels' states, the coarsest first; none without files.
  std::vector<std::optional<equilibrium::LoadPathState>> read();
  /// The finished steps, in order, without their deformations.
  const std::vector<MechanicsStep>& steps() const { return steps_; }
  /// The finest level's state at a finished step that converged.
  discretisation::SolidState finished_state(std::size_t step) const;

  /// Adds a finished step, with its state if it converged, to the files that save() makes.
  void add(const MechanicsStep& step, const discretisation::SolidState* state);
  /// Replaces what was saved.
  void save(std::span<const equilibrium::LoadPathState* const> levels);

  /// The file, if there is one by now.
  std::optional<std::filesystem::path> file() const;

 private:
  std::filesystem::path step_file(std::size_t step) const;
  std::string verified_content() const;

  Checkpoint files_;
  Facts facts_;
  MPI_Comm communicator_;
  std::vector<MechanicsStep> steps_;
  std::vector<std::uint32_t> checksums_;  ///< of the steps' files; 0 without one
  bool saved_ = false;
};

}  // namespace ciliaval::fem::solid

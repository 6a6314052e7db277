// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <mpi.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "fem/solid/contact/follower.h"
#include "fem/solid/contact/pin.h"
#include "fem/solid/level.h"
#include "fem/solid/path_run.h"
#include "fem/solid/solid_options.h"
#include "problem/mechanics_model.h"

namespace ciliaval::fem::solid {

/// The result's level and its companions' under a rigid body that moves, place by place, each on
/// its own way: the surface of a sweep, or the pin of a touch. At the first place of a surface the
/// cilium comes back from far ahead, where a horizontal force holds it bent aside, until the
/// surface holds it. The pin starts where it just touches the straight cilium; under given forces
/// it is moved to where it bears them.
class ContactRun {
 public:
  /// As of PathRun. Throws InputError if the loads differ in more than the place or the force.
  ContactRun(Levels levels, const LoadPath& path, const SolidOptions& options,
             const Checkpoint& checkpoint, const Progress& progress, MPI_Comm communicator);

  /// Goes on from the checkpoint to the end of the path. Throws as contact::Follower::start().
  /// Collective.
  MechanicsResult follow();

 private:
  /// A level's way along the path. A companion that has failed does not go on.
  struct Way {
    const Level* level;
    std::unique_ptr<contact::Follower> follower;
    std::string failure{};  ///< why it does not go on; empty: it does
  };

  void add_way(std::size_t level);

  /// All of step i.
  void solve(std::size_t i);
  MechanicsStep go(const Way& way, std::size_t i, const Progress& progress) const;
  /// The step of a level that has gone there.
  MechanicsStep step_of(const Way& way, std::size_t i,
                        const contact::FollowerOutcome& outcome) const;
  MechanicsStep step_of(const Way& way, std::size_t i, const contact::PinOutcome& outcome) const;
  void go_on_from_checkpoint();
  /// Keeps the levels' states and the last step. Collective.
  void save() const;

  Levels levels_;
  const LoadPath& path_;
  const Checkpoint& checkpoint_;
  const Progress& progress_;
  MPI_Comm communicator_;
  double turn_;            ///< azimuth of the mesh's x axis
  Load in_mesh_;           ///< the path's first load in the mesh's frame
  std::vector<Way> ways_;  ///< the finest level's, and those of the companions' levels
  std::vector<std::size_t> companions_;  ///< the companions' ways: two may share one
  MechanicsResult result_;
};

}  // namespace ciliaval::fem::solid

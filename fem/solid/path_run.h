// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <mpi.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fem/solid/level.h"
#include "fem/solid/postprocessing/mantle.h"
#include "fem/solid/solid.h"
#include "problem/mechanics_model.h"

namespace ciliaval::fem::solid {

/// The levels of the solid: each after the one that gives its initial guess.
struct Levels {
  std::vector<std::unique_ptr<Level>> all;
  std::size_t finest = 0;               ///< the one whose solution is the result
  std::vector<std::size_t> companions;  ///< those of the result's companions
  std::vector<ErrorPart> error_parts;   ///< of the result
};

/// Remark on a mantle that is compressed so far that rubber folds; none if it is not.
std::optional<std::string> fold_remark(const postprocessing::MantleCompression& compression);

/// The error (problem/error.h) that the work of a companion throws, in words; empty: none. It costs
/// the error estimate alone. Throws RankFailure. Collective.
std::string failure_of(const std::function<void()>& work);

/// The levels on their way along a load path.
class PathRun {
 public:
  /// All arguments must outlive it. Rank 0 reads and renews the checkpoint; that of other ranks is
  /// not used.
  PathRun(Levels levels, const LoadPath& path, const SolidOptions& options,
          const Checkpoint& checkpoint, const Progress& progress, MPI_Comm communicator);

  /// Goes on from the checkpoint to the end of the path. Collective.
  MechanicsResult follow();

 private:
  Level& finest() const { return *levels_.all[levels_.finest]; }
  /// The level of a companion of the result.
  Level& companion(std::size_t i) const { return *levels_.all[levels_.companions[i]]; }
  /// Adds a step to the result, and to the companions theirs.
  void add(MechanicsStep step);
  void go_on_from_checkpoint();
  /// Keeps the step that has ended, and the levels' states. Collective.
  void save(const MechanicsStep& finished) const;
  /// "step 2/4, "
  std::string label(std::size_t i) const;
  /// Brings the companions to the load with which the finest level is in equilibrium. Says which
  /// one has none; empty: each has one. Collective.
  std::string advance_companions(const Load& load, const Progress& progress);
  MechanicsStep solve(std::size_t i);

  Levels levels_;
  const LoadPath& path_;
  const SolidOptions& options_;
  const Checkpoint& checkpoint_;
  const Progress& progress_;
  MPI_Comm communicator_;
  MechanicsResult result_;
};

}  // namespace ciliaval::fem::solid

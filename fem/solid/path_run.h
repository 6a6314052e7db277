// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fem/solid/checkpoint.h"
#include "fem/solid/level.h"
#include "fem/solid/solid.h"
#include "problem/mechanics_model.h"

namespace ciliaval::fem::solid {

/// The levels of the solid on their way along a load path.
class PathRun {
 public:
  /// The levels from the coarsest to the finest. Path, options and progress must outlive it.
  PathRun(std::vector<std::unique_ptr<Level>> levels, const LoadPath& path,
          const SolidOptions& options, const Progress& progress);

  /// Goes on from where the checkpoint, if there is one, left off, to the end of the path, and
  /// renews the checkpoint on the way. Collective.
  MechanicsResult follow(SolidCheckpoint& saved);

 private:
  const Level& finest() const { return *levels_.back(); }
  void go_on_from(SolidCheckpoint& saved);
  void follow_path(SolidCheckpoint& saved);
  /// "step 2/4, "
  std::string label(std::size_t i) const;
  /// Step i. If `keep`, saves each equilibrium on the way.
  MechanicsStep solve(std::size_t i, SolidCheckpoint& saved, bool keep);
  /// Adds the step that the levels have ended with.
  void add_to(SolidCheckpoint& saved, const MechanicsStep& step) const;
  void add_deformation(MechanicsStep& step, const discretisation::SolidState& state) const;
  std::vector<const equilibrium::LoadPathState*> states() const;

  std::vector<std::unique_ptr<Level>> levels_;  ///< the coarsest first
  const LoadPath& path_;
  const SolidOptions& options_;
  const Progress& progress_;
  MechanicsResult result_;
};

}  // namespace ciliaval::fem::solid

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "compare/study/evaluate.h"
#include "compare/study/solutions.h"
#include "compare/study/study.h"

namespace ciliaval::compare::study {

/// A study with the results of all pairs at all points.
struct StudyResult {
  Study study;
  std::vector<std::vector<PairResult>> points;  ///< for each of all points, in the order of
                                                ///< the pairs
};

/// Computes the solutions that are not kept yet: those of rods and their fields on all cores, then
/// the others one after the other, each on all cores by itself. The numbers are the same in any
/// order. Throws RankFailure, CheckpointError.
StudyResult run_study(const Study& study, Solutions& solutions,
                      std::span<const models::MechanicsEntry> mechanics_models,
                      std::span<const models::FieldEntry> field_models,
                      const Progress& progress = {});

}  // namespace ciliaval::compare::study

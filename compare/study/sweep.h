// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/study/evaluate.h"
#include "compare/study/journal.h"
#include "compare/study/optimise.h"
#include "compare/study/study.h"

namespace ciliaval::compare::study {

/// A study with the results of all pairs at all points.
struct StudyResult {
  Study study;
  std::vector<std::vector<PairResult>> points;  ///< for each of all points, in the order of
                                                ///< the pairs
  std::optional<Optimum> optimum = std::nullopt;
};

/// The journal's first line: format, program and the study as resolved() has it.
std::string journal_header(const Study& study, const std::string& program);

/// What makes the journal that of another study or of another program, in words; empty if it is
/// that of `header`.
std::string difference(const std::string& journal_header, const std::string& header);

/// How many solutions, each of one mechanics model at one point with its fields, the study has and
/// how many of them the journal holds.
struct Extent {
  std::size_t all = 0;
  std::size_t kept = 0;
};
Extent extent(const Study& study, const Journal& journal);

/// Computes what the journal does not hold and adds each solution to it as soon as it is there:
/// those of rods and their fields on all cores, then the others one after the other, each on all
/// cores by itself. The numbers are the same in any order. The journal has its header. Throws
/// FileError, RankFailure, CheckpointError.
StudyResult run_study(const Study& study, Journal& journal,
                      std::span<const models::MechanicsEntry> mechanics_models,
                      std::span<const models::FieldEntry> field_models,
                      const Progress& progress = {});

}  // namespace ciliaval::compare::study

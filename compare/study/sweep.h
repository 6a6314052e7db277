// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "compare/output/store/store.h"
#include "compare/study/evaluate.h"
#include "compare/study/study.h"

namespace ciliaval::compare::study {

/// The solutions of a study, each one of a mechanics model at one point with its fields, by a name
/// that says so. A store keeps each from add() on, and every number as it was.
class Solutions {
 public:
  /// None, and kept in memory alone.
  Solutions() = default;
  /// Reads what the store keeps of the study. Throws CheckpointError, also if that is of another
  /// study or program.
  Solutions(output::store::Store& store, const Study& study, const std::string& program);

  /// Null if it is not there. Not while another thread adds.
  const std::vector<PairResult>* find(const std::string& name) const;
  /// By any thread; returns how many there are now. Throws CheckpointError.
  std::size_t add(const std::string& name, std::vector<PairResult> results);
  std::size_t size() const { return all_.size(); }

 private:
  output::store::Store* store_ = nullptr;
  std::map<std::string, std::vector<PairResult>> all_;
  std::mutex mutex_;
};

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

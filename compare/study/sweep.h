// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compare/output/store/store.h"
#include "compare/study/evaluate.h"
#include "compare/study/study.h"

namespace ciliaval::compare::study {

/// The file in the folder of a study's results that keeps what is solved.
inline constexpr const char* store_name = "points.sqlite";
inline constexpr std::string_view store_owner = "study";  ///< of its entries

/// Makes the folder of a study's results if it is not there. Throws FileError if something else
/// lies there.
void make_folder(const std::filesystem::path& folder);

/// The solutions of a study, each one of a mechanics model at one point with its fields, by a name
/// that says so. A store keeps each from add() on, and every number as it was.
class Solutions {
 public:
  /// No solutions; those added are kept in memory alone.
  Solutions() = default;
  /// Reads what the store keeps of the study. Throws CheckpointError, also if that is of another
  /// study or program.
  Solutions(output::store::Store& store, const Study& study, const std::string& program);

  /// Null if it is not there. Not while another thread adds.
  const std::vector<PairResult>* find(const std::string& name) const;
  /// Adds a solution, by any thread; returns their number then. Throws CheckpointError.
  std::size_t add(const std::string& name, std::vector<PairResult> results);
  std::size_t size() const { return all_.size(); }

 private:
  output::store::Store* store_ = nullptr;
  std::map<std::string, std::vector<PairResult>> all_;
  std::mutex mutex_;
};

/// A solution as the store keeps it: every number as it was.
std::string to_bytes(const std::vector<PairResult>& results);
std::vector<PairResult> from_bytes(const std::string& bytes);

/// A part of a study that is solved by itself: one mechanics model at one point, with the fields of
/// its pairs.
struct Task {
  std::size_t point = 0;
  std::string mechanics;
  /// Name of the task's solution.
  std::string name() const;
};

/// True if the models of the study's pairs with this mechanics model may run in several threads
/// beside each other: collective ones use the cores themselves.
bool runs_in_threads(const Study& study, const std::string& mechanics,
                     std::span<const models::MechanicsEntry> mechanics_models,
                     std::span<const models::FieldEntry> field_models);

/// Tasks by how they use the cores.
struct Tasks {
  std::vector<Task> side_by_side;  ///< rods and their fields: several at once
  std::vector<Task> one_by_one;    ///< models that use all cores by themselves
};
/// Tasks that are not solved yet.
Tasks missing_tasks(const Study& study, const Solutions& solutions,
                    std::span<const models::MechanicsEntry> mechanics_models,
                    std::span<const models::FieldEntry> field_models);

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

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/models/registry.h"
#include "compare/study/study.h"
#include "problem/mechanics_model.h"

namespace ciliaval::compare::study {

/// What a pair of models makes of a point.
struct PairResult {
  Status status = Status::failed;
  std::string message;                        ///< why it failed or slipped off, or why a value is
                                              ///< missing; else empty
  std::vector<std::optional<double>> values;  ///< of the study's outputs, in their order
  std::optional<double> uncertainty = std::nullopt;  ///< numerical, of the components of ΔB, T
};

/// Runs one mechanics model of the study on the case of one of its points, and the fields of its
/// pairs on it: a result for each of these pairs, in their order. What a model throws is its
/// failure. A contact that slips off has a range, but no field. Throws RankFailure,
/// CheckpointError.
std::vector<PairResult> evaluate(const Study& study, input::Case c, const std::string& mechanics,
                                 std::span<const models::MechanicsEntry> mechanics_models,
                                 std::span<const models::FieldEntry> field_models,
                                 const Progress& progress = {});

}  // namespace ciliaval::compare::study

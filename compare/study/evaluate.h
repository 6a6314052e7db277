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

/// Results of a pair of models at a point.
struct PairResult {
  Status status = Status::failed;
  std::string message;                        ///< why it failed or slipped off, or why a value is
                                              ///< missing; else empty
  std::vector<std::optional<double>> values;  ///< of the study's outputs, in their order
  std::optional<double> uncertainty = std::nullopt;  ///< numerical, of the components of ΔB, T
  std::optional<double> range_uncertainty = std::nullopt;  ///< numerical, in the range's unit
  /// Model parts of rods, if the study asks for them, of the components of ΔB (T) and
  /// of a range by slip-off.
  std::optional<double> model_uncertainty = std::nullopt;
  std::optional<double> range_model_uncertainty = std::nullopt;
};

/// A largest load: N, N/m, or m of a probe.
struct LargestLoad {
  double magnitude = 0;
  std::optional<double> uncertainty{};  ///< if the model knows it
  std::string remark{};                 ///< on the load, by the model
};

/// Runs one mechanics model of the study on the case of one of its points, and the fields of its
/// pairs on it: a result for each of these pairs, in their order. An exception of a model is its
/// failure. A contact that slips off has a range, but no field. Throws RankFailure,
/// CheckpointError.
std::vector<PairResult> evaluate(const Study& study, input::Case c, const std::string& mechanics,
                                 std::span<const models::MechanicsEntry> mechanics_models,
                                 std::span<const models::FieldEntry> field_models,
                                 const Progress& progress = {});

/// The largest magnitude of a contact (N) or a probe's displacement (m) that the model bears: where
/// it slips off. `step` is the model's step at some magnitude. Throws SolverError if the model
/// finds none. `simplest` is a model that takes but a moment: its range shows where to begin.
LargestLoad slip_off(const MechanicsModel& model, const Cilium& cilium, const MechanicsStep& step,
                     const MechanicsModel& simplest, const Progress& progress = {});

/// The magnitude of the load at which the tip's rotation from +z is `rotation` (rad, below 90°), to
/// 1e-6 of it, by bracketing and TOMS 748: each trial is a solution from the straight cilium. Its
/// uncertainty is the bracket and that of the tip's angle over dθ/dF, which a secant over 1 %
/// gives. Throws SolverError.
LargestLoad magnitude_at_rotation(const MechanicsModel& model, const Cilium& cilium,
                                  const Load& load, double rotation, const Progress& progress = {});

}  // namespace ciliaval::compare::study

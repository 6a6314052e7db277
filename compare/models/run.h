// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "compare/input/case.h"
#include "compare/models/registry.h"
#include "problem/field_model.h"
#include "problem/mechanics_model.h"

namespace ciliaval::compare::models {

/// Model part of the error of a quantity: its difference from a better model that is quick to
/// solve.
template <class Value>
struct ModelPart {
  Value difference;              ///< |Q(model) − Q(better)|, of a vector by components
  double of_the_better = 0;      ///< its own error: numerical, and of its corrections
  bool is_in_numerical = false;  ///< the model's numerical error has the second already

  Value uncertainty() const { return difference + ones() * of_the_better; }
  /// The numerical error with it: about 95 %, both parts being bounds.
  Value band(const Value& numerical) const {
    return numerical + difference + ones() * (is_in_numerical ? 0 : of_the_better);
  }

 private:
  static Value ones() {
    if constexpr (std::is_same_v<Value, double>)
      return 1;
    else
      return Value::Ones();
  }
};

/// Model parts of the shape at a step.
struct ShapeModelParts {
  std::optional<ModelPart<double>> tip;            ///< position, m
  std::optional<ModelPart<double>> tip_angle;      ///< rad
  std::optional<ModelPart<double>> applied_force;  ///< N
  std::optional<ModelPart<double>> slip_off;       ///< slip_off_limit()
  std::string unknown;                             ///< why they are not known; else empty
};

/// Shift of a shape by one standard uncertainty of an input.
struct ShapeShift {
  std::optional<double> tip;            ///< the distance, m
  std::optional<double> tip_angle;      ///< rad
  std::optional<double> applied_force;  ///< N
  std::optional<double> slip_off;       ///< slip_off_limit()
};

/// Results of one mechanics model along the load path.
struct MechanicsRun {
  std::string model;       ///< id
  MechanicsResult result;  ///< one step for each load; if the model threw, all of them failed with
                           ///< its message
  std::vector<ShapeModelParts> model_parts{};  ///< of each step, after add_model_parts()
  /// [step][input] of CaseResult::inputs, after validation::add_input_parts().
  std::vector<std::vector<ShapeShift>> input_parts{};
};

/// A vector at each sensor, T; none where it is undefined or unknown.
using AtSensors = std::vector<std::optional<Vector3>>;

/// B of one pair of models at one step.
struct FieldStep {
  AtSensors B;               ///< flux density
  AtSensors uncertainty;     ///< the field model's estimate of the numerical error of B
  AtSensors dB;              ///< ΔB = B − B(undeformed): none where one of the two is missing
  AtSensors dB_uncertainty;  ///< sum of the two uncertainties
  /// Error of B and of ΔB from the mechanics model's discretisation, in any direction, T: from the
  /// fields of its companions (problem/error_estimate.h). None where it is not known.
  std::vector<std::optional<double>> from_mechanics;
  std::vector<std::optional<double>> dB_from_mechanics;
  /// Model parts of both models, after add_model_parts(); none where they are not known.
  std::vector<std::optional<ModelPart<Vector3>>> B_model_part;
  std::vector<std::optional<ModelPart<Vector3>>> dB_model_part;
  std::string model_part_unknown;  ///< why; else empty
  /// Shift by each input at each sensor, after validation::add_input_parts(), T; a list is empty,
  /// or a vector none, where it is not known.
  std::vector<AtSensors> B_input_parts;
  std::vector<AtSensors> dB_input_parts;
  std::shared_ptr<const FieldMesh> mesh;  ///< what B was computed from, if it can be drawn
  double seconds = 0;                     ///< wall time
  std::string remark;   ///< of the field model: why an uncertainty is not known; else empty
  std::string failure;  ///< why a value of B or ΔB is missing, at which sensors; else empty

  /// True if there is B or ΔB at any sensor.
  bool any() const;
};

/// Results of one field model for the deformations of one mechanics model.
struct FieldRun {
  std::string mechanics;  ///< ids
  std::string field;
  FieldStep undeformed;                         ///< its ΔB is zero
  std::vector<std::optional<FieldStep>> steps;  ///< none where the mechanics did not converge

  bool measured = false;  ///< readings of an external model: of no deformation

  std::string name() const { return mechanics + "/" + field; }
};

/// Results of a case. Both lists are in the order of the registry, the less detailed model first,
/// then the case's external models; field runs go by mechanics first. In a comparison the later one
/// is the reference.
struct CaseResult {
  input::Case problem;
  std::vector<MechanicsRun> mechanics;
  std::vector<FieldRun> fields;
  std::vector<std::string> inputs{};  ///< numbers of [[input_uncertainty]], by their paths
  std::string unstated_touch{};       ///< in words, what it would do (unstated_touch.h)
};

/// Runs the models that the case asks for, and puts its external ones beside them: each mechanics
/// model along the load path, then each field model on the undeformed cilium and on every converged
/// step (a model that needs a body only where there is one). An exception of one model, or a result
/// that is not finite, is recorded as its failure and does not stop the others; where B diverges at
/// one sensor, the rest are computed. A mechanics model goes on from the checkpoint under its id,
/// if there is one. Throws InputError if the case names a model that is not among the entries, or
/// an external one is of another load path, CheckpointError, RankFailure.
CaseResult run(const input::Case& problem, std::span<const MechanicsEntry> mechanics,
               std::span<const FieldEntry> fields, const Progress& progress = {},
               const std::map<std::string, Checkpoint>& checkpoints = {});

/// A part of run(): one mechanics model, which goes by the name `id` in messages and in the result,
/// along the load path of a case. Throws CheckpointError, RankFailure.
MechanicsRun run_mechanics(const std::string& id, const MechanicsModel& model,
                           const input::Case& problem, const Progress& progress = {},
                           const Checkpoint& checkpoint = {});

/// The same of the entry's model, by an Evaluator. Throws as above.
MechanicsRun run_mechanics(const MechanicsEntry& entry, const input::Case& problem,
                           std::span<const FieldEntry> fields, const Progress& progress = {},
                           const Checkpoint& checkpoint = {});

/// A part of run(): one field model at the sensors of a case, on the undeformed cilium and on every
/// converged step of a mechanics run, whatever the load path of the case.
FieldRun run_field(const std::string& id, const FieldModel& model, const MechanicsRun& mechanics,
                   const input::Case& problem, const Progress& progress = {});

/// True if no step of the model failed.
bool all_solved(const MechanicsRun& run);

/// True if nothing failed. A cilium that slipped off is a result, not a failure.
bool all_solved(const CaseResult& result);

}  // namespace ciliaval::compare::models

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/models/evaluator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "compare/models/errors.h"
#include "compare/models/run.h"
#include "fem/solid/solid_options.h"
#include "problem/continuation/slip_off.h"
#include "problem/error.h"

namespace ciliaval::compare::models {
namespace {

using input::ErrorLimit;

constexpr double unknown = std::numeric_limits<double>::infinity();

/// True if the cilium is straight because nothing acts on it.
bool bears_nothing(const Load& load) {
  return surroundings::is_empty(acting_environment(load)) &&
         (load.is<EnvironmentLoad>() || magnitude(load) == 0);
}

/// The largest estimate of the tip's error over its displacement, of the steps that converged; 0
/// where nothing has moved.
double largest_tip_error(const MechanicsResult& result) {
  const auto tip = [](const Deformation& deformation) {
    return deformation.centreline.at(deformation.centreline.length()).position;
  };
  double largest = 0;
  for (const MechanicsStep& step : result.steps) {
    if (step.status != Status::converged || bears_nothing(step.load)) continue;
    const double moved = (tip(*step.deformation) - tip(result.undeformed)).norm();
    largest = std::max(largest, step.tip_uncertainty ? *step.tip_uncertainty / moved : unknown);
  }
  return largest;
}

/// The largest uncertainty of ΔB at any sensor and step over the sensor's largest |ΔB|.
double largest_field_error(const MechanicsRun& run, const input::Case& problem,
                           const FieldEntry& entry) {
  const FieldRun fields = run_field(entry.id, *entry.make(problem.options), run, problem);
  double largest = 0;
  for (std::size_t s = 0; s < problem.sensors.size(); ++s) {
    double scale = 0;
    double error = 0;
    for (std::size_t i = 0; i < fields.steps.size(); ++i) {
      if (!fields.steps[i] || bears_nothing(run.result.steps[i].load)) continue;
      const std::optional<Vector3>& dB = fields.steps[i]->dB[s];
      if (!dB) return unknown;
      scale = std::max(scale, dB->norm());
      error = std::max(error, change_uncertainty(run, fields, i, s).value_or(unknown));
    }
    if (error > 0) largest = std::max(largest, error / scale);
  }
  return largest;
}

/// Message on the outcome of an error limit, to be read beside the results.
std::string outcome(const std::string& refinement, double percent, const ErrorLimit& limit) {
  if (!std::isfinite(percent))
    return fmt::format("{}: the error is not known, so the tolerance of {:g} % is not met",
                       refinement, limit.percent);
  std::string error =
      fmt::format("{}, error of at most {:.2g} % of {}", refinement, percent,
                  limit.of == ErrorLimit::Of::tip ? "the tip's displacement" : "|dB|");
  if (percent <= limit.percent) return error;
  return fmt::format("{}: the tolerance of {:g} % is not met, this is the finest mesh", error,
                     limit.percent);
}

/// The part of a checkpoint whose entries begin with the prefix.
Checkpoint part_of(const Checkpoint& checkpoint, const std::string& prefix) {
  Checkpoint part;
  for (const auto& [name, bytes] : checkpoint.kept)
    if (name.starts_with(prefix)) part.kept.emplace(name.substr(prefix.size()), bytes);
  if (checkpoint.save)
    part.save = [&checkpoint, prefix](const Checkpoint::Entries& entries) {
      Checkpoint::Entries named;
      for (const auto& [name, bytes] : entries) named.emplace(prefix + name, bytes);
      checkpoint.save(named);
    };
  return part;
}

}  // namespace

Evaluator::Evaluator(const MechanicsEntry& entry, const input::Case& problem,
                     std::span<const FieldEntry> fields)
    : entry_(entry), fields_(fields) {
  problem_.name = problem.name;
  problem_.mechanics = {entry.id};
  problem_.options = problem.options;
  problem_.sensors = problem.sensors;
  problem_.sensor_names = problem.sensor_names;
}

MechanicsResult Evaluator::solve(const Cilium& cilium, const LoadPath& path,
                                 const Progress& progress) const {
  return solve_from(cilium, path, {}, progress);
}

MechanicsResult Evaluator::solve_from(const Cilium& cilium, const LoadPath& path,
                                      const Checkpoint& checkpoint,
                                      const Progress& progress) const {
  input::Case problem = problem_;
  problem.cilium = cilium;
  problem.load_path = path;
  if (const std::string fault = fault_of(entry_, problem); !fault.empty()) throw InputError(fault);
  const ErrorLimit limit =
      entry_.error_limit ? entry_.error_limit(problem.options) : input::ErrorLimit{};
  if (limit.percent == 0) {
    const auto model = entry_.make(problem.options);
    MechanicsResult result = model->solve_from(cilium, path, checkpoint, progress);
    for (MechanicsStep& step : result.steps) fail_unless_finite(step);
    if (!entry_.has_body)
      continuation::let_go_at_rim(
          *model, cilium, problem.options.of<fem::solid::SolidOptions>().kernel_width, result);
    return result;
  }

  const input::Refinement& refinement = entry_.refinements.front();
  const input::Option& option =
      *std::ranges::find(entry_.options, refinement.option, &input::Option::name);
  // The field of the model's own body, the same on all ranks.
  const auto field =
      std::ranges::find_if(fields_, [&](const FieldEntry& of) { return of.has_body; });
  if (limit.of == ErrorLimit::Of::field && field == fields_.end())
    throw InputError(entry_.id + ": there is no field model of its body to refine for");
  const auto error_of = [&](MechanicsResult& result) {
    if (limit.of == ErrorLimit::Of::tip) return largest_tip_error(result);
    MechanicsRun run{entry_.id, std::move(result)};
    const double error = largest_field_error(run, problem, *field);
    result = std::move(run.result);
    return error;
  };
  std::vector<double> seconds(path.size(), 0);  // of all refinements
  for (std::size_t i = 0;; ++i) {
    const std::string name = fmt::format("{} {:g}", refinement.option, refinement.values[i]);
    input::ModelOptions options = problem.options;
    option.set_number(options, refinement.values[i]);
    MechanicsResult result = entry_.make(options)->solve_from(
        cilium, path, part_of(checkpoint, name + ": "), with_prefix(progress, name + ", "));
    bool is_solved = result.steps.size() == path.size();
    for (std::size_t step = 0; step < std::min(result.steps.size(), path.size()); ++step) {
      fail_unless_finite(result.steps[step]);
      is_solved = is_solved && result.steps[step].status != Status::failed;
      result.steps[step].seconds = seconds[step] += result.steps[step].seconds;
    }
    if (!is_solved) return result;
    const double error = 100 * error_of(result);
    // If the model does not know its error, it says why, and finer meshes are not tried.
    const bool is_last = i + 1 == refinement.values.size() || !std::isfinite(error);
    if (error > limit.percent && !is_last) continue;
    const std::string reached = outcome(name, error, limit);
    for (MechanicsStep& step : result.steps)
      if (step.status == Status::converged)
        step.message += (step.message.empty() ? "" : "; ") + reached;
    return result;
  }
}

void fail_unless_finite(MechanicsStep& step) {
  if (step.status != Status::converged) return;
  const auto fail = [&](std::string message) {
    step.status = Status::failed;
    step.message = std::move(message);
    step.deformation.reset();
  };
  if (!step.deformation || step.deformation->centreline.pieces().empty())
    return fail("the model says converged but gave no deformation");
  for (const double S : step.deformation->centreline.breaks()) {
    const CentrelinePoint point = step.deformation->centreline.at(S);
    if (!point.position.allFinite() || !point.rotation.coeffs().allFinite())
      return fail("the deformation is not finite at S = " + std::to_string(S) + " m");
  }
}

MechanicsRun run_mechanics(const MechanicsEntry& entry, const input::Case& problem,
                           std::span<const FieldEntry> fields, const Progress& progress,
                           const Checkpoint& checkpoint) {
  return run_mechanics(entry.id, Evaluator(entry, problem, fields), problem, progress, checkpoint);
}

}  // namespace ciliaval::compare::models

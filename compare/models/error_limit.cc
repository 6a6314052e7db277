// SPDX-License-Identifier: LGPL-2.1-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "compare/models/errors.h"
#include "compare/models/run.h"
#include "problem/error.h"

namespace ciliaval::compare::models {
namespace {

using input::ErrorLimit;

constexpr double unknown = std::numeric_limits<double>::infinity();

/// Whether the cilium is straight because nothing acts on it.
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

/// What came of a limit, to be read beside the results.
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

MechanicsRun run_mechanics(const MechanicsEntry& entry, const input::Case& problem,
                           std::span<const FieldEntry> fields, const Progress& progress,
                           const Checkpoint& checkpoint) {
  const ErrorLimit limit =
      entry.error_limit ? entry.error_limit(problem.options) : input::ErrorLimit{};
  if (limit.percent == 0)
    return run_mechanics(entry.id, *entry.make(problem.options), problem, progress, checkpoint);

  const input::Refinement& refinement = entry.refinements.front();
  const input::Option& option =
      *std::ranges::find(entry.options, refinement.option, &input::Option::name);
  // The field of the model's own body, the same on all ranks.
  const auto field =
      std::ranges::find_if(fields, [&](const FieldEntry& of) { return of.has_body; });
  if (limit.of == ErrorLimit::Of::field && field == fields.end())
    throw InputError(entry.id + ": there is no field model of its body to refine for");
  const auto error_of = [&](const MechanicsRun& run) {
    return limit.of == ErrorLimit::Of::tip ? largest_tip_error(run.result)
                                           : largest_field_error(run, problem, *field);
  };
  std::vector<double> seconds(problem.load_path.size(), 0);  // of all refinements
  for (std::size_t i = 0;; ++i) {
    const std::string name = fmt::format("{} {:g}", refinement.option, refinement.values[i]);
    input::ModelOptions options = problem.options;
    option.set_number(options, refinement.values[i]);
    MechanicsRun run =
        run_mechanics(entry.id, *entry.make(options), problem, with_prefix(progress, name + ", "),
                      part_of(checkpoint, name + ": "));
    for (std::size_t step = 0; step < seconds.size(); ++step)
      run.result.steps[step].seconds = seconds[step] += run.result.steps[step].seconds;
    if (!all_solved(run)) return run;
    const double error = 100 * error_of(run);
    // Where the model does not know its error, it says why, and finer meshes are not tried.
    const bool is_last = i + 1 == refinement.values.size() || !std::isfinite(error);
    if (error > limit.percent && !is_last) continue;
    const std::string result = outcome(name, error, limit);
    for (MechanicsStep& step : run.result.steps)
      if (step.status == Status::converged)
        step.message += (step.message.empty() ? "" : "; ") + result;
    return run;
  }
}

}  // namespace ciliaval::compare::models

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/run.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <memory>
#include <utility>

#include "problem/error.h"

namespace ciliaval::compare {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The models that the case asks for, each with its id, in the order of the registry.
template <class Entry>
auto make_chosen(std::span<const Entry> entries, const std::vector<std::string>& ids,
                 const ModelOptions& options) {
  for (const std::string& id : ids)
    if (std::none_of(entries.begin(), entries.end(), [&](const Entry& e) { return e.id == id; }))
      throw InputError("there is no model `" + id + "`; `ciliaval list` names them all");
  std::vector<std::pair<std::string, decltype(entries.front().make(options))>> result;
  for (const Entry& entry : entries)
    if (std::find(ids.begin(), ids.end(), entry.id) != ids.end())
      result.emplace_back(entry.id, entry.make(options));
  return result;
}

void fail(MechanicsStep& step, std::string message) {
  step.status = Status::failed;
  step.message = std::move(message);
  step.deformation.reset();
}

/// A converged step must have a deformation that is finite all along the centreline.
void check(MechanicsStep& step) {
  if (step.status != Status::converged) return;
  if (!step.deformation || step.deformation->centreline.pieces().empty())
    return fail(step, "the model says converged but gave no deformation");
  for (const double S : step.deformation->centreline.breaks()) {
    const CentrelinePoint point = step.deformation->centreline.at(S);
    if (!point.position.allFinite() || !point.rotation.coeffs().allFinite())
      return fail(step, "the deformation is not finite at S = " + std::to_string(S) + " m");
  }
}

MechanicsRun run_mechanics(const std::string& id, const MechanicsModel& model, const Case& problem,
                           const Progress& progress) {
  MechanicsRun run{id, {}};
  std::string failure;
  try {
    Progress named;
    if (progress) named = [&](const std::string& text) { progress(id + ": " + text); };
    run.result = model.solve(problem.cilium, problem.load_path, named);
    if (run.result.steps.size() != problem.load_path.size())
      failure = "the model gave " + std::to_string(run.result.steps.size()) +
                " steps for a path of " + std::to_string(problem.load_path.size());
  } catch (const std::exception& error) {
    failure = error.what();
  }
  if (!failure.empty()) {
    run.result = {};
    for (const Load& load : problem.load_path) {
      MechanicsStep step;
      step.load = load;
      fail(step, failure);
      run.result.steps.push_back(std::move(step));
    }
  }
  for (MechanicsStep& step : run.result.steps) check(step);
  return run;
}

/// The field at the sensors. What the model throws becomes `failure`.
FieldStep field_at_sensors(const FieldModel& model, const Case& problem,
                           const Deformation& deformation) {
  FieldStep step;
  const auto start = std::chrono::steady_clock::now();
  const auto finite = [](const Vector3& v) { return v.allFinite(); };
  try {
    Field field = model.field(problem.cilium, deformation, problem.sensors);
    if (field.B.size() != problem.sensors.size() ||
        (!field.uncertainty.empty() && field.uncertainty.size() != problem.sensors.size()))
      step.failure = "the model gave fields at another number of points than asked";
    else if (!std::all_of(field.B.begin(), field.B.end(), finite))
      step.failure = "the field is not finite";
    else
      step.field = std::move(field);
  } catch (const std::exception& error) {
    step.failure = error.what();
  }
  step.seconds = seconds_since(start);
  return step;
}

/// Sets ΔB = B − B(undeformed) and the sum of the uncertainties.
void subtract(FieldStep& step, const FieldStep& undeformed) {
  if (!step.failure.empty()) return;
  if (!undeformed.failure.empty()) {
    step = {{}, {}, {}, step.seconds, "undeformed cilium: " + undeformed.failure};
    return;
  }
  const bool known = !step.field.uncertainty.empty() && !undeformed.field.uncertainty.empty();
  for (std::size_t i = 0; i < step.field.B.size(); ++i) {
    step.dB.emplace_back(step.field.B[i] - undeformed.field.B[i]);
    if (known)
      step.dB_uncertainty.emplace_back(step.field.uncertainty[i].cwiseAbs() +
                                       undeformed.field.uncertainty[i].cwiseAbs());
  }
}

FieldRun run_field(const std::string& id, const FieldModel& model, const MechanicsRun& mechanics,
                   const Case& problem, const Progress& progress) {
  FieldRun run;
  run.mechanics = mechanics.model;
  run.field = id;
  if (progress) progress(run.name() + ": undeformed cilium");
  run.undeformed = field_at_sensors(model, problem, mechanics.result.undeformed);
  if (run.undeformed.failure.empty())
    run.undeformed.dB.assign(problem.sensors.size(), Vector3::Zero());
  for (std::size_t i = 0; i < mechanics.result.steps.size(); ++i) {
    const MechanicsStep& step = mechanics.result.steps[i];
    run.steps.emplace_back();
    if (step.status != Status::converged) continue;
    if (progress)
      progress(run.name() + ": step " + std::to_string(i + 1) + "/" +
               std::to_string(mechanics.result.steps.size()));
    run.steps.back() = field_at_sensors(model, problem, *step.deformation);
    subtract(*run.steps.back(), run.undeformed);
  }
  return run;
}

}  // namespace

CaseResult run(const Case& problem, std::span<const MechanicsEntry> mechanics,
               std::span<const FieldEntry> fields, const Progress& progress) {
  const auto mechanics_models = make_chosen(mechanics, problem.mechanics, problem.options);
  const auto field_models = make_chosen(fields, problem.fields, problem.options);
  CaseResult result{problem, {}, {}};
  for (const auto& [id, model] : mechanics_models) {
    if (progress) progress(id + ": starting");
    result.mechanics.push_back(run_mechanics(id, *model, problem, progress));
  }
  for (const MechanicsRun& mechanics_run : result.mechanics) {
    const Deformation& undeformed = mechanics_run.result.undeformed;
    if (undeformed.centreline.pieces().empty()) continue;
    for (const auto& [id, model] : field_models)
      if (!model->needs_body() || undeformed.body)
        result.fields.push_back(run_field(id, *model, mechanics_run, problem, progress));
  }
  return result;
}

bool all_solved(const CaseResult& result) {
  const auto solved = [](const MechanicsStep& step) { return step.status != Status::failed; };
  const auto computed = [](const std::optional<FieldStep>& step) {
    return !step || step->failure.empty();
  };
  return std::all_of(result.mechanics.begin(), result.mechanics.end(),
                     [&](const MechanicsRun& run) {
                       return std::all_of(run.result.steps.begin(), run.result.steps.end(), solved);
                     }) &&
         std::all_of(result.fields.begin(), result.fields.end(), [&](const FieldRun& run) {
           return run.undeformed.failure.empty() &&
                  std::all_of(run.steps.begin(), run.steps.end(), computed);
         });
}

}  // namespace ciliaval::compare

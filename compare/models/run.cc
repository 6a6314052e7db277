// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/models/run.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "compare/models/evaluator.h"
#include "fem/parallel.h"
#include "problem/error.h"
#include "problem/error_estimate.h"

namespace ciliaval::compare::models {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The entries of the models that the case asks for, in the order of the registry.
template <class Entry>
std::vector<const Entry*> chosen(std::span<const Entry> entries,
                                 const std::vector<std::string>& ids) {
  for (const std::string& id : ids) entry_of(entries, id);
  std::vector<const Entry*> result;
  for (const Entry& entry : entries)
    if (std::find(ids.begin(), ids.end(), entry.id) != ids.end()) result.push_back(&entry);
  return result;
}

/// Plain rods before corrected ones: in a comparison the later one is the reference.
void put_corrected_last(std::vector<const MechanicsEntry*>& entries,
                        const input::ModelOptions& options) {
  const auto is_rod = [](const MechanicsEntry* entry) { return bool(entry->correct); };
  const auto end = std::ranges::find_if_not(entries, is_rod);
  std::stable_partition(entries.begin(), end,
                        [&](const MechanicsEntry* entry) { return !entry->is_corrected(options); });
}

/// B and its uncertainty at some of the sensors; throws if they are not as many or not finite.
Field checked_field(const FieldModel& model, const Cilium& cilium, const Deformation& deformation,
                    std::span<const Vector3> points) {
  Field field = model.field(cilium, deformation, points);
  if (field.B.size() != points.size() ||
      (!field.uncertainty.empty() && field.uncertainty.size() != points.size()))
    throw SolverError("the model gave fields at another number of points than asked");
  for (const Vector3& B : field.B)
    if (!B.allFinite()) throw SolverError("the field is not finite");
  return field;
}

/// Fails all the points of a set.
void append_failures(std::size_t points, const std::string& message, FieldStep& step,
                     std::vector<std::pair<std::size_t, std::string>>& failures) {
  for (std::size_t i = 0; i < points; ++i) {
    failures.emplace_back(step.B.size(), message);
    step.B.emplace_back();
    step.uncertainty.emplace_back();
  }
}

/// Evaluates B at all the points and appends it to `step`. If the model refuses them, halves the
/// set until the points at which it gives no B stand alone; each message is kept with the sensors.
/// A model that solves one system for all points is not asked again if the solver failed.
void append_field(const FieldModel& model, const Cilium& cilium, const Deformation& deformation,
                  std::span<const Vector3> points, FieldStep& step,
                  std::vector<std::pair<std::size_t, std::string>>& failures) {
  try {
    const Field field = checked_field(model, cilium, deformation, points);
    step.mesh = field.mesh;
    step.remark = field.remark;
    for (std::size_t i = 0; i < points.size(); ++i) {
      step.B.emplace_back(field.B[i]);
      step.uncertainty.push_back(field.uncertainty.empty() ? std::nullopt
                                                           : std::optional(field.uncertainty[i]));
    }
    return;
  } catch (const RankFailure&) {
    throw;
  } catch (const std::exception& error) {
    const bool refused = dynamic_cast<const InputError*>(&error) != nullptr;
    if (points.size() <= 1 || !(model.pointwise() || refused))
      return append_failures(points.size(), error.what(), step, failures);
  }
  const std::size_t half = points.size() / 2;
  append_field(model, cilium, deformation, points.first(half), step, failures);
  append_field(model, cilium, deformation, points.subspan(half), step, failures);
}

/// "sensor 1: …; sensors 2, 4: …", or the message alone if it is that of every sensor.
std::string describe(const std::vector<std::pair<std::size_t, std::string>>& failures,
                     const input::Case& problem) {
  std::map<std::string, std::vector<std::string>> sensors_of;
  std::vector<std::string> messages;  // in the order in which they came
  for (const auto& [sensor, message] : failures) {
    if (sensors_of[message].empty()) messages.push_back(message);
    sensors_of[message].push_back(input::sensor_name(problem, sensor));
  }
  if (messages.size() == 1 && failures.size() >= problem.sensors.size()) return messages.front();
  std::vector<std::string> parts;
  for (const std::string& message : messages) {
    const std::vector<std::string>& where = sensors_of[message];
    parts.push_back(fmt::format("sensor{} {}: {}", where.size() > 1 ? "s" : "",
                                fmt::join(where, ", "), message));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

/// The field at the sensors. An exception of the model becomes `failure`.
FieldStep field_at_sensors(const FieldModel& model, const input::Case& problem,
                           const Deformation& deformation) {
  FieldStep step;
  step.from_mechanics.resize(problem.sensors.size());
  step.dB_from_mechanics.resize(problem.sensors.size());
  const auto start = std::chrono::steady_clock::now();
  std::vector<std::pair<std::size_t, std::string>> failures;
  append_field(model, problem.cilium, deformation, problem.sensors, step, failures);
  step.failure = describe(failures, problem);
  step.seconds = seconds_since(start);
  return step;
}

/// Sets ΔB = B − B(undeformed) and the sum of the uncertainties.
void subtract(FieldStep& step, const FieldStep& undeformed) {
  bool offset_missing = false;
  for (std::size_t i = 0; i < step.B.size(); ++i) {
    step.dB.emplace_back();
    step.dB_uncertainty.emplace_back();
    offset_missing = offset_missing || (step.B[i] && !undeformed.B[i]);
    if (!step.B[i] || !undeformed.B[i]) continue;
    step.dB[i] = *step.B[i] - *undeformed.B[i];
    if (step.uncertainty[i] && undeformed.uncertainty[i])
      step.dB_uncertainty[i] =
          step.uncertainty[i]->cwiseAbs() + undeformed.uncertainty[i]->cwiseAbs();
  }
  if (offset_missing)
    step.failure += fmt::format("{}undeformed cilium: {}", step.failure.empty() ? "" : "; ",
                                undeformed.failure);
}

/// B and ΔB on the undeformed cilium and on each step of one solution; without the models' names.
FieldRun fields_of(const FieldModel& model, const MechanicsResult& solution,
                   const input::Case& problem, const Progress& progress) {
  const std::size_t parts = solution.steps.size() + 1;
  const auto tell = [&](const std::string& text, std::size_t done) {
    if (progress) progress({text, done, parts});
  };
  FieldRun fields;
  tell("undeformed cilium", 0);
  fields.undeformed = field_at_sensors(model, problem, solution.undeformed);
  for (const std::optional<Vector3>& B : fields.undeformed.B)
    fields.undeformed.dB.push_back(B ? std::optional<Vector3>(Vector3::Zero()) : std::nullopt);
  for (std::size_t i = 0; i < solution.steps.size(); ++i) {
    fields.steps.emplace_back();
    if (solution.steps[i].status != Status::converged) continue;
    tell(fmt::format("step {}/{}", i + 1, solution.steps.size()), i + 1);
    fields.steps.back() = field_at_sensors(model, problem, *solution.steps[i].deformation);
    subtract(*fields.steps.back(), fields.undeformed);
  }
  return fields;
}

/// Sets what the discretisation error of the mechanics makes of the fields.
void estimate_from_mechanics(const FieldModel& model, const MechanicsResult& mechanics,
                             const input::Case& problem, FieldRun& fields,
                             const Progress& progress) {
  if (mechanics.error_parts.empty()) return;
  std::vector<FieldRun> solutions;
  const FieldModel& cheap = model.for_differences();
  const Progress of_estimate = with_prefix(progress, "error estimate, ");
  for (std::size_t i = 0; i <= mechanics.companions.size(); ++i)
    solutions.push_back(i == 0 && &cheap == &model
                            ? fields
                            : fields_of(cheap, solution(mechanics, i), problem, of_estimate));
  const auto set = [&](FieldStep& step, const auto& step_of_solution) {
    for (std::size_t s = 0; s < problem.sensors.size(); ++s) {
      const auto estimate = [&](AtSensors FieldStep::*values) {
        return error_estimate(mechanics.error_parts, [&](std::size_t i) -> std::optional<Vector3> {
          const FieldStep* other = step_of_solution(solutions[i]);
          return other != nullptr ? (other->*values)[s] : std::nullopt;
        });
      };
      step.from_mechanics[s] = estimate(&FieldStep::B);
      step.dB_from_mechanics[s] = estimate(&FieldStep::dB);
    }
  };
  set(fields.undeformed, [](const FieldRun& of) { return &of.undeformed; });
  for (std::size_t i = 0; i < fields.steps.size(); ++i)
    if (fields.steps[i])
      set(*fields.steps[i], [i](const FieldRun& of) -> const FieldStep* {
        return of.steps[i] ? &*of.steps[i] : nullptr;
      });
}

/// The horizontal force of a load whose shape is known from outside, N, without the environment's;
/// NaN for a probe.
double stated_force(const Load& load, const Cilium& cilium, const Vector3& tip) {
  if (load.is<ProbeLoad>()) return std::numeric_limits<double>::quiet_NaN();
  if (load.is<EnvironmentLoad>() || load.is<MomentLoad>()) return 0;
  if (load.is<FlowLoad>()) return magnitude(load) * tip.z();
  return magnitude(load) * (load.is<DeadLoad>() ? cilium.length() : 1);
}

/// Throws InputError unless an external model has a centreline and a reading for each step of the
/// path, or none.
void require_of_path(const input::external::ExternalModel& model, const LoadPath& path) {
  for (const std::size_t count : {model.centrelines.size(), model.readings.size()})
    if (count != 0 && count != path.size())
      throw InputError(
          fmt::format("the external model '{}' is of a path of {} load steps, not of {}",
                      model.name, count, path.size()));
}

/// The centrelines of an external model as those of a mechanics model.
MechanicsRun external_mechanics(const input::external::ExternalModel& model,
                                const input::Case& problem) {
  MechanicsRun run{model.name, {}};
  run.result.undeformed.centreline = straight_centreline(problem.cilium.interfaces());
  for (std::size_t i = 0; i < problem.load_path.size(); ++i) {
    MechanicsStep step;
    step.load = problem.load_path[i];
    step.status = Status::converged;
    step.message = model.remarks.at(i);
    step.deformation = Deformation{model.centrelines[i], nullptr};
    step.applied_force = stated_force(
        step.load, problem.cilium, model.centrelines[i].at(model.centrelines[i].length()).position);
    step.tip_uncertainty = model.tip_uncertainty;
    fail_unless_finite(step);
    run.result.steps.push_back(std::move(step));
  }
  return run;
}

FieldStep external_step(const input::external::ExternalReading& reading,
                        std::optional<double> uncertainty, bool undeformed_was_read) {
  FieldStep step;
  step.B = reading.B;
  step.dB = reading.dB;
  for (std::size_t s = 0; s < reading.B.size(); ++s) {
    const auto spread = [&](const std::optional<Vector3>& value, double readings) {
      return value && uncertainty
                 ? std::optional<Vector3>(Vector3::Constant(readings * *uncertainty))
                 : std::nullopt;
    };
    step.uncertainty.push_back(spread(step.B[s], 1));
    step.dB_uncertainty.push_back(spread(step.dB[s], undeformed_was_read ? 2 : 1));
  }
  return step;
}

/// The readings of an external model as those of a field model.
FieldRun external_fields(const input::external::ExternalModel& model, std::size_t sensors) {
  FieldRun run;
  run.mechanics = model.name;
  run.field = "readings";
  run.measured = true;
  input::external::ExternalReading none{AtSensors(sensors), AtSensors(sensors)};
  run.undeformed = external_step(model.undeformed.value_or(none), model.field_uncertainty, true);
  for (const input::external::ExternalReading& reading : model.readings)
    run.steps.emplace_back(
        external_step(reading, model.field_uncertainty, model.undeformed.has_value()));
  return run;
}

/// The ranks of a program bend the rods each by itself, and a collective field model is called by
/// all of them or by none: throws RankFailure on all unless the same steps have converged on all.
/// Collective.
void require_same_steps_on_all_ranks(const MechanicsRun& run) {
  std::string converged;
  for (const MechanicsStep& step : run.result.steps)
    converged += step.status == Status::converged ? '1' : '0';
  if (!fem::is_same_on_all_ranks(MPI_COMM_WORLD, converged))
    throw RankFailure(run.model +
                      ": some ranks have solved load steps that others have not, out of memory?");
}

}  // namespace

bool FieldStep::any() const {
  const auto there = [](const std::optional<Vector3>& value) { return value.has_value(); };
  return std::any_of(B.begin(), B.end(), there) || std::any_of(dB.begin(), dB.end(), there);
}

MechanicsRun run_mechanics(const std::string& id, const MechanicsModel& model,
                           const input::Case& problem, const Progress& progress,
                           const Checkpoint& checkpoint) {
  MechanicsRun run{id, {}};
  std::string failure;
  try {
    const Progress named = with_prefix(progress, id + ": ");
    if (named) named({"starting", 0, problem.load_path.size()});
    run.result = model.solve_from(problem.cilium, problem.load_path, checkpoint, named);
    if (run.result.steps.size() != problem.load_path.size())
      failure = "the model gave " + std::to_string(run.result.steps.size()) +
                " steps for a path of " + std::to_string(problem.load_path.size());
  } catch (const CheckpointError&) {
    throw;
  } catch (const RankFailure&) {
    throw;
  } catch (const std::exception& error) {
    failure = error.what();
  }
  if (!failure.empty()) {
    run.result = {};
    for (const Load& load : problem.load_path) {
      MechanicsStep step;
      step.load = load;
      step.status = Status::failed;
      step.message = failure;
      run.result.steps.push_back(std::move(step));
    }
  }
  for (MechanicsStep& step : run.result.steps) fail_unless_finite(step);
  return run;
}

FieldRun run_field(const std::string& id, const FieldModel& model, const MechanicsRun& mechanics,
                   const input::Case& problem, const Progress& progress) {
  const Progress named = with_prefix(progress, fmt::format("{}/{}: ", mechanics.model, id));
  FieldRun run = fields_of(model, mechanics.result, problem, named);
  run.mechanics = mechanics.model;
  run.field = id;
  estimate_from_mechanics(model, mechanics.result, problem, run, named);
  return run;
}

CaseResult run(const input::Case& problem, std::span<const MechanicsEntry> mechanics,
               std::span<const FieldEntry> fields, const Progress& progress,
               const std::map<std::string, Checkpoint>& checkpoints) {
  std::vector<const MechanicsEntry*> mechanics_entries = chosen(mechanics, problem.mechanics);
  put_corrected_last(mechanics_entries, problem.options);
  const std::vector<const FieldEntry*> field_entries = chosen(fields, problem.fields);
  for (const input::external::ExternalModel& model : problem.external)
    require_of_path(model, problem.load_path);
  CaseResult result{problem, {}, {}};
  for (const MechanicsEntry* entry : mechanics_entries) {
    const auto kept = checkpoints.find(entry->id);
    result.mechanics.push_back(
        run_mechanics(*entry, problem, fields, progress,
                      kept != checkpoints.end() ? kept->second : Checkpoint{}));
  }
  for (const input::external::ExternalModel& model : problem.external)
    if (!model.centrelines.empty()) result.mechanics.push_back(external_mechanics(model, problem));
  const bool is_collective = std::ranges::any_of(
      field_entries, [](const FieldEntry* entry) { return entry->is_collective; });
  for (const MechanicsRun& mechanics_run : result.mechanics) {
    if (is_collective) require_same_steps_on_all_ranks(mechanics_run);
    const Deformation& undeformed = mechanics_run.result.undeformed;
    if (undeformed.centreline.pieces().empty()) continue;
    for (const FieldEntry* entry : field_entries)
      if (!entry->has_body || undeformed.body)
        result.fields.push_back(
            run_field(entry->id, *entry->make(problem.options), mechanics_run, problem, progress));
  }
  for (const input::external::ExternalModel& model : problem.external)
    if (!model.readings.empty())
      result.fields.push_back(external_fields(model, problem.sensors.size()));
  return result;
}

bool all_solved(const MechanicsRun& run) {
  return std::none_of(run.result.steps.begin(), run.result.steps.end(),
                      [](const MechanicsStep& step) { return step.status == Status::failed; });
}

bool all_solved(const CaseResult& result) {
  const auto computed = [](const std::optional<FieldStep>& step) {
    return !step || step->failure.empty();
  };
  return std::all_of(result.mechanics.begin(), result.mechanics.end(),
                     [](const MechanicsRun& run) { return all_solved(run); }) &&
         std::all_of(result.fields.begin(), result.fields.end(), [&](const FieldRun& run) {
           return run.undeformed.failure.empty() &&
                  std::all_of(run.steps.begin(), run.steps.end(), computed);
         });
}

}  // namespace ciliaval::compare::models

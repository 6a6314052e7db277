// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/study/evaluate.h"

#include <fmt/core.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <exception>
#include <map>
#include <memory>

#include "compare/budget/sensitivity.h"
#include "compare/models/errors.h"
#include "compare/models/evaluator.h"
#include "compare/models/model_part.h"
#include "compare/models/run.h"
#include "problem/error.h"

namespace ciliaval::compare::study {
namespace {

MechanicsStep solve_one(const MechanicsModel& model, const Cilium& cilium, const Load& load,
                        const Progress& progress) {
  return model.solve(cilium, {load}, progress).steps.at(0);
}

/// The magnitude that bends the softest material by some radians over the whole length; of the
/// environment the one that the case states.
double soft_magnitude(const Cilium& cilium, const Load& load) {
  if (load.is<EnvironmentLoad>()) return 1;
  double E = 0;
  for (const Segment& s : cilium.segments)
    E = E == 0 ? s.young_modulus : std::min(E, s.young_modulus);
  const double L = cilium.length();
  const double force = E * cilium.second_moment(azimuth(load)) / (L * L);
  if (load.is<MomentLoad>()) return force * L;
  return load.is<SectionLoad>() ? force : force / L;
}

void append(std::string& message, const std::string& text) {
  if (!text.empty()) message += (message.empty() ? "" : "; ") + text;
}

/// d|ΔB|/dF = ΔB·(dB/dF)/|ΔB|; none without both.
std::optional<double> slope_of_norm(const models::FieldRun& run, const budget::SurroundedPath& path,
                                    const Vector3& dB) {
  const auto slope = sensitivity(run, path, 0, 0);
  if (!slope || dB.norm() == 0) return std::nullopt;
  return dB.dot(slope->value) / dB.norm();
}

/// The outputs of one pair, but for the range, which is of its mechanics model alone.
PairResult result_of(const Study& study, const MechanicsStep& step, const models::FieldRun& run,
                     const budget::SurroundedPath& path) {
  PairResult result{step.status, step.message, {}};
  result.values.resize(study.outputs.size());
  if (step.status != Status::converged) return result;
  const models::FieldStep& field = run.steps[path.step.front()].value();
  if (!field.dB.front()) {
    result.status = Status::failed;
    result.message = field.failure;
    return result;
  }
  const Vector3 dB = *field.dB.front();
  const bool needs_slope = study.needs_slope();
  const auto slope = needs_slope ? slope_of_norm(run, path, dB) : std::nullopt;
  if (needs_slope && !slope)
    append(result.message, path.around.front()
                               ? "sensitivity: a load 2 % higher or lower has no field"
                               : "sensitivity: the load is zero");
  const Vector3 B = *field.B.front();
  const std::map<Output, std::optional<double>> known{
      {Output::B_x, B.x()},
      {Output::B_y, B.y()},
      {Output::B_z, B.z()},
      {Output::dB_x, dB.x()},
      {Output::dB_y, dB.y()},
      {Output::dB_z, dB.z()},
      {Output::dB_norm, dB.norm()},
      {Output::sensitivity, slope},
      {Output::range, std::nullopt},
      {Output::resolution, slope && *slope != 0 && study.noise
                               ? std::optional(*study.noise / std::abs(*slope))
                               : std::nullopt}};
  for (std::size_t i = 0; i < study.outputs.size(); ++i) {
    const auto found = known.find(study.outputs[i]);
    result.values[i] = found != known.end() ? found->second : number(study.outputs[i], step);
  }
  return result;
}

/// The range as the mechanics model has it, into all results.
void add_range(const Study& study, const input::Case& c, const MechanicsModel& model,
               const MechanicsModel& simplest, const MechanicsStep& step, const Progress& progress,
               std::vector<PairResult>& results) {
  const auto output = std::find(study.outputs.begin(), study.outputs.end(), Output::range);
  if (output == study.outputs.end()) return;
  std::optional<LargestLoad> range;
  std::string failure;
  try {
    range = study.rotation
                ? magnitude_at_rotation(model, c.cilium, step.load, *study.rotation, progress)
                : slip_off(model, c.cilium, step, simplest, progress);
    if (!std::isfinite(range->magnitude)) throw SolverError("range: it is not finite");
  } catch (const CheckpointError&) {
    throw;
  } catch (const RankFailure&) {
    throw;
  } catch (const std::exception& error) {
    failure = error.what();
  }
  for (PairResult& result : results) {
    if (result.status == Status::failed) continue;
    if (range) {
      result.values[static_cast<std::size_t>(output - study.outputs.begin())] = range->magnitude;
      result.range_uncertainty = range->uncertainty;
      append(result.message, range->remark);
    }
    append(result.message, failure);
  }
}

/// Adds the model parts to the results of the runs, which are in their order.
void add_model_uncertainties(const MechanicsStep& step, std::size_t index, models::CaseResult runs,
                             std::span<const models::MechanicsEntry> mechanics_models,
                             std::span<const models::FieldEntry> field_models,
                             std::vector<PairResult>& results) {
  models::add_model_parts(runs, mechanics_models, field_models);
  const auto& range = runs.mechanics.front().model_parts[index].slip_off;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (range && slip_off_limit(step)) results[i].range_model_uncertainty = range->uncertainty();
    if (i >= runs.fields.size() || !runs.fields[i].steps[index]) continue;
    const auto& parts = runs.fields[i].steps[index]->dB_model_part;
    if (!parts.empty() && parts.front())
      results[i].model_uncertainty = parts.front()->uncertainty().maxCoeff();
  }
}

}  // namespace

LargestLoad slip_off(const MechanicsModel& model, const Cilium& cilium, const MechanicsStep& step,
                     const MechanicsModel& simplest, const Progress& progress) {
  if (const auto limit = slip_off_limit(step)) return {*limit, step.slip_off_uncertainty};
  // A model that meets its limit on the way says so: any load beyond will do, and that of the
  // simplest is near. Not every model takes an environment, which is left to the model.
  const MechanicsStep guess =
      solve_one(simplest, cilium, with_environment(step.load, {}), progress);
  double magnitude = 1.5 * slip_off_limit(guess).value_or(ciliaval::magnitude(step.load));
  constexpr int most_trials = 8;
  for (int i = 0; i < most_trials; ++i, magnitude *= 2) {
    const MechanicsStep trial =
        solve_one(model, cilium, with_magnitude(step.load, magnitude), progress);
    if (const auto limit = slip_off_limit(trial)) return {*limit, trial.slip_off_uncertainty};
    if (trial.status == Status::failed || trial.status == Status::pulled_in)
      throw SolverError(fmt::format("range: under {:g} {} the model failed: {}", magnitude,
                                    magnitude_unit(step.load), trial.message));
  }
  throw SolverError(fmt::format("range: the contact does not slip off up to {:g} {}", magnitude / 2,
                                magnitude_unit(step.load)));
}

LargestLoad magnitude_at_rotation(const MechanicsModel& model, const Cilium& cilium,
                                  const Load& load, double rotation, const Progress& progress) {
  std::map<double, LargestLoad> angles;  // uncertainty and remark, by magnitude
  const auto excess = [&](double magnitude) {
    const bool is_straight =
        surroundings::is_empty(load.environment()) || load.is<EnvironmentLoad>();
    if (magnitude == 0 && is_straight) return -rotation;
    const MechanicsStep step = solve_one(model, cilium, with_magnitude(load, magnitude), progress);
    if (step.status != Status::converged)
      throw SolverError(fmt::format("range: under {:g} {} the model failed: {}", magnitude,
                                    magnitude_unit(load), step.message));
    angles[magnitude] = {magnitude, step.tip_angle_uncertainty, step.message};
    const Centreline& centreline = step.deformation->centreline;
    return centreline.at(centreline.length()).theta() - rotation;
  };
  double lower = 0;
  double at_lower = excess(lower);
  if (at_lower >= 0)
    throw SolverError("range: the environment alone turns the tip by the rotation asked for");
  double upper = magnitude(load) > 0 ? magnitude(load) : soft_magnitude(cilium, load);
  double at_upper = excess(upper);
  constexpr int most_doublings = 60;
  for (int i = 0; at_upper < 0; ++i) {
    if (i == most_doublings)
      throw SolverError("range: no load turns the tip as far as the rotation asked for");
    lower = upper;
    at_lower = at_upper;
    upper *= 2;
    at_upper = excess(upper);
  }
  constexpr double tolerance = 1e-6;
  std::uintmax_t trials = 100;
  const auto close = [](double a, double b) { return b - a <= tolerance * b; };
  const auto [a, b] =
      boost::math::tools::toms748_solve(excess, lower, upper, at_lower, at_upper, close, trials);
  LargestLoad result{(a + b) / 2};
  const LargestLoad& angle = angles.at(b);
  constexpr double secant = 0.01;
  const double turned = -excess((1 - secant) * result.magnitude);
  if (angle.uncertainty && turned > 0)
    result.uncertainty = b - a + *angle.uncertainty * secant * result.magnitude / turned;
  else if (!angle.remark.empty())
    result.remark = "range: " + angle.remark;
  return result;
}

std::vector<PairResult> evaluate(const Study& study, input::Case c, const std::string& mechanics,
                                 std::span<const models::MechanicsEntry> mechanics_models,
                                 std::span<const models::FieldEntry> field_models,
                                 const Progress& progress) {
  const budget::SurroundedPath path = budget::surround(c.load_path, study.needs_slope());
  c.load_path = path.loads;
  const models::MechanicsEntry& entry = models::entry_of(mechanics_models, mechanics);
  const models::MechanicsRun run = models::run_mechanics(entry, c, field_models, progress);
  const MechanicsStep& step = run.result.steps[path.step.front()];
  std::vector<PairResult> results;
  models::CaseResult runs{c, {run}, {}};
  for (const ModelPair& pair : study.pairs) {
    if (pair.mechanics != mechanics) continue;
    if (step.status != Status::converged) {
      results.push_back(result_of(study, step, {}, path));
      continue;
    }
    const auto field = models::entry_of(field_models, pair.field).make(c.options);
    const models::FieldRun fields = models::run_field(pair.field, *field, run, c, progress);
    results.push_back(result_of(study, step, fields, path));
    results.back().uncertainty = models::change_uncertainty(run, fields, path.step.front(), 0);
    runs.fields.push_back(fields);
  }
  if (study.has_model_uncertainty && entry.correct)
    add_model_uncertainties(step, path.step.front(), std::move(runs), mechanics_models,
                            field_models, results);
  // A root is sought on one mesh: within an error limit each trial would choose its own.
  for (const input::Refinement& refinement : entry.refinements)
    if (entry.error_limit && refinement.also) refinement.also(c.options);
  add_range(study, c, models::Evaluator(entry, c, field_models),
            models::Evaluator(mechanics_models.front(), c, field_models), step, progress, results);
  return results;
}

}  // namespace ciliaval::compare::study

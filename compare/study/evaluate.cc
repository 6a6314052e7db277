// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/study/evaluate.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <map>
#include <memory>

#include "analytic/elastica/elastica.h"
#include "compare/budget/sensitivity.h"
#include "compare/models/errors.h"
#include "compare/models/run.h"
#include "compare/study/range.h"
#include "problem/error.h"

namespace ciliaval::compare::study {
namespace {

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
  for (std::size_t i = 0; i < study.outputs.size(); ++i)
    result.values[i] = known.at(study.outputs[i]);
  return result;
}

/// The range as the mechanics model has it, into all results.
void add_range(const Study& study, const input::Case& c, const MechanicsModel& model,
               const MechanicsStep& step, const Progress& progress,
               std::vector<PairResult>& results) {
  const auto output = std::find(study.outputs.begin(), study.outputs.end(), Output::range);
  if (output == study.outputs.end()) return;
  std::optional<double> range;
  std::string failure;
  try {
    range = study.rotation
                ? magnitude_at_rotation(model, c.cilium, step.load, *study.rotation, progress)
                : slip_off(model, c.cilium, step,
                           c.options.of<analytic::elastica::ElasticaOptions>(), progress);
    if (!std::isfinite(*range)) throw SolverError("range: it is not finite");
  } catch (const CheckpointError&) {
    throw;
  } catch (const RankFailure&) {
    throw;
  } catch (const std::exception& error) {
    failure = error.what();
  }
  for (PairResult& result : results) {
    if (result.status == Status::failed) continue;
    result.values[static_cast<std::size_t>(output - study.outputs.begin())] = range;
    append(result.message, failure);
  }
}

}  // namespace

std::vector<PairResult> evaluate(const Study& study, input::Case c, const std::string& mechanics,
                                 std::span<const models::MechanicsEntry> mechanics_models,
                                 std::span<const models::FieldEntry> field_models,
                                 const Progress& progress) {
  const budget::SurroundedPath path = budget::surround(c.load_path, study.needs_slope());
  c.load_path = path.loads;
  const auto model = models::entry_of(mechanics_models, mechanics).make(c.options);
  const models::MechanicsRun run = models::run_mechanics(mechanics, *model, c, progress);
  const MechanicsStep& step = run.result.steps[path.step.front()];
  std::vector<PairResult> results;
  for (const models::ModelPair& pair : study.pairs) {
    if (pair.mechanics != mechanics) continue;
    if (step.status != Status::converged) {
      results.push_back(result_of(study, step, {}, path));
      continue;
    }
    const auto field = models::entry_of(field_models, pair.field).make(c.options);
    const models::FieldRun fields = models::run_field(pair.field, *field, run, c, progress);
    results.push_back(result_of(study, step, fields, path));
    results.back().uncertainty = models::change_uncertainty(run, fields, path.step.front(), 0);
  }
  add_range(study, c, *model, step, progress, results);
  return results;
}

}  // namespace ciliaval::compare::study

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/budget/budget.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "compare/budget/sensitivity.h"
#include "compare/results/quantity.h"
#include "problem/error.h"
#include "problem/types.h"

namespace ciliaval::compare::budget {
namespace {

/// The fields of one stage: with dB/dF on the surrounded path, else at the steps of the case only.
struct StageFields {
  const Stage* stage;
  const models::MechanicsRun* mechanics;
  const SurroundedPath* path;
  models::FieldRun run;

  std::optional<models::FieldValue> value(std::size_t step, std::size_t sensor, bool change) const {
    if (run.steps.empty()) return std::nullopt;
    const std::size_t place = stage->sensitivity ? path->step[step] : step;
    return models::field_value(run, *mechanics, place, sensor, change);
  }
};

/// Everything that was computed.
struct Computed {
  SurroundedPath path;
  std::map<std::string, models::MechanicsRun> around;  ///< by id, on the surrounded path
  std::map<std::string, models::MechanicsRun> alone;   ///< the steps of the case only
  std::vector<StageFields> fields;  ///< in the order of the stages, the model beside last
};

MechanicsResult steps_of(const MechanicsResult& all, const std::vector<std::size_t>& places) {
  MechanicsResult result{all.undeformed, {}, {}, all.error_parts, all.algebraic_error};
  for (const std::size_t place : places) result.steps.push_back(all.steps[place]);
  for (const MechanicsResult& companion : all.companions)
    result.companions.push_back(steps_of(companion, places));
  return result;
}

models::MechanicsRun steps_of(const models::MechanicsRun& run,
                              const std::vector<std::size_t>& places) {
  return {run.model, steps_of(run.result, places)};
}

/// The loads in what is around them at a stage.
LoadPath loads_of(const Stage& stage, LoadPath loads) {
  using surroundings::MagneticEnergy;
  for (Load& load : loads) {
    surroundings::Environment around = load.environment();
    if (stage.around == Around::nothing) around = {};
    if (stage.around == Around::other_law)
      around.magnetic_energy =
          around.magnetic_energy == MagneticEnergy::F ? MagneticEnergy::R : MagneticEnergy::F;
    load.set_environment(around);
  }
  return loads;
}

StageFields compute_fields(const Stage& stage, const input::Case& problem,
                           std::span<const models::FieldEntry> entries, const Computed& computed,
                           const Progress& progress) {
  input::ModelOptions options = problem.options;
  stage.set(options);
  const models::FieldEntry& entry = models::entry_of(entries, stage.field);
  const models::MechanicsRun& mechanics =
      (stage.sensitivity ? computed.around : computed.alone).at(stage.mechanics_name());
  StageFields result{&stage, &mechanics, &computed.path, {}};
  if (!mechanics.result.undeformed.centreline.pieces().empty() &&
      (!entry.has_body || mechanics.result.undeformed.body))
    result.run =
        models::run_field(stage.field_name(), *entry.make(options), mechanics, problem, progress);
  return result;
}

void compute(const input::Case& problem, std::span<const models::MechanicsEntry> mechanics,
             std::span<const models::FieldEntry> fields, const Chain& chain,
             const Progress& progress, Computed& computed) {
  computed.path =
      surround(problem.load_path, chain.stages.front().sensitivity && !problem.sensors.empty());
  for (const Stage& stage : chain.mechanics) {
    input::Case surrounded = problem;
    surrounded.load_path = loads_of(stage, computed.path.loads);
    stage.set(surrounded.options);
    const models::MechanicsEntry& entry = models::entry_of(mechanics, stage.mechanics);
    const models::MechanicsRun& run =
        computed.around
            .emplace(stage.mechanics_name(),
                     models::run_mechanics(entry, surrounded, fields, progress))
            .first->second;
    computed.alone.emplace(stage.mechanics_name(), steps_of(run, computed.path.step));
  }
  if (problem.sensors.empty()) return;
  for (const Stage& stage : chain.stages)
    computed.fields.push_back(compute_fields(stage, problem, fields, computed, progress));
  if (chain.beside)
    computed.fields.push_back(compute_fields(*chain.beside, problem, fields, computed, progress));
}

// ------------------------------------------------------------------------------------------- rows

/// A number of all stages of a chain, and of the model beside, with the uncertainty of each
/// difference.
struct Numbers {
  std::vector<std::string> names;             ///< of the stages
  std::vector<std::optional<double>> values;  ///< none where a stage has no value
  std::function<std::optional<double>(std::size_t, std::size_t)> uncertainty;
};

BudgetLink make_link(const Numbers& numbers, std::size_t from, std::size_t to,
                     std::string physics) {
  BudgetLink link{numbers.names[from], numbers.names[to], std::move(physics),
                  *numbers.values[to] - *numbers.values[from], numbers.uncertainty(from, to)};
  if (link.uncertainty && !std::isfinite(*link.uncertainty)) link.uncertainty.reset();
  if (link.uncertainty)
    link.verdict = std::abs(link.value) > *link.uncertainty ? models::Verdict::resolved
                                                            : models::Verdict::below_uncertainty;
  return link;
}

/// Adds a row with its links, unless there is no link, or no value of the paper's model.
void add_row(BudgetRow row, const Numbers& numbers, const Chain& chain,
             std::vector<BudgetRow>& rows) {
  const std::size_t beside = chain.stages.size();
  if (!numbers.values.front()) return;
  std::size_t last = 0;
  for (std::size_t i = 1; i < std::min(numbers.values.size(), beside); ++i) {
    if (!numbers.values[i]) continue;
    row.links.push_back(make_link(numbers, last, i, chain.physics(last, i)));
    last = i;
  }
  if (last == 0) return;
  row.paper = *numbers.values.front();
  row.best = *numbers.values[last];
  row.total = make_link(numbers, 0, last, chain.physics(0, last));
  if (numbers.values.size() > beside && numbers.values[beside])
    row.beside = make_link(numbers, 0, beside, chain.beside->physics);
  rows.push_back(std::move(row));
}

/// Adds what people look at first of the shapes at a step, where every mechanics model has it. The
/// first stages of the chain are the mechanics models, in their order.
void add_mechanics(const Chain& chain, const Computed& computed, std::size_t step,
                   std::vector<BudgetRow>& rows) {
  std::vector<const MechanicsStep*> steps;
  std::vector<std::string> names;
  for (const Stage& stage : chain.mechanics) {
    names.push_back(stage.mechanics_name());
    steps.push_back(&computed.alone.at(names.back()).result.steps[step]);
  }
  for (const results::Quantity& quantity : results::quantities()) {
    if (!quantity.is_looked_at || !quantity.is_accepted) continue;
    const std::size_t components = std::max<std::size_t>(1, quantity.components.size());
    std::vector<std::vector<double>> values;
    for (const MechanicsStep* of_stage : steps) values.push_back(quantity.values(*of_stage));
    if (std::ranges::any_of(values, [&](const auto& v) { return v.size() != components; }))
      continue;
    for (std::size_t c = 0; c < components; ++c) {
      Numbers numbers{names, {}, {}};
      for (const std::vector<double>& of_stage : values) numbers.values.emplace_back(of_stage[c]);
      numbers.uncertainty = [&](std::size_t a, std::size_t b) -> std::optional<double> {
        if (!quantity.uncertainty) return std::nullopt;
        const std::optional<double> ua = quantity.uncertainty(*steps[a]);
        const std::optional<double> ub = quantity.uncertainty(*steps[b]);
        return ua && ub ? std::optional(std::abs(*ua) + std::abs(*ub)) : std::nullopt;
      };
      const std::string component(quantity.components.empty() ? "" : quantity.components[c]);
      add_row({step,
               {},
               std::string(quantity.name),
               component,
               std::string(quantity.kind.unit),
               0,
               0,
               {},
               {},
               {}},
              numbers, chain, rows);
    }
  }
}

/// Adds B, ΔB and dB/dF at a sensor and a step.
void add_fields(const Chain& chain, const Computed& computed, std::size_t step, std::size_t sensor,
                std::vector<BudgetRow>& rows) {
  using Vector = std::optional<Vector3>;
  const auto add = [&](const char* quantity, const std::string& unit, const auto& value,
                       const auto& uncertainty) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const auto component = [axis](const Vector& v) {
        return v ? std::optional((*v)[axis]) : std::nullopt;
      };
      Numbers numbers;
      for (const StageFields& fields : computed.fields) {
        numbers.names.push_back(fields.stage->name());
        numbers.values.push_back(component(value(fields)));
      }
      numbers.uncertainty = [&](std::size_t a, std::size_t b) {
        return component(uncertainty(computed.fields[a], computed.fields[b]));
      };
      const std::string name = axis_names[static_cast<std::size_t>(axis)];
      add_row({step, sensor, quantity, name, unit, 0, 0, {}, {}, {}}, numbers, chain, rows);
    }
  };
  const auto pair = [&](const StageFields& a, const StageFields& b, bool change) -> Vector {
    const auto va = a.value(step, sensor, change);
    const auto vb = b.value(step, sensor, change);
    if (!va || !vb) return std::nullopt;
    return models::combined_uncertainty(*va, *vb,
                                        a.stage->mechanics_name() == b.stage->mechanics_name());
  };
  for (const bool change : {false, true})
    add(
        change ? "dB" : "B", "T",
        [&](const StageFields& fields) -> Vector {
          const auto value = fields.value(step, sensor, change);
          return value ? Vector(value->value) : std::nullopt;
        },
        [&](const StageFields& a, const StageFields& b) { return pair(a, b, change); });
  const auto derivative = [&](const StageFields& fields) -> std::optional<Sensitivity> {
    if (!fields.stage->sensitivity) return std::nullopt;
    return sensitivity(fields.run, computed.path, step, sensor);
  };
  const Quantity& magnitude = computed.path.loads.front().type().parameters.front().quantity;
  add(
      "sensitivity", std::string(results::flux_density_per(magnitude).unit),
      [&](const StageFields& fields) -> Vector {
        const auto value = derivative(fields);
        return value ? Vector(value->value) : std::nullopt;
      },
      // Truncation error of b − a, plus the uncertainty of b − a in ΔB times |dB/dF|/|ΔB| of b.
      [&](const StageFields& a, const StageFields& b) -> Vector {
        const Vector discretisation = pair(a, b, true);
        const auto change = b.value(step, sensor, true);
        if (!discretisation || !(change->value.norm() > 0)) return std::nullopt;
        const Sensitivity da = *derivative(a);
        const Sensitivity db = *derivative(b);
        const Vector3 truncation = ((db.value - da.value) - (db.plain - da.plain)).cwiseAbs();
        return truncation + *discretisation * (db.value.norm() / change->value.norm());
      });
}

// ---------------------------------------------------------------------------------------- remarks

std::string_view outcome(Status status) {
  if (status == Status::pulled_in) return "pulled in";
  return status == Status::slipped_off ? "slipped off" : "failed";
}

/// True if all mechanics models bear a step; else a remark names each that does not.
bool borne(const Computed& computed, const Chain& chain, std::size_t step, Budget& budget) {
  bool all = true;
  for (const Stage& stage : chain.mechanics) {
    const std::string id = stage.mechanics_name();
    const MechanicsStep& result = computed.alone.at(id).result.steps[step];
    if (result.status == Status::converged) continue;
    all = false;
    budget.failed = budget.failed || result.status == Status::failed;
    budget.remarks.push_back(fmt::format("step {}: no budget: {} {}{}{}", step + 1, id,
                                         outcome(result.status), result.message.empty() ? "" : ": ",
                                         result.message));
  }
  return all;
}

/// Says which neighbours of a step are missing, and so its dB/dF.
void remark_neighbours(const Computed& computed, const Chain& chain, std::size_t step,
                       Budget& budget) {
  if (!computed.path.around[step]) {
    if (magnitude(budget.load_path[step]) == 0)
      budget.remarks.push_back(fmt::format("step {}: no dB/dF at a load of zero", step + 1));
    return;
  }
  for (const Stage& stage : chain.mechanics)
    for (const std::size_t place : *computed.path.around[step]) {
      const std::string id = stage.mechanics_name();
      const MechanicsStep& result = computed.around.at(id).result.steps[place];
      if (result.status == Status::converged) continue;
      budget.failed = budget.failed || result.status == Status::failed;
      budget.remarks.push_back(
          fmt::format("step {}: dB/dF is not known by all models: {} {} at {:g} of the load",
                      step + 1, id, outcome(result.status),
                      magnitude(computed.path.loads[place]) / magnitude(budget.load_path[step])));
      break;
    }
}

void remark_failures(const StageFields& fields, Budget& budget) {
  std::vector<std::string> messages;
  const auto add = [&](const models::FieldStep& step) {
    if (!step.failure.empty() &&
        std::find(messages.begin(), messages.end(), step.failure) == messages.end())
      messages.push_back(step.failure);
  };
  if (fields.run.undeformed.B.empty()) return;  // its mechanics gave nothing, which is said
  add(fields.run.undeformed);
  for (const auto& step : fields.run.steps)
    if (step) add(*step);
  for (const std::string& message : messages) {
    budget.failed = true;
    budget.remarks.push_back(fmt::format("{}: {}", fields.run.name(), message));
  }
}

/// dB/dF may end before the chain does.
void remark_sensitivity(const Chain& chain, const Computed& computed, Budget& budget) {
  if (computed.fields.empty() || !chain.stages.front().sensitivity) return;
  const auto end = std::find_if(chain.stages.begin(), chain.stages.end(),
                                [](const Stage& stage) { return !stage.sensitivity; });
  if (end != chain.stages.end())
    budget.remarks.push_back(
        fmt::format("dB/dF ends at {}: the numerical error of {} is too large for differences",
                    std::prev(end)->name(), end->field));
}

}  // namespace

bool Budget::decided() const {
  return std::any_of(rows.begin(), rows.end(), [](const BudgetRow& row) {
    return std::any_of(row.links.begin(), row.links.end(), [](const BudgetLink& link) {
      return link.verdict != models::Verdict::inconclusive;
    });
  });
}

Budget error_budget(const input::Case& problem, std::span<const models::MechanicsEntry> mechanics,
                    std::span<const models::FieldEntry> fields,
                    const std::vector<std::string>& without, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  Budget budget;
  budget.case_name = problem.name;
  budget.sensor_names = input::sensor_names(problem);
  budget.load_path = problem.load_path;
  budget.chain = make_chain(problem, mechanics, fields, without);
  const Chain& chain = budget.chain;
  Computed computed;
  compute(problem, mechanics, fields, chain, progress, computed);
  for (std::size_t step = 0; step < problem.load_path.size(); ++step) {
    if (!borne(computed, chain, step, budget)) continue;
    add_mechanics(chain, computed, step, budget.rows);
    if (chain.stages.front().sensitivity && !problem.sensors.empty())
      remark_neighbours(computed, chain, step, budget);
    for (std::size_t sensor = 0; sensor < problem.sensors.size(); ++sensor)
      add_fields(chain, computed, step, sensor, budget.rows);
  }
  for (const StageFields& stage : computed.fields) remark_failures(stage, budget);
  remark_sensitivity(chain, computed, budget);
  budget.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return budget;
}

}  // namespace ciliaval::compare::budget

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/models/model_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "compare/models/errors.h"
#include "compare/models/registry.h"
#include "fem/solid/solid_options.h"
#include "problem/joints/companions.h"

namespace ciliaval::compare::models {
namespace {

/// The better models on the case.
struct Better {
  const MechanicsEntry* entry = nullptr;
  input::Case corrected;
  std::optional<MechanicsRun> shape;  ///< none: the corrections do not reach, says `unknown`
  std::string unknown;
  std::optional<FieldRun> field;  ///< of that shape
  /// Steps that state a slip-off limit, each by its load of magnitude 0; sought when asked for.
  std::vector<std::pair<Load, MechanicsStep>> limits{};
  /// The path of a contact as it is, and with the contact a standard deviation of the solid's
  /// kernel lower and higher; by the simplest rod with corrected joints.
  std::vector<MechanicsRun> across{};
};

/// The entry of a rod; null: the model is none.
const MechanicsEntry* rod(std::span<const MechanicsEntry> entries, const std::string& id) {
  const auto found = std::ranges::find(entries, id, &MechanicsEntry::id);
  return found != entries.end() && found->correct ? &*found : nullptr;
}

std::string not_of_a_rod(const std::string& model) {
  return "what " + model + " leaves out is not known: only rods are held against a better model";
}

const FieldEntry* best_field(std::span<const FieldEntry> fields) {
  const FieldEntry* best = nullptr;
  for (const FieldEntry& entry : fields)
    if (entry.is_quick()) best = &entry;
  return best;
}

/// Standard deviation of the height in the kernel k(s) = (1 + cos(πs/w))/(2w).
double kernel_deviation(const input::Case& problem) {
  const double w = problem.options.of<fem::solid::SolidOptions>().kernel_width;
  return w * std::sqrt(1.0 / 3 - 2 / (std::numbers::pi * std::numbers::pi));
}

/// The load with its contact higher by `rise`, m.
Load raised(Load load, double rise) {
  const auto& parameters = load.type().parameters;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (parameters[i].site == LoadParameter::Site::height)
      load.set_value(i, load.values()[i] + rise);
  return load;
}

/// Better::across; empty: there is no contact.
std::vector<MechanicsRun> runs_across_the_contact(const input::Case& problem,
                                                  std::span<const MechanicsEntry> mechanics) {
  if (problem.load_path.empty() || !contact_height(problem.load_path.front())) return {};
  for (const MechanicsEntry& entry : mechanics) {
    input::Case corrected = problem;
    if (!correct(entry, corrected).empty()) continue;
    if (entry.hasten) entry.hasten(corrected.options);
    std::vector<MechanicsRun> runs;
    for (const double rise : {0.0, -kernel_deviation(problem), kernel_deviation(problem)}) {
      input::Case moved = corrected;
      for (Load& load : moved.load_path) load = raised(load, rise);
      runs.push_back(run_mechanics(entry, moved, {}));
    }
    return runs;
  }
  return {};
}

Better better_models(const input::Case& problem, std::span<const MechanicsEntry> mechanics,
                     std::span<const FieldEntry> fields, const Progress& progress) {
  Better better;
  for (auto most_detailed = mechanics.rbegin(); most_detailed != mechanics.rend();
       ++most_detailed) {
    const MechanicsEntry& entry = *most_detailed;
    if (!entry.correct) continue;
    input::Case corrected = problem;
    const std::string fault = correct(entry, corrected);
    if (!fault.empty()) {
      if (better.unknown.empty()) better.unknown = fault;
      continue;
    }
    const Progress named = with_prefix(progress, "model part, ");
    better.unknown.clear();
    better.entry = &entry;
    better.corrected = corrected;
    better.shape = run_mechanics(entry, corrected, fields, named);
    if (const FieldEntry* field = best_field(fields);
        field != nullptr && !problem.sensors.empty() && !problem.fields.empty())
      better.field =
          run_field(field->id, *field->make(problem.options), *better.shape, corrected, named);
    better.across = runs_across_the_contact(problem, mechanics);
    return better;
  }
  return better;
}

/// Reason why the better shape does not tell the model's error at a step; empty: it does.
std::string reason_against(const input::Case& problem, const MechanicsStep& step,
                           const MechanicsRun& better, std::size_t index) {
  const MechanicsStep& other = better.result.steps[index];
  if (other.status == Status::failed)
    return fmt::format("{} with corrected joints: {}", better.model, other.message);
  if (step.status == Status::failed) return "it has no shape";
  if (step.status != other.status)
    return fmt::format("{} with corrected joints has {} equilibrium at this load", better.model,
                       other.status == Status::converged ? "an" : "no");
  if (step.status != Status::converged) return {};
  const std::vector<double> strains =
      joints::strains(problem.cilium, other.deformation->centreline);
  const double largest = *std::ranges::max_element(strains);
  if (largest > joints::largest_strain)
    return fmt::format("a strain of {:.2g}: the corrections are known up to {:g}", largest,
                       joints::largest_strain);
  return {};
}

/// `across` is what the contact's width makes.
std::optional<ModelPart<double>> part_of(double difference, std::optional<double> across,
                                         std::optional<double> of_the_better, bool is_corrected) {
  if (!of_the_better || !across) return std::nullopt;
  return ModelPart<double>{std::abs(difference) + *across, *of_the_better, is_corrected};
}

double size_of(double value) {
  return std::abs(value);
}
double size_of(const Vector3& value) {
  return value.norm();
}

/// The change that a contact of some width makes of a step's number, to second order:
/// |Q(h + σ) + Q(h − σ) − 2 Q(h)|/2. At the end of the range, where one of the two has no such
/// number, |Q(h ± σ) − Q(h)|, which is more. None where there is none of them.
template <class Number>
std::optional<double> width_part(const Better& better, std::size_t step, const Number& number) {
  if (better.across.empty()) return 0;
  const auto at = [&](std::size_t i) { return number(better.across[i].result.steps[step]); };
  const auto middle = at(0);
  const auto lower = at(1);
  const auto higher = at(2);
  if (!middle || (!lower && !higher)) return std::nullopt;
  if (lower && higher) return size_of(*lower + *higher - 2 * *middle) / 2;
  return size_of((lower ? *lower : *higher) - *middle);
}

/// The better model's step that states the limit of a step's load, where another states `limit`. A
/// beam looks for its limit only under a larger load.
const MechanicsStep& limit_of(Better& better, const MechanicsStep& step, const MechanicsStep& other,
                              double limit) {
  if (slip_off_limit(other)) return other;
  constexpr double beyond = 1.5;
  const Load kind = with_magnitude(step.load, 0);
  auto known = std::ranges::find(better.limits, kind, &std::pair<Load, MechanicsStep>::first);
  if (known == better.limits.end()) {
    input::Case larger = better.corrected;
    larger.load_path = {with_magnitude(kind, beyond * limit)};
    larger.stated_by.clear();
    MechanicsRun run = run_mechanics(*better.entry, larger, {});
    known = better.limits.insert(known, {kind, std::move(run.result.steps.front())});
  }
  return known->second;
}

ShapeModelParts shape_parts(const input::Case& problem, const MechanicsRun& run, std::size_t index,
                            bool corrected, Better& better) {
  ShapeModelParts parts;
  parts.unknown = better.unknown;
  if (!better.shape) return parts;
  const MechanicsStep& step = run.result.steps[index];
  const MechanicsStep& other = better.shape->result.steps[index];
  const auto limit = slip_off_limit(step);
  if (limit) {
    const MechanicsStep& at_limit = limit_of(better, step, other, *limit);
    if (const auto better_limit = slip_off_limit(at_limit))
      parts.slip_off = part_of(*limit - *better_limit, width_part(better, index, slip_off_limit),
                               at_limit.slip_off_uncertainty, corrected);
  }
  parts.unknown = reason_against(problem, step, *better.shape, index);
  if (!parts.unknown.empty() || step.status != Status::converged) return parts;
  const auto of_shape = [](const auto& number) {
    return [number](const MechanicsStep& of) -> std::optional<decltype(number(of))> {
      if (!of.deformation) return std::nullopt;
      return number(of);
    };
  };
  const auto tip = [](const MechanicsStep& of) {
    return of.deformation->centreline.at(of.deformation->centreline.length());
  };
  const auto position = [&](const MechanicsStep& of) { return tip(of).position; };
  const auto angle = [&](const MechanicsStep& of) { return tip(of).theta(); };
  const auto force = [](const MechanicsStep& of) { return of.applied_force; };
  const auto part = [&](const auto& number, std::optional<double> of_the_better) {
    return part_of(size_of(number(step) - number(other)),
                   width_part(better, index, of_shape(number)), of_the_better, corrected);
  };
  parts.tip = part(position, other.tip_uncertainty);
  parts.tip_angle = part(angle, other.tip_angle_uncertainty);
  parts.applied_force = part(force, other.applied_force_uncertainty);
  return parts;
}

/// Members for B or for ΔB: values, the field model's uncertainty, the effect of the shape's error.
struct Members {
  AtSensors FieldStep::*value;
  AtSensors FieldStep::*uncertainty;
  std::vector<std::optional<double>> FieldStep::*from_mechanics;
  std::vector<std::optional<ModelPart<Vector3>>> FieldStep::*part;
};
constexpr Members members[] = {
    {&FieldStep::B, &FieldStep::uncertainty, &FieldStep::from_mechanics, &FieldStep::B_model_part},
    {&FieldStep::dB, &FieldStep::dB_uncertainty, &FieldStep::dB_from_mechanics,
     &FieldStep::dB_model_part}};

/// The value at a sensor; none where there is no list.
template <class T>
std::optional<T> at(const std::vector<std::optional<T>>& values, std::size_t sensor) {
  return sensor < values.size() ? values[sensor] : std::nullopt;
}

/// An error at a sensor; where there is no list there is no error: ΔB of the straight cilium.
template <class T>
std::optional<T> known(const std::vector<std::optional<T>>& errors, std::size_t sensor, T none) {
  return errors.empty() ? std::optional<T>(none) : at(errors, sensor);
}

/// `own` has the values that the better ones are held against: the step's own, or those of the
/// better field on the step's shape.
void set_parts(FieldStep& step, const FieldStep& own, const FieldStep& better, bool corrected) {
  for (const Members& of : members) {
    auto& parts = step.*of.part;
    parts.resize(step.B.size());
    for (std::size_t s = 0; s < step.B.size(); ++s) {
      const auto a = at(own.*of.value, s);
      const auto b = at(better.*of.value, s);
      if (!a || !b) continue;
      const auto field = known(better.*of.uncertainty, s, Vector3(0, 0, 0));
      const auto shape = known(better.*of.from_mechanics, s, 0.0);
      if (!field || !shape) continue;
      parts[s] = ModelPart<Vector3>{(*a - *b).cwiseAbs() + (corrected ? *field : Vector3(0, 0, 0)),
                                    *shape + (corrected ? 0 : field->lpNorm<Eigen::Infinity>()),
                                    corrected};
    }
  }
}

}  // namespace

std::string correct(const MechanicsEntry& entry, input::Case& problem) {
  if (!entry.correct) return entry.id + " has no corrected joints";
  entry.correct(problem.options);
  return fault_of(entry, problem);
}

void add_model_parts(CaseResult& result, std::span<const MechanicsEntry> mechanics,
                     std::span<const FieldEntry> fields, const Progress& progress) {
  const input::Case& problem = result.problem;
  Better better;
  if (std::ranges::any_of(result.mechanics, [&](const MechanicsRun& run) {
        return rod(mechanics, run.model) != nullptr;
      }))
    better = better_models(problem, mechanics, fields, progress);
  for (MechanicsRun& run : result.mechanics) {
    const MechanicsEntry* entry = rod(mechanics, run.model);
    for (std::size_t i = 0; i < run.result.steps.size(); ++i)
      run.model_parts.push_back(
          entry != nullptr
              ? shape_parts(problem, run, i, entry->is_corrected(problem.options), better)
              : ShapeModelParts{{}, {}, {}, {}, not_of_a_rod(run.model)});
  }
  const FieldEntry* best = best_field(fields);
  for (FieldRun& run : result.fields) {
    if (run.measured) continue;
    const MechanicsRun& shape = mechanics_of(run, result);
    const MechanicsEntry* shape_entry = rod(mechanics, shape.model);
    const bool is_known = shape_entry != nullptr && better.field;
    const auto entry = std::ranges::find(fields, run.field, &FieldEntry::id);
    std::optional<FieldRun> own;  // where the field itself is beyond what the better one knows
    if (is_known && !entry->is_quick())
      own = run_field(best->id, *best->make(problem.options), shape, problem);
    const auto set = [&](FieldStep& step, const FieldStep* of_own, const FieldStep* of_better) {
      if (of_own != nullptr && of_better != nullptr)
        set_parts(step, *of_own, *of_better, shape_entry->is_corrected(problem.options));
    };
    if (is_known)
      set(run.undeformed, own ? &own->undeformed : &run.undeformed, &better.field->undeformed);
    for (std::size_t i = 0; i < run.steps.size(); ++i) {
      if (!run.steps[i]) continue;
      FieldStep& step = *run.steps[i];
      step.model_part_unknown = shape.model_parts[i].unknown;
      if (!is_known || !step.model_part_unknown.empty()) continue;
      const auto& own_step = own ? own->steps[i] : run.steps[i];
      const auto& better_step = better.field->steps[i];
      set(step, own_step ? &*own_step : nullptr, better_step ? &*better_step : nullptr);
    }
  }
}

}  // namespace ciliaval::compare::models

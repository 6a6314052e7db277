// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/models/errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "compare/results/quantity.h"
#include "problem/types.h"

namespace ciliaval::compare::models {
namespace {

/// A length or angle this small (relative to L, or in rad) is rounding error: no scale.
constexpr double vanishing_deflection = 1e-9;
/// A field this small against the scale of its quantity is rounding error: no scale.
constexpr double vanishing_field = 1e-9;
/// Two computations of the same deformation differ by rounding: B by so much of itself.
constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();

std::optional<double> sum(std::optional<double> a, std::optional<double> b) {
  if (!a || !b) return std::nullopt;
  return std::abs(*a) + std::abs(*b);
}

/// Divides by the scale unless it vanishes, and draws the verdict.
void finish(Comparison& c, double scale, double smallest_scale, const std::string& scale_name) {
  if (std::isfinite(scale) && std::abs(scale) > smallest_scale) {
    c.scale = std::abs(scale);
    if (c.difference) c.relative = *c.difference / *c.scale;
  } else {
    c.note = "relative error undefined: " + scale_name + " vanishes";
  }
  if (c.uncertainty && !std::isfinite(*c.uncertainty)) c.uncertainty.reset();
  if (c.difference && c.uncertainty)
    c.verdict =
        std::abs(*c.difference) > *c.uncertainty ? Verdict::resolved : Verdict::below_uncertainty;
}

// ------------------------------------------------------------------------------------- mechanics

/// One step of one mechanics model, with what errors are scaled by.
struct Shape {
  const Centreline& curve;
  std::optional<double> tip_uncertainty;        ///< m
  std::optional<double> tip_angle_uncertainty;  ///< rad
  Vector3 tip;                                  ///< m
  double tip_angle;                             ///< rad
  double tip_deflection;                        ///< along e, m
  double tip_displacement;                      ///< m

  /// True if the tip displacement is more than rounding error.
  bool moved() const { return tip_displacement > vanishing_deflection * curve.length(); }
  /// Relative uncertainty of the deformation, if the tip's is known and it has moved.
  double relative_uncertainty() const { return *tip_uncertainty / tip_displacement; }

  Shape(const MechanicsStep& step, const Deformation& undeformed)
      : curve(step.deformation->centreline),
        tip_uncertainty(step.tip_uncertainty),
        tip_angle_uncertainty(results::tip_angle_uncertainty(step)) {
    const CentrelinePoint end = curve.at(curve.length());
    const Vector3 displacement =
        end.position - undeformed.centreline.at(undeformed.centreline.length()).position;
    tip = end.position;
    tip_angle = end.theta();
    tip_deflection = displacement.dot(direction(step.load));
    tip_displacement = displacement.norm();
  }
};

std::optional<Shape> shape_of(const MechanicsRun& run, std::size_t step) {
  const std::vector<MechanicsStep>& steps = run.result.steps;
  if (step >= steps.size() || steps[step].status != Status::converged || !steps[step].deformation)
    return std::nullopt;
  return Shape(steps[step], run.result.undeformed);
}

void compare_shapes(const Shape& model, const Shape& reference, const Vector3& e, Comparison base,
                    std::vector<Comparison>& out) {
  const double L = reference.curve.length();
  const double smallest = vanishing_deflection * L;
  const std::string deflection_name = "the reference's tip deflection";
  const std::optional<double> tip_uncertainty =
      sum(model.tip_uncertainty, reference.tip_uncertainty);
  base.unit = "m";
  const auto add = [&](const char* quantity, const char* statistic, double difference,
                       std::optional<double> uncertainty) {
    Comparison c = base;
    c.quantity = quantity;
    c.statistic = statistic;
    c.difference = difference;
    c.uncertainty = uncertainty;
    finish(c, reference.tip_deflection, smallest, deflection_name);
    out.push_back(std::move(c));
  };
  const CurveDistance d = distance(model.curve, reference.curve);
  add("centreline", "maximum", d.largest, tip_uncertainty);
  add("centreline", "rms", d.rms, tip_uncertainty);
  add("tip", "value", (model.tip - reference.tip).norm(), tip_uncertainty);

  Comparison angle = base;
  angle.quantity = "tip_angle";
  angle.statistic = "value";
  angle.unit = "rad";
  angle.difference = model.tip_angle - reference.tip_angle;
  angle.uncertainty = sum(model.tip_angle_uncertainty, reference.tip_angle_uncertainty);
  finish(angle, reference.tip_angle, vanishing_deflection, "the reference's tip angle");
  out.push_back(std::move(angle));

  Comparison shape = base;
  shape.quantity = "deflection";
  shape.statistic = "r2";
  if (const auto agreement = compare_deflection(model.curve, reference.curve, e)) {
    shape.difference = agreement->rms;
    shape.uncertainty = tip_uncertainty;
    finish(shape, agreement->deviation, smallest, "the variation of the reference's w(z)");
    if (shape.relative) shape.r2 = agreement->r2();
    if (shape.relative && std::isfinite(agreement->correlation))
      shape.correlation = agreement->correlation * agreement->correlation;
  } else {
    shape.note = "undefined: z does not increase along the centreline; w(z) is not a function";
  }
  out.push_back(std::move(shape));
}

// ----------------------------------------------------------------------------------------- fields

/// One quantity (B or ΔB) of one pair of models over the path: empty where there is none.
struct FieldPath {
  std::vector<std::vector<std::optional<FieldValue>>> at;  ///< [sensor][step]
  std::vector<double> largest;  ///< max |value| over the path, each sensor, T
};

/// |ΔB|·u/|tip displacement|. Zero where nothing has moved and nothing has changed (no load).
std::optional<double> carried_over(const std::optional<Shape>& shape, const Vector3& B,
                                   const std::optional<Vector3>& dB) {
  if (!shape || !shape->tip_uncertainty || !dB) return std::nullopt;
  if (*shape->tip_uncertainty == 0) return 0;
  if (shape->moved()) return dB->norm() * shape->relative_uncertainty();
  if (dB->norm() <= vanishing_field * B.norm()) return 0;
  return std::nullopt;
}

FieldPath field_path(const FieldRun& run, const MechanicsRun& mechanics, bool change,
                     std::size_t sensors) {
  FieldPath path;
  path.largest.assign(sensors, 0);
  path.at.assign(sensors, std::vector<std::optional<FieldValue>>(run.steps.size()));
  for (std::size_t i = 0; i < run.steps.size(); ++i)
    for (std::size_t s = 0; s < sensors; ++s)
      if (const auto value = field_value(run, mechanics, i, s, change)) {
        path.largest[s] = std::max(path.largest[s], value->value.norm());
        path.at[s][i] = value;
      }
  return path;
}

/// Sums over the load path of one component at one sensor.
struct PathSums {
  int n = 0;
  double difference = 0;   ///< Σ(a−b)², T²
  double reference = 0;    ///< Σb², T²
  double uncertainty = 0;  ///< Σu², T²
  bool known = true;       ///< the uncertainty, at every step
};

/// Error of one component at each step, then over the path.
void compare_component(const FieldPath& model, const FieldPath& reference, std::size_t sensor,
                       Eigen::Index axis, bool same_mechanics, double smallest_scale,
                       Comparison base, std::vector<Comparison>& out) {
  const double largest = reference.largest[sensor];
  const std::string name = base.quantity == "B" ? "|B|" : "|dB|";
  base.sensor = sensor;
  base.component = axis_names[static_cast<std::size_t>(axis)];
  base.unit = std::string("T");  // GCC 12 warns at a plain literal (bug 105651)
  PathSums sums;
  for (std::size_t step = 0; step < model.at[sensor].size(); ++step) {
    const auto& a = model.at[sensor][step];
    const auto& b = reference.at[sensor][step];
    if (!a || !b) continue;
    Comparison c = base;
    c.step = step;
    c.statistic = "value";
    c.difference = a->value[axis] - b->value[axis];
    if (const auto u = combined_uncertainty(*a, *b, same_mechanics)) c.uncertainty = (*u)[axis];
    finish(c, largest, smallest_scale, "the reference's largest " + name + " over the load path");
    ++sums.n;
    sums.difference += std::pow(*c.difference, 2);
    sums.reference += std::pow(b->value[axis], 2);
    sums.uncertainty += std::pow(c.uncertainty.value_or(0), 2);
    sums.known = sums.known && c.uncertainty;
    out.push_back(std::move(c));
  }
  if (sums.n == 0) return;
  base.statistic = "rrmse";
  base.difference = std::sqrt(sums.difference / sums.n);
  if (sums.known) base.uncertainty = std::sqrt(sums.uncertainty / sums.n);
  finish(base, std::sqrt(sums.reference / sums.n),
         std::max(vanishing_field * largest, smallest_scale), "this component of the reference");
  out.push_back(std::move(base));
}

/// True if both fields belong to one deformation.
bool same_deformation(const FieldRun& a, const FieldRun& b) {
  return a.mechanics == b.mechanics && !a.measured && !b.measured;
}

void compare_fields(const CaseResult& result, std::vector<Comparison>& out) {
  const std::size_t sensors = result.problem.sensors.size();
  std::vector<std::array<FieldPath, 2>> paths;  // of each field run: B, ΔB
  for (const FieldRun& run : result.fields) {
    const MechanicsRun& mechanics = mechanics_of(run, result);
    paths.push_back(
        {field_path(run, mechanics, false, sensors), field_path(run, mechanics, true, sensors)});
  }
  for (std::size_t b = 0; b < paths.size(); ++b)
    for (std::size_t a = 0; a < b; ++a)
      for (std::size_t quantity = 0; quantity < 2; ++quantity)
        for (std::size_t sensor = 0; sensor < sensors; ++sensor)
          for (Eigen::Index axis = 0; axis < 3; ++axis) {
            Comparison base;
            base.quantity = quantity == 0 ? "B" : "dB";
            base.model = result.fields[a].name();
            base.reference = result.fields[b].name();
            compare_component(paths[a][quantity], paths[b][quantity], sensor, axis,
                              same_deformation(result.fields[a], result.fields[b]),
                              vanishing_field * paths[b][0].largest[sensor], std::move(base), out);
          }
}

}  // namespace

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::resolved:
      return "resolved";
    case Verdict::below_uncertainty:
      return "below uncertainty";
    case Verdict::inconclusive:
      break;
  }
  return "inconclusive";
}

const MechanicsRun& mechanics_of(const FieldRun& run, const CaseResult& result) {
  static const MechanicsRun none;
  if (run.measured) return none;
  const auto found = std::ranges::find(result.mechanics, run.mechanics, &MechanicsRun::model);
  return found != result.mechanics.end() ? *found : none;
}

std::optional<FieldValue> field_value(const FieldRun& run, const MechanicsRun& mechanics,
                                      std::size_t step, std::size_t sensor, bool change) {
  if (!run.steps[step]) return std::nullopt;
  const FieldStep& fields = *run.steps[step];
  const std::optional<Vector3>& value = change ? fields.dB[sensor] : fields.B[sensor];
  if (!value) return std::nullopt;
  FieldValue result{*value, std::nullopt, std::nullopt, 0};
  const auto& uncertainty = change ? fields.dB_uncertainty[sensor] : fields.uncertainty[sensor];
  if (uncertainty) result.numerical = uncertainty->cwiseAbs();
  if (run.measured) {
    result.from_mechanics = 0;
    return result;
  }
  const Vector3& B = *fields.B[sensor];  // where ΔB is, B is, but for readings
  const std::optional<Vector3>& dB = fields.dB[sensor];
  if (mechanics.result.error_parts.empty())
    result.from_mechanics = carried_over(shape_of(mechanics, step), B, dB);
  else
    result.from_mechanics =
        change ? fields.dB_from_mechanics[sensor] : fields.from_mechanics[sensor];
  result.rounding = rounding * B.norm();
  if (dB) result.rounding += rounding * (B - *dB).norm();
  return result;
}

std::optional<Vector3> combined_uncertainty(const FieldValue& a, const FieldValue& b,
                                            bool same_mechanics) {
  if (!a.numerical || !b.numerical) return std::nullopt;
  const Vector3 numerical = *a.numerical + *b.numerical;
  if (same_mechanics) return numerical;
  const std::optional<double> deformations = sum(a.from_mechanics, b.from_mechanics);
  if (!deformations) return std::nullopt;
  return numerical + Vector3::Constant(*deformations + a.rounding + b.rounding);
}

std::optional<Vector3> uncertainties(const MechanicsRun& mechanics, const FieldRun& run,
                                     std::size_t step, std::size_t sensor, bool change) {
  const auto value = field_value(run, mechanics, step, sensor, change);
  if (!value || !value->numerical || !value->from_mechanics) return std::nullopt;
  return *value->numerical + Vector3::Constant(*value->from_mechanics);
}

std::optional<double> change_uncertainty(const MechanicsRun& mechanics, const FieldRun& run,
                                         std::size_t step, std::size_t sensor) {
  const auto components = uncertainties(mechanics, run, step, sensor, true);
  return components ? std::optional(components->maxCoeff()) : std::nullopt;
}

std::vector<Comparison> compare_models(const CaseResult& result) {
  std::vector<Comparison> out;
  for (std::size_t step = 0; step < result.problem.load_path.size(); ++step)
    for (std::size_t b = 0; b < result.mechanics.size(); ++b)
      for (std::size_t a = 0; a < b; ++a) {
        const auto model = shape_of(result.mechanics[a], step);
        const auto reference = shape_of(result.mechanics[b], step);
        if (!model || !reference) continue;
        Comparison base;
        base.step = step;
        base.model = result.mechanics[a].model;
        base.reference = result.mechanics[b].model;
        compare_shapes(*model, *reference, direction(result.problem.load_path[step]),
                       std::move(base), out);
      }
  compare_fields(result, out);
  return out;
}

}  // namespace ciliaval::compare::models

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/regression/quantities.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "compare/output/results.h"

namespace ciliaval::compare::regression {
namespace {

constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};

/// A group's scale at least, in parts of what its rounding comes from.
constexpr double smallest_group = 1e-3;

constexpr std::array<std::string_view, 4> places{"quarter", "middle", "three_quarters", "tip"};

Vector3 position_at(const Centreline& centreline, std::size_t place) {
  return centreline.at(centreline.length() * static_cast<double>(place + 1) / 4).position;
}

/// The largest values of a mechanics model over the load path.
struct Largest {
  double deflection = 0;  ///< m
  double angle = 0;       ///< rad
  double force = 0;       ///< N

  explicit Largest(const models::MechanicsRun& run) {
    for (const MechanicsStep& step : run.result.steps) {
      raise(force, step.applied_force);
      raise(force, step.slip_off_force.value_or(0));
      if (!step.deformation) continue;
      const Centreline& centreline = step.deformation->centreline;
      for (std::size_t i = 0; i < places.size(); ++i)
        raise(deflection, position_at(centreline, i).head<2>().norm());
      raise(deflection, smallest_group * centreline.length());
      raise(angle, centreline.at(centreline.length()).theta());
      raise(angle, smallest_group);
    }
  }
  static void raise(double& largest, double value) {
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  }
};

void add_shape(const std::string& prefix, const models::MechanicsRun& run,
               const MechanicsStep& step, const Largest& largest, Measurements& out) {
  const Centreline& centreline = step.deformation->centreline;
  const double L = centreline.length();
  const auto add = [&](std::string_view name, const char* unit, double value, double scale,
                       std::optional<double> uncertainty = {}) {
    out.quantities.push_back(
        {fmt::format("{}/{}", prefix, name), run.model, {}, unit, value, scale, uncertainty});
  };
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t axis = 0; axis < axes.size(); ++axis)
      add(fmt::format("{}/{}", places[i], axes[axis]), "m",
          position_at(centreline, i)[static_cast<Eigen::Index>(axis)],
          axes[axis] == "z" ? L : largest.deflection,
          places[i] == "tip" ? step.tip_uncertainty : std::nullopt);
  add("tip_angle", "rad", centreline.at(L).theta(), largest.angle);
  add("applied_force", "N", step.applied_force, largest.force);
  if (step.contact_arclength) add("contact_arclength", "m", *step.contact_arclength, L);
  if (step.tip_uncertainty) add("tip_uncertainty", "m", *step.tip_uncertainty, L);
}

void add_mechanics(const models::MechanicsRun& run, Measurements& out) {
  const Largest largest(run);
  for (std::size_t i = 0; i < run.result.steps.size(); ++i) {
    const MechanicsStep& step = run.result.steps[i];
    const std::string prefix = fmt::format("steps/{}/mechanics/{}", i, run.model);
    out.outcomes.push_back(
        {prefix + "/status", run.model, std::string(output::to_string(step.status))});
    if (step.deformation) add_shape(prefix, run, step, largest, out);
    const auto add = [&](const char* name, const char* unit, const std::optional<double>& value,
                         double scale) {
      if (value) out.quantities.push_back({prefix + name, run.model, {}, unit, *value, scale, {}});
    };
    add("/slip_off_force", "N", step.slip_off_force, largest.force);
    add("/slip_off_displacement", "m", step.slip_off_displacement,
        step.slip_off_displacement.value_or(0));
  }
}

/// The largest |B| and the largest |ΔB| of a pair at a sensor over the undeformed cilium and the
/// path, T.
std::pair<double, double> largest_fields(const models::FieldRun& run, std::size_t sensor) {
  const auto largest = [&](const models::AtSensors models::FieldStep::*values) {
    double result = 0;
    const auto look = [&](const models::FieldStep& step) {
      if (sensor < (step.*values).size() && (step.*values)[sensor])
        Largest::raise(result, (step.*values)[sensor]->norm());
    };
    look(run.undeformed);
    for (const auto& step : run.steps)
      if (step) look(*step);
    return result;
  };
  const double B = largest(&models::FieldStep::B);
  return {B, std::max(largest(&models::FieldStep::dB), smallest_group * B)};
}

void add_fields(const models::FieldRun& run, Measurements& out) {
  std::vector<std::pair<double, double>> scales;
  const auto scales_at = [&](std::size_t sensor) {
    while (scales.size() <= sensor) scales.push_back(largest_fields(run, scales.size()));
    return scales[sensor];
  };
  const auto add_step = [&](const std::string& prefix, const models::FieldStep& step,
                            bool deformed) {
    out.outcomes.push_back(
        {prefix + "/status", run.mechanics, step.failure.empty() ? "computed" : "failed"});
    const auto add = [&](const char* name, const models::AtSensors& values,
                         const models::AtSensors& uncertainties, bool difference) {
      for (std::size_t s = 0; s < values.size(); ++s) {
        if (!values[s]) continue;
        const auto [B, dB] = scales_at(s);
        const auto uncertainty = s < uncertainties.size() ? uncertainties[s] : std::nullopt;
        for (std::size_t axis = 0; axis < axes.size(); ++axis) {
          const auto i = static_cast<Eigen::Index>(axis);
          Quantity quantity{fmt::format("{}/{}/{}/{}", prefix, name, s, axes[axis]),
                            run.mechanics,
                            run.field,
                            "T",
                            (*values[s])[i],
                            difference ? dB : B,
                            {}};
          if (uncertainty) quantity.uncertainty = std::abs((*uncertainty)[i]);
          out.quantities.push_back(std::move(quantity));
        }
      }
    };
    add("B", step.B, step.uncertainty, false);
    if (deformed) add("dB", step.dB, step.dB_uncertainty, true);
  };
  add_step("undeformed/fields/" + run.name(), run.undeformed, false);
  for (std::size_t i = 0; i < run.steps.size(); ++i)
    if (run.steps[i])
      add_step(fmt::format("steps/{}/fields/{}", i, run.name()), *run.steps[i], true);
}

}  // namespace

Measurements measurements(const models::CaseResult& result) {
  Measurements out;
  for (const models::MechanicsRun& run : result.mechanics) add_mechanics(run, out);
  for (const models::FieldRun& run : result.fields) add_fields(run, out);
  return out;
}

}  // namespace ciliaval::compare::regression

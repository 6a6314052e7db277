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

void add_vector(Quantity quantity, const Vector3& value, const std::optional<Vector3>& uncertainty,
                Measurements& out) {
  const std::string group = quantity.id;
  for (Eigen::Index i = 0; i < 3; ++i) {
    quantity.id = fmt::format("{}/{}", group, axes[static_cast<std::size_t>(i)]);
    quantity.value = value[i];
    if (uncertainty) quantity.uncertainty = std::abs((*uncertainty)[i]);
    out.quantities.push_back(quantity);
  }
}

void add_shape(const std::string& prefix, const models::MechanicsRun& run,
               const MechanicsStep& step, double largest_force, Measurements& out) {
  const Centreline& centreline = step.deformation->centreline;
  const double L = centreline.length();
  constexpr std::array<std::string_view, 4> places{"quarter", "middle", "three_quarters", "tip"};
  for (std::size_t i = 0; i < places.size(); ++i) {
    Quantity position{fmt::format("{}/{}", prefix, places[i]), run.model, "m", 0, L, {}};
    const bool tip = i + 1 == places.size();
    if (tip) position.uncertainty = step.tip_uncertainty;
    add_vector(position, centreline.at(L * static_cast<double>(i + 1) / 4).position, std::nullopt,
               out);
  }
  const auto add = [&](std::string_view name, const char* unit, double value, double scale) {
    out.quantities.push_back(
        {fmt::format("{}/{}", prefix, name), run.model, unit, value, scale, {}});
  };
  add("tip_angle", "rad", centreline.at(L).theta(), 1);
  add("applied_force", "N", step.applied_force, largest_force);
  if (step.contact_arclength) add("contact_arclength", "m", *step.contact_arclength, L);
  if (step.tip_uncertainty) add("tip_uncertainty", "m", *step.tip_uncertainty, L);
}

void add_mechanics(const models::MechanicsRun& run, Measurements& out) {
  double largest_force = 0;
  for (const MechanicsStep& step : run.result.steps)
    for (const double force : {step.applied_force, step.slip_off_force.value_or(0)})
      largest_force = std::max(largest_force, std::abs(force));
  for (std::size_t i = 0; i < run.result.steps.size(); ++i) {
    const MechanicsStep& step = run.result.steps[i];
    const std::string prefix = fmt::format("steps/{}/mechanics/{}", i, run.model);
    out.outcomes.push_back(
        {prefix + "/status", run.model, std::string(output::to_string(step.status))});
    if (step.deformation) add_shape(prefix, run, step, largest_force, out);
    if (step.slip_off_force)
      out.quantities.push_back(
          {prefix + "/slip_off_force", run.model, "N", *step.slip_off_force, largest_force, {}});
    if (step.slip_off_displacement)
      out.quantities.push_back({prefix + "/slip_off_displacement",
                                run.model,
                                "m",
                                *step.slip_off_displacement,
                                *step.slip_off_displacement,
                                {}});
  }
}

/// The largest |B| or |ΔB| of a pair at each sensor, over the undeformed cilium and the path, T.
std::vector<double> largest_fields(const models::FieldRun& run) {
  std::vector<double> largest(run.undeformed.B.size(), 0);
  const auto look = [&](const models::FieldStep& step) {
    for (std::size_t s = 0; s < step.B.size() && s < largest.size(); ++s)
      for (const auto& value : {step.B[s], step.dB[s]})  // readings may have ΔB alone
        if (value && value->allFinite()) largest[s] = std::max(largest[s], value->norm());
  };
  look(run.undeformed);
  for (const auto& step : run.steps)
    if (step) look(*step);
  return largest;
}

void add_fields(const models::FieldRun& run, Measurements& out) {
  const std::vector<double> scale = largest_fields(run);
  const auto add_rows = [&](const std::string& prefix, const models::AtSensors& values,
                            const models::AtSensors& uncertainty) {
    for (std::size_t s = 0; s < values.size(); ++s)
      if (values[s])
        add_vector({fmt::format("{}/{}", prefix, s),
                    run.mechanics,
                    "T",
                    0,
                    s < scale.size() ? scale[s] : 0,
                    {}},
                   *values[s], s < uncertainty.size() ? uncertainty[s] : std::nullopt, out);
  };
  const auto add_step = [&](const std::string& prefix, const models::FieldStep& step,
                            bool deformed) {
    out.outcomes.push_back(
        {prefix + "/status", run.mechanics, step.failure.empty() ? "computed" : "failed"});
    add_rows(prefix + "/B", step.B, step.uncertainty);
    if (deformed) add_rows(prefix + "/dB", step.dB, step.dB_uncertainty);
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

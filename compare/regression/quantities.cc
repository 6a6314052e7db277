// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/regression/quantities.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "compare/output/results.h"
#include "compare/output/sweep.h"
#include "compare/output/text_table.h"

namespace ciliaval::compare::regression {
namespace {

constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};

constexpr std::size_t most_of_a_sweep = 27;  ///< steps

constexpr std::array<std::string_view, 4> places{"quarter", "middle", "three_quarters", "tip"};

Vector3 position_at(const Centreline& centreline, std::size_t place) {
  return centreline.at(centreline.length() * static_cast<double>(place + 1) / 4).position;
}

void raise(double& largest, double value) {
  if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
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
      raise(angle, centreline.at(centreline.length()).theta());
    }
  }
};

void add_step(const std::string& prefix, const models::MechanicsRun& run, const MechanicsStep& step,
              const Largest& largest, Measurements& out) {
  const auto add = [&](std::string_view name, const char* unit, const std::optional<double>& value,
                       double scale, double group, std::optional<double> uncertainty = {}) {
    if (value)
      out.quantities.push_back({fmt::format("{}/{}", prefix, name),
                                run.model,
                                {},
                                unit,
                                *value,
                                scale,
                                group,
                                uncertainty});
  };
  if (step.deformation) {
    const Centreline& centreline = step.deformation->centreline;
    const double L = centreline.length();
    for (std::size_t i = 0; i < places.size(); ++i)
      for (std::size_t axis = 0; axis < axes.size(); ++axis)
        add(fmt::format("{}/{}", places[i], axes[axis]), "m",
            position_at(centreline, i)[static_cast<Eigen::Index>(axis)], L,
            axes[axis] == "z" ? L : largest.deflection,
            places[i] == "tip" ? step.tip_uncertainty : std::nullopt);
    add("tip_angle", "rad", centreline.at(L).theta(), 1, largest.angle);
    // Of an environment alone it is nothing but rounding.
    if (!step.load.is<EnvironmentLoad>())
      add("applied_force", "N", step.applied_force, largest.force, largest.force);
    add("contact_arclength", "m", step.contact_arclength, L, L);
    add("tip_uncertainty", "m", step.tip_uncertainty, L, L);
  }
  add("slip_off_force", "N", step.slip_off_force, largest.force, largest.force);
  const double slip_off = step.slip_off_displacement.value_or(0);
  add("slip_off_displacement", "m", step.slip_off_displacement, slip_off, slip_off);
  if (step.pull_in) add("pull_in_fraction", "", step.pull_in->fraction, 1, 1);
}

/// Contact forces at the steps, and the number of jumps. Not the works: how a jump divides its
/// energy between friction and loss depends on the steps of its damped motion (1e-3 of it), far
/// more than on rounding.
void add_sweep(const models::MechanicsRun& run, const std::vector<std::size_t>& steps,
               Measurements& out) {
  double largest = 0;
  int jumps = 0;
  for (const MechanicsStep& step : run.result.steps)
    if (step.contact) {
      raise(largest, step.contact->normal_force);
      jumps += step.contact->energy_lost ? 1 : 0;
    }
  const auto add = [&](std::string id, const char* unit, double value, double scale) {
    out.quantities.push_back({std::move(id), run.model, {}, unit, value, scale, scale, {}});
  };
  for (const std::size_t i : steps) {
    if (i >= run.result.steps.size()) break;
    if (const auto& contact = run.result.steps[i].contact) {
      const std::string prefix = fmt::format("steps/{}/mechanics/{}/contact/", i, run.model);
      out.outcomes.push_back({prefix + "state", std::string(output::to_string(contact->state))});
      add(prefix + "normal_force", "N", contact->normal_force, largest);
      add(prefix + "friction_force", "N", contact->friction_force, largest);
    }
  }
  out.outcomes.push_back(
      {fmt::format("energy_balance/{}/jumps", run.model), std::to_string(jumps)});
}

void add_mechanics(const models::MechanicsRun& run, const std::vector<std::size_t>& steps,
                   Measurements& out) {
  const Largest largest(run);
  for (const std::size_t i : steps) {
    if (i >= run.result.steps.size()) break;  // of a run that was cut off
    const MechanicsStep& step = run.result.steps[i];
    const std::string prefix = fmt::format("steps/{}/mechanics/{}", i, run.model);
    out.outcomes.push_back({prefix + "/status", std::string(output::to_string(step.status))});
    add_step(prefix, run, step, largest, out);
  }
  if (!run.result.steps.empty() && run.result.steps.front().load.is<SweepLoad>())
    add_sweep(run, steps, out);
}

/// The largest values of a pair at each sensor over the undeformed cilium and the path, T.
struct LargestFields {
  std::vector<double> B;   ///< |B|, and |ΔB|: readings may have ΔB alone
  std::vector<double> dB;  ///< |ΔB|

  explicit LargestFields(const models::FieldRun& run) {
    look(run.undeformed);
    for (const auto& step : run.steps)
      if (step) look(*step);
  }

 private:
  void look(const models::FieldStep& step) {
    const auto raise_all = [](std::vector<double>& largest, const models::AtSensors& values) {
      largest.resize(std::max(largest.size(), values.size()));
      for (std::size_t s = 0; s < values.size(); ++s)
        if (values[s]) raise(largest[s], values[s]->norm());
    };
    raise_all(B, step.B);
    raise_all(B, step.dB);
    raise_all(dB, step.dB);
  }
};

void add_fields(const models::FieldRun& run, const std::vector<std::size_t>& steps,
                Measurements& out) {
  const LargestFields largest(run);
  const auto add_step = [&](const std::string& prefix, const models::FieldStep& step,
                            bool deformed) {
    out.outcomes.push_back({prefix + "/status", step.failure.empty() ? "computed" : "failed"});
    const auto add = [&](const char* name, const models::AtSensors& values,
                         const models::AtSensors& uncertainties, const std::vector<double>& group) {
      for (std::size_t s = 0; s < values.size(); ++s)
        for (std::size_t axis = 0; values[s] && axis < axes.size(); ++axis) {
          const auto i = static_cast<Eigen::Index>(axis);
          std::optional<double> uncertainty;
          if (s < uncertainties.size() && uncertainties[s])
            uncertainty = std::abs((*uncertainties[s])[i]);
          out.quantities.push_back({fmt::format("{}/{}/{}/{}", prefix, name, s, axes[axis]),
                                    run.mechanics, run.field, "T", (*values[s])[i], largest.B[s],
                                    group[s], uncertainty});
        }
    };
    add("B", step.B, step.uncertainty, largest.B);
    if (deformed) add("dB", step.dB, step.dB_uncertainty, largest.dB);
  };
  add_step("undeformed/fields/" + run.name(), run.undeformed, false);
  for (const std::size_t i : steps)
    if (i < run.steps.size() && run.steps[i])
      add_step(fmt::format("steps/{}/fields/{}", i, run.name()), *run.steps[i], true);
}

}  // namespace

std::vector<std::string> models_of(std::string_view id) {
  std::vector<std::string> result;
  std::size_t missing = 0;
  while (!id.empty()) {
    const std::size_t slash = std::min(id.find('/'), id.size());
    const std::string_view part = id.substr(0, slash);
    id.remove_prefix(std::min(slash + 1, id.size()));
    if (missing > 0) {
      result.emplace_back(part);
      if (--missing == 0) break;
    } else if (part == "fields") {
      missing = 2;
    } else if (part == "mechanics" || part == "energy_balance") {
      missing = 1;
    }
  }
  return result;
}

Measurements measurements(const models::CaseResult& result) {
  const std::size_t count = result.problem.load_path.size();
  const std::vector<std::size_t> steps =
      output::evenly(count, output::is_sweep(result.problem) ? most_of_a_sweep : count);
  Measurements out;
  for (const models::MechanicsRun& run : result.mechanics) add_mechanics(run, steps, out);
  for (const models::FieldRun& run : result.fields) add_fields(run, steps, out);
  return out;
}

}  // namespace ciliaval::compare::regression

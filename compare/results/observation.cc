// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/results/observation.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "compare/results/quantity.h"
#include "problem/support/evenly.h"
#include "problem/types.h"

namespace ciliaval::compare::results {
namespace {

double largest_of(const Quantity& quantity, const models::MechanicsRun& run) {
  double largest = 0;
  for (const MechanicsStep& step : run.result.steps)
    for (const double value : quantity.values(step)) raise(largest, value);
  return largest;
}

void add_mechanics(const models::MechanicsRun& run, const std::vector<std::size_t>& steps,
                   std::vector<Observation>& out) {
  const Extent extent(run.result);
  for (const Quantity& quantity : quantities()) {
    const double largest = quantity.size ? 0 : largest_of(quantity, run);
    for (const std::size_t i : steps) {
      if (i >= run.result.steps.size()) break;  // of a run that was cut off
      const MechanicsStep& step = run.result.steps[i];
      if (quantity.is_compared && !quantity.is_compared(step)) continue;
      const std::vector<double> values = quantity.values(step);
      for (std::size_t c = 0; c < values.size(); ++c) {
        const Size size = quantity.size ? quantity.size(extent, c) : Size{largest, largest};
        out.push_back({i,
                       run.model,
                       {},
                       {},
                       std::string(quantity.name),
                       std::string(quantity.components.empty() ? "" : quantity.components.at(c)),
                       std::string(quantity.kind.unit),
                       values[c],
                       quantity.uncertainty ? quantity.uncertainty(step) : std::nullopt,
                       size.scale,
                       size.group,
                       quantity.is_estimate,
                       quantity.is_accepted,
                       quantity.is_converged,
                       quantity.is_looked_at,
                       false});
      }
    }
  }
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
                std::vector<Observation>& out) {
  const LargestFields largest(run);
  const auto add = [&](std::optional<std::size_t> step, const char* name,
                       const models::AtSensors& values, const models::AtSensors& uncertainties,
                       const std::vector<double>& group, bool is_change) {
    for (std::size_t s = 0; s < values.size(); ++s) {
      if (!values[s]) continue;
      Observation row{step, run.mechanics, run.field, s,     name, {},   "T",       0,
                      {},   largest.B[s],  group[s],  false, true, true, is_change, is_change};
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        row.component = axis_names[static_cast<std::size_t>(axis)];
        row.value = (*values[s])[axis];
        row.uncertainty.reset();
        if (s < uncertainties.size() && uncertainties[s])
          row.uncertainty = std::abs((*uncertainties[s])[axis]);
        out.push_back(row);
      }
      if (!is_change) continue;
      row.component = "norm";
      row.value = values[s]->norm();
      if (row.uncertainty) row.uncertainty = uncertainties[s]->norm();
      row.is_accepted = false;
      out.push_back(std::move(row));
    }
  };
  add({}, "B", run.undeformed.B, run.undeformed.uncertainty, largest.B, false);
  for (const std::size_t i : steps) {
    if (i >= run.steps.size() || !run.steps[i]) continue;
    add(i, "B", run.steps[i]->B, run.steps[i]->uncertainty, largest.B, false);
    add(i, "dB", run.steps[i]->dB, run.steps[i]->dB_uncertainty, largest.dB, true);
  }
}

}  // namespace

std::string Observation::id() const {
  std::string id = step ? fmt::format("steps/{}/", *step) : "undeformed/";
  id += field.empty()
            ? fmt::format("mechanics/{}/{}", mechanics, quantity)
            : fmt::format("fields/{}/{}/{}/{}", mechanics, field, quantity, sensor.value_or(0));
  return component.empty() ? id : fmt::format("{}/{}", id, component);
}

double Observation::size() const {
  return std::max(group, 1e-3 * scale);
}

std::vector<std::size_t> steps_of_table(const LoadPath& path) {
  constexpr std::size_t most_of_a_sweep = 27;
  const bool is_sweep = !path.empty() && path.front().is<SweepLoad>();
  return support::evenly(path.size(), is_sweep ? most_of_a_sweep : path.size());
}

std::vector<Observation> observations(const models::CaseResult& result) {
  const std::vector<std::size_t> steps = steps_of_table(result.problem.load_path);
  std::vector<Observation> out;
  for (const models::MechanicsRun& run : result.mechanics) add_mechanics(run, steps, out);
  for (const models::FieldRun& run : result.fields) add_fields(run, steps, out);
  return out;
}

}  // namespace ciliaval::compare::results

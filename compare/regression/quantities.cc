// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/regression/quantities.h"

#include <fmt/core.h>

#include <algorithm>
#include <string_view>

#include "compare/output/results.h"

namespace ciliaval::compare::regression {
namespace {

void add_mechanics(const models::MechanicsRun& run, const std::vector<std::size_t>& steps,
                   std::vector<Outcome>& out) {
  for (const std::size_t i : steps) {
    if (i >= run.result.steps.size()) break;  // of a run that was cut off
    const MechanicsStep& step = run.result.steps[i];
    const std::string prefix = fmt::format("steps/{}/mechanics/{}", i, run.model);
    out.push_back({prefix + "/status", std::string(output::to_string(step.status))});
    if (step.contact)
      out.push_back(
          {prefix + "/contact/state", std::string(output::to_string(step.contact->state))});
  }
  if (run.result.steps.empty() || !run.result.steps.front().load.is<SweepLoad>()) return;
  const auto jumps = std::ranges::count_if(run.result.steps, [](const MechanicsStep& step) {
    return step.contact && step.contact->energy_lost;
  });
  out.push_back({fmt::format("energy_balance/{}/jumps", run.model), std::to_string(jumps)});
}

void add_fields(const models::FieldRun& run, const std::vector<std::size_t>& steps,
                std::vector<Outcome>& out) {
  const auto add = [&](const std::string& place, const models::FieldStep& step) {
    out.push_back({fmt::format("{}/fields/{}/status", place, run.name()),
                   step.failure.empty() ? "computed" : "failed"});
  };
  add("undeformed", run.undeformed);
  for (const std::size_t i : steps)
    if (i < run.steps.size() && run.steps[i]) add(fmt::format("steps/{}", i), *run.steps[i]);
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
  const std::vector<std::size_t> steps = results::steps_of_table(result.problem.load_path);
  Measurements out{results::observations(result), {}};
  std::erase_if(out.quantities, [](const auto& row) { return !row.is_accepted; });
  for (const models::MechanicsRun& run : result.mechanics) add_mechanics(run, steps, out.outcomes);
  for (const models::FieldRun& run : result.fields) add_fields(run, steps, out.outcomes);
  return out;
}

}  // namespace ciliaval::compare::regression

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/convergence/refinement.h"

#include <algorithm>

#include "compare/models/registry.h"

namespace ciliaval::compare::convergence {

void ModelRefinement::set(input::ModelOptions& options, double value) const {
  option.set_number(options, value);
  if (sequence.also) sequence.also(options);
}

std::vector<ModelRefinement> refinements(const input::Case& problem) {
  std::vector<ModelRefinement> result;
  const auto add = [&](const auto& entries, const std::vector<std::string>& asked, bool is_field) {
    for (const auto& entry : entries) {
      if (std::find(asked.begin(), asked.end(), entry.id) == asked.end()) continue;
      for (const input::Refinement& sequence : entry.refinements)
        if (!sequence.applies || sequence.applies(problem.options)) {
          const auto is_its_option = [&](const input::Option& option) {
            return option.name == sequence.option;
          };
          result.push_back(
              {entry.id, is_field, entry.accuracy / 10,
               *std::find_if(entry.options.begin(), entry.options.end(), is_its_option), sequence});
        }
    }
  };
  add(models::mechanics_models(), problem.mechanics, false);
  add(models::field_models(), problem.fields, true);
  return result;
}

}  // namespace ciliaval::compare::convergence

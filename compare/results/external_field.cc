// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/results/external_field.h"

#include <algorithm>
#include <functional>

namespace ciliaval::compare::results {

std::vector<std::vector<Vector3>> external_field(const input::Case& problem) {
  std::vector<std::vector<Vector3>> field;
  for (const Load& load : problem.load_path) {
    const surroundings::Environment environment = acting_environment(load);
    std::vector<Vector3>& at = field.emplace_back();
    for (const Vector3& sensor : problem.sensors)
      at.push_back(environment.uniform_field +
                   surroundings::magnets::jet(environment.magnets, sensor).B);
  }
  if (std::ranges::adjacent_find(field, std::ranges::not_equal_to{}) == field.end()) return {};
  return field;
}

}  // namespace ciliaval::compare::results

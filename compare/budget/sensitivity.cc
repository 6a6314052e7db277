// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/budget/sensitivity.h"

namespace ciliaval::compare::budget {

SurroundedPath surround(const LoadPath& path, bool with_neighbours) {
  SurroundedPath result;
  for (const Load& load : path) {
    const double F = magnitude(load);
    const bool surrounded = with_neighbours && F > 0;
    result.around.emplace_back();
    if (!surrounded) {
      result.step.push_back(result.loads.size());
      result.loads.push_back(load);
      continue;
    }
    const std::size_t first = result.loads.size();
    for (const int k : {-2, -1, 0, 1, 2})
      result.loads.push_back(k == 0 ? load : with_magnitude(load, F * (1 + k * sensitivity_step)));
    result.step.push_back(first + 2);
    result.around.back() = {first, first + 1, first + 3, first + 4};
  }
  return result;
}

std::optional<Sensitivity> sensitivity(const models::FieldRun& run, const SurroundedPath& path,
                                       std::size_t step, std::size_t sensor) {
  if (!path.around[step] || run.steps.empty()) return std::nullopt;
  std::array<Vector3, 4> B;
  std::array<double, 4> F{};
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t place = (*path.around[step])[i];
    if (!run.steps[place] || !run.steps[place]->B[sensor]) return std::nullopt;
    B[i] = *run.steps[place]->B[sensor];
    F[i] = magnitude(path.loads[place]);
  }
  const Vector3 fine = (B[2] - B[1]) / (F[2] - F[1]);
  const Vector3 coarse = (B[3] - B[0]) / (F[3] - F[0]);
  return Sensitivity{(4 * fine - coarse) / 3, fine};
}

}  // namespace ciliaval::compare::budget

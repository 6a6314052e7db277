// SPDX-License-Identifier: LGPL-2.1-or-later
// Seconds that the mechanics of a sweep take over the surface of cases/paper/fig6-surface.toml.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <string>

#include "compare/input/case.h"
#include "compare/models/registry.h"
#include "compare/models/run.h"

namespace ciliaval::compare {
namespace {

void sweep(benchmark::State& state, const std::string& mechanics, std::size_t samples,
           double travel) {
  input::Case problem =
      input::read_case(std::filesystem::path(CILIAVAL_SOURCE_DIR) / "cases/paper/fig6-surface.toml",
                       models::known());
  problem.load_path = sweep_path(problem.load_path.front(), {travel, samples, false});
  const auto model = models::entry_of(models::mechanics_models(), mechanics).make(problem.options);
  for (auto _ : state) {
    const MechanicsResult result = model->solve(problem.cilium, problem.load_path);
    for (const MechanicsStep& step : result.steps)
      if (step.status != Status::converged) {
        state.SkipWithError(step.message.c_str());
        return;
      }
  }
  state.counters["samples"] = static_cast<double>(samples);
}

// The whole surface, two plateaus; what the design asks of the solid: 200 samples.
BENCHMARK_CAPTURE(sweep, elastica_2000, "elastica", 2001, 52e-3)
    ->Unit(benchmark::kSecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(sweep, beam_2000, "beam", 2001, 52e-3)->Unit(benchmark::kSecond)->UseRealTime();
BENCHMARK_CAPTURE(sweep, solid_200, "solid", 201, 26e-3)->Unit(benchmark::kSecond)->UseRealTime();
BENCHMARK_CAPTURE(sweep, elastica_50, "elastica", 51, 5e-3)
    ->Unit(benchmark::kSecond)
    ->UseRealTime();

}  // namespace
}  // namespace ciliaval::compare

BENCHMARK_MAIN();

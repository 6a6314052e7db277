// SPDX-License-Identifier: LGPL-2.1-or-later
// Processor time of evaluating one design, its shape and B, with the plain and the corrected
// elastica: random designs of one load type each, by turns. A contact finds its slip-off force too.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "analytic/elastica/elastica.h"
#include "analytic/rod/field_models.h"
#include "tests/coverage/random_case.h"

namespace ciliaval::test {
namespace {

constexpr std::size_t designs = 50;

const std::vector<RandomCase>& drawn(const std::string& type_of_load) {
  static std::map<std::string, std::vector<RandomCase>> kept;  // drawing takes longer
  std::vector<RandomCase>& result = kept[type_of_load];
  for (std::uint32_t seed = 0; result.size() < designs; ++seed)
    if (RandomCase design = random_design(seed); type(design.load) == type_of_load)
      result.push_back(std::move(design));
  return result;
}

void evaluate(benchmark::State& state, const std::string& type_of_load,
              joints::Correction correction) {
  const std::vector<RandomCase>& cases = drawn(type_of_load);
  const analytic::elastica::Elastica elastica({.joints = correction, .error_estimate = false});
  const analytic::rod::VolumeField volume;
  std::size_t next = 0;
  std::size_t solved = 0;
  for ([[maybe_unused]] auto _ : state) {
    const RandomCase& design = cases[next++ % designs];
    const MechanicsResult result = elastica.solve(design.cilium, {design.load});
    const MechanicsStep& step = result.steps.front();
    if (!step.deformation) continue;
    ++solved;
    benchmark::DoNotOptimize(volume.field(design.cilium, *step.deformation, design.sensors).B);
  }
  state.counters["solved"] = static_cast<double>(solved) / static_cast<double>(next);
}

BENCHMARK_CAPTURE(evaluate, contact_plain, "contact", joints::Correction::none);
BENCHMARK_CAPTURE(evaluate, contact_corrected, "contact", joints::Correction::corrected);
BENCHMARK_CAPTURE(evaluate, section_plain, "section", joints::Correction::none);
BENCHMARK_CAPTURE(evaluate, section_corrected, "section", joints::Correction::corrected);
BENCHMARK_CAPTURE(evaluate, flow_plain, "flow", joints::Correction::none);
BENCHMARK_CAPTURE(evaluate, flow_corrected, "flow", joints::Correction::corrected);

}  // namespace
}  // namespace ciliaval::test

BENCHMARK_MAIN();

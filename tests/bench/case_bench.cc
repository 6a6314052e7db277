// SPDX-License-Identifier: LGPL-2.1-or-later
// Seconds that whole cases take: read, run, compared and written, as `ciliaval run` does it, but
// for its start. Wall time.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "compare/input/case.h"
#include "compare/models/errors.h"
#include "compare/models/registry.h"
#include "compare/models/run.h"
#include "compare/output/field_grid.h"
#include "compare/output/provenance.h"
#include "compare/output/results.h"
#include "compare/output/vtk/output.h"
#include "fem/solid/solid_options.h"

namespace ciliaval::compare {
namespace {

namespace fs = std::filesystem;

fs::path shipped(const std::string& name) {
  return fs::path(CILIAVAL_SOURCE_DIR) / "cases" / "paper" / (name + ".toml");
}

/// Changes of a case before it is timed.
struct Change {
  std::vector<std::string> mechanics;  ///< empty: those of the file
  std::optional<std::size_t> last;     ///< the first steps of the load path are left out
  unsigned int refinement = 1;
};

void whole_case(benchmark::State& state, const std::string& name, const Change& change) {
  const fs::path folder =
      fs::temp_directory_path() / ("ciliaval-bench-" + std::to_string(getpid()));
  for (auto _ : state) {
    input::Case problem = input::read_case(shipped(name), models::known());
    if (!change.mechanics.empty()) problem.mechanics = change.mechanics;
    problem.options.of<fem::solid::SolidOptions>().refinement = change.refinement;
    if (change.last)
      problem.load_path.erase(problem.load_path.begin(),
                              problem.load_path.end() - static_cast<std::ptrdiff_t>(*change.last));
    fs::create_directories(folder);
    const models::CaseResult result =
        models::run(problem, models::mechanics_models(), models::field_models());
    if (!models::all_solved(result)) state.SkipWithError("a model failed");
    const output::Provenance origin = output::provenance("bench_case");
    output::write_results(result, models::compare_models(result), origin, folder);
    output::vtk::write_vtk(result, output::field_grid(result, models::field_models()), origin,
                           output::vtk::drawn_steps(problem.load_path.size(), false),
                           folder / "vtk");
    state.counters["steps"] = static_cast<double>(problem.load_path.size());
  }
  fs::remove_all(folder);
}

void add(const std::string& label, const std::string& name, const Change& change) {
  benchmark::RegisterBenchmark(
      (name + "/" + label).c_str(),
      [name, change](benchmark::State& state) { whole_case(state, name, change); })
      ->Unit(benchmark::kSecond)
      ->UseRealTime()
      ->Iterations(1);
}

}  // namespace
}  // namespace ciliaval::compare

int main(int argc, char** argv) {
  using ciliaval::compare::add;
  add("rods", "fig3b", {.mechanics = {"elastica", "beam"}, .last = {}});
  for (const unsigned int refinement : {0U, 1U, 2U}) {
    const std::string label = "/refinement:" + std::to_string(refinement);
    add("4mN" + label, "fig3b", {.mechanics = {}, .last = 1, .refinement = refinement});
    add("all" + label, "fig3b", {.mechanics = {}, .last = {}, .refinement = refinement});
  }
  add("all", "fig3d", {.mechanics = {}, .last = {}});
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

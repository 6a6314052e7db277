// SPDX-License-Identifier: LGPL-2.1-or-later
// Seconds, iterations and memory of one linear solution of the solid: the tangent of the paper's
// cilium (E₂/E₁ = 30) without load, the nodal forces of 1 mN at 16 mm; on a family of meshes, and
// on those that the program makes. Under mpirun in parts: the seconds of the first rank, the memory
// of the rank that has the most.
#include <benchmark/benchmark.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/multithread_info.h>

#include <string>
#include <utility>
#include <vector>

#include "fem/solid/solid.h"
#include "tests/bench/mesh_family.h"

namespace ciliaval::fem::solid {
using namespace solvers;
namespace {

void solve(benchmark::State& run, const meshes::cylinder::CylinderMeshOptions& mesh,
           double poisson_ratio, SolverKind kind) {
  const Discretised problem(mesh, poisson_ratio);
  LinearSolver solver(*problem.space, problem.constraints, kind, MPI_COMM_SELF);
  discretisation::Vector solution;
  int iterations = 0;
  for ([[maybe_unused]] auto _ : run) {
    run.PauseTiming();
    problem.assemble(solver);
    run.ResumeTiming();
    solver.prepare();
    iterations = solver.solve(problem.forces, solution, 1e-6);
  }
  const double unknowns = problem.space->unknowns();
  run.counters["unknowns"] = unknowns;
  run.counters["iterations"] = iterations;
  run.counters["per_unknown"] = benchmark::Counter(
      unknowns, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  run.counters["GB"] = dealii::Utilities::MPI::max(gigabytes(), MPI_COMM_WORLD);
}

void on_mesh_family(benchmark::State& run, SolverKind kind) {
  solve(run, mesh_family.at(static_cast<std::size_t>(run.range(0))), 0.49, kind);
}

/// Arguments: refinement, whether it is the half mesh, 10⁴ν.
void on_own_mesh(benchmark::State& run) {
  auto mesh = cylinder_mesh_options(static_cast<unsigned int>(run.range(0)));
  mesh.half = run.range(1) != 0;
  solve(run, mesh, 1e-4 * static_cast<double>(run.range(2)), SolverKind::iterative);
}

/// Reporter of the ranks that keep silent.
class NoReporter : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>&) override {}
};

}  // namespace
}  // namespace ciliaval::fem::solid

int main(int argc, char** argv) {
  using namespace ciliaval::fem;
  using namespace ciliaval::fem::solid;
  using namespace ciliaval::fem::solid::material;
  using namespace ciliaval::fem::solid::solvers;
  start_mpi();
  dealii::MultithreadInfo::set_thread_limit(1);
  const bool alone = rank_count() == 1;
  for (const auto& [name, kind] :
       {std::pair<std::string, SolverKind>{"iterative", SolverKind::iterative},
        {"direct", SolverKind::direct}}) {
    if (kind == SolverKind::direct && !alone) continue;
    auto* bench = benchmark::RegisterBenchmark(("solve/" + name).c_str(), on_mesh_family, kind);
    const auto meshes =
        static_cast<int>(kind == SolverKind::direct ? million - 1 : mesh_family.size());
    for (int mesh = 0; mesh < meshes; ++mesh) bench->Arg(mesh);
    bench->ArgName("mesh")->Iterations(1)->Unit(benchmark::kSecond)->UseRealTime();
  }
  auto* own = benchmark::RegisterBenchmark("own/iterative", on_own_mesh);
  for (const int refinement : {0, 1, 2, 3})
    for (const int half : {0, 1})
      for (const int poisson : {4900, 4999}) own->Args({refinement, half, poisson});
  own->ArgNames({"refinement", "half", "poisson"})
      ->Iterations(1)
      ->Unit(benchmark::kSecond)
      ->UseRealTime();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  NoReporter none;
  if (rank() == 0)
    benchmark::RunSpecifiedBenchmarks();
  else
    benchmark::RunSpecifiedBenchmarks(&none);
}

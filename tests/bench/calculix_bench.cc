// SPDX-License-Identifier: LGPL-2.1-or-later
// The solid beside CalculiX (C3D20R, NLGEOM, neo-Hooke, two threads each): the paper's cilium under
// the dead force of a `section` load, on the same sequence of graded half meshes. Prints error of
// the tip, wall and processor time of each run, and the ratio of the times at equal error.
//   build/release/tests/bench/bench_calculix [folder for CalculiX's files]
#include <deal.II/base/multithread_info.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "fem/calculix/calculix.h"
#include "fem/parallel.h"
#include "fem/solid/solid.h"
#include "meshes/cylinder/cylinder_mesh.h"
#include "problem/error.h"
#include "tests/bench/paper_cilium.h"

namespace ciliaval::fem {
namespace {

using namespace calculix;

namespace fs = std::filesystem;

constexpr double force = 2e-3;       // N
constexpr double arclength = 16e-3;  // m
const Load load = SectionLoad{.force = force, .arclength = arclength, .azimuth = 0};

/// One run of a program on one mesh.
struct Run {
  std::size_t unknowns = 0;
  double deflection = 0;  // m
  double wall = 0;        // s
  double cpu = 0;         // s
};

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

double cpu_seconds(const rusage& usage) {
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

class Stopwatch {
 public:
  double elapsed() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

double deflection(const Centreline& line) {
  return line.at(line.length()).position.x();
}

Run solid_run(unsigned int refinement) {
  solid::SolidOptions options;
  options.refinement = refinement;
  rusage before{};
  rusage after{};
  getrusage(RUSAGE_SELF, &before);
  const Stopwatch watch;
  const MechanicsResult result = solid::Solid(options).solve(paper_cilium(), {load});
  getrusage(RUSAGE_SELF, &after);
  const MechanicsStep& step = result.steps.front();
  if (!step.deformation) throw SolverError(step.message);
  return {step.unknowns, deflection(step.deformation->centreline), watch.elapsed(),
          cpu_seconds(after) - cpu_seconds(before)};
}

/// Mean displacement of the tip face along x.
double tip_deflection(const meshes::MeshNodes& mesh, const std::vector<Vector3>& displacements) {
  const auto weights =
      calculix_forces(mesh, paper_cilium(),
                      SectionLoad{.force = 1, .arclength = paper_cilium().length(), .azimuth = 0});
  double sum = 0;
  double weight = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    sum += weights[i].x() * displacements[i].x();
    weight += weights[i].x();
  }
  return sum / weight;
}

std::optional<Run> calculix_run(const fs::path& folder, unsigned int refinement,
                                double first_increment) {
  meshes::cylinder::CylinderMeshOptions options = solid::cylinder_mesh_options(refinement);
  options.half = true;
  options.planes = {arclength};
  dealii::Triangulation<3> triangulation;
  meshes::cylinder::make_cylinder(paper_cilium(), options, triangulation);
  const auto mapping = meshes::cylinder::cylinder_mapping(triangulation);
  const meshes::MeshNodes mesh = meshes::mesh_nodes(triangulation, *mapping);
  {
    std::ofstream input(folder / "cilium.inp");
    write_calculix(input, mesh, paper_cilium(), load, first_increment);
  }
  fs::remove(folder / "cilium.dat");  // an earlier run's must not pass for this one's
  const Stopwatch watch;
  const pid_t child = fork();
  if (child == 0) {
    if (chdir(folder.c_str()) != 0 || std::freopen("ccx.log", "w", stdout) == nullptr ||
        setenv("OMP_NUM_THREADS", "2", 1) != 0)
      _exit(127);
    execlp("ccx", "ccx", "-i", "cilium", nullptr);
    _exit(127);
  }
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  const double wall = watch.elapsed();
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
    throw SolverError("CalculiX is not installed: apt-get install calculix-ccx");
  std::ifstream output(folder / "cilium.dat");
  try {
    const auto displacements = read_calculix(output, mesh);
    const auto nodes = std::count_if(displacements.begin(), displacements.end(),
                                     [](const Vector3& u) { return u != Vector3::Zero(); });
    return Run{3 * static_cast<std::size_t>(nodes), tip_deflection(mesh, displacements), wall,
               cpu_seconds(usage)};
  } catch (const FileError&) {
    return std::nullopt;
  }
}

double error(const Run& run, double converged) {
  return std::abs(run.deflection / converged - 1);
}

void print(const char* program, const Run& run, double converged) {
  std::printf("%-9s %9zu %12.5f %9.3f %9.2f %9.2f\n", program, run.unknowns, 1e3 * run.deflection,
              100 * error(run, converged), run.wall, run.cpu);
  std::fflush(stdout);
}

/// Time at which the runs reach an error, by linear interpolation of the logarithms; the cheapest
/// run's time if all are better. Empty if none reaches it.
std::optional<double> time_at(const std::vector<Run>& runs, double converged, double limit,
                              double Run::*time) {
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const double here = error(runs[i], converged);
    if (here > limit) continue;
    if (i == 0) return runs[0].*time;
    const double before = error(runs[i - 1], converged);
    const double t = std::log(before / limit) / std::log(before / here);
    return std::exp((1 - t) * std::log(runs[i - 1].*time) + t * std::log(runs[i].*time));
  }
  return std::nullopt;
}

void compare(const fs::path& folder) {
  std::printf("%-9s %9s %12s %9s %9s %9s\n", "program", "unknowns", "tip mm", "error %", "wall s",
              "cpu s");
  const double converged = solid_run(3).deflection;
  std::vector<Run> solid;
  std::vector<Run> calculix;
  for (const unsigned int refinement : {0U, 1U, 2U}) {
    solid.push_back(solid_run(refinement));
    print("solid", solid.back(), converged);
  }
  for (const unsigned int refinement : {0U, 1U, 2U}) {
    std::optional<Run> best;
    for (const double first_increment : {1.0, 0.5, 0.2, 0.1}) {
      const auto run = calculix_run(folder, refinement, first_increment);
      if (run && (!best || run->cpu < best->cpu)) best = run;
    }
    if (!best) throw SolverError("CalculiX did not converge with any first increment");
    calculix.push_back(*best);
    print("CalculiX", *best, converged);
  }
  for (const double limit : {5e-3, 2e-3})
    for (const auto& [name, time] : {std::pair{"wall", &Run::wall}, std::pair{"cpu", &Run::cpu}}) {
      const auto ours = time_at(solid, converged, limit, time);
      const auto theirs = time_at(calculix, converged, limit, time);
      if (ours && theirs)
        std::printf("at %.1f %%: %s %.2f s, CalculiX %.2f s, ratio %.1f\n", 100 * limit, name,
                    *ours, *theirs, *theirs / *ours);
      else
        std::printf("at %.1f %%: not reached by %s\n", 100 * limit,
                    ours ? "CalculiX" : "the solid");
    }
}

}  // namespace
}  // namespace ciliaval::fem

int main(int argc, char** argv) {
  using namespace ciliaval;
  try {
    fem::start_mpi();
    dealii::MultithreadInfo::set_thread_limit(2);
    const std::filesystem::path folder =
        argc > 1 ? argv[1] : std::filesystem::temp_directory_path() / "ciliaval-calculix";
    std::filesystem::create_directories(folder);
    fem::compare(folder);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_calculix: %s\n", error.what());
    return 1;
  }
}

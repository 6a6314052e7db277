// SPDX-License-Identifier: LGPL-2.1-or-later
// Tip of the paper's cilium under 2 mN of fig3b (ν = 0.49) on half meshes that are similar to each
// other, each finer than the last one in all directions alike, and Richardson's extrapolation by
// least squares (Eça & Hoekstra) of the last four: docs/evidence/solid.md.
// Usage: reference_study [CELLS …], of each mesh those along a side of the section's square; even.
#include <deal.II/base/multithread_info.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "compare/convergence/extrapolation.h"
#include "fem/parallel.h"
#include "fem/solid/level.h"
#include "fem/solid/postprocessing/centreline.h"
#include "fem/solid/solid.h"
#include "tests/bench/paper_cilium.h"

namespace ciliaval::fem::solid {
namespace {

/// With 4 cells it is the mesh of refinement 2.
meshes::cylinder::CylinderMeshOptions mesh(unsigned int square_cells) {
  const double h = 4.0 / square_cells;
  meshes::cylinder::CylinderMeshOptions options = cylinder_mesh_options(2);
  options.square_cells = square_cells;
  options.rings = square_cells;
  options.ring_ratio = std::pow(options.ring_ratio, h);
  options.finest_layer *= h;
  options.coarsest_layer *= h;
  options.growth *= h;
  options.half = true;
  return options;
}

void study(const std::vector<unsigned int>& square_cells) {
  const Cilium cilium = paper_cilium();
  const SolidOptions defaults;
  LevelOptions options;
  options.path.newton.tolerance = defaults.newton_tolerance;
  options.path.kernel_width = defaults.kernel_width;
  std::vector<material::Hyperelastic> materials;
  for (const Segment& segment : cilium.segments)
    materials.push_back(
        material::Hyperelastic::neo_hooke(segment.shear_modulus(), segment.bulk_modulus()));
  const auto start = std::chrono::steady_clock::now();
  std::vector<std::unique_ptr<Level>> levels;  // coarsest first
  levels.reserve(square_cells.size());
  for (const unsigned int cells : square_cells)
    levels.push_back(std::make_unique<Level>(cilium, mesh(cells), materials, options,
                                             levels.empty() ? nullptr : levels.back().get()));
  const ContactLoad load{.force = 2e-3, .height = 16e-3};
  if (levels.back()->advance(load, {}).status != Status::converged)
    throw std::runtime_error("the solid did not converge");
  std::vector<compare::convergence::RefinementLevel> deflections;  // finest first
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const Level& level = *levels[i];
    if (magnitude(level.state()->current.load) != load.force)
      throw std::runtime_error("a coarser mesh did not converge");
    const double deflection = postprocessing::tip_position(level.space(), level.quadrature(),
                                                           level.state()->current.state)
                                  .head<2>()
                                  .norm();
    deflections.insert(deflections.begin(), {1.0 / square_cells[i], deflection});
    if (rank() == 0)
      std::printf("%2u cells, %8zu unknowns: %.6f mm\n", square_cells[i], level.unknowns(),
                  1e3 * deflection);
  }
  if (rank() != 0) return;
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  std::printf("%.0f s\n", elapsed.count());
  if (deflections.size() < 4) return;
  deflections.resize(4);
  const auto fit = compare::convergence::least_squares_convergence(deflections);
  if (fit.conclusive)
    std::printf("order %.2f, limit %.6f mm, finest mesh +- %.6f mm (%.4f %%) %s\n",
                fit.order.value_or(0), 1e3 * fit.limit, 1e3 * fit.uncertainty,
                100 * fit.uncertainty / fit.limit, fit.reason.c_str());
  else
    std::printf("inconclusive: %s\n", fit.reason.c_str());
}

}  // namespace
}  // namespace ciliaval::fem::solid

int main(int argc, char** argv) {
  try {
    ciliaval::fem::start_mpi();
    dealii::MultithreadInfo::set_thread_limit(1);
    std::vector<unsigned int> square_cells;
    for (int i = 1; i < argc; ++i)
      square_cells.push_back(static_cast<unsigned int>(std::stoul(argv[i])));
    if (square_cells.empty()) square_cells = {2, 4, 6, 8, 10};
    ciliaval::fem::solid::study(square_cells);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "reference_study: %s\n", error.what());
    return 1;
  }
}

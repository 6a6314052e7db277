// SPDX-License-Identifier: LGPL-2.1-or-later
// Assembly of the solid on the paper's cilium, bent by hand: time for each quadrature point.
#include <benchmark/benchmark.h>
#include <deal.II/base/multithread_info.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fem/solid/discretisation/assembly.h"
#include "fem/solid/solid.h"
#include "meshes/cylinder/cylinder_mesh.h"
#include "tests/bench/paper_cilium.h"

namespace ciliaval::fem::solid {
using namespace material;
using namespace discretisation;
namespace {

/// The coarse mesh (refinement 0), bent into an arc of 1 rad, clamped, with its matrix.
class BentCilium {
 public:
  explicit BentCilium(const Hyperelastic& material) {
    meshes::cylinder::make_cylinder(paper_cilium(), cylinder_mesh_options(0), triangulation_);
    mapping_ = meshes::cylinder::cylinder_mapping(triangulation_, element_degree);
    const std::vector<Hyperelastic> materials(2, material);
    space_ = std::make_unique<SolidSpace>(triangulation_, *mapping_, materials);
    state_ = space_->undeformed();
    bend();
    internal_ = internal_forces(*space_, state_);
    if (!internal_) std::abort();
    const std::array clamped{DirichletCondition{.boundary = meshes::base_id}};
    constraints_ = increment_constraints(*space_, clamped);
    dealii::DynamicSparsityPattern pattern(space_->unknowns());
    dealii::DoFTools::make_sparsity_pattern(space_->dof_handler(), pattern, constraints_, true);
    sparsity_.copy_from(pattern);
    matrix_.reinit(sparsity_);
  }

  const SolidSpace& space() const { return *space_; }
  const SolidState& state() const { return state_; }
  const InternalForces& internal() const { return *internal_; }
  const dealii::AffineConstraints<double>& constraints() const { return constraints_; }
  dealii::SparseMatrix<double>& matrix() { return matrix_; }
  double points() const { return static_cast<double>(space_->elements().size()) * element_points; }

 private:
  void bend() {
    std::vector<dealii::Point<3>> support(space_->unknowns());
    dealii::DoFTools::map_dofs_to_support_points<3, 3>(*mapping_, space_->dof_handler(), support);
    const double kappa = 1 / paper_cilium().length();
    for (const SolidElement& element : space_->elements()) {
      for (std::size_t a = 0; a < element_nodes; ++a) {
        const auto X = support.at(element.dofs[a]);
        const double theta = kappa * X[2];
        state_.displacement[element.dofs[a]] =
            (1 - std::cos(theta)) / kappa + X[0] * std::cos(theta) - X[0];
        state_.displacement[element.dofs[2 * element_nodes + a]] =
            std::sin(theta) / kappa - X[0] * std::sin(theta) - X[2];
      }
    }
    project_pressure(*space_, state_);
  }

  dealii::Triangulation<3> triangulation_;
  std::unique_ptr<dealii::MappingQCache<3>> mapping_;
  std::unique_ptr<SolidSpace> space_;
  SolidState state_;
  std::optional<InternalForces> internal_;
  dealii::AffineConstraints<double> constraints_;
  dealii::SparsityPattern sparsity_;
  dealii::SparseMatrix<double> matrix_;
};

/// Tells the CPU time, or the real time, of an iteration over all cells by quadrature point.
void count_points(benchmark::State& run, double points) {
  run.counters["time/point"] = benchmark::Counter(
      points, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// ∂P/∂F alone.
void tangent(benchmark::State& run, const Hyperelastic& material) {
  Matrix3 F;
  F << 1.1, 0.2, -0.1, 0.05, 0.9, 0.3, -0.2, 0.1, 1.05;
  for (auto _ : run) {
    benchmark::DoNotOptimize(F.data());
    const StressTangent A = stress_tangent(material, F, 0.3);
    benchmark::DoNotOptimize(A.data());
  }
  count_points(run, 1);
}

void forces(benchmark::State& run, const Hyperelastic& material) {
  BentCilium cilium(material);
  for (auto _ : run)
    benchmark::DoNotOptimize(internal_forces(cilium.space(), cilium.state()).has_value());
  count_points(run, cilium.points());
}

/// The element matrices alone, not added to the sparse matrix.
void element_matrices(benchmark::State& run, const Hyperelastic& material) {
  BentCilium cilium(material);
  const auto& elements = cilium.space().elements();
  dealii::FullMatrix<double> matrix(element_dofs, element_dofs);
  for (auto _ : run) {
    for (std::size_t e = 0; e < elements.size(); ++e) {
      element_stiffness(elements[e], cilium.state(), e, cilium.internal().pressure[e], matrix);
      benchmark::DoNotOptimize(&matrix(0, 0));
    }
  }
  count_points(run, cilium.points());
}

void stiffness(benchmark::State& run, const Hyperelastic& material) {
  dealii::MultithreadInfo::set_thread_limit(static_cast<unsigned int>(run.range(0)));
  BentCilium cilium(material);
  for (auto _ : run) {
    cilium.matrix() = 0;
    AssembledTangent tangent(cilium.constraints(), cilium.matrix());
    add_stiffness(cilium.space(), cilium.state(), cilium.internal(), tangent);
  }
  count_points(run, cilium.points());
  dealii::MultithreadInfo::set_thread_limit(1);
}

}  // namespace
}  // namespace ciliaval::fem::solid

int main(int argc, char** argv) {
  using namespace ciliaval::fem;
  using namespace ciliaval::fem::solid;
  using namespace ciliaval::fem::solid::material;
  using namespace ciliaval::fem::solid::solvers;
  dealii::MultithreadInfo::set_thread_limit(1);
  const std::vector<std::pair<std::string, Hyperelastic>> materials{
      {"neo-hooke", Hyperelastic::neo_hooke(1e5, 5e6)},
      {"mooney-rivlin", Hyperelastic::mooney_rivlin(1e5, 5e6, 0.25)},
      {"yeoh", Hyperelastic::yeoh(1e5, 5e6, -0.1, 0.01)}};
  for (const auto& [name, material] : materials) {
    benchmark::RegisterBenchmark(("tangent/" + name).c_str(), tangent, material);
    benchmark::RegisterBenchmark(("forces/" + name).c_str(), forces, material)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(("element_matrices/" + name).c_str(), element_matrices, material)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(("stiffness/" + name).c_str(), stiffness, material)
        ->ArgName("threads")
        ->Arg(1)
        ->Arg(2)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
}

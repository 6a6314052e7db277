// SPDX-License-Identifier: LGPL-2.1-or-later
// Which element? The paper's cilium under the dead force of a `section` load, discretised with
// displacement elements and with elements that have a discontinuous pressure, on the solid's
// sequence of half meshes: error of the tip, unknowns, Newton iterations, processor time. One plain
// assembly for all of them, written apart from the solid's own, whose Q2–P1 it must repeat.
//   OPENBLAS_NUM_THREADS=1 build/release/tests/bench/element_study [refinement of the reference
//   [element]]
#include <deal.II/base/multithread_info.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/numerics/vector_tools.h>

#include <Eigen/LU>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "fem/beam/beam.h"
#include "fem/parallel.h"
#include "fem/solid/discretisation/space.h"
#include "fem/solid/equilibrium/initial_guess.h"
#include "fem/solid/material/hyperelastic.h"
#include "fem/solid/solid.h"
#include "fem/solid/solvers/direct_solver.h"
#include "meshes/cylinder/cylinder_mesh.h"
#include "problem/error.h"
#include "tests/bench/paper_cilium.h"

namespace ciliaval::fem::solid {
using namespace material;
using namespace discretisation;
using namespace solvers;
using namespace equilibrium;
namespace {

using dealii::types::global_dof_index;

constexpr SectionLoad load{.force = 2e-3, .arclength = 16e-3, .azimuth = 0};

/// Displacement in Q_degree; pressure in the complete polynomials of pressure_degree,
/// discontinuous, or none of its own (−1).
struct Element {
  std::string name;
  int degree;
  int pressure_degree;
};
const std::vector<Element> elements{
    {"Q2", 2, -1}, {"Q3", 3, -1}, {"Q2-P0", 2, 0}, {"Q2-P1", 2, 1}, {"Q3-P2", 3, 2}};

/// Monomials of the local coordinates x up to a degree.
Eigen::VectorXd monomials(const Vector3& x, int degree) {
  std::vector<double> values;
  for (int i = 0; i <= degree; ++i)
    for (int j = 0; i + j <= degree; ++j)
      for (int k = 0; i + j + k <= degree; ++k)
        values.push_back(std::pow(x[0], i) * std::pow(x[1], j) * std::pow(x[2], k));
  return Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

struct CellPressure {
  Vector3 centre = Vector3::Zero();  // m
  double size = 1;
  Eigen::VectorXd coefficients;  // Pa
  Eigen::MatrixXd gradient;      // ∂R_p/∂u
  Eigen::MatrixXd inverse_compliance;
  Eigen::VectorXd correction;  // C⁻¹ R_p
};

struct Outcome {
  std::size_t unknowns = 0;
  double deflection = 0;  // m
  int iterations = 0;
  int steps = 1;
  double seconds = 0;
  std::string trouble;
};

double processor_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

class Study {
 public:
  Study(const Element& element, double poisson_ratio,
        const meshes::cylinder::CylinderMeshOptions& mesh)
      : kind_(element),
        cilium_(paper_cilium(poisson_ratio)),
        element_(dealii::FE_Q<3>(static_cast<unsigned int>(element.degree)), 3),
        quadrature_(static_cast<unsigned int>(element.degree) + 1) {
    for (const Segment& segment : cilium_.segments)
      materials_.push_back(
          Hyperelastic::neo_hooke(segment.shear_modulus(), segment.bulk_modulus()));
    meshes::cylinder::make_cylinder(cilium_, mesh, triangulation_);
    mapping_ = meshes::cylinder::cylinder_mapping(triangulation_,
                                                  static_cast<unsigned int>(element.degree));
    dof_handler_.reinit(triangulation_);
    dof_handler_.distribute_dofs(element_);
    const dealii::Functions::ZeroFunction<3> zero(3);
    dealii::VectorTools::interpolate_boundary_values(*mapping_, dof_handler_, meshes::base_id, zero,
                                                     constraints_);
    dealii::VectorTools::interpolate_boundary_values(*mapping_, dof_handler_, meshes::symmetry_id,
                                                     zero, constraints_,
                                                     dealii::ComponentMask({false, true, false}));
    constraints_.close();
    dealii::DynamicSparsityPattern pattern(dof_handler_.n_dofs());
    dealii::DoFTools::make_sparsity_pattern(dof_handler_, pattern, constraints_, true);
    sparsity_.copy_from(pattern);
    matrix_.reinit(sparsity_);
    forces_ = section_integrals(load.arclength);
    forces_ *= load.force / 2;  // on the half
  }

  /// The whole load at once from the rod_guess beam; if that fails, in more and more equal steps
  /// from the straight cilium. The iterations and seconds are those of the attempt that succeeds.
  Outcome solve(int max_steps) {
    Outcome outcome;
    for (const int steps : {1, 8, 32}) {
      if (steps > max_steps) break;
      const double start = processor_seconds();
      outcome = {};
      outcome.steps = steps;
      start_from_beam();
      if (steps > 1) displacement_ = 0;
      if (steps > 1)
        for (CellPressure& pressure : pressures_) pressure.coefficients.setZero();
      DirectSolver solver(sparsity_, DirectSolver::Kind::general, {0, matrix_.m()}, MPI_COMM_SELF);
      for (int step = 1; step <= steps && outcome.trouble.empty(); ++step)
        newton(solver, static_cast<double>(step) / steps, outcome);
      outcome.seconds = processor_seconds() - start;
      if (outcome.trouble.empty()) break;
    }
    outcome.unknowns = dof_handler_.n_dofs();
    outcome.deflection = section_integrals(cilium_.length()) * displacement_;
    return outcome;
  }

 private:
  /// Equilibrium with a part of the load.
  void newton(DirectSolver& solver, double part, Outcome& outcome) {
    constexpr int max_iterations = 15;
    constexpr double tolerance = 1e-9;
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
      Vector residual(forces_);
      residual *= part;
      if (!assemble(residual)) {
        outcome.trouble = "det F <= 0";
        return;
      }
      constraints_.set_zero(residual);
      solver.factorize(matrix_);
      ++outcome.iterations;
      Vector increment;
      solver.solve(residual, increment);
      constraints_.distribute(increment);
      advance(increment);
      if (increment.linfty_norm() <= tolerance * displacement_.linfty_norm()) return;
    }
    outcome.trouble = "no convergence";
  }

  /// ∫ N_a dA / A of the x components over the plane Z = S.
  Vector section_integrals(double S) {
    const dealii::QGauss<2> quadrature(quadrature_.size() > 27 ? 4 : 3);
    dealii::FEFaceValues<3> values(*mapping_, element_, quadrature,
                                   dealii::update_values | dealii::update_JxW_values);
    Vector result(dof_handler_.n_dofs());
    std::vector<global_dof_index> dofs(element_.n_dofs_per_cell());
    double area = 0;
    for (const auto& cell : dof_handler_.active_cell_iterators()) {
      constexpr unsigned int upper = 5;  // the face ζ = 1
      if (std::abs(cell->face(upper)->center()[2] - S) > 1e-9 * cilium_.length()) continue;
      values.reinit(cell, upper);
      cell->get_dof_indices(dofs);
      for (unsigned int q = 0; q < quadrature.size(); ++q) {
        area += values.JxW(q);
        for (unsigned int i = 0; i < dofs.size(); ++i)
          if (element_.system_to_component_index(i).first == 0)
            result[dofs[i]] += values.shape_value(i, q) * values.JxW(q);
      }
    }
    result /= area;
    return result;
  }

  /// Displacement and pressure of the rod, rod_guess as the solid's first guess.
  void start_from_beam() {
    const MechanicsResult beam = fem::beam::Beam().solve(cilium_, {load});
    const SolidSpace space(triangulation_, *quadratic_mapping(), materials_);
    SolidState state = rod_guess(beam.steps.front().deformation->centreline, cilium_, space);
    displacement_.reinit(dof_handler_.n_dofs());
    dealii::FETools::interpolate(space.dof_handler(), state.displacement, dof_handler_,
                                 displacement_);
    constraints_.distribute(displacement_);
    pressures_.assign(triangulation_.n_active_cells(), {});
    dealii::FEValues<3> values(*mapping_, element_, quadrature_,
                               dealii::update_quadrature_points | dealii::update_JxW_values);
    for (const auto& cell : dof_handler_.active_cell_iterators()) {
      CellPressure& pressure = pressures_[cell->active_cell_index()];
      const auto centre = cell->center();
      pressure.centre = Vector3(centre[0], centre[1], centre[2]);
      pressure.size = cell->diameter() / 2;
      if (kind_.pressure_degree < 0) continue;
      values.reinit(cell);
      const std::size_t e = cell->active_cell_index();
      const SolidElement& quadratic = space.elements()[e];
      const double K = materials_[cell->material_id()].bulk_modulus;
      Eigen::MatrixXd mass;
      Eigen::VectorXd moment;
      for (unsigned int q = 0; q < quadrature_.size(); ++q) {
        const auto& point = values.quadrature_point(q);
        const Vector3 X(point[0], point[1], point[2]);
        const Eigen::VectorXd psi = basis(pressure, X);
        if (q == 0) {
          mass = Eigen::MatrixXd::Zero(psi.size(), psi.size());
          moment = Eigen::VectorXd::Zero(psi.size());
        }
        mass += values.JxW(q) * psi * psi.transpose();
        moment += values.JxW(q) * quadratic.pressure_basis(X).dot(state.pressure[e]) * psi;
      }
      const Eigen::MatrixXd inverse = mass.inverse();
      pressure.coefficients = inverse * moment;
      pressure.inverse_compliance = K * inverse;
    }
  }

  const dealii::Mapping<3>* quadratic_mapping() {
    if (kind_.degree == element_degree) return mapping_.get();
    if (!quadratic_mapping_)
      quadratic_mapping_ = meshes::cylinder::cylinder_mapping(triangulation_, element_degree);
    return quadratic_mapping_.get();
  }

  Eigen::VectorXd basis(const CellPressure& pressure, const Vector3& X) const {
    return monomials((X - pressure.centre) / pressure.size, kind_.pressure_degree);
  }

  /// Tangent into matrix_; internal forces off the residual. False if det F ≤ 0 somewhere.
  bool assemble(Vector& residual) {
    matrix_ = 0;
    dealii::FEValues<3> values(
        *mapping_, element_, quadrature_,
        dealii::update_gradients | dealii::update_quadrature_points | dealii::update_JxW_values);
    const auto n = static_cast<Eigen::Index>(element_.n_dofs_per_cell());
    std::vector<global_dof_index> dofs(element_.n_dofs_per_cell());
    dealii::FullMatrix<double> share(element_.n_dofs_per_cell());
    Vector internal(element_.n_dofs_per_cell());
    for (const auto& cell : dof_handler_.active_cell_iterators()) {
      values.reinit(cell);
      cell->get_dof_indices(dofs);
      Eigen::VectorXd u(n);
      for (Eigen::Index i = 0; i < n; ++i) u[i] = displacement_[dofs[static_cast<std::size_t>(i)]];
      Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(n, n);
      Eigen::VectorXd forces = Eigen::VectorXd::Zero(n);
      if (!add_cell(values, materials_[cell->material_id()], u,
                    pressures_[cell->active_cell_index()], stiffness, forces))
        return false;
      for (Eigen::Index i = 0; i < n; ++i) {
        internal[static_cast<unsigned int>(i)] = -forces[i];
        for (Eigen::Index j = 0; j < n; ++j)
          share(static_cast<unsigned int>(i), static_cast<unsigned int>(j)) = stiffness(i, j);
      }
      constraints_.distribute_local_to_global(share, dofs, matrix_);
      constraints_.distribute_local_to_global(internal, dofs, residual);
    }
    return true;
  }

  bool add_cell(const dealii::FEValues<3>& values, const Hyperelastic& material,
                const Eigen::VectorXd& u, CellPressure& pressure, Eigen::MatrixXd& stiffness,
                Eigen::VectorXd& forces) const {
    const bool mixed = kind_.pressure_degree >= 0;
    const auto n = u.size();
    const double K = material.bulk_modulus;
    Eigen::VectorXd residual;
    if (mixed) {
      pressure.gradient = Eigen::MatrixXd::Zero(pressure.coefficients.size(), n);
      residual = Eigen::VectorXd::Zero(pressure.coefficients.size());
    }
    Eigen::MatrixXd D(9, n);  // δF = D δu, rows 3i + J
    for (unsigned int q = 0; q < quadrature_.size(); ++q) {
      D.setZero();
      for (Eigen::Index i = 0; i < n; ++i) {
        const auto component =
            element_.system_to_component_index(static_cast<unsigned int>(i)).first;
        const auto gradient =
            values.shape_grad_component(static_cast<unsigned int>(i), q, component);
        for (unsigned int J = 0; J < 3; ++J)
          D(static_cast<Eigen::Index>(3 * component + J), i) = gradient[J];
      }
      const Eigen::Matrix<double, 9, 1> f = D * u;
      const Matrix3 F = Matrix3::Identity() +
                        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(f.data());
      const double J = F.determinant();
      if (!(J > 0)) return false;
      const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> cofactor = J * F.inverse().transpose();
      const Eigen::Map<const Eigen::Matrix<double, 9, 1>> cof(cofactor.data());
      const double weight = values.JxW(q);
      const auto& point = values.quadrature_point(q);
      Eigen::VectorXd psi;
      double p = K * (J - 1);
      if (mixed) {
        psi = basis(pressure, Vector3(point[0], point[1], point[2]));
        p = psi.dot(pressure.coefficients);
        residual += weight * (J - 1 - p / K) * psi;
        pressure.gradient += weight * psi * (cof.transpose() * D);
      }
      StressTangent tangent = stress_tangent(material, F, p);
      if (!mixed) tangent += K * cof * cof.transpose();
      const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> P = first_piola_stress(material, F, p);
      forces += weight * D.transpose() * Eigen::Map<const Eigen::Matrix<double, 9, 1>>(P.data());
      stiffness.noalias() += D.transpose() * (weight * tangent * D);
    }
    if (mixed) {
      pressure.correction = pressure.inverse_compliance * residual;
      forces += pressure.gradient.transpose() * pressure.correction;
      stiffness += pressure.gradient.transpose() * pressure.inverse_compliance * pressure.gradient;
    }
    return true;
  }

  void advance(const Vector& increment) {
    std::vector<global_dof_index> dofs(element_.n_dofs_per_cell());
    if (kind_.pressure_degree >= 0)
      for (const auto& cell : dof_handler_.active_cell_iterators()) {
        cell->get_dof_indices(dofs);
        Eigen::VectorXd du(static_cast<Eigen::Index>(dofs.size()));
        for (std::size_t i = 0; i < dofs.size(); ++i)
          du[static_cast<Eigen::Index>(i)] = increment[dofs[i]];
        CellPressure& pressure = pressures_[cell->active_cell_index()];
        pressure.coefficients +=
            pressure.correction + pressure.inverse_compliance * (pressure.gradient * du);
      }
    displacement_ += increment;
  }

  Element kind_;
  Cilium cilium_;
  std::vector<Hyperelastic> materials_;
  dealii::FESystem<3> element_;
  dealii::QGauss<3> quadrature_;
  dealii::Triangulation<3> triangulation_;
  std::unique_ptr<dealii::MappingQCache<3>> mapping_;
  std::unique_ptr<dealii::MappingQCache<3>> quadratic_mapping_;
  dealii::DoFHandler<3> dof_handler_;
  dealii::AffineConstraints<double> constraints_;
  dealii::SparsityPattern sparsity_;
  dealii::SparseMatrix<double> matrix_;
  Vector forces_;
  Vector displacement_;
  std::vector<CellPressure> pressures_;
};

meshes::cylinder::CylinderMeshOptions mesh(const Element& element, unsigned int level) {
  meshes::cylinder::CylinderMeshOptions options = level_mesh(level);
  options.half = true;
  options.planes = {load.arclength};
  // Quadratic cells have the exact area with their nodes slightly outside R, cubic ones on it.
  options.equal_area = element.degree == element_degree;
  return options;
}

double solid_deflection(double poisson_ratio, unsigned int refinement) {
  SolidOptions options;
  options.refinement = refinement;
  options.solver = SolverKind::direct;
  const MechanicsResult result = Solid(options).solve(paper_cilium(poisson_ratio), {load});
  const MechanicsStep& step = result.steps.front();
  if (!step.deformation) throw SolverError(step.message);
  const Centreline& line = step.deformation->centreline;
  return line.at(line.length()).position.x();
}

void study(double poisson_ratio, unsigned int finest, const std::string& only) {
  const double converged = solid_deflection(poisson_ratio, finest);
  const double coarse = solid_deflection(poisson_ratio, 0);
  std::printf("nu = %g: converged %.6f mm (the solid at refinement %u); its refinement 0 %.9f mm\n",
              poisson_ratio, 1e3 * converged, finest, 1e3 * coarse);
  std::printf("%-6s %5s %9s %13s %9s %5s %5s %8s\n", "", "level", "unknowns", "tip mm", "error %",
              "steps", "iter", "cpu s");
  for (const Element& element : elements) {
    if (!only.empty() && element.name != only) continue;
    for (unsigned int level = 0; level < (finest == 0           ? 2U
                                          : element.degree == 2 ? 4U
                                                                : 3U);
         ++level) {
      const Outcome outcome =
          Study(element, poisson_ratio, mesh(element, level)).solve(level < 2 ? 32 : 1);
      std::printf("%-6s %5u %9zu %13.9f %9.3f %5d %5d %8.2f %s\n", element.name.c_str(), level,
                  outcome.unknowns, 1e3 * outcome.deflection,
                  100 * (outcome.deflection / converged - 1), outcome.steps, outcome.iterations,
                  outcome.seconds, outcome.trouble.c_str());
      std::fflush(stdout);
      // Both are solved to 1e-9.
      if (element.name == "Q2-P1" && level == mesh_level(0) &&
          !(std::abs(outcome.deflection / coarse - 1) < 1e-8))
        throw std::runtime_error("Q2-P1 does not repeat the solid's tip");
    }
  }
}

}  // namespace
}  // namespace ciliaval::fem::solid

int main(int argc, char** argv) {
  using namespace ciliaval;
  try {
    fem::start_mpi();
    dealii::MultithreadInfo::set_thread_limit(1);
    // Refinement of the reference. With 0 (ctest) the two coarsest meshes at one ratio; the second
    // is the solid's refinement 0.
    const unsigned int finest = argc > 1 ? static_cast<unsigned int>(std::stoul(argv[1])) : 3;
    const std::vector<double> ratios =
        finest == 0 ? std::vector<double>{0.49} : std::vector<double>{0.3, 0.49, 0.499, 0.4999};
    for (const double poisson_ratio : ratios)
      fem::solid::study(poisson_ratio, finest, argc > 2 ? argv[2] : "");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "element_study: %s\n", error.what());
    return 1;
  }
}

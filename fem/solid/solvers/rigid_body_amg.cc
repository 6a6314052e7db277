// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/solvers/rigid_body_amg.h"

#include <deal.II/base/mpi.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>

#include <Epetra_MultiVector.h>
#include <Teuchos_ParameterList.hpp>
#include <algorithm>
#include <exception>
#include <memory>
#include <string>

#include "fem/parallel.h"
#include "problem/error.h"

namespace ciliaval::fem::solid::solvers {
using namespace discretisation;
namespace {

// Measured: docs/measurements.md.
constexpr unsigned int iterations = 8;
constexpr double reduction = 1e-3;      ///< of the residual, that ends them before
constexpr int amg_smoother_degree = 2;  ///< of Chebyshev's polynomials

constexpr std::size_t motion_count = 6;

}  // namespace

RigidBodyAmg::RigidBodyAmg(const dealii::IndexSet& own, std::span<const Vector3> positions,
                           const std::vector<bool>& fixed, MPI_Comm communicator)
    : motions_(motion_count * own.n_elements()) {
  // In the body's own length, so that all six are of one size.
  double size = 0;
  for (const Vector3& X : positions) size = std::max(size, X.norm());
  size = dealii::Utilities::MPI::max(size, communicator);
  const std::size_t rows = own.n_elements();
  for (std::size_t node = 0; node < positions.size(); ++node) {
    const Vector3 x = positions[node] / size;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Vector3 turned = Vector3::Unit(k).cross(x);
      for (Eigen::Index component = 0; component < 3; ++component) {
        const std::size_t row = 3 * node + static_cast<std::size_t>(component);
        if (fixed[row]) continue;
        motions_[static_cast<std::size_t>(k) * rows + row] = component == k ? 1 : 0;
        motions_[static_cast<std::size_t>(k + 3) * rows + row] = turned[component];
      }
    }
  }
}

void RigidBodyAmg::update() {
  dealii::TrilinosWrappers::PreconditionAMG::AdditionalData options;
  options.elliptic = true;
  options.smoother_sweeps = amg_smoother_degree;
  options.aggregation_threshold = 0;  // of near-incompressible material no coupling is weak
  Teuchos::ParameterList list;
  std::unique_ptr<Epetra_MultiVector> unused;
  options.set_parameters(list, unused, matrix_);
  list.set("PDE equations", 3);
  list.set("null space: type", "pre-computed");
  list.set("null space: dimension", static_cast<int>(motion_count));
  list.set("null space: vectors", motions_.data());
  std::string trouble;
  try {
    amg_.initialize(matrix_, list);
  } catch (const std::exception& error) {
    trouble = error.what();
  }
  trouble = first_text(matrix_.get_mpi_communicator(), trouble);
  if (!trouble.empty()) throw SolverError("the solid's multigrid cannot be set up: " + trouble);
}

void RigidBodyAmg::vmult(Vector& x, const Vector& b) const {
  dealii::IterationNumberControl control(iterations, reduction * b.l2_norm());
  dealii::SolverCG<Vector> solver(control);
  x = 0.;
  solver.solve(matrix_, x, b, amg_);
}

}  // namespace ciliaval::fem::solid::solvers

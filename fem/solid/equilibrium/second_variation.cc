// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/equilibrium/second_variation.h"

#include <algorithm>

#include "fem/lanczos.h"
#include "fem/solid/solvers/direct_solver.h"

namespace ciliaval::fem::solid::equilibrium {
using namespace discretisation;
namespace {

/// ∫ N_a u dV.
Vector weighed(const SolidSpace& space, const Vector& u) {
  Vector result = space.vector();
  for (const SolidElement& element : space.elements()) {
    const Eigen::Matrix<double, element_nodes, 3> f =
        unit_values() * (element.gauss_points().weights.asDiagonal() *
                         (unit_values().transpose() * nodal_displacements(element, u)));
    for (unsigned int a = 0; a < element_nodes; ++a)
      for (unsigned int c = 0; c < 3; ++c)
        result.local_element(element.dofs[c * element_nodes + a]) += f(a, c);
  }
  return result;
}

Vector to_dealii(const Eigen::VectorXd& v) {
  Vector result(static_cast<dealii::types::global_dof_index>(v.size()));
  std::ranges::copy(v, result.begin());
  return result;
}

Eigen::VectorXd to_eigen(const Vector& v) {
  return Eigen::Map<const Eigen::VectorXd>(v.begin(), static_cast<Eigen::Index>(v.size()));
}

}  // namespace

SecondVariation second_variation(const SolidSpace& space,
                                 const dealii::AffineConstraints<double>& constraints,
                                 const dealii::SparseMatrix<double>& tangent, RowRange rows,
                                 MPI_Comm communicator) {
  using solvers::DirectSolver;
  DirectSolver factors(tangent.get_sparsity_pattern(), DirectSolver::Kind::symmetric_part, rows,
                       communicator);
  factors.factorize(tangent);
  const EigenProblem problem{
      static_cast<Eigen::Index>(space.unknowns()),
      [&](const Eigen::VectorXd& f) {
        Vector free = to_dealii(f);
        Vector u(free.size());
        constraints.set_zero(free);
        factors.solve(free, u);
        return to_eigen(u);
      },
      [&](const Eigen::VectorXd& u) { return to_eigen(weighed(space, to_dealii(u))); }};
  const int negative = factors.negative_eigenvalues();
  return {negative, smallest_eigenpair(problem, negative).value};
}

}  // namespace ciliaval::fem::solid::equilibrium

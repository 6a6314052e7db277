// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/sparse_matrix.h>
#include <mpi.h>

#include "fem/solid/discretisation/row_range.h"
#include "fem/solid/discretisation/space.h"

namespace ciliaval::fem::solid::equilibrium {

/// The second variation of the potential energy at an equilibrium.
struct SecondVariation {
  int unstable_modes = 0;          ///< negative eigenvalues; 0: stable
  double smallest_eigenvalue = 0;  ///< ω, K u = ω W u, uᵀ W u = ∫ |u|² dV, N/m⁴
};

/// Second variation of the energy by the condensed tangent K, of which this rank has the rows
/// `rows`. Where the pressure equation holds, K is the second derivative of the energy by the
/// displacements alone, so its inertia needs no correction for the pressures; each constrained
/// unknown has a positive diagonal entry and no other. The space must be whole on every rank. One
/// factorisation LDLᵀ and some ten solutions. Collective. Throws SolverError if K is singular or
/// the memory does not suffice.
SecondVariation second_variation(const discretisation::SolidSpace& space,
                                 const dealii::AffineConstraints<double>& constraints,
                                 const dealii::SparseMatrix<double>& tangent,
                                 discretisation::RowRange rows, MPI_Comm communicator);

}  // namespace ciliaval::fem::solid::equilibrium

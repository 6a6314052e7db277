// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/lac/la_parallel_vector.h>

namespace ciliaval::fem::solid::discretisation {

/// Values of the unknowns. Each rank owns some, and has room for those of others at its cells: of
/// displacements, those values after update_ghost_values(); of forces on their way, its shares of
/// them until compress(). On a space that is whole on every rank, each of them owns all.
using Vector = dealii::LinearAlgebra::distributed::Vector<double>;

}  // namespace ciliaval::fem::solid::discretisation

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/types.h>
#include <mpi.h>

namespace ciliaval::fem::solid::discretisation {

using Row = dealii::types::global_dof_index;

inline constexpr Row node_unknowns = 3;  ///< of a node, numbered one after the other

/// A contiguous part of a range of rows.
struct RowRange {
  Row begin = 0;
  Row end = 0;
  bool contains(Row index) const { return index >= begin && index < end; }
};

/// This rank's part of 0 … size − 1; the ranks' parts are contiguous, in order and nearly equal,
/// and begin at multiples of three: the unknowns of a node stay together.
RowRange own_range(MPI_Comm communicator, Row size);

}  // namespace ciliaval::fem::solid::discretisation

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/discretisation/tangent_matrix.h"

#include <vector>

namespace ciliaval::fem::solid::discretisation {

void AssembledTangent::add(const dealii::FullMatrix<double>& local, Dofs rows, Dofs columns) {
  using dealii::types::global_dof_index;
  const std::vector<global_dof_index> row_list(rows.begin(), rows.end());
  if (rows.data() == columns.data() && rows.size() == columns.size()) {
    constraints_.distribute_local_to_global(local, row_list, matrix_);
    return;
  }
  const std::vector<global_dof_index> column_list(columns.begin(), columns.end());
  constraints_.distribute_local_to_global(local, row_list, column_list, matrix_);
}

}  // namespace ciliaval::fem::solid::discretisation

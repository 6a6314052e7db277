// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/discretisation/row_range.h"

#include "fem/parallel.h"

namespace ciliaval::fem::solid::discretisation {

RowRange own_range(MPI_Comm communicator, Row size) {
  const int ranks = rank_count(communicator);
  const auto bound = [&](int i) {
    const auto exact = static_cast<Row>(static_cast<long long>(size) * i / ranks);
    return i == ranks ? size : exact - exact % node_unknowns;
  };
  const int own = rank(communicator);
  return {bound(own), bound(own + 1)};
}

}  // namespace ciliaval::fem::solid::discretisation

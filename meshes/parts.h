// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/grid/tria.h>

#include <functional>

namespace ciliaval::meshes {

/// Makes a mesh of which each rank has a part: as many of its cells as each other, those at the
/// base on the first rank, and the cells beside them. One rank of each machine makes the whole mesh
/// and forgets it again. `make` fills an empty triangulation; manifolds are not carried over.
/// Collective. Throws what `make` throws, on the ranks that called it.
void make_in_parts(const std::function<void(dealii::Triangulation<3>&)>& make,
                   dealii::parallel::fullydistributed::Triangulation<3>& parts);

}  // namespace ciliaval::meshes

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/mpi.h>
#include <deal.II/grid/tria.h>

#include <functional>
#include <memory>

namespace ciliaval::meshes {

/// Makes a mesh of which each rank has a part: as many of its cells as each other, those at the
/// base on the first rank, and the cells beside them. One rank of each machine makes the whole mesh
/// and forgets it again, where ranks are numbered machine by machine; a rank alone keeps it. `make`
/// fills an empty triangulation, whose manifolds are not carried over: `attach_manifolds` attaches
/// them to the parts. Collective. Throws what `make` throws, on the ranks that called it.
std::unique_ptr<dealii::Triangulation<3>> make_in_parts(
    const std::function<void(dealii::Triangulation<3>&)>& make, MPI_Comm communicator,
    const std::function<void(dealii::Triangulation<3>&)>& attach_manifolds = [](auto&) {});

}  // namespace ciliaval::meshes

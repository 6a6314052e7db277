// SPDX-License-Identifier: LGPL-2.1-or-later
#include "meshes/parts.h"

#include <deal.II/base/utilities.h>
#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/grid/tria_description.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

namespace ciliaval::meshes {
namespace {

using dealii::Triangulation;

/// Equal numbers of cells to each rank, by height, so that few cells meet those of another rank.
void partition_by_height(Triangulation<3>& mesh, std::size_t ranks) {
  std::vector<std::pair<std::array<double, 2>, Triangulation<3>::active_cell_iterator>> cells;
  for (const auto& cell : mesh.active_cell_iterators())
    cells.push_back({{cell->vertex(0)[2], cell->center()[0]}, cell});
  std::stable_sort(cells.begin(), cells.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < cells.size(); ++i)
    cells[i].second->set_subdomain_id(
        static_cast<dealii::types::subdomain_id>(i * ranks / cells.size()));
}

/// Ranks of the machine that has the most of them, by the machines' names. Where names do not tell
/// machines apart, another number of ranks makes the whole mesh; the parts are the same.
int ranks_of_a_machine(MPI_Comm communicator) {
  const std::string own = dealii::Utilities::System::get_hostname();
  const auto names = dealii::Utilities::MPI::all_gather(communicator, own);
  return dealii::Utilities::MPI::max(static_cast<int>(std::ranges::count(names, own)),
                                     communicator);
}

}  // namespace

std::unique_ptr<Triangulation<3>> make_in_parts(
    const std::function<void(Triangulation<3>&)>& make, MPI_Comm communicator,
    const std::function<void(Triangulation<3>&)>& attach_manifolds) {
  const std::size_t ranks = dealii::Utilities::MPI::job_supports_mpi()  // once it is started
                                ? dealii::Utilities::MPI::n_mpi_processes(communicator)
                                : 1;
  if (ranks == 1) {
    auto whole = std::make_unique<Triangulation<3>>();
    make(*whole);
    return whole;
  }
  auto parts = std::make_unique<dealii::parallel::fullydistributed::Triangulation<3>>(communicator);
  attach_manifolds(*parts);
  using dealii::TriangulationDescription::Utilities::
      create_description_from_triangulation_in_groups;
  parts->create_triangulation(create_description_from_triangulation_in_groups<3, 3>(
      make,
      [ranks](Triangulation<3>& whole, const MPI_Comm&, unsigned int) {
        partition_by_height(whole, ranks);
      },
      communicator, ranks_of_a_machine(communicator)));
  return parts;
}

}  // namespace ciliaval::meshes

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/distributed/tria.h>
#include <mpi.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "problem/types.h"

namespace ciliaval::fem::potential {

/// An axis-aligned cube.
struct Cube {
  Vector3 lower = Vector3::Zero();  ///< m
  double size = 0;                  ///< of an edge, m

  Vector3 centre() const { return lower + Vector3::Constant(size / 2); }
  Eigen::AlignedBox3d box() const { return {lower, lower + Vector3::Constant(size)}; }
};

/// An octree of cubes, spread over the ranks (p4est), with neighbours that differ by at most one
/// level. Every rank has a directory of all leaves, so that a point is located by arithmetic, to
/// the same leaf on all ranks; deal.II's search knows the own and ghost leaves only.
class Octree {
 public:
  using Triangulation = dealii::parallel::distributed::Triangulation<3>;
  using CellIterator = Triangulation::active_cell_iterator;

  /// One cube with faces at centre ± half_width (m).
  Octree(const Vector3& centre, double half_width, MPI_Comm communicator = MPI_COMM_WORLD);

  /// Cuts every own leaf for which `cut` holds into eight. Returns whether any was, on any rank.
  /// Collective.
  bool refine(const std::function<bool(const Cube&)>& cut);
  /// Cuts the own leaves whose flag is set, one for each of cells(). Collective.
  void refine(const std::vector<bool>& flags);

  /// Cuts the own leaves that make up the fraction of the sum of the indicators (one ≥ 0 for each
  /// of cells(), summed over all ranks), the largest first. Collective. deal.II's
  /// refine_and_coarsen_fixed_fraction() stops its bisection early and may stay below the fraction:
  /// it cuts other leaves, which gives other numbers (docs/measurements.md).
  void refine_largest(const std::vector<double>& indicators, double fraction);

  const Triangulation& triangulation() const { return triangulation_; }
  const Cube& root() const { return root_; }
  MPI_Comm communicator() const { return triangulation_.get_communicator(); }

  /// This rank's leaves, in deal.II's order.
  const std::vector<CellIterator>& cells() const { return cells_; }
  const std::vector<Cube>& cubes() const { return cubes_; }

  static constexpr int other_rank = -1;
  static constexpr int outside = -2;
  /// The leaf that holds a point: its index in cells(), and the point's coordinates in [0, 1]³.
  struct Place {
    int cell = outside;
    Vector3 unit = Vector3::Zero();
  };
  /// The search begins with leaves of the size `smallest` (m): no smaller one may hold the point.
  Place locate(const Vector3& point, double smallest) const;

  /// Edge of the smallest leaf that meets the box, m; 0 if none does.
  double smallest_size(const Eigen::AlignedBox3d& box) const;
  /// True if any own leaf meets the box.
  bool meets_own(const Eigen::AlignedBox3d& box) const;
  /// Calls the function with the index of every own leaf that meets the box.
  void for_each_in(const Eigen::AlignedBox3d& box, const std::function<void(int)>& act) const;

 private:
  using Key = std::uint64_t;
  struct Node {
    int level = 0;
    std::uint64_t i = 0, j = 0, k = 0;
  };
  static Key key(const Node& node);
  Cube cube(const Node& node) const;
  Node node_of(const Cube& cube) const;
  template <typename Act>
  void descend(const Node& node, const Eigen::AlignedBox3d& box, const Act& act) const;
  void update();

  Cube root_;
  Triangulation triangulation_;
  std::vector<CellIterator> cells_;
  std::vector<Cube> cubes_;
  std::unordered_map<Key, int> directory_;  ///< every leaf: its index in cells(), or other_rank
};

}  // namespace ciliaval::fem::potential

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/potential/octree.h"

#include <deal.II/base/mpi.h>
#include <deal.II/grid/grid_generator.h>
#include <p4est_base.h>
#include <sc.h>

#include <algorithm>
#include <cmath>

#include "fem/parallel.h"
#include "problem/error.h"

namespace ciliaval::fem::potential {
namespace {

constexpr int finest_level = 19;  ///< three indices of 19 bits and the level fill a key

/// p4est's own state; without it, p4est writes to the console.
MPI_Comm start_p4est(MPI_Comm communicator) {
  start_mpi();
  if (sc_package_id < 0) {
    sc_init(MPI_COMM_WORLD, 0, 0, nullptr, SC_LP_SILENT);
    p4est_init(nullptr, SC_LP_SILENT);
  }
  return communicator;
}

dealii::Point<3> to_point(const Vector3& x) {
  return {x[0], x[1], x[2]};
}

}  // namespace

Octree::Octree(const Vector3& centre, double half_width, MPI_Comm communicator)
    : root_{centre - Vector3::Constant(half_width), 2 * half_width},
      triangulation_(start_p4est(communicator), Triangulation::none) {
  if (!centre.allFinite() || !(half_width > 0) || !std::isfinite(half_width))
    throw InputError("the octree needs a finite centre and a positive half-width");
  dealii::GridGenerator::hyper_rectangle(triangulation_, to_point(root_.lower),
                                         to_point(root_.lower + Vector3::Constant(root_.size)));
  update();
}

Octree::Key Octree::key(const Node& node) {
  return (static_cast<Key>(node.level) << 57) | (node.i << 38) | (node.j << 19) | node.k;
}

Cube Octree::cube(const Node& node) const {
  const double size = std::ldexp(root_.size, -node.level);
  return {root_.lower + size * Vector3(static_cast<double>(node.i), static_cast<double>(node.j),
                                       static_cast<double>(node.k)),
          size};
}

Octree::Node Octree::node_of(const Cube& leaf) const {
  Node node;
  node.level = static_cast<int>(std::lround(std::log2(root_.size / leaf.size)));
  const Vector3 part = (leaf.centre() - root_.lower) / leaf.size;
  node.i = static_cast<std::uint64_t>(part[0]);
  node.j = static_cast<std::uint64_t>(part[1]);
  node.k = static_cast<std::uint64_t>(part[2]);
  return node;
}

void Octree::update() {
  cells_.clear();
  cubes_.clear();
  directory_.clear();
  std::vector<Key> own;
  for (const CellIterator& cell : triangulation_.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    const dealii::Point<3> v = cell->vertex(0);
    const double size = std::ldexp(root_.size, -cell->level());
    const Node node = node_of({Vector3(v[0], v[1], v[2]), size});
    cells_.push_back(cell);
    cubes_.push_back(cube(node));
    own.push_back(key(node));
  }
  for (std::size_t c = 0; c < own.size(); ++c) directory_.emplace(own[c], static_cast<int>(c));
  if (rank_count(communicator()) == 1) return;
  for (const std::vector<Key>& keys : dealii::Utilities::MPI::all_gather(communicator(), own))
    for (const Key k : keys) directory_.emplace(k, other_rank);  // leaves the own as they are
}

bool Octree::refine(const std::function<bool(const Cube&)>& cut) {
  std::vector<bool> flags;
  for (const Cube& leaf : cubes_) flags.push_back(cut(leaf));
  const int any = std::find(flags.begin(), flags.end(), true) != flags.end() ? 1 : 0;
  if (dealii::Utilities::MPI::max(any, communicator()) == 0) return false;
  refine(flags);
  return true;
}

void Octree::refine(const std::vector<bool>& flags) {
  int is_too_deep = 0;
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    if (!flags[c]) continue;
    if (cells_[c]->level() >= finest_level - 1) is_too_deep = 1;
    cells_[c]->set_refine_flag();
  }
  // One rank has the deepest leaf, and all of them must know before they refine.
  if (dealii::Utilities::MPI::max(is_too_deep, communicator()) != 0)
    throw SolverError("the octree of the potential would need more than 18 levels");
  triangulation_.execute_coarsening_and_refinement();
  update();
}

void Octree::refine_largest(const std::vector<double>& indicators, double fraction) {
  const auto sum_above = [&](double threshold) {
    double sum = 0;
    for (const double value : indicators)
      if (value > threshold) sum += value;
    return dealii::Utilities::MPI::sum(sum, communicator());
  };
  const double total = sum_above(0);
  // The largest threshold that leaves the fraction above it, by bisection of its logarithm.
  double lower = total * 1e-12;
  double upper = total;
  for (int step = 0; step < 60; ++step) {
    const double middle = std::sqrt(lower * upper);
    (sum_above(middle) >= fraction * total ? lower : upper) = middle;
  }
  std::vector<bool> flags;
  flags.reserve(indicators.size());
  for (const double value : indicators) flags.push_back(value > lower);
  refine(flags);
}

Octree::Place Octree::locate(const Vector3& point, double smallest) const {
  Place place;
  const Vector3 part = (point - root_.lower) / root_.size;
  if (!(part.minCoeff() >= 0 && part.maxCoeff() < 1)) return place;
  for (auto level = static_cast<int>(std::lround(std::log2(root_.size / smallest))); level >= 0;
       --level) {
    const Vector3 scaled(std::ldexp(part[0], level), std::ldexp(part[1], level),
                         std::ldexp(part[2], level));
    const Node node{level, static_cast<std::uint64_t>(scaled[0]),
                    static_cast<std::uint64_t>(scaled[1]), static_cast<std::uint64_t>(scaled[2])};
    const auto leaf = directory_.find(key(node));
    if (leaf == directory_.end()) continue;
    place.cell = leaf->second;
    place.unit = scaled - Vector3(static_cast<double>(node.i), static_cast<double>(node.j),
                                  static_cast<double>(node.k));
    return place;
  }
  return place;
}

template <typename Act>
void Octree::descend(const Node& node, const Eigen::AlignedBox3d& box, const Act& act) const {
  if (node.level > finest_level || !cube(node).box().intersects(box)) return;
  const auto leaf = directory_.find(key(node));
  if (leaf != directory_.end()) {
    act(leaf->second, cube(node).size);
    return;
  }
  for (std::uint64_t child = 0; child < 8; ++child)
    descend(Node{node.level + 1, 2 * node.i + (child & 1U), 2 * node.j + ((child >> 1U) & 1U),
                 2 * node.k + (child >> 2U)},
            box, act);
}

double Octree::smallest_size(const Eigen::AlignedBox3d& box) const {
  double smallest = 0;
  descend(Node{}, box,
          [&](int, double size) { smallest = smallest == 0 ? size : std::min(smallest, size); });
  return smallest;
}

bool Octree::meets_own(const Eigen::AlignedBox3d& box) const {
  if (rank_count(communicator()) == 1) return root_.box().intersects(box);
  bool any = false;
  descend(Node{}, box, [&](int cell, double) { any = any || cell != other_rank; });
  return any;
}

void Octree::for_each_in(const Eigen::AlignedBox3d& box,
                         const std::function<void(int)>& act) const {
  descend(Node{}, box, [&](int cell, double) {
    if (cell != other_rank) act(cell);
  });
}

}  // namespace ciliaval::fem::potential

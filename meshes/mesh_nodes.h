// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/point.h>

#include <array>
#include <cstddef>
#include <vector>

// By name alone: who only writes a mesh need not compile deal.II's headers.
namespace dealii {
template <int dim, int spacedim>
class Triangulation;
template <int dim, int spacedim>
class Mapping;
}  // namespace dealii

namespace ciliaval::meshes {

/// A mesh as plain data of second order, for files: every node once, cells and boundary faces by
/// their nodes.
struct MeshNodes {
  struct Cell {
    std::array<std::size_t, 27> nodes;  ///< lexicographic: first local coordinate fastest
    unsigned int material = 0;
  };
  struct Face {
    std::array<std::size_t, 9> nodes;  ///< lexicographic, the normal outwards
    unsigned int boundary = 0;
  };
  std::vector<dealii::Point<3>> nodes;  ///< m
  std::vector<Cell> cells;              ///< in the order of the triangulation
  std::vector<Face> faces;
};

/// The active cells and boundary faces of a mesh, its curved geometry taken at the nodes of
/// quadratic elements: exact for a mapping of degree 2 or less.
MeshNodes mesh_nodes(const dealii::Triangulation<3, 3>& triangulation,
                     const dealii::Mapping<3, 3>& mapping);

}  // namespace ciliaval::meshes

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/point.h>

#include <array>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "meshes/gmsh/gmsh_names.h"

namespace ciliaval::meshes::gmsh {

/// A mesh taken apart into its section and its layers: every cell is a quadrilateral of the section
/// between two neighbouring planes Z = const. A vertex is a column (a point of the section) in a
/// plane.
struct Extrusion {
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  struct Cell {
    std::size_t quad = 0;
    std::size_t layer = 0;           ///< between planes layer and layer + 1
    std::vector<std::size_t> nodes;  ///< of the file, lexicographic, ζ up, positive Jacobian
  };
  using Quad = std::array<std::size_t, 4>;           ///< columns, lexicographic
  using Edge = std::pair<std::size_t, std::size_t>;  ///< columns, the smaller first

  std::vector<double> planes;             ///< Z, ascending; at interfaces exactly there, m
  std::vector<dealii::Point<2>> columns;  ///< (X, Y), m
  std::vector<Quad> quads;
  std::vector<Cell> cells;              ///< in the order of the file's hexahedra
  std::vector<std::size_t> vertices;    ///< of the file's nodes: column + planes' index · columns;
                                        ///< `none` if it is no corner of a cell
  std::map<Quad, std::size_t> quad_of;  ///< index of a quadrilateral by its sorted columns
  std::vector<std::vector<std::size_t>> cell_of;  ///< cell by layer and quadrilateral

  std::size_t column(std::size_t vertex) const { return vertex % columns.size(); }
  std::size_t plane(std::size_t vertex) const { return vertex / columns.size(); }
};

inline Extrusion::Edge edge(std::size_t a, std::size_t b) {
  return a < b ? Extrusion::Edge(a, b) : Extrusion::Edge(b, a);
}

/// The edges of a quadrilateral, counter-clockwise.
inline std::array<Extrusion::Edge, 4> edges_of(const Extrusion::Quad& quad) {
  return {{{quad[0], quad[1]}, {quad[1], quad[3]}, {quad[3], quad[2]}, {quad[2], quad[0]}}};
}

/// Finds planes, columns and layers and turns the cells upright; mirrored ones get a remark. Throws
/// InputError if the mesh does not stand on Z = 0, is not as high as the cilium, is not extruded
/// (the faulty cell is told), has coincident nodes, collapsed, double or missing cells, or if a
/// physical volume does not span its segment.
Extrusion find_extrusion(UserMesh& mesh);

}  // namespace ciliaval::meshes::gmsh

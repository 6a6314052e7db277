// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <set>

#include "meshes/gmsh/gmsh_extrusion.h"

namespace ciliaval::meshes::gmsh {

/// The curved section of an extruded mesh: nine nodes on each quadrilateral.
struct Section {
  std::set<Extrusion::Edge> mantle;                     ///< the edges on the circle
  std::map<Extrusion::Edge, dealii::Point<2>> middles;  ///< nodes of the edges, m
  std::vector<dealii::Point<2>> centres;                ///< nodes of the quadrilaterals, m

  /// The nodes of a quadrilateral, lexicographic, m; `quad` may be any turn of the index's.
  std::array<dealii::Point<2>, 9> nodes(const Extrusion& extrusion, std::size_t index,
                                        const Extrusion::Quad& quad) const;
};

/// Checks the section (in one piece, without holes, overlaps and hanging nodes, its rim on the
/// cilium's circle, its area πR² within 2 %, its cells well shaped) and finds its curved nodes. Of
/// a second-order mesh they are the file's, X and Y of the lowest layer in all the others; in a
/// first-order mesh the rim is curved to a circle whose quadratic arcs enclose πR² exactly (as
/// `equal_area` of the built-in mesh), and moves its columns there. Throws InputError; remarks on
/// an area off by 1e-4 and on poor cells.
Section make_section(UserMesh& mesh, Extrusion& extrusion);

/// Checks that the physical surfaces `base`, `mantle` and `tip` are exactly the boundary faces on Z
/// = 0, on the mantle and on Z = L. Throws InputError at the first face that is elsewhere, belongs
/// to no cell, or is missing.
void check_boundaries(UserMesh& mesh, const Extrusion& extrusion, const Section& section);

}  // namespace ciliaval::meshes::gmsh

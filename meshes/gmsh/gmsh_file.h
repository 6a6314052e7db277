// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/point.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace ciliaval::meshes::gmsh {

/// A hexahedron or quadrilateral of a Gmsh file.
struct GmshElement {
  std::size_t tag = 0;             ///< its number in the file
  int entity = 0;                  ///< the volume or surface that it belongs to
  std::vector<std::size_t> nodes;  ///< indices of its 2ᵈ or 3ᵈ nodes, lexicographic: first local
                                   ///< coordinate fastest

  template <typename Archive>
  void serialize(Archive& archive, unsigned int /*version*/) {
    archive& tag& entity& nodes;
  }
};

/// A physical group: entities under a name.
struct GmshGroup {
  int dimension = 0;
  int tag = 0;
  std::string name;  ///< may be empty
  std::vector<int> entities;

  template <typename Archive>
  void serialize(Archive& archive, unsigned int /*version*/) {
    archive& dimension& tag& name& entities;
  }
};

/// The used content of a Gmsh file.
struct GmshFile {
  std::vector<std::size_t> node_tags;   ///< numbers of the nodes in the file
  std::vector<dealii::Point<3>> nodes;  ///< in the file's unit
  bool quadratic = false;               ///< 27 and 9 nodes in each element, else 8 and 4
  std::vector<GmshElement> hexahedra;
  std::vector<GmshElement> quadrilaterals;  ///< of the physical surfaces
  std::vector<GmshGroup> groups;            ///< of dimension 2 and 3

  template <typename Archive>
  void serialize(Archive& archive, unsigned int /*version*/) {
    archive& node_tags& nodes& quadratic& hexahedra& quadrilaterals& groups;
  }
};

/// Reads a `.msh` file of format 2 or 4, text or binary, by the Gmsh library. Throws FileError if
/// the file is missing, truncated, damaged or not of Gmsh; InputError if a volume has anything but
/// hexahedra of 8 or of 27 nodes, if the two are mixed, or if a physical surface has triangles.
GmshFile read_gmsh_file(const std::filesystem::path& path);

/// Gmsh's number of the element with 3ᵈ (`quadratic`) or 2ᵈ nodes, and for each of its nodes in
/// Gmsh's order the lexicographic index.
struct GmshElementType {
  int type = 0;
  std::vector<std::size_t> lexicographic;
};

/// The hexahedron's (dimension 3) or quadrilateral's (2) from Gmsh's own table; inside
/// in_gmsh_process().
GmshElementType gmsh_element_type(int dimension, bool quadratic);

}  // namespace ciliaval::meshes::gmsh

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "problem/cilium.h"

namespace ciliaval::test {

/// A mesh as a Gmsh file of format 2.2 states it, to plant faults in. It shares no code with
/// meshes/write_gmsh: nodes and elements are written as the format's manual says.
struct TextMesh {
  struct Element {
    int type = 5;  ///< 5: 8-node hexahedron, 3: 4-node quadrilateral, …
    int physical = 0;
    int entity = 0;
    std::vector<std::size_t> nodes;  ///< from 1
  };
  struct Name {
    int dimension = 0;
    int tag = 0;
    std::string name;
  };
  std::vector<std::array<double, 3>> nodes;
  std::vector<Element> elements;
  std::vector<Name> names;

  std::string text() const;
  void write(const std::filesystem::path& file) const;

  std::array<double, 3>& at(std::size_t node) { return nodes.at(node - 1); }
  /// The mean of an element's nodes.
  std::array<double, 3> centre(const Element& element) const;
  /// Number of the first element of a type whose centre is within `width` of the heights.
  std::size_t find(int type, double low, double high) const;
};

/// Stub of 3 mm and magnet of 17 mm, diameter 3 mm.
Cilium stub_and_magnet();

/// The coarse built-in mesh of a cilium (12 cells in the section) of first order, in metres:
/// physical volumes 1… as the segments, physical surfaces 11 `base`, 12 `mantle`, 13 `tip`.
TextMesh built_in(const Cilium& cilium);

}  // namespace ciliaval::test

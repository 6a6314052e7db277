// SPDX-License-Identifier: LGPL-2.1-or-later
#include <fmt/core.h>

#include <algorithm>
#include <compare>
#include <optional>
#include <string>

#include "meshes/boundary_ids.h"
#include "meshes/gmsh/gmsh_mesh.h"
#include "meshes/gmsh/gmsh_section.h"

namespace ciliaval::meshes::gmsh {
namespace {

/// A face of the boundary: a quadrilateral of the base or the tip, or an edge of the mantle in a
/// layer.
struct Face {
  unsigned int boundary = 0;
  Extrusion::Edge place;  ///< quadrilateral and 0, or number of the edge and layer
  auto operator<=>(const Face&) const = default;  // NOLINT: clang-tidy 14 takes its 0 for a pointer
};

/// All faces of the boundary with an element at each.
std::map<Face, std::size_t> boundary_faces(const Extrusion& extrusion, const Section& section) {
  std::map<Face, std::size_t> faces;
  std::map<Extrusion::Edge, std::size_t> quad_of_edge;
  for (std::size_t q = 0; q < extrusion.quads.size(); ++q) {
    for (const auto& [a, b] : edges_of(extrusion.quads[q])) quad_of_edge[edge(a, b)] = q;
    faces[{base_id, {q, 0}}] = extrusion.cell_of.front()[q];
    faces[{tip_id, {q, 0}}] = extrusion.cell_of.back()[q];
  }
  std::size_t number = 0;
  for (const Extrusion::Edge& e : section.mantle) {
    for (std::size_t layer = 0; layer < extrusion.cell_of.size(); ++layer)
      faces[{mantle_id, {number, layer}}] = extrusion.cell_of[layer][quad_of_edge.at(e)];
    ++number;
  }
  return faces;
}

std::string surface_element(const UserMesh& mesh, const GmshElement& element, unsigned int id) {
  dealii::Point<3> x;
  for (const std::size_t n : element.nodes)
    x += mesh.file.nodes[n] / static_cast<double>(element.nodes.size());
  return fmt::format("element {} of the physical surface '{}' at ({:.4g}, {:.4g}, {:.4g})",
                     element.tag, boundary_names[id], x[0], x[1], x[2]);
}

/// The boundary face with these four vertices; empty for an inner face, throws if there is no face.
std::optional<Face> find_face(const UserMesh& mesh, const Extrusion& extrusion,
                              const std::map<Extrusion::Edge, std::size_t>& mantle,
                              const GmshElement& element, unsigned int id) {
  const std::size_t n = mesh.file.quadratic ? 3 : 2;
  Extrusion::Quad columns{};
  std::array<std::size_t, 4> planes{};
  for (std::size_t v = 0; v < 4; ++v) {
    const std::size_t node = element.nodes[(v & 1) * (n - 1) + (v >> 1) * (n - 1) * n];
    const std::size_t vertex = extrusion.vertices[node];
    if (vertex == Extrusion::none)
      mesh.fail(fmt::format("{} is not a face of a hexahedron: {} is no corner of one",
                            surface_element(mesh, element, id), mesh.node(node)));
    columns[v] = extrusion.column(vertex);
    planes[v] = extrusion.plane(vertex);
  }
  const auto [low, high] = std::minmax_element(planes.begin(), planes.end());
  std::sort(columns.begin(), columns.end());
  if (*low == *high) {
    const auto quad = extrusion.quad_of.find(columns);
    if (quad == extrusion.quad_of.end())
      mesh.fail(surface_element(mesh, element, id) + " is not a face of a hexahedron");
    if (*low == 0) return Face{base_id, {quad->second, 0}};
    if (*low + 1 == extrusion.planes.size()) return Face{tip_id, {quad->second, 0}};
    return std::nullopt;
  }
  const auto found = mantle.find(edge(columns[0], columns[2]));
  if (columns[0] != columns[1] || columns[2] != columns[3] || *high != *low + 1 ||
      found == mantle.end())
    return std::nullopt;
  return Face{mantle_id, {found->second, *low}};
}

}  // namespace

void check_boundaries(UserMesh& mesh, const Extrusion& extrusion, const Section& section) {
  const std::map<int, unsigned int> id_of_entity = find_boundaries(mesh);
  std::map<Face, std::size_t> missing = boundary_faces(extrusion, section);
  std::map<Extrusion::Edge, std::size_t> mantle;
  for (const Extrusion::Edge& e : section.mantle) mantle.emplace(e, mantle.size());
  std::array<std::size_t, 3> total{};
  for (const auto& [face, unused] : missing) ++total[face.boundary];

  for (const GmshElement& element : mesh.file.quadrilaterals) {
    const auto id = id_of_entity.find(element.entity);
    if (id == id_of_entity.end()) continue;
    const auto face = find_face(mesh, extrusion, mantle, element, id->second);
    if (!face)
      mesh.fail(fmt::format("{} lies inside the body: only the outer faces belong to it",
                            surface_element(mesh, element, id->second)));
    if (face->boundary != id->second)
      mesh.fail(fmt::format("{} lies on the {}", surface_element(mesh, element, id->second),
                            boundary_names[face->boundary]));
    missing.erase(*face);
  }
  if (missing.empty()) return;
  std::array<std::size_t, 3> open{};
  for (const auto& [face, unused] : missing) ++open[face.boundary];
  const auto& [face, element] = *missing.begin();
  mesh.fail(
      fmt::format("the physical surface '{}' is not closed: {} of its {} faces are missing, "
                  "the first that of {}; {}",
                  boundary_names[face.boundary], open[face.boundary], total[face.boundary],
                  mesh.hexahedron(element),
                  face.boundary == base_id ? "all faces on Z = 0 belong to it, for they are clamped"
                                           : "add the missing surfaces"));
}

}  // namespace ciliaval::meshes::gmsh

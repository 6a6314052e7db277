// SPDX-License-Identifier: LGPL-2.1-or-later
#include "meshes/gmsh/write_gmsh.h"

#include <fmt/core.h>
#include <gmsh.h>

#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "meshes/boundary_ids.h"
#include "meshes/gmsh/gmsh_file.h"
#include "meshes/gmsh/gmsh_mesh.h"
#include "meshes/gmsh/gmsh_process.h"
#include "problem/error.h"

namespace ciliaval::meshes::gmsh {
namespace {

/// Nodes of an element in Gmsh's order.
template <std::size_t n>
void append_nodes(const std::array<std::size_t, n>& nodes, const GmshElementType& type,
                  bool quadratic, std::vector<std::size_t>& tags) {
  for (const std::size_t lexicographic : type.lexicographic) {
    std::size_t index = lexicographic;
    if (!quadratic)  // corner of 2ᵈ to corner of 3ᵈ
      index = 2 * (lexicographic & 1) + 6 * ((lexicographic >> 1) & 1) + 18 * (lexicographic >> 2);
    tags.push_back(nodes[index] + 1);
  }
}

/// True for each node that the written elements have.
std::vector<bool> used_nodes(const MeshNodes& mesh, bool quadratic) {
  std::vector<bool> used(mesh.nodes.size(), quadratic);
  for (const MeshNodes::Cell& cell : mesh.cells)
    for (const std::size_t corner : {0, 2, 6, 8, 18, 20, 24, 26}) used[cell.nodes[corner]] = true;
  return used;
}

void add_nodes(const MeshNodes& mesh, const GmshFormat& format) {
  const std::vector<bool> used = used_nodes(mesh, format.quadratic);
  std::vector<std::size_t> tags;
  std::vector<double> coordinates;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (!used[i]) continue;
    tags.push_back(i + 1);
    for (unsigned int c = 0; c < 3; ++c) coordinates.push_back(mesh.nodes[i][c] / format.unit);
  }
  ::gmsh::model::mesh::addNodes(3, 1, tags, coordinates);
}

/// One discrete entity and one physical group of a name, with the elements of an id.
void add_named(int dimension, unsigned int id, const std::string& name, const GmshElementType& type,
               const std::vector<std::size_t>& nodes, std::size_t& next_element) {
  const int tag = static_cast<int>(id) + 1;
  std::vector<std::size_t> elements(nodes.size() / type.lexicographic.size());
  for (std::size_t& element : elements) element = next_element++;
  ::gmsh::model::mesh::addElementsByType(tag, type.type, elements, nodes);
  ::gmsh::model::addPhysicalGroup(dimension, {tag}, tag);
  ::gmsh::model::setPhysicalName(dimension, tag, name);
}

void build_model(const MeshNodes& mesh, const std::vector<std::string>& segments,
                 const GmshFormat& format) {
  ::gmsh::model::add("cilium");
  const GmshElementType cell_type = gmsh_element_type(3, format.quadratic);
  const GmshElementType face_type = gmsh_element_type(2, format.quadratic);
  for (std::size_t i = 0; i < segments.size(); ++i)
    ::gmsh::model::addDiscreteEntity(3, static_cast<int>(i) + 1);
  for (std::size_t i = 0; i < boundary_names.size(); ++i)
    ::gmsh::model::addDiscreteEntity(2, static_cast<int>(i) + 1);
  add_nodes(mesh, format);

  std::vector<std::vector<std::size_t>> cells(segments.size());
  std::vector<std::vector<std::size_t>> faces(boundary_names.size());
  for (const MeshNodes::Cell& cell : mesh.cells)
    append_nodes(cell.nodes, cell_type, format.quadratic, cells.at(cell.material));
  for (const MeshNodes::Face& face : mesh.faces)
    append_nodes(face.nodes, face_type, format.quadratic, faces.at(face.boundary));
  std::size_t next_element = 1;
  for (unsigned int i = 0; i < faces.size(); ++i)
    add_named(2, i, boundary_names[i], face_type, faces[i], next_element);
  for (unsigned int i = 0; i < cells.size(); ++i)
    add_named(3, i, segments[i], cell_type, cells[i], next_element);
}

/// Gmsh does not notice a full disk, but then the end is missing.
void require_complete(const std::filesystem::path& path) {
  constexpr std::string_view last = "$EndElements\n";
  std::ifstream in(path, std::ios::binary);
  in.seekg(-static_cast<std::streamoff>(last.size()), std::ios::end);
  std::string tail(last.size(), '\0');
  in.read(tail.data(), static_cast<std::streamsize>(tail.size()));
  if (!in || tail != last)
    throw FileError(path.string() +
                    ": the mesh could not be written in full: is the folder writable, is the disk "
                    "full?");
}

}  // namespace

void write_gmsh(const MeshNodes& mesh, const Cilium& cilium, const std::filesystem::path& path,
                const GmshFormat& format) {
  if (path.extension() != ".msh")
    throw InputError(path.string() + ": a Gmsh mesh file must have the extension .msh");
  for (const MeshNodes::Cell& cell : mesh.cells)
    if (cell.material >= cilium.segments.size())
      throw InputError(fmt::format("a cell has the material {}, the cilium has {} segments",
                                   cell.material, cilium.segments.size()));
  for (const MeshNodes::Face& face : mesh.faces)
    if (face.boundary >= boundary_names.size())
      throw InputError(
          fmt::format("a boundary face has the id {}, which has no name", face.boundary));
  std::vector<std::string> segments;
  for (const Segment& segment : cilium.segments) segments.push_back(segment.name);
  in_gmsh_process(path, "write the mesh", [&] {
    build_model(mesh, segments, format);
    ::gmsh::option::setNumber("Mesh.MshFileVersion", format.version);
    ::gmsh::option::setNumber("Mesh.Binary", format.binary ? 1 : 0);
    ::gmsh::write(path.string());
    return std::string();
  });
  require_complete(path);
}

}  // namespace ciliaval::meshes::gmsh

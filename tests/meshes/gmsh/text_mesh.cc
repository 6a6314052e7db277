// SPDX-License-Identifier: LGPL-2.1-or-later
#include "text_mesh.h"

#include <fstream>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "meshes/cylinder/cylinder_mesh.h"
#include "meshes/mesh_nodes.h"

namespace ciliaval::test {

std::string TextMesh::text() const {
  std::ostringstream out;
  out << std::setprecision(17) << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n"
      << names.size() << '\n';
  for (const Name& name : names)
    out << name.dimension << ' ' << name.tag << " \"" << name.name << "\"\n";
  out << "$EndPhysicalNames\n$Nodes\n" << nodes.size() << '\n';
  for (std::size_t i = 0; i < nodes.size(); ++i)
    out << i + 1 << ' ' << nodes[i][0] << ' ' << nodes[i][1] << ' ' << nodes[i][2] << '\n';
  out << "$EndNodes\n$Elements\n" << elements.size() << '\n';
  for (std::size_t e = 0; e < elements.size(); ++e) {
    out << e + 1 << ' ' << elements[e].type << " 2 " << elements[e].physical << ' '
        << elements[e].entity;
    for (const std::size_t node : elements[e].nodes) out << ' ' << node;
    out << '\n';
  }
  out << "$EndElements\n";
  return out.str();
}

void TextMesh::write(const std::filesystem::path& file) const {
  std::ofstream(file) << text();
}

std::array<double, 3> TextMesh::centre(const Element& element) const {
  std::array<double, 3> x{};
  for (const std::size_t node : element.nodes)
    for (std::size_t c = 0; c < 3; ++c)
      x[c] += nodes.at(node - 1)[c] / static_cast<double>(element.nodes.size());
  return x;
}

std::size_t TextMesh::find(int type, double low, double high) const {
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const double z = centre(elements[e])[2];
    if (elements[e].type == type && z >= low && z <= high) return e;
  }
  throw std::logic_error("the test's mesh has no such element");
}

Cilium stub_and_magnet() {
  return {3e-3, {{"stub", 3e-3, 1e5, 0.49, 0}, {"magnet", 17e-3, 3e6, 0.49, 75e3}}};
}

TextMesh built_in(const Cilium& cilium) {
  meshes::cylinder::CylinderMeshOptions options;
  options.square_cells = 2;
  options.rings = 1;
  options.finest_layer = 0.5;
  options.coarsest_layer = 1;
  dealii::Triangulation<3> triangulation;
  meshes::cylinder::make_cylinder(cilium, options, triangulation);
  const auto mapping = meshes::cylinder::cylinder_mapping(triangulation);
  TextMesh mesh;
  for (const auto& x : triangulation.get_vertices()) mesh.nodes.push_back({x[0], x[1], x[2]});
  for (std::size_t i = 0; i < cilium.segments.size(); ++i)
    mesh.names.push_back({3, static_cast<int>(i) + 1, cilium.segments[i].name});
  mesh.names.push_back({2, 11, "base"});
  mesh.names.push_back({2, 12, "mantle"});
  mesh.names.push_back({2, 13, "tip"});
  for (const auto& cell : triangulation.active_cell_iterators()) {
    const int material = static_cast<int>(cell->material_id()) + 1;
    TextMesh::Element hexahedron{5, material, material, {}};
    for (const unsigned int v : {0, 1, 3, 2, 4, 5, 7, 6})
      hexahedron.nodes.push_back(cell->vertex_index(v) + 1);
    mesh.elements.push_back(hexahedron);
    for (const auto& face : cell->face_iterators()) {
      if (!face->at_boundary()) continue;
      const int boundary = static_cast<int>(face->boundary_id()) + 11;
      TextMesh::Element quadrilateral{3, boundary, boundary, {}};
      for (const unsigned int v : {0, 1, 3, 2})
        quadrilateral.nodes.push_back(face->vertex_index(v) + 1);
      mesh.elements.push_back(quadrilateral);
    }
  }
  return mesh;
}

}  // namespace ciliaval::test

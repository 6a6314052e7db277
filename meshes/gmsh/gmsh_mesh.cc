// SPDX-License-Identifier: LGPL-2.1-or-later
#include "meshes/gmsh/gmsh_mesh.h"

#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/grid_tools.h>

#include <cmath>

#include "meshes/boundary_ids.h"
#include "meshes/gmsh/gmsh_section.h"
#include "meshes/parts.h"
#include "problem/error.h"

namespace ciliaval::meshes::gmsh {
namespace {

using dealii::Point;
using dealii::Triangulation;

/// The section's quadrilaterals turned so that opposite edges of each run the same way, which
/// deal.II wants of the whole mesh.
std::vector<Extrusion::Quad> ordered_quads(const Extrusion& extrusion) {
  std::vector<dealii::CellData<2>> cells;
  for (const Extrusion::Quad& quad : extrusion.quads) {
    cells.emplace_back();
    for (unsigned int v = 0; v < 4; ++v)
      cells.back().vertices[v] = static_cast<unsigned int>(quad[v]);
  }
  dealii::GridTools::consistently_order_cells(cells);
  std::vector<Extrusion::Quad> quads;
  for (const dealii::CellData<2>& cell : cells) {
    Extrusion::Quad quad{};
    for (unsigned int v = 0; v < 4; ++v) quad[v] = cell.vertices[v];
    quads.push_back(quad);
  }
  return quads;
}

void triangulate(const UserMesh& mesh, const Extrusion& extrusion,
                 const std::vector<Extrusion::Quad>& quads, Triangulation<3>& triangulation) {
  std::vector<Point<3>> vertices;
  for (const double z : extrusion.planes)
    for (const Point<2>& column : extrusion.columns) vertices.emplace_back(column[0], column[1], z);
  std::vector<dealii::CellData<3>> cells;
  for (std::size_t e = 0; e < extrusion.cells.size(); ++e) {
    const Extrusion::Cell& cell = extrusion.cells[e];
    cells.emplace_back();
    for (unsigned int v = 0; v < 8; ++v)
      cells.back().vertices[v] = static_cast<unsigned int>(
          (cell.layer + v / 4) * extrusion.columns.size() + quads[cell.quad][v % 4]);
    cells.back().material_id = static_cast<dealii::types::material_id>(mesh.segments[e]);
  }
  triangulation.create_triangulation(vertices, cells, {});
  for (const auto& cell : triangulation.active_cell_iterators()) {
    for (const auto& face : cell->face_iterators()) {
      if (!face->at_boundary()) continue;
      const bool horizontal = face->vertex(0)[2] == face->vertex(3)[2];
      face->set_boundary_id(!horizontal ? mantle_id : face->vertex(0)[2] == 0 ? base_id : tip_id);
    }
  }
}

/// The quadratic mapping through the section's nodes.
std::unique_ptr<dealii::MappingQCache<3>> mapping(const Extrusion& extrusion,
                                                  const Section& section,
                                                  const std::vector<Extrusion::Quad>& quads,
                                                  const Triangulation<3>& triangulation) {
  const std::vector<Point<3>> unit_points = dealii::FE_Q<3>(2).get_unit_support_points();
  auto result = std::make_unique<dealii::MappingQCache<3>>(2);
  result->initialize(triangulation, [&](const Triangulation<3>::cell_iterator& iterator) {
    const auto number = iterator->id().get_coarse_cell_id();
    if (number >= extrusion.cells.size())  // what a rank without cells has
      return std::vector<Point<3>>(unit_points);
    const Extrusion::Cell& cell = extrusion.cells[number];
    const auto nodes = section.nodes(extrusion, cell.quad, quads[cell.quad]);
    const double bottom = extrusion.planes[cell.layer];
    const double top = extrusion.planes[cell.layer + 1];
    std::vector<Point<3>> points;
    for (const Point<3>& unit : unit_points) {
      const Point<2>& x =
          nodes[static_cast<std::size_t>(std::lround(2 * unit[0]) + 3 * std::lround(2 * unit[1]))];
      points.emplace_back(x[0], x[1], unit[2] == 1 ? top : bottom + unit[2] * (top - bottom));
    }
    return points;
  });
  return result;
}

}  // namespace

GmshMesh read_gmsh(const MeshFile& source, const Cilium& cilium,
                   const std::function<MPI_Comm(std::size_t nodes)>& ranks) {
  require_valid(cilium);
  if (!(std::isfinite(source.unit) && source.unit > 0))
    throw InputError(source.path.string() + ": the unit of a mesh must be finite and positive");
  UserMesh mesh{source, cilium, read_gmsh_file(source.path), {}, {}};
  find_segments(mesh);
  Extrusion extrusion = find_extrusion(mesh);
  const Section section = make_section(mesh, extrusion);
  check_boundaries(mesh, extrusion, section);

  const std::vector<Extrusion::Quad> quads = ordered_quads(extrusion);
  const std::size_t in_plane = extrusion.columns.size() + section.middles.size() + quads.size();
  GmshMesh result;
  result.triangulation =
      make_in_parts([&](Triangulation<3>& whole) { triangulate(mesh, extrusion, quads, whole); },
                    ranks(in_plane * (2 * extrusion.planes.size() - 1)));
  result.mapping = mapping(extrusion, section, quads, *result.triangulation);
  result.remarks = std::move(mesh.remarks);
  return result;
}

}  // namespace ciliaval::meshes::gmsh

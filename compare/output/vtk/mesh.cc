// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/vtk/mesh.h"

#include <vtkBiQuadraticQuad.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkTriQuadraticHexahedron.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "meshes/gmsh/gmsh_mesh.h"

namespace ciliaval::compare::output::vtk {
namespace {

/// The lexicographic number of each of a cell's n points in VTK's order.
template <std::size_t n>
std::array<std::size_t, n> lexicographic(vtkCell& cell) {
  const double* coordinates = cell.GetParametricCoords();
  std::array<std::size_t, n> order{};
  for (std::size_t i = 0; i < n; ++i)
    order[i] = static_cast<std::size_t>(std::lround(2 * coordinates[3 * i]) +
                                        3 * std::lround(2 * coordinates[3 * i + 1]) +
                                        9 * std::lround(2 * coordinates[3 * i + 2]));
  return order;
}

template <std::size_t n>
void add_cell(vtkUnstructuredGrid& grid, int type, const std::array<std::size_t, n>& nodes,
              const std::array<std::size_t, n>& order) {
  std::array<vtkIdType, n> ids{};
  for (std::size_t i = 0; i < n; ++i) ids[i] = static_cast<vtkIdType>(nodes[order[i]]);
  grid.InsertNextCell(type, static_cast<vtkIdType>(n), ids.data());
}

void add_names(vtkUnstructuredGrid& grid, const char* name, const std::vector<std::string>& names) {
  const vtkNew<vtkStringArray> array;
  array->SetName(name);
  for (const std::string& text : names) array->InsertNextValue(text);
  grid.GetFieldData()->AddArray(array);
}

}  // namespace

vtkSmartPointer<vtkUnstructuredGrid> mesh_grid(const meshes::MeshNodes& mesh,
                                               const Cilium& cilium) {
  const vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const auto& x : mesh.nodes) points->InsertNextPoint(x[0], x[1], x[2]);
  const vtkNew<vtkIntArray> materials;
  materials->SetName("MaterialIDs");
  const vtkNew<vtkIntArray> boundaries;
  boundaries->SetName("BoundaryIDs");
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(points);
  const vtkNew<vtkTriQuadraticHexahedron> hexahedron;
  const auto volume_order = lexicographic<27>(*hexahedron);
  for (const auto& cell : mesh.cells) {
    add_cell(*grid, VTK_TRIQUADRATIC_HEXAHEDRON, cell.nodes, volume_order);
    materials->InsertNextValue(static_cast<int>(cell.material));
    boundaries->InsertNextValue(-1);
  }
  const vtkNew<vtkBiQuadraticQuad> quadrilateral;
  const auto face_order = lexicographic<9>(*quadrilateral);
  for (const auto& face : mesh.faces) {
    add_cell(*grid, VTK_BIQUADRATIC_QUAD, face.nodes, face_order);
    materials->InsertNextValue(-1);
    boundaries->InsertNextValue(static_cast<int>(face.boundary));
  }
  grid->GetCellData()->AddArray(materials);
  grid->GetCellData()->AddArray(boundaries);
  std::vector<std::string> names;
  for (const Segment& segment : cilium.segments) names.push_back(segment.name);
  add_names(*grid, "materials", names);
  add_names(*grid, "boundaries", meshes::gmsh::boundary_names());
  add_names(*grid, "units", {"points: m"});
  return grid;
}

}  // namespace ciliaval::compare::output::vtk

// SPDX-License-Identifier: LGPL-2.1-or-later
// GoogleTest first: deal.II defines a macro Assert.
#include <gtest/gtest.h>

#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkStringArray.h>

#include <array>
#include <cmath>

#include "compare/output/vtk/datasets.h"
#include "meshes/cylinder/cylinder_mesh.h"

namespace ciliaval::compare::vtk {
namespace {

// Oracle: VTK's own interpolation of its triquadratic cell against deal.II's mapping, at a point
// that no symmetry of a cube leaves where it is. Measured: within 2.6e-18 m.
TEST(MeshGrid, HasTheCurvedCellsOfTheMapping) {
  const Cilium cilium{3e-3, {{"stub", 3e-3, 1e5, 0.49, 0}, {"magnet", 5e-3, 3e6, 0.49, 75e3}}};
  dealii::Triangulation<3> triangulation;
  meshes::cylinder::CylinderMeshOptions options;
  options.square_cells = 2;
  meshes::cylinder::make_cylinder(cilium, options, triangulation);
  const auto mapping = meshes::cylinder::cylinder_mapping(triangulation);
  const auto grid = output::vtk::mesh_grid(meshes::mesh_nodes(triangulation, *mapping), cilium);
  const auto* material =
      vtkIntArray::SafeDownCast(grid->GetCellData()->GetAbstractArray("MaterialIDs"));
  const auto* boundary =
      vtkIntArray::SafeDownCast(grid->GetCellData()->GetAbstractArray("BoundaryIDs"));
  ASSERT_NE(material, nullptr);
  ASSERT_NE(boundary, nullptr);
  const std::array<double, 3> xi{0.1, 0.35, 0.8};
  vtkIdType id = 0;
  std::array<double, 27> weights{};
  for (const auto& cell : triangulation.active_cell_iterators()) {
    std::array<double, 3> x{};
    int part = 0;
    grid->GetCell(id)->EvaluateLocation(part, xi.data(), x.data(), weights.data());
    const dealii::Point<3> expected =
        mapping->transform_unit_to_real_cell(cell, dealii::Point<3>(xi[0], xi[1], xi[2]));
    for (unsigned int c = 0; c < 3; ++c) ASSERT_NEAR(x[c], expected[c], 3e-17);
    EXPECT_EQ(material->GetValue(id), static_cast<int>(cell->material_id()));
    EXPECT_EQ(boundary->GetValue(id), -1);
    ++id;
  }
  // The boundary: its id is told by where it is.
  std::array<int, 3> count{};
  for (; id < grid->GetNumberOfCells(); ++id) {
    std::array<double, 3> x{};
    int part = 0;
    const std::array<double, 3> middle{0.5, 0.5, 0};
    grid->GetCell(id)->EvaluateLocation(part, middle.data(), x.data(), weights.data());
    const int where = x[2] < 1e-9 ? 0 : x[2] > 8e-3 - 1e-9 ? 2 : 1;
    EXPECT_EQ(boundary->GetValue(id), where);
    EXPECT_EQ(material->GetValue(id), -1);
    if (where == 1) {
      EXPECT_NEAR(std::hypot(x[0], x[1]), 1.5e-3, 1e-6);
    }
    ++count[static_cast<std::size_t>(where)];
  }
  EXPECT_EQ(count[0], 20);  // 2² + 4·2·2
  EXPECT_EQ(count[2], 20);
  EXPECT_GT(count[1], 20);
  const auto* names =
      vtkStringArray::SafeDownCast(grid->GetFieldData()->GetAbstractArray("materials"));
  ASSERT_NE(names, nullptr);
  EXPECT_EQ(const_cast<vtkStringArray*>(names)->GetValue(1), "magnet");
}

}  // namespace
}  // namespace ciliaval::compare::vtk

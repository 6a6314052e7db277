// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "meshes/cylinder/cylinder_mesh.h"
#include "meshes/gmsh/gmsh_mesh.h"
#include "meshes/gmsh/write_gmsh.h"
#include "problem/error.h"
#include "tests/support/temporary_folder.h"
#include "text_mesh.h"

namespace ciliaval::meshes::gmsh {
namespace {

using dealii::Point;
using dealii::Triangulation;

/// A mesh with its mapping, wherever it comes from.
struct Mesh {
  std::unique_ptr<Triangulation<3>> triangulation = std::make_unique<Triangulation<3>>();
  std::unique_ptr<dealii::MappingQCache<3>> mapping;
  std::vector<std::string> remarks;

  void make(const Cilium& cilium, const cylinder::CylinderMeshOptions& options) {
    cylinder::make_cylinder(cilium, options, *triangulation);
    mapping = cylinder::cylinder_mapping(*triangulation);
  }
  void read(const MeshFile& file, const Cilium& cilium) {
    GmshMesh result = read_gmsh(file, cilium);
    triangulation = std::move(result.triangulation);
    mapping = std::move(result.mapping);
    remarks = std::move(result.remarks);
  }
};

struct Integrals {
  double volume = 0;
  double second_moment = 0;  ///< ∫ x² dV
  double least_jacobian = 1;
};

Integrals integrals(const Mesh& mesh) {
  const dealii::FE_Q<3> element(1);
  const dealii::QGauss<3> gauss(6);
  dealii::FEValues<3> values(*mesh.mapping, element, gauss,
                             dealii::update_JxW_values | dealii::update_quadrature_points);
  Integrals result;
  for (const auto& cell : mesh.triangulation->active_cell_iterators()) {
    values.reinit(cell);
    for (unsigned int q = 0; q < gauss.size(); ++q) {
      result.volume += values.JxW(q);
      result.second_moment += values.JxW(q) * std::pow(values.quadrature_point(q)[0], 2);
      result.least_jacobian = std::min(result.least_jacobian, values.JxW(q));
    }
  }
  return result;
}

/// A key for points that are the same but for rounding: 1e-8 m, far below the size of a cell, and
/// shifted, so that the rounding of 0 does not decide.
std::array<long long, 3> key(const Point<3>& x) {
  return {std::llround(x[0] * 1e8 + 0.123), std::llround(x[1] * 1e8 + 0.123),
          std::llround(x[2] * 1e8 + 0.123)};
}

/// Every cell of one mesh is, by its nodes and its material, at the same place in the other, every
/// boundary face with its id too. Returns the largest distance of a node.
double expect_same(const Mesh& a, const Mesh& b) {
  const MeshNodes first = mesh_nodes(*a.triangulation, *a.mapping);
  const MeshNodes second = mesh_nodes(*b.triangulation, *b.mapping);
  EXPECT_EQ(first.nodes.size(), second.nodes.size());
  EXPECT_EQ(first.cells.size(), second.cells.size());
  EXPECT_EQ(first.faces.size(), second.faces.size());
  std::map<std::array<long long, 3>, std::size_t> cell_at;
  for (std::size_t e = 0; e < second.cells.size(); ++e)
    cell_at[key(second.nodes[second.cells[e].nodes[13]])] = e;
  double largest = 0;
  for (const MeshNodes::Cell& cell : first.cells) {
    const auto other = cell_at.find(key(first.nodes[cell.nodes[13]]));
    if (other == cell_at.end()) {
      ADD_FAILURE() << "no cell at " << first.nodes[cell.nodes[13]];
      return 1;
    }
    EXPECT_EQ(cell.material, second.cells[other->second].material);
    for (const std::size_t node : cell.nodes) {
      double nearest = 1;
      for (const std::size_t twin : second.cells[other->second].nodes)
        nearest = std::min(nearest, first.nodes[node].distance(second.nodes[twin]));
      largest = std::max(largest, nearest);
    }
  }
  const auto faces = [](const MeshNodes& mesh) {
    std::map<std::array<long long, 3>, unsigned int> ids;
    for (const MeshNodes::Face& face : mesh.faces)
      ids[key(mesh.nodes[face.nodes[4]])] = face.boundary;
    return ids;
  };
  EXPECT_EQ(faces(first), faces(second));
  return largest;
}

cylinder::CylinderMeshOptions small() {
  cylinder::CylinderMeshOptions options;
  options.square_cells = 2;
  options.rings = 2;
  options.finest_layer = 0.3;
  options.coarsest_layer = 1;
  return options;
}

// Oracle: the mesh before it was written. The nodes come back to rounding error (3e-18 m measured,
// text and binary), and again from a mesh that was read.
TEST(GmshRoundTrip, KeepsCellsMaterialsBoundariesAndVolume) {
  const test::TemporaryFolder folder;
  const Cilium cilium = test::stub_and_magnet();
  Mesh made;
  made.make(cilium, small());
  const Integrals before = integrals(made);
  for (const double version : {2.2, 4.1}) {
    for (const bool binary : {false, true}) {
      for (const double unit : {1.0, 1e-3}) {
        const MeshFile file{folder.path() / "cilium.msh", unit};
        write_gmsh(mesh_nodes(*made.triangulation, *made.mapping), cilium, file.path,
                   {version, binary, unit});
        Mesh back;
        back.read(file, cilium);
        EXPECT_LT(expect_same(made, back), 1e-16);
        EXPECT_THAT(back.remarks, testing::IsEmpty());
        const Integrals after = integrals(back);
        EXPECT_NEAR(after.volume / before.volume, 1, 1e-11);
        EXPECT_NEAR(after.second_moment / before.second_moment, 1, 1e-11);
        EXPECT_GT(after.least_jacobian, 0);

        write_gmsh(mesh_nodes(*back.triangulation, *back.mapping), cilium, file.path,
                   {version, binary, unit});
        Mesh again;
        again.read(file, cilium);
        EXPECT_LT(expect_same(back, again), 1e-17);
        EXPECT_NEAR(integrals(again).volume / after.volume, 1, 1e-14);
      }
    }
  }
}

// Oracle: cylinder::make_cylinder() curves the same vertices itself (by manifolds): a first-order
// file gets the same geometry here, and with it the exact volume πd²L/4.
TEST(GmshRoundTrip, CurvesAFirstOrderMeshAsTheBuiltInOne) {
  const test::TemporaryFolder folder;
  const Cilium cilium = test::stub_and_magnet();
  Mesh made;
  made.make(cilium, small());
  const MeshFile file{folder.path() / "linear.msh"};
  write_gmsh(mesh_nodes(*made.triangulation, *made.mapping), cilium, file.path,
             {.quadratic = false});
  Mesh back;
  back.read(file, cilium);
  EXPECT_LT(expect_same(made, back), 1e-16);
  EXPECT_NEAR(integrals(back).volume / (cilium.area() * cilium.length()), 1, 1e-13);
}

// A rim with nodes on R itself at unequal distances: the area is exact all the same.
TEST(GmshMeshes, HaveTheExactAreaWithUnequalArcs) {
  const test::TemporaryFolder folder;
  const Cilium cilium = test::stub_and_magnet();
  test::TextMesh mesh = test::built_in(cilium);
  for (auto& x : mesh.nodes) {
    const double r = std::min(1.5e-3, std::hypot(x[0], x[1]));
    const double phi = std::atan2(x[1], x[0]);
    const double turned = phi + 0.1 * std::sin(phi);
    x = {r * std::cos(turned), r * std::sin(turned), x[2]};
  }
  mesh.write(folder.path() / "uneven.msh");
  Mesh back;
  back.read({folder.path() / "uneven.msh"}, cilium);
  EXPECT_NEAR(integrals(back).volume / (cilium.area() * cilium.length()), 1, 1e-12);
}

// Oracle: the mesh before its cells were renumbered by one of the 48 symmetries of a cube each,
// half of which turn them inside out.
TEST(GmshMeshes, RepairTurnedAndMirroredCells) {
  const test::TemporaryFolder folder;
  const Cilium cilium = test::stub_and_magnet();
  test::TextMesh mesh = test::built_in(cilium);
  mesh.write(folder.path() / "straight.msh");
  std::mt19937 random(7);
  constexpr std::array<std::size_t, 8> gmsh{0, 1, 3, 2, 4, 5, 7, 6};  // lexicographic to Gmsh
  for (auto& element : mesh.elements) {
    if (element.type != 5) continue;
    std::array<unsigned int, 3> axes{0, 1, 2};
    std::shuffle(axes.begin(), axes.end(), random);
    const auto flips = static_cast<unsigned int>(random() % 8);
    const auto before = element.nodes;
    for (unsigned int v = 0; v < 8; ++v) {
      unsigned int from = 0;
      for (unsigned int c = 0; c < 3; ++c) from |= ((v >> c) & 1U) << axes[c];
      element.nodes[gmsh[v]] = before[gmsh[from ^ flips]];
    }
  }
  mesh.write(folder.path() / "turned.msh");
  Mesh straight;
  straight.read({folder.path() / "straight.msh"}, cilium);
  EXPECT_THAT(straight.remarks, testing::IsEmpty());
  Mesh turned;
  turned.read({folder.path() / "turned.msh"}, cilium);
  EXPECT_LT(expect_same(straight, turned), 1e-17);
  EXPECT_GT(integrals(turned).least_jacobian, 0);
  EXPECT_THAT(turned.remarks, testing::ElementsAre(testing::HasSubstr("inside out")));
}

// Second-order nodes that are on R itself are left there: the area is then short by 8e-4 with
// eight arcs (sin β (1 + (1 − cos β)/3)/β, β = π/8), which a remark tells.
TEST(GmshMeshes, HonourSecondOrderNodesAndTellTheirArea) {
  const test::TemporaryFolder folder;
  const Cilium cilium = test::stub_and_magnet();
  cylinder::CylinderMeshOptions options = small();
  options.equal_area = false;
  Mesh made;
  made.make(cilium, options);
  write_gmsh(mesh_nodes(*made.triangulation, *made.mapping), cilium, folder.path() / "on_R.msh");
  Mesh back;
  back.read({folder.path() / "on_R.msh"}, cilium);
  EXPECT_LT(expect_same(made, back), 1e-16);
  EXPECT_NEAR(integrals(back).volume / (cilium.area() * cilium.length()), 1 - 7.8e-4, 1e-5);
  EXPECT_THAT(back.remarks, testing::ElementsAre(testing::HasSubstr("-0.078 % off")));
}

TEST(GmshMeshes, RefuseCurvedNodesThatAreNotExtruded) {
  const test::TemporaryFolder folder;
  const Cilium cilium = test::stub_and_magnet();
  Mesh made;
  made.make(cilium, small());
  MeshNodes nodes = mesh_nodes(*made.triangulation, *made.mapping);
  nodes.nodes[nodes.cells[40].nodes[12]][0] += 1e-5;
  write_gmsh(nodes, cilium, folder.path() / "bulge.msh");
  Mesh back;
  try {
    back.read({folder.path() / "bulge.msh"}, cilium);
    FAIL() << "the mesh was read";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("second-order node"));
    EXPECT_THAT(error.what(), testing::HasSubstr("straight vertical lines"));
  }
}

TEST(GmshMeshes, ListUnusedSurfacesAndPoorCells) {
  const test::TemporaryFolder folder;
  const Cilium cilium = test::stub_and_magnet();
  test::TextMesh mesh = test::built_in(cilium);
  test::TextMesh::Element extra = mesh.elements[mesh.find(3, -1, 1e-6)];
  extra.physical = extra.entity = 20;
  mesh.elements.push_back(extra);
  mesh.names.push_back({2, 20, "glue"});
  // The inner square turned against the rim by 0.35 rad: its ring's cells get skew.
  for (auto& x : mesh.nodes) {
    if (std::hypot(x[0], x[1]) > 1.2e-3) continue;
    const double c = std::cos(0.35);
    const double s = std::sin(0.35);
    x = {c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]};
  }
  mesh.write(folder.path() / "poor.msh");
  Mesh back;
  back.read({folder.path() / "poor.msh"}, cilium);
  EXPECT_THAT(back.remarks, testing::UnorderedElementsAre(testing::HasSubstr("'glue' is not used"),
                                                          testing::HasSubstr("poorly shaped")));
}

TEST(GmshWriter, TellsWhatItCannotWrite) {
  const test::TemporaryFolder folder;
  const Cilium cilium = test::stub_and_magnet();
  Mesh made;
  made.make(cilium, small());
  MeshNodes nodes = mesh_nodes(*made.triangulation, *made.mapping);
  EXPECT_THROW(write_gmsh(nodes, cilium, folder.path() / "none" / "x.msh"), FileError);
  EXPECT_THROW(write_gmsh(nodes, cilium, folder.path() / "x.mesh"), InputError);
  nodes.cells.front().material = 7;
  EXPECT_THROW(write_gmsh(nodes, cilium, folder.path() / "x.msh"), InputError);
}

}  // namespace
}  // namespace ciliaval::meshes::gmsh

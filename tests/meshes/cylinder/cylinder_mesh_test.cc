// SPDX-License-Identifier: LGPL-2.1-or-later
// GoogleMock first: deal.II defines a macro Assert.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "meshes/cylinder/cylinder_mesh.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "meshes/base_section.h"
#include "problem/error.h"

namespace ciliaval::meshes::cylinder {
namespace {

Cilium stub_and_magnet() {
  return {3e-3, {{"base", 3e-3, 1e5, 0.49, 0}, {"magnet", 17e-3, 3e6, 0.49, 75e3}}};
}

/// Volume, ∫ x² dV and the smallest Jacobian over its mean in the cell.
struct Geometry {
  double volume = 0;
  double second_moment = 0;
  double worst_jacobian = std::numeric_limits<double>::infinity();
};

Geometry geometry(const Cilium& cilium, const CylinderMeshOptions& options, unsigned int degree) {
  dealii::Triangulation<3> triangulation;
  make_cylinder(cilium, options, triangulation);
  const auto mapping = cylinder_mapping(triangulation, degree);
  const dealii::FE_Q<3> element(1);
  const dealii::QGauss<3> gauss(8);
  dealii::FEValues<3> values(
      *mapping, element, gauss,
      dealii::update_JxW_values | dealii::update_quadrature_points | dealii::update_jacobians);
  Geometry result;
  for (const auto& cell : triangulation.active_cell_iterators()) {
    values.reinit(cell);
    double volume = 0;
    double smallest = std::numeric_limits<double>::infinity();
    for (unsigned int q = 0; q < gauss.size(); ++q) {
      volume += values.JxW(q);
      result.second_moment += values.JxW(q) * std::pow(values.quadrature_point(q)[0], 2);
      smallest = std::min(smallest, values.JxW(q) / gauss.weight(q));
    }
    result.volume += volume;
    result.worst_jacobian = std::min(result.worst_jacobian, smallest / volume);
  }
  return result;
}

// Oracle: V = πd²L/4 and ∫x² dV = πd⁴L/64. With quadratic cells the volume is exact by
// construction, and the second moment is left with an error of second order in that of the arcs:
// measured 2e-6 with 8 arcs, 1e-8 with 16.
TEST(CylinderMesh, HasTheVolumeAndSecondMomentOfTheCylinder) {
  const Cilium cilium = stub_and_magnet();
  for (const auto& [square_cells, tolerance] : {std::pair{2U, 1e-5}, std::pair{4U, 1e-6}}) {
    CylinderMeshOptions options;
    options.square_cells = square_cells;
    const Geometry mesh = geometry(cilium, options, 2);
    EXPECT_NEAR(mesh.volume / (cilium.area() * cilium.length()), 1, 1e-12);
    EXPECT_NEAR(mesh.second_moment / (cilium.second_moment() * cilium.length()), 1, tolerance);
  }
}

// Oracle: hand formulas. Half of a section has half of the volume and of ∫x² dV.
TEST(CylinderMesh, HasTheVolumeAndSecondMomentOfARectangleAndATube) {
  Cilium plate = stub_and_magnet();
  plate.diameter = 0;
  plate.section = {.shape = CrossSection::Shape::rectangle, .width = 4e-3, .height = 1e-3};
  Cilium tube = stub_and_magnet();
  tube.section = {.shape = CrossSection::Shape::tube, .inner_diameter = 0.4 * tube.diameter};
  for (const Cilium& cilium : {plate, turned(plate, std::acos(-1.0) / 2), tube}) {
    for (const bool half : {false, true}) {
      CylinderMeshOptions options;
      options.half = half;
      const Geometry mesh = geometry(cilium, options, 2);
      const double part = half ? 0.5 : 1;
      const double L = cilium.length();
      EXPECT_NEAR(mesh.volume / (part * cilium.area() * L), 1, 1e-12);
      EXPECT_NEAR(mesh.second_moment / (part * cilium.second_moment() * L), 1, 1e-6);
    }
  }
  dealii::Triangulation<3> triangulation;
  EXPECT_THROW(make_cylinder(turned(plate, 0.1), {}, triangulation), InputError);
}

// Oracle: the sector of the parabola through three points of an arc of half-angle β, in closed form
// sin β (1 + (1 − cos β)/3), against β.
TEST(BaseSection, IsThatOfTheMeshedCircle) {
  const Cilium cilium = stub_and_magnet();
  CylinderMeshOptions options;
  options.square_cells = 2;
  for (const bool equal : {true, false}) {
    options.equal_area = equal;
    dealii::Triangulation<3> triangulation;
    make_cylinder(cilium, options, triangulation);
    const SectionProperties section = base_section(triangulation, *cylinder_mapping(triangulation));
    const double beta = std::acos(-1.0) / 8;
    const double sector = std::sin(beta) * (1 + (1 - std::cos(beta)) / 3) / beta;
    EXPECT_NEAR(section.area / cilium.area(), equal ? 1 : sector, 1e-12);
    EXPECT_NEAR(section.about_x / cilium.second_moment(), equal ? 1 : sector * sector, 2e-5);
    EXPECT_NEAR(section.about_y / section.about_x, 1, 1e-12);
  }
}

// Oracle: area and moments of a boundary interpolated at p+1 Gauss–Lobatto points of each arc of
// angle α converge as α^(2p). α is halved from 45° to 22.5°, the nodes on the cylinder itself.
TEST(CylinderMesh, ConvergesToTheCylinderWithTwiceTheMappingDegree) {
  const Cilium cilium = stub_and_magnet();
  const double exact = cilium.area() * cilium.length();
  CylinderMeshOptions options;
  options.equal_area = false;
  options.finest_layer = options.coarsest_layer = 2;
  for (const unsigned int degree : {2U, 3U}) {
    options.square_cells = 2;
    const double coarse = std::abs(geometry(cilium, options, degree).volume - exact);
    options.square_cells = 4;
    const double fine = std::abs(geometry(cilium, options, degree).volume - exact);
    EXPECT_NEAR(std::log2(coarse / fine), 2 * degree, 0.2) << "degree " << degree;
  }
}

// A cell whose Jacobian falls below a tenth of its mean would be badly distorted; zero is invalid.
TEST(CylinderMesh, HasWellShapedCells) {
  CylinderMeshOptions options;
  for (const unsigned int square_cells : {2U, 4U, 6U}) {
    for (const unsigned int rings : {1U, 2U, 3U}) {
      options.square_cells = square_cells;
      options.rings = rings;
      EXPECT_GT(geometry(stub_and_magnet(), options, 2).worst_jacobian, 0.3);
    }
  }
}

TEST(CylinderMesh, HasPlanesAtInterfacesAndWhereAsked) {
  CylinderMeshOptions options;
  options.planes = {16e-3, 3e-3 * (1 + 1e-12), 20e-3};
  const std::vector<double> planes = layer_planes(stub_and_magnet(), options);
  EXPECT_TRUE(std::is_sorted(planes.begin(), planes.end()));
  EXPECT_EQ(planes.front(), 0.0);
  EXPECT_DOUBLE_EQ(planes.back(), 20e-3);
  EXPECT_THAT(planes, ::testing::Contains(3e-3));
  EXPECT_THAT(planes, ::testing::Contains(16e-3));
  for (std::size_t i = 1; i < planes.size(); ++i) EXPECT_GT(planes[i] - planes[i - 1], 1e-5);
}

// The layers next to the clamped end and on both sides of the interface are the finest, and no
// layer is thicker than asked.
TEST(CylinderMesh, GradesItsLayersTowardsClampAndInterface) {
  const Cilium cilium = stub_and_magnet();
  const CylinderMeshOptions options;
  const std::vector<double> planes = layer_planes(cilium, options);
  double thickest = 0;
  for (std::size_t i = 1; i < planes.size(); ++i) {
    const double thickness = (planes[i] - planes[i - 1]) / cilium.diameter;
    thickest = std::max(thickest, thickness);
    if (planes[i - 1] == 0 || planes[i - 1] == 3e-3 || planes[i] == 3e-3) {
      EXPECT_LT(thickness, 1.3 * options.finest_layer);
    }
  }
  EXPECT_LT(thickest, 1.05 * options.coarsest_layer);
  EXPECT_GT(thickest, 0.8 * options.coarsest_layer);
}

// Every cell lies in one segment, which is its material; every inner face has two neighbours with
// the same vertices (conformity); base, mantle and tip are where they should be.
TEST(CylinderMesh, ConformsToSegmentsAndNamesItsBoundaries) {
  const Cilium cilium = stub_and_magnet();
  dealii::Triangulation<3> triangulation;
  make_cylinder(cilium, {}, triangulation);
  const std::vector<double> interfaces = cilium.interfaces();
  for (const auto& cell : triangulation.active_cell_iterators()) {
    const std::size_t segment = cell->material_id();
    for (const unsigned int v : cell->vertex_indices()) {
      EXPECT_GE(cell->vertex(v)[2], interfaces.at(segment) * (1 - 1e-12));
      EXPECT_LE(cell->vertex(v)[2], interfaces.at(segment + 1) * (1 + 1e-12));
    }
    for (const auto& face : cell->face_iterators()) {
      if (!face->at_boundary()) continue;
      const dealii::Point<3> centre = face->center(true);
      if (face->boundary_id() == base_id) {
        EXPECT_NEAR(centre[2], 0, 1e-13);
      } else if (face->boundary_id() == tip_id) {
        EXPECT_NEAR(centre[2], 20e-3, 1e-13);
      } else {
        EXPECT_EQ(face->boundary_id(), mantle_id);
        EXPECT_NEAR(std::hypot(centre[0], centre[1]), 1.5e-3, 1e-7);
      }
    }
  }
}

// The flow and contact loads integrate along ζ at constant X and Y.
TEST(CylinderMesh, HasStraightLinesAlongTheAxis) {
  dealii::Triangulation<3> triangulation;
  make_cylinder(stub_and_magnet(), {}, triangulation);
  const auto mapping = cylinder_mapping(triangulation);
  for (const auto& cell : triangulation.active_cell_iterators()) {
    const auto at = [&](double zeta) {
      return mapping->transform_unit_to_real_cell(cell, dealii::Point<3>(0.83, 0.37, zeta));
    };
    const dealii::Point<3> bottom = at(0);
    const dealii::Point<3> middle = at(0.4);
    EXPECT_NEAR(middle[0], bottom[0], 1e-14);
    EXPECT_NEAR(middle[1], bottom[1], 1e-14);
    EXPECT_NEAR(middle[2], 0.6 * bottom[2] + 0.4 * at(1)[2], 1e-14);
  }
}

// Oracle: the whole mesh. Its cells with Y > 0, their nodes and ids, and no others; the cut is the
// symmetry boundary and nothing else is.
TEST(CylinderMesh, HalfIsTheHalfOfTheWholeMesh) {
  for (const unsigned int n : {2U, 4U}) {
    CylinderMeshOptions options;
    options.square_cells = n;
    dealii::Triangulation<3> whole;
    make_cylinder(stub_and_magnet(), options, whole);
    options.half = true;
    dealii::Triangulation<3> half;
    make_cylinder(stub_and_magnet(), options, half);
    EXPECT_EQ(2 * half.n_active_cells(), whole.n_active_cells());
    const auto whole_mapping = cylinder_mapping(whole);
    const auto half_mapping = cylinder_mapping(half);
    const dealii::Point<3> inside(0.2, 0.7, 0.4);
    for (const auto& cell : half.active_cell_iterators()) {
      double distance = std::numeric_limits<double>::infinity();
      const auto point = half_mapping->transform_unit_to_real_cell(cell, inside);
      EXPECT_GT(point[1], 0);
      for (const auto& other : whole.active_cell_iterators())
        if (other->center().distance(cell->center()) < 1e-12) {
          EXPECT_EQ(other->material_id(), cell->material_id());
          distance = whole_mapping->transform_unit_to_real_cell(other, inside).distance(point);
        }
      EXPECT_LT(distance, 1e-15);
      for (const auto& face : cell->face_iterators()) {
        if (!face->at_boundary()) continue;
        const bool on_cut = std::abs(face->center()[1]) < 1e-9;
        EXPECT_EQ(face->boundary_id() == symmetry_id, on_cut);
      }
    }
  }
}

TEST(CylinderMesh, RejectsWhatItCannotMesh) {
  dealii::Triangulation<3> triangulation;
  const auto rejects = [&](const CylinderMeshOptions& options) {
    EXPECT_THROW(make_cylinder(stub_and_magnet(), options, triangulation), InputError);
  };
  const auto with = []<typename T>(T CylinderMeshOptions::*member, std::type_identity_t<T> value) {
    CylinderMeshOptions options;
    options.*member = value;
    return options;
  };
  rejects(with(&CylinderMeshOptions::square_cells, 3));
  rejects(with(&CylinderMeshOptions::square_cells, 0));
  rejects(with(&CylinderMeshOptions::rings, 0));
  rejects(with(&CylinderMeshOptions::finest_layer, 0));
  rejects(with(&CylinderMeshOptions::finest_layer, 1));
  rejects(with(&CylinderMeshOptions::growth, std::numeric_limits<double>::quiet_NaN()));
  rejects(with(&CylinderMeshOptions::planes, {21e-3}));
  rejects(with(&CylinderMeshOptions::planes, {-1e-3}));
  EXPECT_THROW(make_cylinder({3e-3, {}}, {}, triangulation), InputError);
}

}  // namespace
}  // namespace ciliaval::meshes::cylinder

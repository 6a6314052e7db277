// SPDX-License-Identifier: LGPL-2.1-or-later
// The solid in parts, on the ranks that mpirun has started. Oracle: the same solid, whole on every
// rank. Sums are in another order.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "fem/parallel.h"
#include "fem/solid/discretisation/assembly.h"
#include "fem/solid/discretisation/row_range.h"
#include "fem/solid/equilibrium/initial_guess.h"
#include "fem/solid/loads/dead_forces.h"
#include "fem/solid/loads/external_forces.h"
#include "fem/solid/loads/height_loads.h"
#include "fem/solid/loads/probe.h"
#include "fem/solid/postprocessing/body.h"
#include "fem/solid/postprocessing/centreline.h"
#include "fem/solid/postprocessing/mantle.h"
#include "fem/solid/solvers/linear_solver.h"
#include "meshes/cylinder/cylinder_mesh.h"
#include "meshes/gmsh/gmsh_mesh.h"
#include "meshes/gmsh/write_gmsh.h"
#include "meshes/mesh_nodes.h"
#include "tests/support/temporary_folder.h"

namespace ciliaval::fem::solid {
using namespace discretisation;
namespace {

constexpr double rounding = 1e-11;  // of sums in another order

Cilium two_segments() {
  return {3e-3, {{"a", 3e-3, 1e5, 0.49, 0, 1000}, {"b", 5e-3, 3e5, 0.49, 75e3, 1700}}};
}

/// Bent and twisted, with something of every direction.
Vector3 displacement(const Vector3& X) {
  const double s = X.z() / 8e-3;
  return {3e-3 * s * s + 1e-5 * std::sin(4e3 * X.y()), 2e-2 * s * X.x() + 1e-4 * s,
          -0.3 * s * X.x() - 5e-4 * s * s};
}

/// A mesh of the cilium with the displacement above.
struct Meshed {
  Cilium cilium = two_segments();
  std::vector<material::Hyperelastic> materials{
      material::Hyperelastic::mooney_rivlin(3.4e4, 1.7e6, 0.25),
      material::Hyperelastic::yeoh(1e5, 5e6, -0.1, 0.01)};
  std::unique_ptr<dealii::Triangulation<3>> triangulation;
  std::unique_ptr<dealii::MappingQCache<3>> mapping;
  std::unique_ptr<SolidSpace> space;
  std::unique_ptr<ExtrudedQuadrature> quadrature;
  SolidState state;

  Meshed(bool in_parts, bool half, double layer = 0.7) {
    meshes::cylinder::CylinderMeshOptions options;
    options.square_cells = 2;
    options.rings = 1;
    options.finest_layer = options.coarsest_layer = layer;
    options.planes = {5e-3};
    options.half = half;
    triangulation =
        meshes::cylinder::make_cylinder(cilium, options, in_parts ? MPI_COMM_WORLD : MPI_COMM_SELF);
    mapping = meshes::cylinder::cylinder_mapping(*triangulation);
    space = std::make_unique<SolidSpace>(*triangulation, *mapping, materials);
    quadrature = std::make_unique<ExtrudedQuadrature>(*space, half ? Extent::half : Extent::whole);
    state = space->undeformed();
    for (const SolidElement& element : space->elements())
      for (std::size_t a = 0; a < element_nodes; ++a)
        for (std::size_t c = 0; c < 3; ++c)
          state.displacement.local_element(element.dofs[c * element_nodes + a]) =
              displacement(element.nodes.row(static_cast<Eigen::Index>(a))
                               .transpose())[static_cast<Eigen::Index>(c)];
    state.displacement.update_ghost_values();
    project_pressure(*space, state);
  }
};

class Parts : public testing::TestWithParam<bool> {
 protected:
  Meshed parts{true, GetParam()};
  Meshed whole{false, GetParam()};

  const SolidElement& twin(const SolidElement& element) const {
    return whole.space->elements()[element.cell->id().get_coarse_cell_id()];
  }
  void expect_same(const Vector& in_parts, const Vector& expected) const {
    in_parts.update_ghost_values();
    const double scale = expected.linfty_norm();
    for (const SolidElement& element : parts.space->elements())
      EXPECT_LE(
          (nodal_displacements(element, in_parts) - nodal_displacements(twin(element), expected))
              .cwiseAbs()
              .maxCoeff(),
          rounding * scale);
  }
  static void expect_near(const Vector3& a, const Vector3& b, double scale) {
    EXPECT_LE((a - b).norm(), rounding * scale) << a.transpose() << " and " << b.transpose();
  }
};
INSTANTIATE_TEST_SUITE_P(Extents, Parts, testing::Bool());

// Oracle: the same file, read whole.
TEST(UserMeshInParts, HasTheCellsOfTheFile) {
  const test::TemporaryFolder folder;
  const Meshed written{false, false};
  const Cilium cilium = two_segments();
  const auto file = folder.path() / "cilium.msh";
  meshes::gmsh::write_gmsh(meshes::mesh_nodes(*written.triangulation, *written.mapping), cilium,
                           file);
  const meshes::gmsh::GmshMesh all = meshes::gmsh::read_gmsh({file}, cilium);
  const SolidSpace whole(*all.triangulation, *all.mapping, written.materials);
  std::size_t nodes = 0;
  const meshes::gmsh::GmshMesh mesh =
      meshes::gmsh::read_gmsh({file}, cilium, [&nodes](std::size_t count) {
        nodes = count;
        return MPI_COMM_WORLD;
      });
  const SolidSpace space(*mesh.triangulation, *mesh.mapping, written.materials);
  EXPECT_EQ(node_unknowns * nodes, whole.unknowns());
  EXPECT_EQ(space.unknowns(), whole.unknowns());
  const std::size_t own = space.own_elements().size();
  EXPECT_EQ(dealii::Utilities::MPI::sum(own, MPI_COMM_WORLD), whole.elements().size());
  if (rank_count() > 1) {
    EXPECT_LT(own, whole.elements().size());
  }
  for (const SolidElement& element : space.elements()) {
    const SolidElement& twin = whole.elements()[element.cell->id().get_coarse_cell_id()];
    EXPECT_EQ(element.cell->material_id(), twin.cell->material_id());
    EXPECT_LE((element.nodes - twin.nodes).norm(), 1e-15);
  }
}

TEST_P(Parts, HaveEachCellOnceAndTheWholesArea) {
  const std::size_t own = parts.space->own_elements().size();
  EXPECT_EQ(dealii::Utilities::MPI::sum(own, MPI_COMM_WORLD), whole.space->elements().size());
  EXPECT_EQ(parts.space->unknowns(), whole.space->unknowns());
  EXPECT_GT(own, 0U);
  if (rank_count() > 1) {
    EXPECT_LT(own, whole.space->elements().size());
  }
  for (const SolidElement& element : parts.space->elements())
    EXPECT_LE((element.nodes - twin(element).nodes).norm(), 1e-15);
  EXPECT_NEAR(parts.quadrature->area(), whole.quadrature->area(), 1e-14 * whole.quadrature->area());
  EXPECT_EQ(parts.quadrature->height(), whole.quadrature->height());
}

TEST_P(Parts, HaveTheForcesOfTheWhole) {
  const auto own = internal_forces(*parts.space, parts.state);
  const auto expected = internal_forces(*whole.space, whole.state);
  ASSERT_TRUE(own && expected);
  expect_same(own->forces, expected->forces);
  expect_same(own->condensed, expected->condensed);
  EXPECT_NEAR(elastic_energy(*parts.space, parts.state), elastic_energy(*whole.space, whole.state),
              rounding * elastic_energy(*whole.space, whole.state));
  const auto same_load = [this](const Load& load) {
    const auto forces = [&load](const Meshed& meshed) {
      return loads::forces_at(
          meshed.state.displacement, *meshed.space,
          loads::external_forces(*meshed.space, *meshed.quadrature, meshed.cilium, load, 0.5e-3));
    };
    const Vector of_whole = forces(whole);
    expect_same(forces(parts), of_whole);
    expect_near(loads::resultant(*parts.space, forces(parts)),
                loads::resultant(*whole.space, of_whole), of_whole.l2_norm());
  };
  same_load(ContactLoad{.force = 1e-3, .height = 4e-3, .azimuth = 0.3});
  same_load(FlowLoad{.force_per_height = 0.1, .azimuth = 0.3});
  same_load(SectionLoad{.force = 1e-3, .arclength = 5e-3, .azimuth = 0.3});
  same_load(DeadLoad{.force_per_length = 0.1, .azimuth = 0.3});
  surroundings::Environment environment;
  environment.gravity = Vector3(1, 2, -9.81);
  environment.uniform_field = Vector3(0.01, 0.02, 0.03);
  environment.magnetic_energy = surroundings::MagneticEnergy::R;
  environment.magnets.push_back({"cuboid",
                                 surroundings::magnets::Shape::cuboid,
                                 Vector3(15e-3, 2e-3, 4e-3),
                                 Quaternion::Identity(),
                                 0,
                                 0,
                                 {6e-3, 4e-3, 5e-3},
                                 {6e5, 0, -6e5}});
  same_load(
      with_environment(ContactLoad{.force = 1e-3, .height = 4e-3, .azimuth = 0.3}, environment));
}

TEST_P(Parts, MeasureTheProbesDisplacementAsTheWhole) {
  const auto kernel = loads::contact_density(1, 1, 4e-3, 0.5e-3);
  const auto mean = [&](const Meshed& meshed, Vector& gradient) {
    return loads::mean_displacement(*meshed.space, *meshed.quadrature, kernel, Vector3::UnitX(),
                                    meshed.state.displacement, &gradient);
  };
  Vector own = parts.space->vector();
  Vector expected = whole.space->vector();
  EXPECT_NEAR(mean(parts, own), mean(whole, expected), rounding * 1e-3);
  expect_same(own, expected);
}

TEST_P(Parts, SolveAsTheWhole) {
  const auto solution = [](const Meshed& meshed, solvers::SolverKind kind) {
    std::vector<DirichletCondition> supports{{.boundary = meshes::base_id}};
    supports.push_back({.boundary = meshes::symmetry_id, .components = {false, true, false}});
    if (meshed.quadrature->extent() == Extent::whole) supports.pop_back();
    const auto constraints = increment_constraints(*meshed.space, supports);
    solvers::LinearSolver solver(*meshed.space, constraints, kind, MPI_COMM_SELF);
    const SolidState rest = meshed.space->undeformed();
    const auto external =
        loads::external_forces(*meshed.space, *meshed.quadrature, meshed.cilium,
                               FlowLoad{.force_per_height = 0.1, .azimuth = 0}, 0.5e-3);
    TangentMatrix& tangent = solver.new_tangent();
    add_stiffness(*meshed.space, rest, internal_forces(*meshed.space, rest).value(), tangent,
                  solver.cells());
    Vector unused = meshed.space->vector();
    external(rest.displacement, unused, &tangent);
    solver.prepare();
    Vector rhs = loads::forces_at(rest.displacement, *meshed.space, external);
    constraints.set_zero(rhs);
    Vector x;
    solver.solve(rhs, x, 1e-12);
    return x;
  };
  const Vector expected = solution(whole, solvers::SolverKind::direct);
  const Vector own = solution(parts, solvers::SolverKind::iterative);
  own.update_ghost_values();
  for (const SolidElement& element : parts.space->elements())
    EXPECT_LE(
        (nodal_displacements(element, own) - nodal_displacements(twin(element), expected)).norm(),
        1e-8 * expected.linfty_norm());
}

TEST_P(Parts, HaveTheCentrelineOfTheWhole) {
  const auto line = [](const Meshed& meshed) {
    return postprocessing::centreline(
        *meshed.space, *meshed.quadrature, meshed.state,
        loads::spread_load(meshed.cilium, ContactLoad{.force = 1e-3, .height = 4e-3, .azimuth = 0},
                           meshed.quadrature->area(), 0.5e-3));
  };
  const Centreline own = line(parts);
  const Centreline expected = line(whole);
  ASSERT_EQ(own.pieces().size(), expected.pieces().size());
  double force = 0;  // the largest
  for (const auto& piece : expected.pieces())
    for (const SectionState& state : piece.states)
      force = std::max(force, state.forces.force.norm());
  for (std::size_t i = 0; i < own.pieces().size(); ++i) {
    ASSERT_EQ(own.pieces()[i].S, expected.pieces()[i].S);
    for (std::size_t k = 0; k < own.pieces()[i].states.size(); ++k) {
      const SectionState& a = own.pieces()[i].states[k];
      const SectionState& b = expected.pieces()[i].states[k];
      expect_near(a.position, b.position, 8e-3);
      EXPECT_LE(a.rotation.angularDistance(b.rotation), 1e-7);  // √ε: by an arc cosine
      expect_near(a.forces.force, b.forces.force, force);
      expect_near(a.forces.moment, b.forces.moment, force * 8e-3);
    }
  }
  expect_near(postprocessing::tip_position(*parts.space, *parts.quadrature, parts.state),
              postprocessing::tip_position(*whole.space, *whole.quadrature, whole.state), 8e-3);
}

TEST_P(Parts, GatherTheBodyOfTheWhole) {
  const SolidBody own =
      postprocessing::solid_body(*parts.space, *parts.quadrature, parts.cilium, parts.state);
  const SolidBody expected =
      postprocessing::solid_body(*whole.space, *whole.quadrature, whole.cilium, whole.state);
  ASSERT_EQ(own.cells.size(), expected.cells.size());
  ASSERT_EQ(own.charged_faces.size(), expected.charged_faces.size());
  const auto volume_and_moment = [](const SolidBody& body) {
    double stress = 0;
    Vector3 sum = Vector3::Zero();
    for (const SolidCell& cell : body.cells) {
      for (const Vector3& x : cell.current) sum += x;
      for (const Matrix3& sigma : cell.cauchy_stress) stress += sigma.norm();
      for (const double J : cell.jacobian) stress += 1e5 * J;
    }
    Vector3 charges = Vector3::Zero();
    for (const ChargedFace& face : body.charged_faces)
      for (const Vector3& x : face.current) charges += face.magnetization_jump.z() * x;
    return std::tuple(sum, charges, stress);
  };
  const auto [sum, charges, stress] = volume_and_moment(own);
  const auto [whole_sum, whole_charges, whole_stress] = volume_and_moment(expected);
  expect_near(sum, whole_sum, whole_sum.norm());
  expect_near(charges, whole_charges, whole_charges.norm());
  EXPECT_NEAR(stress, whole_stress, rounding * whole_stress);
  const auto compression =
      postprocessing::mantle_compression(*parts.space, parts.cilium, parts.state);
  EXPECT_NEAR(compression.ratio,
              postprocessing::mantle_compression(*whole.space, whole.cilium, whole.state).ratio,
              1e-9);
}

TEST_P(Parts, TakeAStateFromAMeshInOtherParts) {
  const Meshed fine(true, GetParam(), 0.31);
  const Meshed fine_whole(false, GetParam(), 0.31);
  const SolidState expected =
      equilibrium::interpolated(*whole.space, *whole.quadrature, whole.state, *fine_whole.space);
  for (const Meshed* from : {&parts, &whole}) {
    const SolidState own =
        equilibrium::interpolated(*from->space, *from->quadrature, from->state, *fine.space);
    for (std::size_t e = 0; e < fine.space->elements().size(); ++e) {
      const SolidElement& element = fine.space->elements()[e];
      const auto number = element.cell->id().get_coarse_cell_id();
      EXPECT_LE((nodal_displacements(element, own.displacement) -
                 nodal_displacements(fine_whole.space->elements()[number], expected.displacement))
                    .norm(),
                rounding * 1e-3);
      EXPECT_LE((own.pressure[e] - expected.pressure[number]).norm(), rounding * 1e6);
    }
  }
}

}  // namespace
}  // namespace ciliaval::fem::solid

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ciliaval::fem::start_mpi();
  return RUN_ALL_TESTS();
}

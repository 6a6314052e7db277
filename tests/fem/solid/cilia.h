// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/dofs/dof_tools.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "fem/solid/discretisation/assembly.h"
#include "fem/solid/equilibrium/load_path.h"
#include "fem/solid/loads/height_loads.h"
#include "fem/solid/solid_options.h"
#include "meshes/cylinder/cylinder_mesh.h"
#include "problem/mechanics_model.h"

namespace ciliaval::fem::solid {

inline SolidOptions coarse() {
  return {.refinement = 0};
}

/// The paper's cilium of fig. 3.
inline Cilium stub_and_magnet() {
  return {3e-3, {{"base", 3e-3, 0.1e6, 0.49, 0, 1000}, {"magnet", 17e-3, 3e6, 0.49, 75e3, 1700}}};
}

/// L/d = 20, ν = 0: no bonded end that cannot contract. EI/L² = 1 N, A M L²/EI = 1 per T, ρA = 1
/// kg/m.
inline Cilium slender() {
  const double d = 0.05;
  Segment segment{"rod", 1, 64 / (std::numbers::pi * std::pow(d, 4)), 0,
                  4 / (std::numbers::pi * d * d)};
  segment.density = 4 / (std::numbers::pi * d * d);
  return {d, {segment}};
}

inline MechanicsStep solved(const MechanicsModel& model, const Cilium& cilium, const Load& load) {
  const MechanicsStep step = model.solve(cilium, {load}).steps.at(0);
  EXPECT_EQ(step.status, Status::converged) << step.message;
  return step;
}

inline Vector3 tip(const MechanicsStep& step) {
  const Centreline& line = step.deformation.value().centreline;
  return line.at(line.length()).position;
}

/// The environment alone.
inline Load in(const surroundings::Environment& environment, double azimuth = 0) {
  return with_environment(EnvironmentLoad{1, azimuth}, environment);
}

inline constexpr std::array laws{surroundings::MagneticEnergy::F, surroundings::MagneticEnergy::R};

/// A coarse cilium, bent by hand: no equilibrium is needed to check forces and their derivatives.
struct BentCilium {
  Cilium cilium{3e-3, {{"a", 3e-3, 1e5, 0.49, 0, 1000}, {"b", 5e-3, 3e5, 0.49, 75e3, 1700}}};
  dealii::Triangulation<3> triangulation;
  std::unique_ptr<dealii::MappingQCache<3>> mapping;
  std::vector<material::Hyperelastic> materials{
      material::Hyperelastic::mooney_rivlin(3.4e4, 1.7e6, 0.25),
      material::Hyperelastic::yeoh(1e5, 5e6, -0.1, 0.01)};
  std::unique_ptr<discretisation::SolidSpace> space;
  std::unique_ptr<discretisation::ExtrudedQuadrature> quadrature;
  discretisation::SolidState state;

  BentCilium() {
    meshes::cylinder::CylinderMeshOptions options;
    options.square_cells = 2;
    options.rings = 1;
    options.finest_layer = options.coarsest_layer = 0.7;
    options.planes = {5e-3};
    meshes::cylinder::make_cylinder(cilium, options, triangulation);
    mapping = meshes::cylinder::cylinder_mapping(triangulation);
    space = std::make_unique<discretisation::SolidSpace>(triangulation, *mapping, materials);
    quadrature = std::make_unique<discretisation::ExtrudedQuadrature>(*space);
    state = space->undeformed();
    bend();
    project_pressure(*space, state);
  }

  /// An arc of 0.5 rad with a little noise, so that nothing cancels by symmetry.
  void bend() {
    std::mt19937 generator(11);
    std::uniform_real_distribution<double> noise(-2e-5, 2e-5);
    std::vector<dealii::Point<3>> support(space->unknowns());
    dealii::DoFTools::map_dofs_to_support_points<3, 3>(*mapping, space->dof_handler(), support);
    const double kappa = 0.5 / 8e-3;
    for (const discretisation::SolidElement& element : space->elements()) {
      for (std::size_t a = 0; a < discretisation::element_nodes; ++a) {
        const auto X = support.at(element.dofs[a]);
        const double theta = kappa * X[2];
        const Vector3 x((1 - std::cos(theta)) / kappa + X[0] * std::cos(theta), X[1],
                        std::sin(theta) / kappa - X[0] * std::sin(theta));
        for (std::size_t c = 0; c < 3; ++c) {
          double& u = state.displacement[element.dofs[c * discretisation::element_nodes + a]];
          if (u == 0)
            u = x[static_cast<Eigen::Index>(c)] - X[static_cast<unsigned int>(c)] +
                noise(generator);
        }
      }
    }
  }

  discretisation::Vector forces(const Load& load, const discretisation::Vector& u) const {
    discretisation::Vector result(space->unknowns());
    loads::external_forces(*space, *quadrature, cilium, load, 0.5e-3)(u, result, nullptr);
    return result;
  }
};

}  // namespace ciliaval::fem::solid

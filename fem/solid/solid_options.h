// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <filesystem>

#include "fem/solid/solvers/solver_kind.h"

namespace ciliaval::fem::solid {

/// Start of Newton's method on the coarsest mesh.
enum class InitialGuess {
  beam,  ///< the beam's solution at the same load
  none   ///< the last equilibria: the straight cilium at first
};

struct SolidOptions {
  /// Energy of all segments (fem/solid/material/hyperelastic.h). Their E and ν fix the initial
  /// shear modulus and the bulk modulus; the ratios say the rest.
  enum class Material { neo_hooke, mooney_rivlin, yeoh };
  Material material = Material::neo_hooke;
  double mooney_ratio = 0.25;                     ///< C₀₁/C₁₀ of Mooney–Rivlin
  std::array<double, 2> yeoh_ratios{-0.1, 0.01};  ///< C₂₀/C₁₀ and C₃₀/C₁₀ of Yeoh
  unsigned int refinement = 1;  ///< mesh: 0 coarse, 1 default, 2 fine (cylinder_mesh_options())
  InitialGuess initial_guess = InitialGuess::beam;
  bool symmetry = true;  ///< mesh only one side of the bending plane, which mirrors the other
  std::filesystem::path mesh{};  ///< a Gmsh file (docs/guide/meshes.md) instead of the built-in
                                 ///< mesh: refinement and symmetry do nothing, and it does not turn
  double mesh_unit = 1;          ///< length of that file's unit, m
  double kernel_width = 0.5e-3;  ///< half-width of the contact kernel k(z−h), m
  double newton_tolerance =
      1e-9;  ///< of the residual, relative to the applied force, and of the increment
  unsigned int max_iterations = 25;
  unsigned int max_cutbacks = 5;
  solvers::SolverKind solver = solvers::SolverKind::automatic;  ///< of the linear systems
};

}  // namespace ciliaval::fem::solid

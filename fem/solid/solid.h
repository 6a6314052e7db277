// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>

#include "fem/solid/solvers/solver_kind.h"
#include "problem/load.h"
#include "problem/mechanics_model.h"

namespace ciliaval::meshes {
struct CylinderMeshOptions;
}

namespace ciliaval::fem {

/// What Newton's method starts from on the coarsest mesh.
enum class InitialGuess {
  beam,  ///< the beam's solution at the same load
  none   ///< the last equilibria: the straight cilium at first
};

struct SolidOptions {
  /// Energy of all segments (fem/solid/material.h). Their E and ν fix the initial shear modulus and
  /// the bulk modulus; the ratios say the rest.
  enum class Material { neo_hooke, mooney_rivlin, yeoh };
  Material material = Material::neo_hooke;
  double mooney_ratio = 0.25;                     ///< C₀₁/C₁₀ of Mooney–Rivlin
  std::array<double, 2> yeoh_ratios{-0.1, 0.01};  ///< C₂₀/C₁₀ and C₃₀/C₁₀ of Yeoh
  unsigned int refinement = 1;  ///< mesh: 0 coarse, 1 default, 2 fine (cylinder_mesh_options())
  InitialGuess initial_guess = InitialGuess::beam;
  bool symmetry = true;  ///< mesh only one side of the bending plane, which mirrors the other
  std::filesystem::path mesh{};  ///< a Gmsh file (docs/meshes.md) instead of the built-in mesh:
                                 ///< refinement and symmetry do nothing, and it does not turn
  double mesh_unit = 1;          ///< length of that file's unit, m
  double kernel_width = 0.5e-3;  ///< half-width of the contact kernel k(z−h), m
  double tolerance =
      1e-9;  ///< of the residual, relative to the applied force, and of the increment
  unsigned int max_iterations = 25;
  unsigned int max_cutbacks = 5;
  SolverKind solver = SolverKind::automatic;  ///< of the linear systems
};

/// The mesh of a refinement. Throws InputError if there is none of that number.
meshes::CylinderMeshOptions cylinder_mesh_options(unsigned int refinement);

/// The number of that mesh in the sequence of level_mesh(). Throws as above.
unsigned int mesh_level(unsigned int refinement);

/// That mesh for a load path, with a plane at each loaded section; half of it if the options say
/// so.
meshes::CylinderMeshOptions cylinder_mesh_options(const SolidOptions& options,
                                                  const LoadPath& path);

/// The sequence of meshes from coarse to fine, of which cylinder_mesh_options() are some.
inline constexpr unsigned int mesh_level_count = 6;
meshes::CylinderMeshOptions level_mesh(unsigned int level);

/// 3D finite-strain near-incompressible hyperelastic solid of the two-material cilium: Q2
/// displacement, discontinuous linear pressure, clamped base (docs/solid.md). The mesh turns with
/// the load's azimuth, so that the bending plane is always one of its planes of symmetry. A
/// sequence of coarser meshes is solved first: each gives the next one its first guess, and the
/// last two the estimate of the tip's error.
class Solid : public MechanicsModel {
 public:
  /// Throws InputError if an option is out of range.
  explicit Solid(SolidOptions options = {});

  /// Besides the interface's: throws InputError if the contact kernel h ± kernel_width does not fit
  /// between the base and the tip of the straight cilium.
  /// A contact or probe step whose fibre ends come into the kernel is `slipped_off`; slip_off_force
  /// (of a probe slip_off_displacement, with the force there) is the lower end of a 1 % bracket,
  /// which the message gives.
  MechanicsResult solve(const Cilium& cilium, const LoadPath& path,
                        const Progress& progress = {}) const override;

  std::optional<std::size_t> finished_steps(const Cilium& cilium, const LoadPath& path,
                                            const Checkpoint& checkpoint) const override;
  MechanicsResult solve_from(const Cilium& cilium, const LoadPath& path,
                             const Checkpoint& checkpoint,
                             const Progress& progress = {}) const override;

 private:
  MechanicsResult follow(const Cilium& cilium, const LoadPath& path, const Checkpoint& checkpoint,
                         const Progress& progress) const;

  SolidOptions options_;
};

}  // namespace ciliaval::fem

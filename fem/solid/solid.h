// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <mpi.h>

#include "fem/solid/solid_options.h"
#include "problem/load.h"
#include "problem/mechanics_model.h"

namespace ciliaval::meshes::cylinder {
struct CylinderMeshOptions;
}

namespace ciliaval::fem::solid {

/// The mesh of a refinement. Throws InputError if there is none of that number.
meshes::cylinder::CylinderMeshOptions cylinder_mesh_options(unsigned int refinement);

/// The number of that mesh in the sequence of level_mesh(). Throws as above.
unsigned int mesh_level(unsigned int refinement);

/// That mesh for a load path, with a plane at each loaded section; half of it if the options say
/// so.
meshes::cylinder::CylinderMeshOptions cylinder_mesh_options(const SolidOptions& options,
                                                            const LoadPath& path);

/// The sequence of meshes from coarse to fine, of which cylinder_mesh_options() are some.
inline constexpr unsigned int mesh_level_count = 5;
meshes::cylinder::CylinderMeshOptions level_mesh(unsigned int level);

/// 3D finite-strain near-incompressible hyperelastic solid of the two-material cilium: Q2
/// displacement, discontinuous linear pressure, clamped base (docs/theory/solid.md). The mesh turns
/// with the load's azimuth, so that the bending plane is always one of its planes of symmetry. A
/// sequence of coarser meshes is solved first: each gives the next one its initial guess. The next
/// coarser one, the coarsest, and the coarsest with twice the arcs are the result's companions.
class Solid : public MechanicsModel {
 public:
  /// The ranks of the communicator share each solution. Throws InputError if an option is out of
  /// range.
  explicit Solid(SolidOptions options = {}, MPI_Comm communicator = MPI_COMM_WORLD);

  /// Besides the interface's: throws InputError if the contact kernel h ± kernel_width does not fit
  /// between the base and the tip of the straight cilium.
  /// A contact or probe step whose extrusion lines end in the kernel is `slipped_off`;
  /// slip_off_force (of a probe slip_off_displacement, with the force there) is the lower end of a
  /// 1 % bracket, which the message gives.
  MechanicsResult solve(const Cilium& cilium, const LoadPath& path,
                        const Progress& progress = {}) const override;

  MechanicsResult solve_from(const Cilium& cilium, const LoadPath& path,
                             const Checkpoint& checkpoint,
                             const Progress& progress = {}) const override;

 private:
  SolidOptions options_;
  MPI_Comm communicator_;
};

}  // namespace ciliaval::fem::solid

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>

#include "problem/mechanics_model.h"

namespace ciliaval::fem::calculix {

struct CalculixOptions {
  unsigned int refinement = 1;            ///< of the solid's half meshes (cylinder_mesh_options())
  bool error_estimate = true;             ///< solve the next coarser mesh too, for tip_uncertainty
  double first_increment = 0.25;          ///< of the load; CalculiX cuts it back or lets it grow
  unsigned int threads = 1;               ///< of CalculiX
  double time_limit = 3600;               ///< of one run of CalculiX, s
  std::filesystem::path program = "ccx";  ///< a name in PATH, or a path with a slash
  std::filesystem::path keep{};  ///< folder in which CalculiX's files stay; empty: they are removed
};

/// CalculiX as a referee (docs/guide/referees.md): the same cilium, mesh and neo-Hooke solid as
/// fem::solid::Solid's, solved by another program with another element, C3D20R. The solid's code
/// makes the centreline and the body from its displacements; section forces are by statics and the
/// pressure is K(J − 1) of the displacements.
///
/// Each step with a force is a run of its own from the straight cilium, in a private folder. Under
/// MPI rank 0 runs CalculiX and all ranks have its result; solve() is collective.
class Calculix : public MechanicsModel {
 public:
  /// Throws InputError if an option is out of range.
  explicit Calculix(CalculixOptions options = {});

  /// Besides the interface's: throws InputError for a load that is neither `section` nor `dead`. A
  /// step for which CalculiX is missing, cannot be started, fails, takes too long or leaves damaged
  /// files has failed, with a message that says which.
  MechanicsResult solve(const Cilium& cilium, const LoadPath& path,
                        const Progress& progress = {}) const override;

 private:
  CalculixOptions options_;
};

}  // namespace ciliaval::fem::calculix

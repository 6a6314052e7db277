// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "meshes/mesh_nodes.h"
#include "problem/cilium.h"
#include "problem/surroundings/surface.h"
#include "problem/types.h"

namespace ciliaval::fem::calculix {

/// A sweep by CalculiX on half of the solid's mesh: the rigid surface is a plate of C3D20 elements
/// whose nodes are all prescribed, the nodes of the tip's face touch it (contact of nodes with
/// faces, by penalty).
struct RefereeSweep {
  Cilium cilium;
  unsigned int refinement = 0;  ///< of the solid's meshes
  surroundings::Surface surface;
  double interference = 0;      ///< δ, m
  std::vector<double> travels;  ///< s of the samples, increasing, m
  double stiffness = 1e11;      ///< pressure over penetration, N/m³; ten times as much: N changes
                                ///< by 0.01 %, x by 0.03 %
  double holding_force = 5e-3;  ///< that first bends the tip to below the surface, N
  double run_in = 1.5e-3;       ///< travel of the surface while that force is taken away, m
  double increment = 0.1;       ///< the largest part of a step that is done at once
};

/// The state of the whole cilium at a sample.
struct SweepState {
  double normal_force = 0;        ///< N, N
  double friction_force = 0;      ///< T along e, N
  Vector3 tip = Vector3::Zero();  ///< mean position of the tip's face, m
  double angle = 0;               ///< of the tip from the z axis, towards e, rad
};

/// The samples. Throws SolverError if ccx fails.
std::vector<SweepState> run_referee(const RefereeSweep& sweep, const std::filesystem::path& folder);

}  // namespace ciliaval::fem::calculix

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "problem/mechanics_model.h"

namespace ciliaval::fem {

struct BeamOptions {
  unsigned int degree = 3;      ///< of the interpolation of position and rotation
  unsigned int refinement = 1;  ///< each step halves the elements
  bool shear_rigid = false;     ///< no shear and no extension: the elastica's assumptions
  double tolerance = 1e-12;     ///< of the residual and the increment, relative
  unsigned int max_iterations = 30;
  unsigned int max_cutbacks = 8;
};

/// Geometrically exact (Simo–Reissner) beam: bending, torsion, shear and extension, finite 3D
/// rotations.
class Beam : public MechanicsModel {
 public:
  explicit Beam(BeamOptions options = {}) : options_(options) {}
  MechanicsResult solve(const Cilium& cilium, const LoadPath& path,
                        const Progress& progress = {}) const override;

 private:
  BeamOptions options_;
};

}  // namespace ciliaval::fem

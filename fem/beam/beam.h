// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "problem/joints/joints.h"
#include "problem/mechanics_model.h"

namespace ciliaval::fem::beam {

/// Part of the tip that a surface touches: the ends of the end section's diameter in the plane of
/// the sweep and the line between them, or the end of the centreline.
enum class TipShape { rim, point };

struct BeamOptions {
  unsigned int degree = 6;      ///< of the interpolation of position and rotation
  unsigned int refinement = 1;  ///< each step halves the elements; 0 is one element between breaks
  bool shear_rigid = false;     ///< no shear and no extension: the elastica's assumptions
  double tolerance = 1e-12;     ///< of the residual and the increment, relative
  unsigned int max_iterations = 30;
  unsigned int max_cutbacks = 8;
  TipShape tip = TipShape::rim;  ///< of a sweep
  bool error_estimate = true;    ///< by a companion of a higher degree; over half of the work
  /// Correction of the joints, under other loads than a sweep. With error_estimate the error
  /// includes the corrections' uncertainty.
  joints::Correction joints = joints::Correction::none;
};

/// Geometrically exact (Simo–Reissner) beam: bending, torsion, shear and extension, finite 3D
/// rotations. The discretisation and its evidence are in docs/theory/beam.md; fem/beam/system.h is
/// the core that takes any reference curve, section and dead load.
class Beam : public MechanicsModel {
 public:
  explicit Beam(BeamOptions options = {}) : options_(options) {}
  /// Errors are estimated, where asked for, by the same path with a higher degree. A result does
  /// not depend on the steps before it. Throws InputError if an option is out of range.
  MechanicsResult solve(const Cilium& cilium, const LoadPath& path,
                        const Progress& progress = {}) const override;

 private:
  BeamOptions options_;
};

}  // namespace ciliaval::fem::beam

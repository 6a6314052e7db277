// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "problem/mechanics_model.h"

namespace ciliaval::fem {

struct SolidOptions {
  unsigned int refinement = 1;
  double kernel_width = 0.5e-3;  ///< half-width of the contact kernel k(z−h), m
  double tolerance =
      1e-9;  ///< of the residual, relative to the applied force, and of the increment
  unsigned int max_iterations = 25;
  unsigned int max_cutbacks = 5;
};

/// 3D finite-strain near-incompressible neo-Hooke solid of the two-material cilium.
class Solid : public MechanicsModel {
 public:
  explicit Solid(SolidOptions options = {}) : options_(options) {}
  MechanicsResult solve(const Cilium& cilium, const LoadPath& path,
                        const Progress& progress = {}) const override;

 private:
  SolidOptions options_;
};

}  // namespace ciliaval::fem

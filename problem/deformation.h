// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <memory>

#include "problem/centreline.h"
#include "problem/solid_body.h"

namespace ciliaval {

/// The shape that every mechanics model hands back: the centreline and, from a solid model, the
/// body. Models are compared at common material points S, never mesh point against mesh point.
struct Deformation {
  Centreline centreline;
  std::shared_ptr<const SolidBody> body;  ///< null for rods
};

/// The deformation turned as a whole, reference and current configuration, by the angle (rad) about
/// the z axis. Section rotations become Q Λ Qᵀ, stresses Q σ Qᵀ.
Deformation turned(const Deformation& deformation, double angle);

}  // namespace ciliaval

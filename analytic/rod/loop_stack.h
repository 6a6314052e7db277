// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <memory>
#include <vector>

#include "analytic/rod/rod_magnet.h"
#include "analytic/sources/field_points.h"

namespace ciliaval::analytic::rod {

/// The flat slices of the paper's Eq. 8–9 as current loops: each slice of thickness dS and
/// magnetisation M d₃ is a current M dS around its edge, so that B = μ₀ ∫ M H(loop at S) dS, inside
/// the magnet as well. The integral is Gauss–Legendre of adaptive order on parts that are bisected
/// towards the field point. Parts and their loops depend on the deformation alone: each is made for
/// the first point that needs it and kept; several threads may ask at once.
class LoopStack {
 public:
  explicit LoopStack(const RodMagnet& magnet);
  ~LoopStack();
  LoopStack(const LoopStack&) = delete;
  LoopStack& operator=(const LoopStack&) = delete;

  /// B (T) at x to tolerance·|B|, as far as the orders bring it. The estimate of its error is the
  /// change from the last orders but one plus the rounding of the positions. Throws InputError on
  /// the rim of an end face, SolverError on the mantle.
  sources::FieldValue field(const Vector3& x, double tolerance) const;

 private:
  class Part;
  double gradient_bound(const Vector3& x) const;

  const RodMagnet& magnet_;
  std::vector<std::unique_ptr<Part>> roots_;  ///< one for each stretch
};

}  // namespace ciliaval::analytic::rod

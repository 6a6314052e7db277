// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <vector>

#include "fem/potential/space.h"

namespace ciliaval::fem::potential {

/// A ball of vacuum around a sensor.
struct SensorBall {
  Vector3 centre;     ///< m
  double radius = 0;  ///< m
};

/// ∇ψ at the centres of balls in which ψ is harmonic, as weighted means of ψ itself: the solid
/// harmonics of different degrees are orthogonal on each sphere, so that with y = x − centre
///
///     ∇ψ = ∫ k(|y|) y ψ dv / ∫ k y₁² dv,   k = (1 − |y|²/radius²)⁴,
///
/// for any higher derivatives. The mean of a finite-element solution converges twice as fast as its
/// gradient at a point, and the dual problem has a smooth load.
class SensorFunctional {
 public:
  SensorFunctional(const PotentialSpace& space, std::vector<SensorBall> balls);

  /// ∇ψ at each centre (A/m, one row each) of a complete ψ. Collective.
  std::vector<Vector3> gradients(const PotentialVector& complete) const;
  /// The functional Σ_s direction_s · ∇ψ(centre_s) as a load on the free nodes. Collective.
  PotentialVector load(const std::vector<Vector3>& directions) const;

 private:
  template <typename Act>
  void for_each_cell(const SensorBall& ball, const Act& act) const;

  const PotentialSpace& space_;
  std::vector<SensorBall> balls_;
};

}  // namespace ciliaval::fem::potential

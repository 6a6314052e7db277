// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/lac/affine_constraints.h>

#include <functional>

#include "fem/solid/discretisation/vector.h"
#include "fem/solid/equilibrium/newton.h"

namespace ciliaval::fem::solid::equilibrium {

/// The tangent K bordered by a force f(u, F) of unknown amplitude F and its condition g(u, F) = 0:
///
///   [ K      −∂f/∂F ] [Δu]   [ r]
///   [ ∂g/∂u   ∂g/∂F ] [ΔF] = [−g],   r = f − internal,
///
/// solved by block elimination with the factorisation of K: b = K⁻¹ ∂f/∂F once for each tangent,
/// and for each right-hand side a = K⁻¹ r, ΔF = −(g + ∂g/∂u·a)/(∂g/∂u·b + ∂g/∂F), Δu = a + ΔF b.
class BorderedSystem {
 public:
  /// x = K⁻¹ rhs, the constrained components of both zero.
  using Solve =
      std::function<void(const discretisation::Vector& rhs, discretisation::Vector& solution)>;

  /// The force must outlive the system.
  BorderedSystem(loads::UnknownForce& force, const dealii::AffineConstraints<double>& constraints)
      : force_(force), constraints_(constraints) {}

  /// Takes the tangent at the displacement u, whose inverse is `solve`. Throws SolverError if the
  /// condition does not determine the force.
  void prepare(const discretisation::Vector& u, const Solve& solve);

  /// Makes Δu at the displacement u out of a, with the tangent last prepared. Returns ΔF.
  double complete(const discretisation::Vector& u, discretisation::Vector& increment) const;

  /// g at the displacement u.
  double gap(const discretisation::Vector& u) const {
    return force_.condition(u, force_.amplitude, nullptr);
  }
  void advance(double amplitude_increment) { force_.amplitude += amplitude_increment; }

 private:
  loads::UnknownForce& force_;
  const dealii::AffineConstraints<double>& constraints_;
  discretisation::Vector gradient_;  ///< ∂g/∂u
  discretisation::Vector response_;  ///< b
  double pivot_ = 0;                 ///< ∂g/∂u·b + ∂g/∂F
};

}  // namespace ciliaval::fem::solid::equilibrium

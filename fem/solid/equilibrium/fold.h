// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>
#include <vector>

#include "fem/solid/discretisation/extruded_quadrature.h"
#include "fem/solid/discretisation/space.h"
#include "fem/solid/equilibrium/load_path.h"
#include "fem/solid/equilibrium/newton.h"
#include "problem/cilium.h"
#include "problem/load.h"

namespace ciliaval::fem::solid::equilibrium {

/// The branch of equilibria R(u, t) = 0 under t times a load and its environment. It goes on by
/// c·(u − u₀) = s, c the unit vector along the tangent du/ds:
///
///   du/ds = dt/ds b,   K b = ∂f/∂t,   dt/ds = ±1/|b|,
///
/// by Newton's method for the bordered system with t as the amplitude of an UnknownForce.
class FoldSearch {
 public:
  /// All must outlive it.
  FoldSearch(const discretisation::SolidSpace& space,
             const discretisation::ExtrudedQuadrature& quadrature, const Cilium& cilium,
             Newton& newton, const LoadPathOptions& options)
      : space_(space),
        quadrature_(quadrature),
        cilium_(cilium),
        newton_(newton),
        options_(options) {}

  /// The equilibria from the straight solid on to the fold, which is the last, where the branch
  /// turns back before t = 1; empty if it is not found to. Collective.
  std::vector<OnTheWay> find(const Load& load) const;

 private:
  class SolidBranch;

  const discretisation::SolidSpace& space_;
  const discretisation::ExtrudedQuadrature& quadrature_;
  const Cilium& cilium_;
  Newton& newton_;
  const LoadPathOptions& options_;
};

}  // namespace ciliaval::fem::solid::equilibrium

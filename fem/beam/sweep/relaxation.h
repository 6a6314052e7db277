// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "fem/beam/sweep/tip.h"

namespace ciliaval::fem::beam::sweep {

struct RelaxationOptions {
  double largest_change = 1e-3;  ///< of an angle (rad) or of the touching point (in L) in a step
};

/// Equilibrium that a tip out of balance relaxes to, and the work lost on the way.
struct Relaxed {
  TipState end;         ///< a stable equilibrium; Touch::none: straight
  double friction = 0;  ///< work of friction on the way
  double dissipation = 0;  ///< viscous work: E before − E after − friction but for the steps' error
  int iterations = 0;
};

/// Damped dynamics under a surface that stands still: quasi-static but for a Kelvin–Voigt viscosity
/// of the bending, of one retardation time τ in all sections, by implicit Euler steps of a bounded
/// change. At each step the contact keeps Coulomb's law. `drag` is the slip of a straight tip that
/// is touched. Throws SolverError if it finds no way or no end.
Relaxed relax(const Tip& tip, const TipState& from, const Place& place, int drag,
              const RelaxationOptions& options = {});

}  // namespace ciliaval::fem::beam::sweep

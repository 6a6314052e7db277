// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>

#include "fem/beam/sweep/tip.h"

namespace ciliaval::fem::beam::sweep {

/// True if a solution of a status's equations keeps the inequalities: N > 0; |T| ≤ μN where it
/// sticks; sliding against T from `start`; the touching point on the end section; no other point of
/// the section's ends in the surface.
bool is_admissible(const Tip& tip, const TipState& state, const Pair& start);

/// The first admissible state at a place: of the status that was, else of another friction, else of
/// another touch. `guess` is of the status that was. Empty: the contact cannot go on here.
std::optional<TipState> go_on(const Tip& tip, const Place& place, const TipState& before,
                              const TipState& guess, const Viscosity& viscosity, int& iterations);

/// An admissible contact of a tip that is above the surface (`before`) and would be in it
/// (`through`); `drag` is the slip to try first.
std::optional<TipState> land(const Tip& tip, const Place& place, const TipState& before,
                             const TipState& through, int drag, const Viscosity& viscosity,
                             int& iterations);

/// The depth of the deepest point of the end section in the surface, < 0: none touches.
struct Depth {
  double depth = 0;
  double eta = 0;
};
Depth deepest(const Tip& tip, const TipState& state, const Place& place);
/// The same of its points between two η.
Depth deepest(const Tip& tip, const TipState& state, const Place& place, double from, double to);

}  // namespace ciliaval::fem::beam::sweep

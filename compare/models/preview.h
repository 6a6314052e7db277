// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

#include "compare/input/case.h"

namespace ciliaval::compare::models {

/// Expected signal of a case and warnings, in lines for people.
struct Preview {
  std::vector<std::string> signal;    ///< by the paper's elastica and the closed form of its magnet
  std::vector<std::string> warnings;  ///< what is odd, or beyond what the models are made for
};

/// Solves the case by the elastica, which takes a moment, and looks at it: a cilium too short for a
/// rod, moduli, sizes and magnetisations out of the usual, sensors in the magnet or close to it, a
/// load that no equilibrium bears, strains beyond 30 %, plain rods that are off by more than 2 %, a
/// signal that no sensor sees or bears. A failure of the models is a warning.
Preview preview(const input::Case& problem);

}  // namespace ciliaval::compare::models

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <iomanip>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "problem/types.h"

namespace ciliaval::continuation {

/// An equilibrium on the way to a fold.
struct ApproachToFold {
  double fraction = 0;  ///< t of the way, as PullIn::fraction
  /// Smallest eigenvalue of the second variation over that of the straight cilium without loads; it
  /// falls as sqrt(1 − t/t_c).
  double smallest_eigenvalue = 0;
};

/// The fold at which a magnet beside the cilium pulls it in: beyond it, the branch of equilibria
/// turns back, and there is none near the last one. The cilium jumps to the magnet, or to an
/// equilibrium farther away.
struct PullIn {
  /// t_c, the part of the step's load and environment, raised together from the straight cilium; of
  /// a contact or probe of the environment alone, which acts before.
  double fraction = 0;
  double load = 0;                         ///< magnitude of the load there, N, N/m or a factor
  std::string magnet;                      ///< the one that pulls most there
  Vector3 tip = Vector3::Zero();           ///< of the last equilibrium, m
  double tip_angle = 0;                    ///< of the last equilibrium, rad
  std::vector<ApproachToFold> approach{};  ///< in the order of t; empty: the load has no potential
};

/// The message of a step that fails because contact with magnets is not modelled.
inline std::string touches_magnet(const std::string& magnet) {
  return "the bent cilium touches the magnet '" + magnet +
         "', whose contact is not modelled: move the magnet away";
}

/// The remark on an equilibrium that lies beyond such a fold.
inline std::string jumps(const PullIn& pull_in) {
  std::ostringstream text;
  text
      << std::setprecision(6) << "the magnet '" << pull_in.magnet
      << "' pulls the cilium in: on the way to this load the equilibrium vanishes in a fold at the "
         "fraction "
      << pull_in.fraction << ", and the cilium jumps to this one";
  return text.str();
}

/// The message of a step that is pulled in.
inline std::string pulled_in(const PullIn& pull_in) {
  std::ostringstream text;
  text << std::setprecision(6) << "the magnet '" << pull_in.magnet
       << "' pulls the cilium in: the equilibrium vanishes in a fold at the fraction "
       << pull_in.fraction << " of the step's load and environment, with the tip at ("
       << 1e3 * pull_in.tip.x() << ", " << 1e3 * pull_in.tip.y() << ", " << 1e3 * pull_in.tip.z()
       << ") mm and an angle of " << pull_in.tip_angle * 180 / std::numbers::pi << " deg";
  return text.str();
}

}  // namespace ciliaval::continuation

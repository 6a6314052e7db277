// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <vector>

#include "analytic/elastica/tip_contact.h"

/// The quasi-static path of a planar elastica's tip under a moving surface (without units, as
/// tip_contact.h).
namespace ciliaval::analytic::elastica {

enum class TipState { open, stick, slip };

/// A jump: the branch of equilibria ended, and the tip went on to the next one.
struct TipJump {
  double at = 0;           ///< part of the way from the sample before, 0 to 1
  double energy_lost = 0;  ///< elastic energy that was neither stored nor spent on friction
  /// False: the way to the next equilibrium was not found (the rod snaps through while its tip is
  /// pressed hard, mostly after a reversal); the sweep goes on from the state that a long sweep in
  /// the present direction leaves, and the friction on the way is part of the energy lost.
  bool is_followed = true;
};

/// The state at one place of the surface.
struct SweepSample {
  SurfacePlace place;
  TipState state = TipState::open;
  TipContact contact;            ///< zero if open
  double friction_work = 0;      ///< spent since the sample before, ∫ |T| |dξ| along the surface
  double surface_work = 0;       ///< done by the surface since the sample before
  std::vector<TipJump> jumps{};  ///< since the sample before
};

/// Follows the tip over the places, one after the other on straight lines in height and travel. At
/// the first one the tip comes back from far ahead, bent aside, until the surface holds it. At each
/// later one:
///
/// The place ξ = x_c − s of the touching point on the surface stays as long as |T| ≤ μN. Else it
/// moves the way that the surface pulls the tip, against T, up to the next ξ at which |T| = μN, or
/// to where N = 0 and the cilium springs back. Where that ξ lies a finite step ahead however short
/// the step of the surface, down to 1e-8 lengths, the tip has jumped (docs/theory/sweep.md).
///
/// Calls `each` with every sample as soon as it is there. Throws SolverError where no equilibrium
/// is found, and InputError as Surface::at().
void sweep(const TipProblem& problem, const surroundings::Surface& surface,
           const std::vector<SurfacePlace>& places,
           const std::function<void(const SweepSample&)>& each);
/// The same, all samples at once.
std::vector<SweepSample> sweep(const TipProblem& problem, const surroundings::Surface& surface,
                               const std::vector<SurfacePlace>& places);

}  // namespace ciliaval::analytic::elastica

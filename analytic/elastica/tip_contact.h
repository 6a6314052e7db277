// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "analytic/elastica/taylor.h"
#include "problem/cilium.h"
#include "problem/surroundings/surface.h"

/// The planar elastica whose tip a rigid surface presses (the sweep). Without units: lengths in L,
/// forces in max(EI)/L², moments in max(EI)/L. θ is the angle from the vertical towards the travel,
/// x the offset along it.
namespace ciliaval::analytic::elastica {

/// The cilium and what touches.
struct TipProblem {
  std::vector<double> ends;        ///< S of the segments' ends: 0, …, 1
  std::vector<double> compliance;  ///< max(EI)/EI of each segment, ≥ 1
  double length = 1;               ///< L, m
  double rim = 0;                  ///< R/L, or 0: the tip is a point on the centreline
  double side = -1;  ///< of the rim: −1 behind (x − R cos θ), which is the upper one for θ > 0
  double tolerance = 1e-12;
};

/// Where the surface stands: z = height − p(x − travel).
struct SurfacePlace {
  double height = 1;
  double travel = 0;
};
inline SurfacePlace between(const SurfacePlace& a, const SurfacePlace& b, double t) {
  return {std::lerp(a.height, b.height, t), std::lerp(a.travel, b.travel, t)};
}

/// An equilibrium.
struct TipContact {
  double base_moment = 0;
  double force_x = 0;  ///< of the contact
  double force_z = 0;
  double normal_force = 0;    ///< N ≥ 0, along the surface's normal that points to the cilium
  double friction_force = 0;  ///< T, along the surface's tangent in the direction of the travel
  double theta = 0;           ///< of the tip
  double x = 0;               ///< of the tip's centre
  double z = 0;
  double contact_x = 0;  ///< of the touching point
  double contact_z = 0;
  double energy = 0;  ///< elastic, ∫ M²/(2EI) dS
  // How the forces of a tip that is held change with the place ξ = x_c − s where it is held.
  double normal_slope = 0;    ///< dN/dξ
  double friction_slope = 0;  ///< dT/dξ
  int iterations = 0;
};

/// The tip's problem of a cilium in the plane of the travel.
TipProblem tip_problem(const Cilium& cilium);

/// The equilibrium in which the surface slides over the tip and drags it along: T = direction · μN,
/// direction +1 or −1. Newton's method from `guess`; empty if it does not converge. N < 0, a
/// surface that pulls, is left to the caller.
///
///     EI θ′ = M,  M′ = −F_x cos θ + F_z sin θ,  F = N n + T t,
///     M(1) = F_x (z_c − z) − F_z (x_c − x),  z_c = H − p(x_c − s),
///     t = (1, −p′)/√(1 + p′²),  n = (−p′, −1)/√(1 + p′²).
std::optional<TipContact> sliding(const TipProblem& problem, const surroundings::Surface& surface,
                                  const SurfacePlace& place, double direction,
                                  const TipContact& guess);

/// The free tip pulled aside by a horizontal force, force_x, so far that it sinks to the height.
std::optional<TipContact> pulled_aside(const TipProblem& problem, double height,
                                       const TipContact& guess);

/// The equilibrium in which the touching point stays at a place of the surface, x_c − s = `held`.
std::optional<TipContact> sticking(const TipProblem& problem, const surroundings::Surface& surface,
                                   const SurfacePlace& place, double held, const TipContact& guess);

}  // namespace ciliaval::analytic::elastica

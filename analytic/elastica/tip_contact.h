// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "analytic/elastica/point_forces/section.h"
#include "problem/cilium.h"
#include "problem/surroundings/surface.h"

/// The planar elastica whose end a rigid surface presses (the sweep). Without units: lengths in L,
/// forces in EI/L², moments in EI/L, EI that of tip_stiffness(). θ is the angle from the vertical
/// towards the travel, x the offset along it.
namespace ciliaval::analytic::elastica {

/// The cilium and what touches.
struct TipProblem {
  std::vector<double> ends;        ///< S of the segments' ends: 0, …, 1
  std::vector<double> compliance;  ///< EI of tip_stiffness() over that of each segment
  double length = 1;               ///< L, m
  double rim = 0;                  ///< R/L of the end's disc, or 0: a point on the centreline
  double side = -1;  ///< of the rim, where a guess does not say which corner touches (Touch::side)
  double tolerance = 1e-12;
};

/// Place of the surface: z = height − p(x − travel).
struct SurfacePlace {
  double height = 1;
  double travel = 0;
};
inline SurfacePlace between(const SurfacePlace& a, const SurfacePlace& b, double t) {
  return {std::lerp(a.height, b.height, t), std::lerp(a.travel, b.travel, t)};
}

/// Part of the cilium that touches: the end of the centreline; a corner of the end face; a point of
/// the face or of the mantle, at which the surface is tangent to it.
enum class TouchPoint { tip, rim, face, mantle };

/// A touching point c = r(S) + a d₁(S), d₁ = (cos θ, −sin θ).
struct Touch {
  TouchPoint where = TouchPoint::tip;
  double side = -1;   ///< of the corner or the mantle: −1 behind (above, for θ > 0), +1 ahead
  double S = 1;       ///< < 1 on the mantle
  double offset = 0;  ///< a, −R to R
  double x = 0;
  double z = 0;
  double inclination = 0;  ///< β of the surface there, tan β = p′
  double curvature = 0;    ///< mean θ′ below and above a point of the mantle
  double force_x = 0;      ///< on the cilium
  double force_z = 0;
  double normal_force = 0;    ///< N, along n = (−sin β, −cos β)
  double friction_force = 0;  ///< T, along t = (cos β, −sin β)
  double slip = 0;  ///< of the surface over the cilium, along −t, since `before`: ∫ (dσ − dl) with
                    ///< the arc lengths σ of the surface and l of the cilium's outline
  Eigen::RowVector2d normal_by_place{0, 0};  ///< derivatives of N by travel and height
  Eigen::RowVector2d slip_by_place{0, 0};

  /// The state from which the slip is counted.
  struct Before {
    double on_surface = 0;  ///< ξ = x − travel
    double below = 0;       ///< z − height
    double inclination = 0;
    double S = 1;
    double offset = 0;
    double curvature = 0;
    double normal_force = 0;
    double friction_force = 0;
    Eigen::RowVector2d normal_by_place{0, 0};
    Eigen::RowVector2d slip_by_place{0, 0};
  } before{};
};

/// An equilibrium.
struct TipContact {
  double base_moment = 0;
  double force_x = 0;  ///< of all touching points together
  double force_z = 0;
  double normal_force = 0;    ///< N ≥ 0, along the surface's normal that points to the cilium
  double friction_force = 0;  ///< T, along the surface's tangent in the direction of the travel
  double theta = 0;           ///< of the tip
  double x = 0;               ///< of the tip's centre
  double z = 0;
  double contact_x = 0;  ///< of the touching point; of several the centre of the normal forces
  double contact_z = 0;
  double energy = 0;  ///< elastic, ∫ M²/(2EI) dS
  // Derivatives of a held tip's forces by its slip on the surface:
  double normal_slope = 0;    ///< dN/dξ
  double friction_slope = 0;  ///< dT/dξ
  int iterations = 0;
  std::vector<Touch> touches{};  ///< empty in a guess: the tip or the rim of the problem's side
  Eigen::Matrix<double, Eigen::Dynamic, 2, 0, point_forces::most_unknowns, 2>
      unknowns_by_place{};                    ///< their derivatives by travel and height
  Eigen::RowVector2d force_x_by_place{0, 0};  ///< likewise
  Eigen::RowVector2d force_z_by_place{0, 0};
};

/// Shape of the end that touches the surface.
enum class CiliumEnd {
  point,  ///< the end of the centreline
  disc    ///< an end face of the last segment's diameter, with its rim, and the mantle
};

/// EI of the uniform rod that a force along the azimuth at its tip bends as far as the cilium:
/// L³/(3 ∫ (L − S)²/EI dS), N m². In its units the numbers of all cilia are of the order of 1.
double tip_stiffness(const Cilium& cilium, double azimuth = 0);

/// The tip's problem of a cilium in the plane of the travel.
TipProblem tip_problem(const Cilium& cilium, CiliumEnd end = CiliumEnd::point);

/// Conditions that hold besides equilibrium, no gap at the touching points, and tangency at those
/// on the face and the mantle.
struct FrictionLaw {
  enum class Kind {
    slip,   ///< T = value · N at each touching point
    place,  ///< the first touching point stays at ξ = value
    moved,  ///< the first one's slip since `before` is the value
    stick,  ///< each point's slip since `before` is 0, except for the point `sliding`
    pulled  ///< no surface: a force of the inclination `value` holds the first point at x = `x`
  } kind = Kind::slip;
  double value = 0;
  std::ptrdiff_t sliding = -1;  ///< stick: the point at which T = value · N
  double x = 0;
};

/// The equilibrium with the guess's touching points. Newton's method from `guess`; empty if it does
/// not converge. N < 0, a surface that pulls, and whatever else touches are left to the caller.
///
///     EI θ′ = M,  M′ = −F_x cos θ + F_z sin θ,  F = N n + T t summed over the points above S,
///     jumps of M by F_x (z_c − z) − F_z (x_c − x) at each point,  M(1+) = 0,  z_c = H − p(x_c −
///     s), t = (1, −p′)/√(1 + p′²),  n = (−p′, −1)/√(1 + p′²).
///
/// Where several points of the end face stick, statics alone do not give the friction of each: they
/// are taken to bear the same T/N (not so with Kind::stick, for points between which the rod
/// bends).
std::optional<TipContact> solve_contact(const TipProblem& problem,
                                        const surroundings::Surface& surface,
                                        const SurfacePlace& place, const FrictionLaw& law,
                                        const TipContact& guess);

/// The equilibrium in which the surface slides over the tip and drags it along: T = direction · μN,
/// direction +1 or −1.
std::optional<TipContact> sliding(const TipProblem& problem, const surroundings::Surface& surface,
                                  const SurfacePlace& place, double direction,
                                  const TipContact& guess);

/// The free cilium pulled aside to x by a force at its tip, or at a corner of its end face, whose
/// direction is t of the inclination. Its one touching point is that point.
std::optional<TipContact> pulled_aside(const TipProblem& problem, double x, double inclination,
                                       const TipContact& guess);

/// The equilibrium in which the touching point stays at a place of the surface, x_c − s = `held`.
std::optional<TipContact> sticking(const TipProblem& problem, const surroundings::Surface& surface,
                                   const SurfacePlace& place, double held, const TipContact& guess);

/// Where a held tip's rod snaps through: follows the equilibria with the touching points of an
/// anchored contact by their arc length (Riks; Crisfield, Computers & Structures 13, 1981) from
/// its slip of 0 in the direction (of the first point's slip) around the folds, until they come
/// back to the slip `target` on a branch whose Jacobian has the first one's sign. Empty if there is
/// none. N < 0 on the way, and whatever else would touch, are left out of account.
std::optional<TipContact> beyond_fold(const TipProblem& problem,
                                      const surroundings::Surface& surface,
                                      const SurfacePlace& place, const TipContact& contact,
                                      double direction, double target);

/// The contact, from which slips are counted: its state as `before` of each touching point.
TipContact anchored(TipContact contact, const SurfacePlace& place);

/// A guess for the equilibrium when the surface has gone on, by the derivatives.
TipContact predicted(TipContact contact, const SurfacePlace& from, const SurfacePlace& to);

}  // namespace ciliaval::analytic::elastica

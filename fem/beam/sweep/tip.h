// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/LU>
#include <cmath>
#include <optional>
#include <vector>

#include "fem/beam/sweep/plane_beam.h"
#include "problem/surroundings/surface.h"

namespace ciliaval::fem::beam::sweep {

/// Place of the surface: z = height − p(x − travel), without units.
struct Place {
  double height = 1;
  double travel = 0;
};
inline Place between(const Place& a, const Place& b, double t) {
  return {std::lerp(a.height, b.height, t), std::lerp(a.travel, b.travel, t)};
}

/// Part of the end section that touches: the end x − R d₁ of its diameter in the plane (upper one
/// of a tip bent forward; also the tip that is a point), the other end, the line between them, or
/// two of these, as across a hollow.
enum class Touch { none, rear, front, face, both_ends, rear_and_face, face_and_front };
/// The touches of single points that a touch is made of.
std::vector<Touch> parts(Touch touch);

/// A contact and its law of friction; each is a smooth system of equations.
struct ContactStatus {
  Touch touch = Touch::none;
  int slip = 0;  ///< 0: it sticks; ±1: it slides with T = ±μN
  bool operator==(const ContactStatus&) const = default;
};

/// A touching pair of points: x_c − s on the surface, and the place on the end section's diameter.
struct Pair {
  double xi = 0;   ///< ξ
  double eta = 0;  ///< η, −R to R
};

/// One of the touching points.
struct ContactPoint {
  Touch part = Touch::rear;
  double normal_force = 0;
  Pair pair;
};

/// An equilibrium.
struct TipState {
  Place place;
  ContactStatus status;
  Eigen::VectorXd angles;             ///< of the nodes but the first
  Vector2d force = Vector2d::Zero();  ///< of the surface on the tip
  Pair pair;  ///< of two points ξ of the first, and the η of the resultant
  std::vector<ContactPoint> points;
  double ratio = 0;  ///< T/N, of two points the same
  // Quantities that follow from them:
  double normal_force = 0;
  double friction_force = 0;
  Vector2d tip{0, 1};
  Vector2d point{0, 1};  ///< touching
  double energy = 0;     ///< elastic
  /// Growth of |T| − μN of the held contact as it is moved on against T, d(T ∓ μN)/dg, g the way of
  /// sliding. Sliding is stable where this is positive.
  double stiffness = 0;
  bool is_held_stable = true;  ///< sign of the determinant of the held contact's equations
  /// Displacement of the angles in the mode of sliding, largest angle 1, and the way g of it.
  Eigen::VectorXd sliding_mode;
  double sliding_way = 0;
  Eigen::MatrixX2d rates;  ///< of the unknowns by height and by travel
  int iterations = 0;

  double angle() const { return angles[angles.size() - 1]; }
};

/// The equations of a contact. Unknown are θ, the force F, ξ and η:
///
///     ∂G/∂θ_a = δ_aL M,  M = −η F·d₃,
///     r_L + η d₁ = (s + ξ, H − p(ξ)),
///     T = ± μN (slides)  or  σ(ξ₀, ξ) = η − η₀ (sticks, or rolls),
///     η = ∓R (an end)  or  p′ cos θ = sin θ (the line is tangent to the surface),
///
/// with N = F·n, T = F·t, σ the arc length along the surface. Newton's method with the exact
/// tangent. Where two points touch, unknown are N_i, ξ_i, η_i and one
/// ratio T_i/N_i, which is ± μ or else holds the first point: with both held the problem would have
/// one equation too many. On a flat surface the line's η is where the resultant of the forces on
/// both ends lies, N₁ and N₂ = N (1 ∓ η/R)/2.
class Tip {
 public:
  /// The surface's unit of length is L, in metres; R without units.
  Tip(const PlaneBeam& beam, const surroundings::Surface& surface, double length, double radius,
      double tolerance, unsigned int max_iterations);

  /// The equilibrium of this status next to the guess; empty if Newton's method does not converge.
  /// `start` is the pair from which it slides or rolls.
  std::optional<TipState> solve(ContactStatus status, const Place& place, const TipState& guess,
                                const Pair& start, const Viscosity& viscosity = {}) const;

  /// Residual and tangent of the equations, unknowns (θ, F, ξ, η), or (θ, N₁, ξ₁, η₁, N₂, ξ₂, η₂,
  /// T_i/N_i).
  void equations(const ContactStatus& status, const Place& place, const Pair& start,
                 const Viscosity& viscosity, const Eigen::VectorXd& unknowns,
                 Eigen::VectorXd& residual, Eigen::MatrixXd& tangent) const;

  /// The straight beam.
  TipState straight(const Place& place) const;
  /// Height of the surface above a point at η of a tip.
  double gap(const TipState& state, const Place& place, double eta) const;
  Vector2d point_at(const TipState& state, double eta) const {
    return state.tip + eta * d1(state.angle());
  }
  /// Way that the touching point of `state` has slid from `start`: σ − (η − η₀), against T.
  double slid(const TipState& state, const Pair& start) const;

  /// The pair from which the contact has come to `after`, with the surface as it was `before`: that
  /// of before where the touching point moves without a break, else where the same point of the
  /// section was then.
  Pair start_of(const TipState& before, const ContactPoint& after) const;
  /// Work of friction between two states of contact that follow each other, by the trapezoidal
  /// rule: |∫ T dg| where one point touches, the sum over the ends where both do.
  double friction_between(const TipState& before, const TipState& after) const;

  const PlaneBeam& beam() const { return beam_; }
  double radius() const { return radius_; }
  double friction() const { return surface_.friction; }
  /// Profile in units of L.
  surroundings::ProfilePoint profile(double xi) const;
  /// The angle of the surface's slope, β = atan p′, at a touching pair.
  double slope_angle(double xi) const { return std::atan(profile(xi).slope); }

  const surroundings::Surface& surface() const { return surface_; }
  double length() const { return length_; }

 private:
  void complete(TipState& state, const Eigen::VectorXd& contact) const;
  void add_responses(TipState& state, const Eigen::PartialPivLU<Eigen::MatrixXd>& lu) const;
  /// The unknowns behind the angles that a guess has, of two points (N, ξ, η) each, and the ratio.
  Eigen::VectorXd contact_unknowns(Touch touch, const TipState& guess) const;
  void two_points(const ContactStatus& status, const Place& place, const Pair& start,
                  const Viscosity& viscosity, const Eigen::VectorXd& unknowns,
                  Eigen::VectorXd& residual, Eigen::MatrixXd& tangent) const;
  double arc(double from, double to) const;

  const PlaneBeam& beam_;
  const surroundings::Surface& surface_;
  double length_;
  double radius_;
  double tolerance_;
  unsigned int max_iterations_;
};

}  // namespace ciliaval::fem::beam::sweep

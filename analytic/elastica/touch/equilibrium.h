// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "analytic/elastica/point_forces/section.h"

/// The planar elastica that a rigid pin touches from the side (docs/theory/touch.md), without
/// units: lengths in L, forces in B/L², moments in B/L, B a bending stiffness.
namespace ciliaval::analytic::elastica::touch {

struct Problem {
  std::vector<double> ends;        ///< S of the segments' ends: 0, …, 1
  std::vector<double> compliance;  ///< B/EI of each
  double height = 0;               ///< h of the pin's centre
  double pin = 0;                  ///< r, its radius
  double mantle = 0;               ///< R, distance of the mantle from the axis; 0: touched there
  bool is_horizontal = false;      ///< the force stays horizontal, whatever friction that takes
  double friction_angle = 0;       ///< arctan μ

  /// The pin's centre is so far from the axis.
  double distance() const { return mantle + pin; }
};

using Vector4 = Eigen::Vector4d;

/// A number of an equilibrium and its derivatives by the unknowns.
struct Row {
  double value = 0;
  Eigen::RowVector4d by = Eigen::RowVector4d::Zero();
};

/// A number that an equilibrium is asked to have.
struct Condition {
  enum class Number {
    friction,      ///< arctan T/N
    slip,          ///< s = S + rθ, which is constant where the pin sticks
    displacement,  ///< the pin's way since it first touched, x + (R + r)(1 − cos θ)
    force,         ///< H
    arclength      ///< S of the contact
  } number;
  double value;
};

/// An equilibrium: the forces and the place of the contact.
struct Equilibrium {
  Vector4 unknowns;  ///< M(0), H, −V, S
  double theta = 0;  ///< at the contact
  double x = 0;      ///< offset of the axis there
  double z = 0;
  double energy = 0;  ///< ∫ M²/2EI dS
  int iterations = 0;
  /// Derivative of the unknowns by the value of the second of the conditions.
  Vector4 by_second = Vector4::Zero();
  double slip_by_second = 0;   ///< and of s
  double force_by_second = 0;  ///< and of H

  double base_moment() const { return unknowns[0]; }
  double force() const { return unknowns[1]; }
  double vertical() const { return -unknowns[2]; }  ///< V, downwards
  double S() const { return unknowns[3]; }
  double slip(const Problem& problem) const { return S() + problem.pin * theta; }
  double displacement(const Problem& problem) const;
  /// arctan T/N, T/N = −tan(arctan V/H − θ).
  double friction_angle() const;
};

/// The straight cilium, touched without a force.
Equilibrium untouched(const Problem& problem);

/// The equilibrium with two given numbers:
///
///     EI θ' = M,  M' = −H cos θ − V sin θ,  M(S) = R T,  z(S) + (R + r) sin θ = h,
///
/// by Newton's method from the guess. Where the force is horizontal, the first condition is V = 0
/// in place of the one given. Empty if it does not converge. A contact beyond the tip lies on the
/// last segment as if that went on.
std::optional<Equilibrium> solve(const Problem& problem, const Condition& first,
                                 const Condition& second, const Equilibrium& guess);

/// The steps of the integration from the base to the contact.
std::vector<point_forces::Step> steps_along(const Problem& problem, const Equilibrium& state);

}  // namespace ciliaval::analytic::elastica::touch

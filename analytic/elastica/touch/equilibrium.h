// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "analytic/elastica/point_forces/section.h"
#include "problem/pin/body.h"

/// The planar elastica that a rigid pin touches from the side (docs/theory/touch.md), without
/// units: lengths in L, forces in B/L², moments in B/L, B a bending stiffness.
namespace ciliaval::analytic::elastica::touch {

struct Problem {
  std::vector<double> ends;        ///< S of the segments' ends: 0, …, 1
  std::vector<double> compliance;  ///< B/EI of each
  pin::Pin pin;
};

using Vector4 = Eigen::Vector4d;

/// A number of an equilibrium and its derivatives by the unknowns.
struct Row {
  double value = 0;
  Eigen::RowVector4d by = Eigen::RowVector4d::Zero();
};

/// The forces and the place of the contact, and the section there.
struct State {
  Vector4 unknowns = Vector4::Zero();  ///< M(0), H, −V, S
  double theta = 0;
  double x = 0;  ///< offset of the axis
  double z = 0;
  double energy = 0;  ///< ∫ M²/2EI dS

  double base_moment() const { return unknowns[0]; }
  double force() const { return unknowns[1]; }
  double vertical() const { return -unknowns[2]; }
  double S() const { return unknowns[3]; }
};

/// The straight cilium, touched without a force.
pin::Equilibrium untouched(const Problem& problem);

/// The equilibrium of a State with two given numbers (pin::Body::solve()):
///
///     EI θ' = M,  M' = −H cos θ − V sin θ,  M(S) = R T,  z(S) + (R + r) sin θ = h.
std::optional<pin::Equilibrium> solve(const Problem& problem, const pin::Condition& first,
                                      const pin::Condition& second, const State& guess);

/// The steps of the integration from the base to the contact.
std::vector<point_forces::Step> steps_along(const Problem& problem, const State& state);

}  // namespace ciliaval::analytic::elastica::touch

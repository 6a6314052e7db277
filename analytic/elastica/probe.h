// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <optional>

#include "analytic/elastica/planar.h"

/// Displacement control of the contact point: the contact force F for which w = δ where z = h.
///
/// The larger F is, the more every section below the contact is turned: θ(S) grows with F wherever
/// it has grown below, since z(S) has then sunk and the moment F (h − z) grown. So S_c, where z =
/// h, moves up, and δ = ∫₀^{S_c} sin θ dS increases with F without a turning point up to the
/// slip-off, for any stiffnesses: the two determine each other. Only their conditioning differs. As
/// θ_c → 90°, δ grows without bound while F stays at a limit (2EI/h² for one material): the last
/// bit of F moves δ by ε h/cos²θ_c. There S_c is the well-conditioned unknown.
namespace ciliaval::analytic::elastica {

/// Solves a planar problem; empty if the contact force is above the slip-off force.
using PlanarSolver = std::function<std::optional<PlanarShape>(const PlanarProblem&)>;

/// w of the contact point of a solved contact problem, over the length.
double contact_deflection(const PlanarShape& shape);

/// δ/L at the slip-off, where S_c = L. `problem` is the contact with the slip-off load. A solver
/// that knows PlanarLoad::section gives it as the dead tip force of that amount, which is
/// well-conditioned at any angle. Another solver gives δ a rounding error below the slip-off, and
/// empty if that error moves it by more than `tolerance` relative to max(δ, h).
std::optional<double> slip_off_deflection(PlanarProblem problem, const PlanarSolver& solver,
                                          bool knows_section, double tolerance);

/// A load PL²/max(EI) and the shape under it.
struct PlanarProbe {
  double load = 0;
  PlanarShape shape;
};

/// The contact load with the deflection δ/L > 0 of the contact point, not above
/// slip_off_deflection(), by the load as the unknown (TOMS 748 on its logarithm). `problem` is a
/// contact; its load is not read. Empty if δ is missed, or the last bits of the load move it, by
/// more than `tolerance` relative to max(δ, h): θ_c is too near to 90°.
std::optional<PlanarProbe> probe_by_load(PlanarProblem problem, double deflection,
                                         double slip_off_load, const PlanarSolver& solver,
                                         double tolerance);

/// The same with S_c as the unknown: the dead force at S_c (PlanarLoad::section, which `solver`
/// must know) that brings that point down to h, and the S_c where it has the deflection. Holds at
/// any angle, takes some hundred solutions. `guess` is a load near the solution.
PlanarProbe probe_by_arclength(PlanarProblem problem, double deflection, double guess,
                               const PlanarSolver& solver);

}  // namespace ciliaval::analytic::elastica

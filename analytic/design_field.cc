// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/design_field.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <variant>
#include <vector>

#include "analytic/elastica/elastica.h"
#include "analytic/elastica/arclength.h"
#include "analytic/elastica/planar.h"
#include "analytic/rod/end_discs.h"
#include "analytic/rod/field_models.h"
#include "analytic/sources/adaptive_order.h"
#include "problem/error.h"

namespace ciliaval::analytic {
namespace {

/// Elastica's tolerance, on positions over the length and angles: a field that falls like a⁻³ or
/// a⁻⁴ multiplies a position's error by some L/a.
double mechanics_tolerance(double tolerance) {
  return std::clamp(tolerance / 100, 1e-13, 1e-3);
}

DesignField by_the_models(const Cilium& cilium, const Load& load, std::span<const Vector3> points,
                          double tolerance) {
  const MechanicsResult result =
      Elastica({.tolerance = mechanics_tolerance(tolerance)}).solve(cilium, {load});
  const MechanicsStep& step = result.steps.front();
  if (step.status == Status::failed) throw SolverError(step.message);
  if (!step.deformation) return {Status::slipped_off, {}};
  const VolumeField volume({VolumeOptions::Slices::wedge, Method::closed_form, tolerance});
  return {Status::converged, volume.field(cilium, *step.deformation, points)};
}

/// The end sections of the magnetic segments.
struct Ends {
  std::vector<RodEnd> charged;
  double lowest = std::numeric_limits<double>::infinity();  ///< z of a magnetic section, m
  double sharpest = 0;  ///< largest curvature of a magnetic segment, 1/m
};

/// The piece of the shape that begins at S (or, at the tip, ends there).
std::size_t piece_above(const PlanarShape& shape, double S) {
  const auto at = std::lower_bound(shape.breaks.begin(), shape.breaks.end(), S - shortest_piece);
  return std::min<std::size_t>(static_cast<std::size_t>(at - shape.breaks.begin()),
                               shape.breaks.size() - 2);
}

Ends ends_of(const Cilium& cilium, const PlanarProblem& problem, const PlanarShape& shape,
             const Vector3& direction) {
  const double L = cilium.length();
  Ends ends;
  double below = 0;  // M
  for (std::size_t i = 0; i <= cilium.segments.size(); ++i) {
    const double above = i < cilium.segments.size() ? cilium.segments[i].magnetization : 0;
    if (below == 0 && above == 0) continue;
    const double S = problem.ends[i];
    const PlanarState state = shape.state(S, piece_above(shape, S));
    const Vector3 e_z = Vector3::UnitZ();
    ends.lowest = std::min(ends.lowest, L * state.z);  // z grows with S
    // The moment falls along S, so each segment is bent most at its lower end.
    if (above != 0) ends.sharpest = std::max(ends.sharpest, state.curvature / L);
    if (below != above)
      ends.charged.push_back(
          {{L * (state.w * direction + state.z * e_z),
            std::sin(state.theta) * direction + std::sin(state.phi) * e_z, cilium.radius()},
           below - above});
    below = above;
  }
  return ends;
}

}  // namespace

DesignField design_field(const Cilium& cilium, const Load& load, std::span<const Vector3> points,
                         double tolerance) {
  if (std::holds_alternative<ProbeLoad>(load))
    return by_the_models(cilium, load, points, tolerance);
  require_valid(cilium);
  require_valid(load, cilium);
  const PlanarProblem problem = planar_problem(cilium, load);
  const std::optional<PlanarShape> shape = solve_arclength(problem, mechanics_tolerance(tolerance));
  if (!shape) return {Status::slipped_off, {}};
  const Ends ends = ends_of(cilium, problem, *shape, direction(load));
  const double R = cilium.radius();
  const bool all_outside = std::all_of(points.begin(), points.end(), [&](const Vector3& x) {
    return x.z() < ends.lowest - R;  // a section reaches no lower
  });
  if (!all_outside || !(ends.sharpest * R < 1))
    return by_the_models(cilium, load, points, tolerance);
  const EndDiscs discs(ends.charged);
  return {Status::converged, field_at(points, 256, [&](const Vector3& x) {
            FieldValue value = discs.field(x);
            require_tolerance(value, {tolerance, 0, "field of the charged discs", x});
            return value;
          })};
}

}  // namespace ciliaval::analytic

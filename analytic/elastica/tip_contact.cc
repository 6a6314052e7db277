// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/tip_contact.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "analytic/elastica/planar.h"
#include "analytic/elastica/point_forces/path.h"
#include "problem/error.h"
#include "problem/support/interruption.h"

namespace ciliaval::analytic::elastica {
using namespace surroundings;
using namespace point_forces;
namespace {

constexpr int most_iterations = 40;
constexpr int swinging_iterations = 8;
constexpr double largest_change = 0.5;  ///< of an unknown in an iteration, over its size + 1
// Limits of the path of equilibria, in lengths over L with forces and moments over their scale.
constexpr double first_path_step = 1e-4;
constexpr double longest_path_step = 0.03;
constexpr double shortest_path_step = 1e-9;
constexpr int most_path_steps = 2000;
constexpr double most_path_energy = 20;  ///< over that at the start
constexpr double lowest_touch = 0.02;    ///< S of a point of the mantle

std::vector<Touch> first_touches(const TipProblem& problem, const TipContact& guess) {
  const bool is_point = !guess.touches.empty() && guess.touches.front().where == TouchPoint::tip;
  if (!guess.touches.empty() && !(is_point && problem.rim > 0)) return guess.touches;
  Touch touch;
  if (problem.rim > 0) touch.where = TouchPoint::rim;
  touch.side = problem.side;
  touch.offset = problem.side * problem.rim;
  touch.force_x = guess.force_x;
  touch.force_z = guess.force_z;
  return {touch};
}

/// Computes the derivatives of the state by the slip and by the surface's place.
void differentiate(const System& system, TipContact& contact) {
  const auto factors = system.jacobian.partialPivLu();
  contact.unknowns_by_place = -factors.solve(system.by_place);
  const auto along = [&](const Row& row) -> Eigen::RowVector2d {
    return row.by * contact.unknowns_by_place + row.by_place;
  };
  Matrix held = system.jacobian;
  held.row(system.law) = system.held.by;
  const Vector unit = Vector::Unit(held.rows(), system.law);
  const Vector by_slip = held.partialPivLu().solve(unit);
  contact.normal_slope = contact.friction_slope = 0;
  contact.force_x_by_place.setZero();
  contact.force_z_by_place.setZero();
  for (std::size_t i = 0; i < contact.touches.size(); ++i) {
    const Touching& own = system.touching[i];
    contact.normal_slope += own.normal_force.by.dot(by_slip);
    contact.friction_slope += own.friction_force.by.dot(by_slip);
    contact.touches[i].normal_by_place = along(own.normal_force);
    contact.touches[i].slip_by_place = along(own.slip);
  }
}

}  // namespace

double tip_stiffness(const Cilium& cilium, double azimuth) {
  const double L = cilium.length();
  const std::vector<double> ends = cilium.interfaces();
  double compliance = 0;  // 3 ∫ (L − S)²/E dS, m³/Pa
  for (std::size_t i = 0; i < cilium.segments.size(); ++i)
    compliance += (std::pow(L - ends[i], 3) - std::pow(L - ends[i + 1], 3)) /
                  cilium.segments[i].young_modulus;
  return std::pow(L, 3) / compliance * cilium.second_moment(azimuth);
}

TipProblem tip_problem(const Cilium& cilium, CiliumEnd end) {
  TipProblem problem;
  problem.length = cilium.length();
  for (const double interface : cilium.interfaces())
    problem.ends.push_back(interface / cilium.length());
  problem.ends.back() = 1;
  for (const Segment& segment : cilium.segments)
    problem.compliance.push_back(tip_stiffness(cilium) /
                                 (segment.young_modulus * cilium.second_moment()));
  if (end == CiliumEnd::disc) problem.rim = cilium.diameter / 2 / cilium.length();
  return problem;
}

std::optional<TipContact> solve_contact(const TipProblem& problem, const Surface& surface,
                                        const SurfacePlace& place, const FrictionLaw& law,
                                        const TipContact& guess) {
  TipContact contact = guess;
  contact.touches = first_touches(problem, guess);
  const Layout layout(contact.touches);
  Vector u = unknowns_of(contact, layout);
  Assembly assembly(problem, surface, place, law, layout, contact);
  double last_change = std::numeric_limits<double>::infinity();
  for (int iteration = 1; iteration <= most_iterations; ++iteration) {
    support::check_interruption();
    const System system = assembly.at(u);
    const Vector change = -system.jacobian.partialPivLu().solve(system.residuals);
    if (!change.allFinite()) return std::nullopt;
    const double relative = (change.array() / (1 + u.array().abs())).abs().maxCoeff();
    // Rounding errors stop the convergence where the rod is stiff in the direction of the surface.
    if (relative < problem.tolerance || (relative < 1e-9 && relative >= last_change / 2)) {
      contact.iterations = iteration;
      for (const Touch& touch : contact.touches)  // must be on the profile
        surface.at((touch.x - place.travel) * problem.length);
      differentiate(system, contact);
      for (std::size_t i = 0; i < contact.touches.size(); ++i) {
        contact.force_x_by_place += contact.unknowns_by_place.row(layout.columns[i]);
        contact.force_z_by_place += contact.unknowns_by_place.row(layout.columns[i] + 1);
      }
      return contact;
    }
    // To and fro about a point where the surface's curvature jumps.
    const bool is_swinging = iteration > swinging_iterations && relative > last_change / 4;
    u += change * std::min(is_swinging ? 0.5 : 1.0, largest_change / relative);
    for (std::size_t i = 0; i < contact.touches.size(); ++i)
      if (contact.touches[i].where == TouchPoint::mantle &&
          !(u[layout.columns[i] + 2] > lowest_touch))
        return std::nullopt;
    if (u.cwiseAbs().maxCoeff() > largest_force) return std::nullopt;
    last_change = relative;
  }
  return std::nullopt;
}

std::optional<TipContact> sliding(const TipProblem& problem, const Surface& surface,
                                  const SurfacePlace& place, double direction,
                                  const TipContact& guess) {
  return solve_contact(problem, surface, place,
                       {FrictionLaw::Kind::slip, direction * surface.friction}, guess);
}

std::optional<TipContact> pulled_aside(const TipProblem& problem, double x, double inclination,
                                       const TipContact& guess) {
  FrictionLaw law{FrictionLaw::Kind::pulled, inclination};
  law.x = x;
  return solve_contact(problem, {FlatProfile{}, 0, 0}, {}, law, guess);
}

std::optional<TipContact> sticking(const TipProblem& problem, const Surface& surface,
                                   const SurfacePlace& place, double held,
                                   const TipContact& guess) {
  return solve_contact(problem, surface, place, {FrictionLaw::Kind::place, held}, guess);
}

std::optional<TipContact> beyond_fold(const TipProblem& problem, const Surface& surface,
                                      const SurfacePlace& place, const TipContact& contact,
                                      double direction, double target) {
  Path path(problem, surface, place, contact);
  path.set_direction(direction);
  const double first = path.determinant();
  bool has_turned = false;
  double step = first_path_step;
  for (int i = 0; i < most_path_steps; ++i) {
    const double before = path.slip();
    if (!path.advance(step)) {
      step /= 4;
      if (step < shortest_path_step) return std::nullopt;
      continue;
    }
    if (path.contact().energy > most_path_energy * std::max(contact.energy, 0.05))
      return std::nullopt;
    step = std::min(1.5 * step, longest_path_step);
    const bool is_stable = path.determinant() * first > 0;
    has_turned = has_turned || !is_stable;
    if (has_turned && is_stable && (before - target) * (path.slip() - target) <= 0)
      return solve_contact(problem, surface, place, {FrictionLaw::Kind::moved, target},
                           path.contact());
  }
  return std::nullopt;
}

TipContact anchored(TipContact contact, const SurfacePlace& place) {
  for (Touch& touch : contact.touches) {
    touch.before = {.on_surface = touch.x - place.travel,
                    .below = touch.z - place.height,
                    .inclination = touch.inclination,
                    .S = touch.S,
                    .offset = touch.offset,
                    .curvature = touch.curvature,
                    .normal_force = touch.normal_force,
                    .friction_force = touch.friction_force,
                    .normal_by_place = touch.normal_by_place,
                    .slip_by_place = touch.slip_by_place};
    touch.slip = 0;
  }
  return contact;
}

TipContact predicted(TipContact contact, const SurfacePlace& from, const SurfacePlace& to) {
  const Layout layout(contact.touches);
  if (contact.unknowns_by_place.rows() != layout.size) return contact;
  const Vector change =
      contact.unknowns_by_place * Eigen::Vector2d(to.travel - from.travel, to.height - from.height);
  contact.base_moment += change[0];
  for (std::size_t i = 0; i < contact.touches.size(); ++i) {
    Touch& touch = contact.touches[i];
    const Eigen::Index column = layout.columns[i];
    touch.force_x += change[column];
    touch.force_z += change[column + 1];
    if (touch.where == TouchPoint::face) touch.offset += change[column + 2];
    if (touch.where == TouchPoint::mantle) touch.S += change[column + 2];
  }
  return contact;
}

}  // namespace ciliaval::analytic::elastica

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/tip_contact.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace ciliaval::analytic::elastica {
using namespace surroundings;
namespace {

constexpr int most_iterations = 40;
constexpr double difference = 1e-7;     ///< of the Jacobian, relative
constexpr double largest_change = 0.5;  ///< of an unknown in an iteration, over its size + 1

using Unknowns = Eigen::Vector3d;   ///< M₀, F_x, F_z
using Residuals = Eigen::Vector3d;  ///< of the moment, the gap, the law of friction

/// The last equation: of the contact and the touching point's place on the surface.
using FrictionLaw = std::function<double(const TipContact& contact, double on_surface)>;

/// The unknowns' derivatives of the residuals and of N and T.
struct Derivatives {
  Eigen::Matrix3d residuals;
  Eigen::RowVector3d normal_force;
  Eigen::RowVector3d friction_force;
  Eigen::RowVector3d contact_x;
};

/// The frame turned by χ, in which the force is horizontal: F_x = F cos χ, F_z = −F sin χ,
/// M′ = −F cos(θ − χ).
struct ForceFrame {
  double force;
  double turn;

  ForceFrame(double force_x, double force_z)
      : force(std::hypot(force_x, force_z)), turn(std::atan2(-force_z, force_x)) {}
};

/// Calls `each` with every Taylor step, in the frame of the force, and returns the tip's state.
template <class Each>
PlanarState integrate(const TipProblem& problem, double base_moment, const ForceFrame& frame,
                      const Each& each) {
  PlanarState state;
  state.theta = -frame.turn;
  state.phi = std::numbers::pi / 2 + frame.turn;
  state.moment = base_moment;
  state.force = frame.force;
  for (std::size_t i = 0; i < problem.compliance.size(); ++i)
    while (state.S < problem.ends[i + 1]) {
      const TaylorStep step(state, problem.compliance[i], ForceLaw::constant, problem.ends[i + 1],
                            std::clamp(1e-4 * problem.tolerance, 1e-17, 1e-8), 1);
      each(step, problem.compliance[i]);
      state = step.end_state();
    }
  return state;
}

/// ∫ f M²/2 dS over a step: f M²/2 + F sin θ̃ is constant along it, and ∫ sin θ̃ dS = Δw̃.
double energy_of(const PlanarState& a, const PlanarState& b, double flexibility) {
  const double sum = flexibility * a.moment * a.moment / 2 + a.force * std::sin(a.theta);
  return sum * (b.S - a.S) - a.force * (b.w - a.w);
}

/// The contact of these unknowns, in equilibrium or not, and its residuals.
Residuals residuals(const TipProblem& problem, const Surface& surface, const SurfacePlace& place,
                    const FrictionLaw& law, const Unknowns& u, TipContact& contact) {
  const ForceFrame frame(u[1], u[2]);
  double energy = 0;
  const PlanarState tip =
      integrate(problem, u[0], frame, [&](const TaylorStep& step, double flexibility) {
        energy += energy_of(step.at(step.start()), step.end_state(), flexibility);
      });
  const double cosine = std::cos(frame.turn);
  const double sine = std::sin(frame.turn);
  contact.base_moment = u[0];
  contact.force_x = u[1];
  contact.force_z = u[2];
  contact.theta = tip.theta + frame.turn;
  contact.x = cosine * tip.w + sine * tip.z;
  contact.z = cosine * tip.z - sine * tip.w;
  const double arm = problem.side * problem.rim;
  contact.contact_x = contact.x + arm * std::cos(contact.theta);
  contact.contact_z = contact.z - arm * std::sin(contact.theta);
  contact.energy = energy;
  const double on_surface = contact.contact_x - place.travel;
  const ProfilePoint profile = surface.extended(on_surface * problem.length);
  const double norm = std::hypot(1, profile.slope);
  contact.normal_force = (-profile.slope * u[1] - u[2]) / norm;
  contact.friction_force = (u[1] - profile.slope * u[2]) / norm;
  return {
      tip.moment - u[1] * (contact.contact_z - contact.z) + u[2] * (contact.contact_x - contact.x),
      place.height - profile.height / problem.length - contact.contact_z, law(contact, on_surface)};
}

std::optional<TipContact> solve(const TipProblem& problem, const Surface& surface,
                                const SurfacePlace& place, const FrictionLaw& law,
                                const TipContact& guess) {
  Unknowns u{guess.base_moment, guess.force_x, guess.force_z};
  TipContact contact;
  const auto at = [&](const Unknowns& unknowns) {
    return residuals(problem, surface, place, law, unknowns, contact);
  };
  const auto differentiate = [&](const Unknowns& unknowns) {
    Derivatives result;
    for (int j = 0; j < 3; ++j) {
      const double h = difference * (1 + std::abs(unknowns[j]));
      Unknowns moved = unknowns;
      moved[j] = unknowns[j] + h;
      const Residuals after = at(moved);
      const TipContact contact_after = contact;
      moved[j] = unknowns[j] - h;
      result.residuals.col(j) = (after - at(moved)) / (2 * h);
      result.normal_force[j] = (contact_after.normal_force - contact.normal_force) / (2 * h);
      result.contact_x[j] = (contact_after.contact_x - contact.contact_x) / (2 * h);
      result.friction_force[j] = (contact_after.friction_force - contact.friction_force) / (2 * h);
    }
    return result;
  };
  double last_change = std::numeric_limits<double>::infinity();
  for (int iteration = 1; iteration <= most_iterations; ++iteration) {
    const Derivatives derivatives = differentiate(u);
    Unknowns change = -derivatives.residuals.partialPivLu().solve(at(u));
    if (!change.allFinite()) return std::nullopt;
    const double relative = (change.array() / (1 + u.array().abs())).abs().maxCoeff();
    u += change * std::min(1.0, largest_change / relative);
    // The Jacobian is right to 1e-9 or so: the next change would be rounding error.
    if (relative < problem.tolerance || (relative < 1e-9 && relative >= last_change / 2)) {
      at(u);
      contact.iterations = iteration;
      surface.at((contact.contact_x - place.travel) * problem.length);  // must be on the profile
      Eigen::Matrix3d held_tip = derivatives.residuals;
      held_tip.row(2) = derivatives.contact_x;
      const Unknowns held = held_tip.partialPivLu().solve(Unknowns::UnitZ());
      contact.normal_slope = derivatives.normal_force * held;
      contact.friction_slope = derivatives.friction_force * held;
      return contact;
    }
    last_change = relative;
  }
  return std::nullopt;
}

}  // namespace

TipProblem tip_problem(const Cilium& cilium) {
  const PlanarProblem same = planar_problem(cilium, SectionLoad{1, cilium.length(), 0});
  return {.ends = same.ends, .compliance = same.compliance, .length = cilium.length()};
}

std::optional<TipContact> sliding(const TipProblem& problem, const Surface& surface,
                                  const SurfacePlace& place, double direction,
                                  const TipContact& guess) {
  const double ratio = direction * surface.friction;
  return solve(
      problem, surface, place,
      [ratio](const TipContact& contact, double) {
        return contact.friction_force - ratio * contact.normal_force;
      },
      guess);
}

std::optional<TipContact> pulled_aside(const TipProblem& problem, double height,
                                       const TipContact& guess) {
  TipProblem centre = problem;
  centre.rim = 0;
  return solve(
      centre, {FlatProfile{}, 0, 0}, {height, 0},
      [](const TipContact& contact, double) { return contact.normal_force; }, guess);
}

std::optional<TipContact> sticking(const TipProblem& problem, const Surface& surface,
                                   const SurfacePlace& place, double held,
                                   const TipContact& guess) {
  return solve(
      problem, surface, place,
      [held](const TipContact&, double on_surface) { return on_surface - held; }, guess);
}

}  // namespace ciliaval::analytic::elastica

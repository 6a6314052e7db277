// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/contact/follower.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fem/solid/discretisation/assembly.h"
#include "fem/solid/loads/dead_forces.h"
#include "fem/solid/loads/height_loads.h"

namespace ciliaval::fem::solid::contact {
using namespace discretisation;
using namespace equilibrium;
namespace {

constexpr double stiffness_factor = 1e3;     ///< of the augmented Lagrangian, in E d
constexpr double penetration = 1e-6;         ///< allowed, in d
constexpr int multiplier_updates = 5;        ///< at most, of one equilibrium
constexpr double longest_travel = 0.02;      ///< step, in L
constexpr double feature_part = 0.5;         ///< step, in the surface's finest length
constexpr double longest_release = 0.2;      ///< step of the holding force
constexpr double shortest_step = 1e-4;       ///< in L, or of the holding force
constexpr double balance = 1e-3;             ///< of a step's works
constexpr double energy_noise = 1e-6;        ///< of the elastic energy
constexpr double vanishing_loss = 1e-4;      ///< of the elastic energy: less is no jump
constexpr double longest_extrapolation = 2;  ///< in the last step
// Of the relaxation:
constexpr double longest_movement = 0.02;  ///< of a step, in L
constexpr double first_rate = 10;          ///< damping, in the tip's stiffness over the volume
constexpr double last_rate = 1e-4;
constexpr double largest_rate = 1e9;
constexpr double rest_movement = 1e-3;  ///< in L
constexpr int most_relaxations = 400;

SweepPlace between(const SweepPlace& a, const SweepPlace& b, double t) {
  return {std::lerp(a.interference, b.interference, t), std::lerp(a.travel, b.travel, t),
          std::lerp(a.hold, b.hold, t)};
}

double way(const SweepPlace& a, const SweepPlace& b) {
  return std::abs(b.travel - a.travel) + std::abs(b.interference - a.interference);
}

double largest_difference(const dealii::Vector<double>& a, const dealii::Vector<double>& b) {
  dealii::Vector<double> difference(a);
  difference -= b;
  return difference.linfty_norm();
}

}  // namespace

Follower::Follower(const SolidSpace& space, const ExtrudedQuadrature& quadrature, Newton& newton,
                   const surroundings::Surface& surface, const Vector3& direction,
                   const FollowerOptions& options)
    : space_(space),
      newton_(newton),
      surface_(surface),
      direction_(direction),
      options_(options),
      nodes_(contact_nodes(space)),
      law_{surface.friction, stiffness_factor * options.young_modulus * options.diameter},
      volumes_(loads::body_force(space, [](const Vector3&) -> Vector3 { return Vector3::Ones(); })),
      hold_(loads::section_force(space, quadrature, 1, quadrature.height(), direction)),
      copies_(quadrature.extent() == Extent::half ? 2 : 1),
      volume_(quadrature.area() * quadrature.height()) {}

RigidSurface Follower::surface_at(const SweepPlace& place) const {
  return {&surface_, direction_, options_.length - place.interference, place.travel};
}

void Follower::start_open(const SweepPlace& place) {
  now_ = {place, space_.undeformed(), {}, {}, 0, Vector3::Zero()};
  before_.reset();
  now_.forces.resize(nodes_.size());
  now_.memory = remembered(nodes_, now_.forces, surface_at(place), now_.solid.displacement);
}

bool Follower::start_held(const SweepPlace& place, SolidState guess) {
  // The surface out of reach: no node touches.
  SweepPlace far = place;
  far.interference = -10 * options_.length;
  start_open(far);
  int iterations = 0;
  auto held = attempt(far, now_, std::move(guess), std::nullopt, iterations);
  if (!held || smallest_gap(nodes_, surface_at(place), held->solid.displacement) < 0) return false;
  now_ = std::move(*held);
  now_.place = place;
  now_.memory = remembered(nodes_, now_.forces, surface_at(place), now_.solid.displacement);
  return true;
}

std::optional<ContactState> Follower::attempt(const SweepPlace& place, const ContactState& from,
                                              SolidState start,
                                              const std::optional<Damping>& damping,
                                              int& iterations) {
  const RigidSurface surface = surface_at(place);
  ContactState state{place, std::move(start), from.memory, {}, 0, Vector3::Zero()};
  const loads::ExternalForces touch = contact_forces(nodes_, state.memory, surface, law_);
  const auto external = [&](const dealii::Vector<double>& u, dealii::Vector<double>& forces,
                            const dealii::AffineConstraints<double>& constraints,
                            dealii::SparseMatrix<double>* matrix) {
    touch(u, forces, constraints, matrix);
    forces.add(place.hold, hold_);
    if (!damping) return;
    for (dealii::types::global_dof_index i = 0; i < u.size(); ++i) {
      const double rate = damping->rate * volumes_[i];
      forces[i] -= rate * (u[i] - damping->from[i]);
      if (matrix != nullptr) matrix->diag_element(i) += rate;
    }
  };
  for (int update = 0; update <= multiplier_updates; ++update) {
    const NewtonResult result = newton_.solve(external, state.solid, options_.newton);
    iterations += result.iterations();
    if (!result.converged) return std::nullopt;
    state.forces = node_forces(nodes_, state.memory, surface, law_, state.solid.displacement);
    if (smallest_gap(nodes_, surface, state.solid.displacement) >=
        -penetration * options_.diameter)
      break;
    if (update == multiplier_updates) return std::nullopt;
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      state.memory[i].multiplier = state.forces[i].normal;
  }
  state.memory = remembered(nodes_, state.forces, surface, state.solid.displacement);
  for (const NodeForce& force : state.forces) state.force += copies_ * force.force;
  if (copies_ == 2) state.force -= state.force.dot(Vector3::UnitY()) * Vector3::UnitY();
  state.energy = copies_ * elastic_energy(space_, state.solid);
  return state;
}

SolidState Follower::predicted(const SweepPlace& place) const {
  SolidState state = now_.solid;
  if (!before_) return state;
  const Eigen::Vector3d last(now_.place.travel - before_->place.travel,
                             now_.place.interference - before_->place.interference,
                             now_.place.hold - before_->place.hold);
  const Eigen::Vector3d next(place.travel - now_.place.travel,
                             place.interference - now_.place.interference,
                             place.hold - now_.place.hold);
  const double factor = last.squaredNorm() > 0 ? next.dot(last) / last.squaredNorm() : 0;
  // Only straight on.
  if (!(factor > 0) || (next - factor * last).norm() > 1e-6 * next.norm()) return state;
  const double t = std::min(factor, longest_extrapolation);
  state.displacement.add(t, now_.solid.displacement, -t, before_->solid.displacement);
  for (std::size_t e = 0; e < state.pressure.size(); ++e)
    state.pressure[e] += t * (now_.solid.pressure[e] - before_->solid.pressure[e]);
  return state;
}

Follower::Work Follower::work(const ContactState& from, const ContactState& to) const {
  Work work;
  const RigidSurface before = surface_at(from.place);
  const RigidSurface after = surface_at(to.place);
  const Vector3 moved = after.displacement_from(before);
  work.surface = (from.force + to.force).dot(moved) / 2;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (from.forces[i].normal == 0 && to.forces[i].normal == 0) continue;
    const Vector3 x0 = nodes_[i].position(from.solid.displacement);
    const Vector3 x1 = nodes_[i].position(to.solid.displacement);
    const Vector3 slip = x1 - x0 - moved;
    const SurfacePoint at0 = surface_point(before, x0);
    const SurfacePoint at1 = surface_point(after, x1);
    work.friction -= copies_ / 2 * slip.dot(at0.tangents * from.forces[i].friction +
                                            at1.tangents * to.forces[i].friction);
  }
  return work;
}

bool Follower::is_balanced(const ContactState& to) const {
  if (to.place.hold != 0 || now_.place.hold != 0) return true;
  const auto [surface, friction] = work(now_, to);
  return std::abs(to.energy - now_.energy - surface + friction) <=
         balance * (std::abs(surface) + std::abs(friction)) +
             energy_noise * std::max(to.energy, now_.energy);
}

void Follower::accept(ContactState&& state, FollowerOutcome& outcome) {
  const auto [surface, friction] = work(now_, state);
  outcome.surface_work += surface;
  outcome.friction_work += friction;
  before_ = std::move(now_);
  now_ = std::move(state);
}

double Follower::longest_step(const SweepPlace& from, const SweepPlace& to) const {
  const double distance = way(from, to);
  if (distance == 0) return longest_release;
  const double longest =
      std::min(longest_travel * options_.length, feature_part * surface_.finest_length());
  return std::min(1.0, longest / distance);
}

FollowerOutcome Follower::go(const SweepPlace& target, const Progress& progress) {
  FollowerOutcome outcome;
  const SweepPlace start = now_.place;
  const double distance = way(start, target);
  const double longest = longest_step(start, target);
  const double unit = distance > 0 ? options_.length / distance : 1;
  double at = 0;
  step_ = longest;
  while (at < 1) {
    const double next = at + 1.000001 * step_ >= 1 ? 1 : at + step_;
    const SweepPlace place = between(start, target, next);
    auto reached = attempt(place, now_, predicted(place), std::nullopt, outcome.iterations);
    if (reached && is_balanced(*reached)) {
      accept(std::move(*reached), outcome);
      step_ = std::min(2 * (next - at), longest);
      at = next;
      continue;
    }
    if (next - at > shortest_step * unit) {
      step_ = std::max((next - at) / 4, 0.999 * shortest_step * unit);
      continue;
    }
    if (!relax(place, outcome, progress)) {
      outcome.trouble = "no equilibrium was found beyond the travel " +
                        std::to_string(1e3 * now_.place.travel) + " mm of the surface";
      return outcome;
    }
    at = next;
  }
  outcome.converged = true;
  return outcome;
}

bool Follower::relax(const SweepPlace& place, FollowerOutcome& outcome, const Progress& progress) {
  const double unit = options_.tip_stiffness / volume_;
  const double energy_before = now_.energy;
  double surface_work = 0;
  double friction_work = 0;
  double rate = first_rate * unit;
  double last_movement = std::numeric_limits<double>::infinity();
  ContactState state = now_;
  for (int i = 0; i < most_relaxations && rate < largest_rate * unit; ++i) {
    const bool at_rest = rate < last_rate * unit && last_movement < rest_movement * options_.length;
    auto next = attempt(place, state, state.solid,
                        at_rest ? std::nullopt
                                : std::optional(Damping{rate, state.solid.displacement}),
                        outcome.iterations);
    const double movement =
        next ? largest_difference(next->solid.displacement, state.solid.displacement) : 0;
    if (progress)
      progress("relaxation " + std::to_string(i) + ", movement " + std::to_string(movement * 1e3) +
               " mm");
    if (!next || movement > longest_movement * options_.length) {
      rate *= 4;
      last_movement = std::numeric_limits<double>::infinity();
      continue;
    }
    const auto [surface, friction] = work(state, *next);
    surface_work += surface;
    friction_work += friction;
    state = std::move(*next);
    if (at_rest) {
      outcome.surface_work += surface_work;
      outcome.friction_work += friction_work;
      const double lost = energy_before + surface_work - friction_work - state.energy;
      if (place.hold == 0 && lost > vanishing_loss * std::max(energy_before, state.energy))
        outcome.energy_lost = outcome.energy_lost.value_or(0) + lost;
      now_ = std::move(state);
      before_.reset();
      return true;
    }
    // Not while an instability grows: too long a step would stop at an unstable equilibrium.
    if (movement < longest_movement / 2 * options_.length && movement <= last_movement) rate /= 4;
    last_movement = movement;
  }
  return false;
}

}  // namespace ciliaval::fem::solid::contact

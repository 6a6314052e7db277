// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/contact/follower.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "fem/solid/discretisation/assembly.h"
#include "fem/solid/discretisation/row_range.h"
#include "fem/solid/loads/dead_forces.h"
#include "fem/solid/loads/height_loads.h"
#include "problem/error.h"

namespace ciliaval::fem::solid::contact {
using namespace discretisation;
using namespace equilibrium;
namespace {

constexpr double stiffness_factor = 1e3;      ///< of the augmented Lagrangian, in E d
constexpr double allowed_penetration = 1e-6;  ///< allowed, in d
constexpr double touch_depth = 1e-7;          ///< of a node that begins to touch, in d
constexpr double line_spacing = 0.02;         ///< of the points that a pin may touch, in its radius
constexpr int most_corrections = 12;          ///< of the nodes' states and multipliers
constexpr double longest_travel = 0.02;       ///< step, in L
constexpr double feature_part = 0.5;          ///< step, in the surface's finest length
constexpr double first_hold = 0.01;      ///< of the holding forces, in the tip's stiffness times L
constexpr double hold_growth = 0.25;     ///< from one to the next
constexpr double least_height = 0.6;     ///< of a tip that is bent aside, in L
constexpr double longest_release = 0.2;  ///< step of the holding force
constexpr double shortest_step = 1e-4;   ///< in L, or of the holding force
constexpr double relaxed_step = 1e-3;    ///< after a jump, in L
constexpr double least_factor = 0.25;    ///< from a step to the next
constexpr double largest_factor = 2;
constexpr double balance = 1e-3;             ///< of a step's works
constexpr double energy_noise = 1e-6;        ///< of the elastic energy
constexpr double vanishing_loss = 1e-4;      ///< of the elastic energy: less is no jump
constexpr double vanishing_energy = 1e-5;    ///< likewise, in the tip's stiffness times L²
constexpr double longest_extrapolation = 2;  ///< in the last step
// Limits of a jump:
constexpr double farthest_walk = 4;        ///< in L
constexpr double shortest_walk = 1e-6;     ///< step, in L
constexpr double longest_movement = 0.02;  ///< of a step, in L
constexpr double first_rate = 1e4;         ///< damping, in the tip's stiffness over the volume
constexpr double largest_rate = 1e9;
constexpr double rest_force = 1e-5;  ///< in the tip's stiffness times L
constexpr int successes_before_faster = 2;
constexpr int most_relaxations = 400;

SweepPlace between(const SweepPlace& a, const SweepPlace& b, double t) {
  return {std::lerp(a.interference, b.interference, t), std::lerp(a.travel, b.travel, t),
          std::lerp(a.hold, b.hold, t)};
}

double way(const SweepPlace& a, const SweepPlace& b) {
  return std::abs(b.travel - a.travel) + std::abs(b.interference - a.interference);
}

double finest_length(const RigidSurface& surface) {
  return surface.profile != nullptr ? surface.profile->finest_length()
                                    : std::numeric_limits<double>::infinity();
}

double largest_difference(const Vector& a, const Vector& b) {
  Vector difference(a);
  difference -= b;
  return difference.linfty_norm();
}

}  // namespace

Follower::Follower(const SolidSpace& space, const ExtrudedQuadrature& quadrature, Newton& newton,
                   const RigidSurface& surface, const FollowerOptions& options)
    : space_(space),
      newton_(newton),
      surface_(surface),
      options_(options),
      nodes_(surface.profile != nullptr
                 ? contact_nodes(space)
                 : mantle_line(space, surface.direction, line_spacing * surface.pin)),
      faces_(surface.profile != nullptr ? contact_faces(space, nodes_)
                                        : std::vector<ContactFace>{}),
      law_{surface.friction, stiffness_factor * options.young_modulus * options.diameter,
           surface.profile != nullptr ? ContactLaw{}.deep : 1},
      volumes_(loads::body_force(space, [](const Vector3&) -> Vector3 { return Vector3::Ones(); })),
      hold_(loads::section_force(space, quadrature, 1, quadrature.height(), surface.direction)),
      copies_(quadrature.extent() == Extent::half ? 2 : 1),
      volume_(quadrature.area() * quadrature.height()),
      longest_(std::min(longest_travel * options.length, feature_part * finest_length(surface))),
      state_{{}, {}, longest_} {}

RigidSurface Follower::surface_at(const SweepPlace& place) const {
  RigidSurface moved = surface_;
  moved.height -= place.interference;
  moved.travel += place.travel;
  return moved;
}

bool Follower::is_free(const SweepPlace& place) const {
  return smallest_gap(nodes_, surface_at(place), current().solid.displacement) >= 0;
}

void Follower::start(SweepPlace place) {
  state_ = {{place, space_.undeformed(), {}, {}, 0, Vector3::Zero()}, {}, longest_};
  ContactState& now = state_.now;
  now.forces.resize(nodes_.size());
  now.memory.resize(nodes_.size());
  const auto from_tip = [this](const ContactNode& node) {
    return (node.X - Vector3(0, 0, options_.length)).squaredNorm();
  };
  const ContactNode& tip = *std::ranges::min_element(nodes_, {}, from_tip);
  const double unit = options_.tip_stiffness * options_.length;
  double step = first_hold * unit;
  int iterations = 0;
  while (!is_free(place)) {
    if (tip.position(now.solid.displacement).z() < least_height * options_.length)
      throw InputError(
          "the surface is pressed on too far: a cilium bent to 0.6 of its length must have room "
          "under it");
    // The surface is out of reach.
    SweepPlace next{-10 * options_.length, place.travel, now.place.hold + step};
    auto held = attempt(next, now, predicted(next), {}, iterations);
    if (!held) {
      step /= 4;
      if (step < shortest_step * unit)
        throw SolverError("Newton's method does not bend the solid aside to under the surface");
      continue;
    }
    state_.before = std::exchange(now, std::move(*held));
    step = std::min(2 * step, hold_growth * now.place.hold);
  }
  place.hold = now.place.hold;
  now.place = place;
  state_.before.reset();
  now.memory = remembered(nodes_, now.forces, surface_at(place), now.solid.displacement);
}

std::optional<ContactState> Follower::attempt(const SweepPlace& place, const ContactState& from,
                                              const SolidState& start, const Brake& brake,
                                              int& iterations) {
  const RigidSurface surface = surface_at(place);
  ContactState state{place, start, from.memory, {}, 0, Vector3::Zero()};
  const loads::ExternalForces touch = contact_forces(nodes_, state.memory, surface, law_);
  const auto external = [&](const Vector& u, Vector& forces,
                            discretisation::TangentMatrix* tangent) {
    touch(u, forces, tangent);
    forces.add(place.hold, hold_);
    if (brake.damping == 0) return;
    for (dealii::types::global_dof_index i = 0; i < u.size(); ++i)
      forces[i] -= brake.damping * volumes_[i] * (u[i] - from.solid.displacement[i]);
    if (tangent == nullptr) return;
    dealii::FullMatrix<double> rates(node_unknowns, node_unknowns);
    for (dealii::types::global_dof_index i = 0; i < u.size(); i += node_unknowns) {
      for (unsigned int k = 0; k < node_unknowns; ++k)
        rates(k, k) = brake.damping * volumes_[i + k];
      tangent->add(rates, std::array{i, i + 1, i + 2});
    }
  };
  for (int update = 0;; ++update) {
    const NewtonResult result = newton_.solve(external, state.solid, options_.newton);
    iterations += result.iterations();
    if (!result.converged) return std::nullopt;
    state.forces = node_forces(nodes_, state.memory, surface, law_, state.solid.displacement);
    const bool penetrates = smallest_gap(nodes_, surface, state.solid.displacement) <
                            -allowed_penetration * options_.diameter;
    if (brake.driver && !(state.forces[*brake.driver].normal > 0)) return std::nullopt;
    const bool corrected = correct_states(state.forces, law_, touch_depth * options_.diameter,
                                          brake.driver, state.memory);
    if (!corrected && !penetrates) break;
    if (update == most_corrections) return std::nullopt;
    if (penetrates)
      for (std::size_t i = 0; i < nodes_.size(); ++i)
        state.memory[i].multiplier = std::max(0.0, state.forces[i].normal);
  }
  state.memory = remembered(nodes_, state.forces, surface, state.solid.displacement);
  for (const NodeForce& force : state.forces) state.force += copies_ * force.force;
  if (copies_ == 2) state.force -= state.force.dot(Vector3::UnitY()) * Vector3::UnitY();
  state.energy = copies_ * elastic_energy(space_, state.solid);
  return state;
}

SolidState Follower::predicted(const SweepPlace& place) const {
  SolidState state = state_.now.solid;
  if (!state_.before) return state;
  const Eigen::Vector3d last(state_.now.place.travel - state_.before->place.travel,
                             state_.now.place.interference - state_.before->place.interference,
                             state_.now.place.hold - state_.before->place.hold);
  const Eigen::Vector3d next(place.travel - state_.now.place.travel,
                             place.interference - state_.now.place.interference,
                             place.hold - state_.now.place.hold);
  const double factor = last.squaredNorm() > 0 ? next.dot(last) / last.squaredNorm() : 0;
  // Only straight on.
  if (!(factor > 0) || (next - factor * last).norm() > 1e-6 * next.norm()) return state;
  const double t = std::min(factor, longest_extrapolation);
  state.displacement.add(t, state_.now.solid.displacement, -t, state_.before->solid.displacement);
  for (std::size_t e = 0; e < state.pressure.size(); ++e)
    state.pressure[e] += t * (state_.now.solid.pressure[e] - state_.before->solid.pressure[e]);
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
    work.friction -=
        copies_ / 2 *
        slip.dot(at0.tangents * from.forces[i].friction + at1.tangents * to.forces[i].friction);
  }
  return work;
}

double Follower::imbalance(const ContactState& to) const {
  if (to.place.hold != 0 || state_.now.place.hold != 0) return 0;
  const auto [surface, friction] = work(state_.now, to);
  return std::abs(to.energy - state_.now.energy - surface + friction) /
         (balance * (std::abs(surface) + std::abs(friction)) +
          energy_noise * std::max(to.energy, state_.now.energy) +
          std::numeric_limits<double>::min());
}

void Follower::accept(ContactState&& state, FollowerOutcome& outcome) {
  const Work done = work(state_.now, state);
  outcome.surface_work += done.surface;
  outcome.friction_work += done.friction;
  state_.before = std::move(state_.now);
  state_.now = std::move(state);
}

FollowerOutcome Follower::go(const SweepPlace& target, const Progress& progress) {
  FollowerOutcome outcome;
  const SweepPlace start = state_.now.place;
  const bool releases = start.hold != target.hold;
  // Lengths of the release are parts of L.
  const double distance = releases ? options_.length : way(start, target);
  const double longest = releases ? longest_release * options_.length : longest_;
  const double shortest = shortest_step * options_.length;
  if (releases) state_.step = longest;
  double done = 0;
  while (done < distance) {
    const double step = done + 1.01 * state_.step >= distance ? distance - done : state_.step;
    const SweepPlace place =
        done + step == distance ? target : between(start, target, (done + step) / distance);
    auto reached = attempt(place, state_.now, predicted(place), {}, outcome.iterations);
    const double excess = reached ? imbalance(*reached) : 0;
    // The error of the trapezoidal rule is of the second order, relative to the work.
    const double factor =
        reached ? std::clamp(0.9 / std::sqrt(excess), least_factor, largest_factor) : least_factor;
    if (reached && excess <= 1) {
      accept(std::move(*reached), outcome);
      if (state_.step <= step || factor < 1) state_.step = step * factor;
      state_.step = std::clamp(state_.step, shortest, longest);
      done += step;
      continue;
    }
    if (step > shortest) {
      state_.step = std::max(step * factor, shortest);
      continue;
    }
    if (!jump(place, outcome, progress)) {
      outcome.trouble = "no equilibrium was found beyond the travel " +
                        std::to_string(1e3 * state_.now.place.travel) + " mm of the surface";
      return outcome;
    }
    state_.step = relaxed_step * options_.length;
    done += step;
  }
  if (releases) state_.step = longest_;
  outcome.converged = true;
  return outcome;
}

bool Follower::jump(const SweepPlace& place, FollowerOutcome& outcome, const Progress& progress) {
  if (progress) progress("a jump");
  const double energy_before = state_.now.energy;
  ContactState state = state_.now;
  Work spent;
  if (!walk(place, state, spent, outcome.iterations) &&
      !relax(place, state, spent, outcome.iterations, progress))
    return false;
  outcome.surface_work += spent.surface;
  outcome.friction_work += spent.friction;
  const double lost = energy_before + spent.surface - spent.friction - state.energy;
  const double vanishing =
      std::max(vanishing_loss * std::max(energy_before, state.energy),
               vanishing_energy * options_.tip_stiffness * options_.length * options_.length);
  if (place.hold == 0 && lost > vanishing)
    outcome.energy_lost = outcome.energy_lost.value_or(0) + lost;
  state_.now = std::move(state);
  state_.before.reset();
  return true;
}

bool Follower::walk(const SweepPlace& place, ContactState& state, Work& spent, int& iterations) {
  const auto bears_more = [](const NodeForce& a, const NodeForce& b) {
    return a.normal < b.normal;
  };
  const auto driver_of = [&](const ContactState& at) {
    return static_cast<std::size_t>(std::ranges::max_element(at.forces, bears_more) -
                                    at.forces.begin());
  };
  const NodeMemory& first = state.memory[driver_of(state)];
  if (first.state != NodeState::slip || first.along[0] == 0) return false;
  const double pull = first.along[0] > 0 ? 1 : -1;  // of the surface on the node
  const double longest =
      std::min(longest_movement * options_.length, feature_part * finest_length(surface_));
  double step = shortest_step * options_.length;
  double done = 0;
  int patience = 0;
  while (done < farthest_walk * options_.length && step > shortest_walk * options_.length) {
    const std::size_t driver = driver_of(state);
    ContactState led = state;
    led.memory[driver].state = NodeState::stick;
    led.memory[driver].place[0] -= pull * step;
    auto next = attempt(place, led, state.solid, {.driver = driver}, iterations);
    if (!next) {
      step /= 4;
      patience = successes_before_faster;
      continue;
    }
    NodeForce& force = next->forces[driver];
    const double borne = law_.friction * force.normal;
    const bool is_held = pull * force.trial[0] <= borne;
    next->memory[driver].state = NodeState::slip;
    next->memory[driver].along = {pull, 0};
    next->memory[driver].friction = force.friction = {pull * borne, 0};
    if (is_held) {
      next->memory[driver].place = state.memory[driver].place;
      next = attempt(place, *next, next->solid, {}, iterations);
      if (!next) {
        step /= 4;
        continue;
      }
    }
    spent.add(work(state, *next));
    state = std::move(*next);
    if (is_held) return true;
    done += step;
    if (--patience < 0) step = std::min(2 * step, longest);
  }
  return false;
}

bool Follower::relax(const SweepPlace& place, ContactState& state, Work& spent, int& iterations,
                     const Progress& progress) {
  const double unit = options_.tip_stiffness / volume_;
  const double longest = longest_movement * options_.length;
  double rate = first_rate * unit;
  double rest = rest_force * unit * options_.length;  // damping force for which it is at rest
  bool at_rest = false;
  int patience = 0;
  for (int i = 0; i < most_relaxations && rate < largest_rate * unit; ++i) {
    auto next = attempt(place, state, state.solid, {.damping = at_rest ? 0 : rate}, iterations);
    const double movement =
        next ? largest_difference(next->solid.displacement, state.solid.displacement) : 0;
    if (progress)
      progress("jump, relaxation " + std::to_string(i) + ", movement " +
               std::to_string(movement * 1e3) + " mm");
    if (!next || movement > longest) {
      if (at_rest)
        rest /= 10;  // slow it was, and not at rest
      else
        rate *= 4;
      at_rest = false;
      patience = successes_before_faster;
      continue;
    }
    spent.add(work(state, *next));
    state = std::move(*next);
    if (at_rest) return true;
    at_rest = rate * movement < rest;
    if (--patience < 0) rate *= std::clamp(2 * movement / longest, 0.25, 2.0);
  }
  return false;
}

}  // namespace ciliaval::fem::solid::contact

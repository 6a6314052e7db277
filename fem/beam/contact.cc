// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/contact.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "problem/error.h"

namespace ciliaval::fem::beam {
namespace {

/// A contact this near to the end of a segment (relative to L) is at the end: no force can be told
/// from the last bit of a height.
constexpr double at_end = 1e-12;

/// Of the increment where the force at the end of a segment is found. Its error is the square; what
/// is left of z − h by rounding moves a small force by much more than the tolerance.
constexpr double force_tolerance = 1e-8;

/// Iterations without any progress after which a load is given up.
constexpr int patience = 150;

/// Iterations after which the search for the force that sinks the tip is given up.
constexpr int search_limit = 250;

/// a + w (b − a); the rotations along the chord, which is the arc to second order in their angle.
State blend(const State& a, const State& b, double w) {
  State result = a;
  for (std::size_t j = 0; j < a.position.size(); ++j) {
    result.position[j] += w * (b.position[j] - a.position[j]);
    const double sign = a.rotation[j].dot(b.rotation[j]) < 0 ? -1 : 1;
    result.rotation[j].coeffs() += w * (sign * b.rotation[j].coeffs() - a.rotation[j].coeffs());
    result.rotation[j].normalize();
  }
  for (std::size_t k = 0; k < a.force.size(); ++k) {
    result.force[k] += w * (b.force[k] - a.force[k]);
    result.moment[k] += w * (b.moment[k] - a.moment[k]);
  }
  result.shift = std::lerp(a.shift, b.shift, w);
  return result;
}

/// The contact slides by an amount that goes with the square of a small force.
double force_at(double shift, double force_a, double shift_a, double force_b, double shift_b) {
  const double w = (shift - shift_a) / (shift_b - shift_a);
  return std::sqrt(std::lerp(force_a * force_a, force_b * force_b, w));
}

std::string slipped_off(double height, double limit, double force) {
  std::ostringstream text;
  text << "the tip sinks to the contact height of " << height << " m under " << limit
       << " N; no equilibrium bears " << force << " N";
  return text.str();
}

Loads force_at_vertex(const CiliumBeam& beam, double force) {
  Loads loads;
  loads.points.push_back({beam.loaded, force * Vector3::UnitX(), Vector3::Zero()});
  return loads;
}

/// A force and the equilibrium under it.
struct Loaded {
  double force = 0;
  State state;
};

std::optional<Loaded> loaded(CiliumBeam& beam, const Loaded& from, double force,
                             const NewtonOptions& options, int& iterations) {
  Loaded to{force, from.state};
  const PathReport report = advance(beam.system, to.state, force_at_vertex(beam, from.force),
                                    force_at_vertex(beam, force), options);
  iterations += report.iterations;
  return report.converged ? std::optional(std::move(to)) : std::nullopt;
}

/// The dead force at the tip that brings it down to a height: bracketed and bisected until Newton's
/// method with the force for the unknown converges inside the bracket. It takes many iterations,
/// but never meets the contact point that runs away where θ comes near 90°. None if a dead force
/// does not converge.
std::optional<double> force_that_sinks_the_tip(const Cilium& cilium, const BeamOptions& options,
                                               double height, int& iterations) {
  CiliumBeam beam = cilium_beam(cilium, options, cilium.length());
  const NewtonOptions newton_options{
      options.tolerance, options.max_iterations, options.max_cutbacks, {}};
  const int last = iterations + search_limit;
  const std::size_t node = beam.system.vertex_node(beam.loaded);
  const auto above = [&](const Loaded& l) { return l.state.position[node][2] > height; };
  Loaded low{0, beam.system.reference_state()};
  std::optional<Loaded> high =
      loaded(beam, low, beam.system.force_scale(), newton_options, iterations);
  // The height falls as sqrt(2EI/F) at worst: four times the force for half the height.
  while (high && above(*high)) {
    if (iterations > last) return std::nullopt;
    low = *std::move(high);
    high = loaded(beam, low, 2 * low.force, newton_options, iterations);
  }
  const HeightCondition condition{beam.loaded, height, HeightCondition::Unknown::load_factor};
  while (high && iterations <= last) {
    State state = high->state;
    const NewtonReport report =
        newton(beam.system, state, force_at_vertex(beam, high->force), newton_options, condition);
    iterations += static_cast<int>(report.increments.size());
    const double force = state.load_factor * high->force;
    // At the bracket's upper end itself, rounding error may put the force just outside.
    if (report.converged && force >= low.force && force <= high->force * (1 + 1e-9)) return force;
    std::optional<Loaded> middle =
        loaded(beam, low, (low.force + high->force) / 2, newton_options, iterations);
    if (!middle) return std::nullopt;
    (above(*middle) ? low : *high) = *std::move(middle);
  }
  return std::nullopt;
}

}  // namespace

void ContactSolver::stand_straight(const ContactLoad& load) {
  const std::vector<double> ends = cilium_.interfaces();
  const std::size_t last = cilium_.segments.size() - 1;
  for (host_ = 0; host_ < last && ends[host_ + 1] <= load.height + at_end * ends.back();) ++host_;
  beam_ = cilium_beam_with_moving_vertex(cilium_, options_, host_);
  state_ = beam_->system.reference_state(std::max(load.height - ends[host_], 0.0));
  last_ = load;
  last_->force = 0;
  entry_force_ = 0;
}

bool ContactSolver::find_arclength(State& state, double force, BeamStep& step,
                                   const PathProgress& progress) {
  const HeightCondition condition{beam_->loaded, last_->height, HeightCondition::Unknown::shift};
  const NewtonReport report =
      newton(beam_->system, state, loads(with_magnitude(*last_, force), *beam_),
             {options_.tolerance, options_.max_iterations, 0, {}}, condition);
  step.iterations += static_cast<int>(report.increments.size());
  if (!report.converged) step.message = describe(report);
  if (progress) progress(force, report);
  return report.converged;
}

bool ContactSolver::find_force(State& state, double& force, BeamStep& step) {
  const HeightCondition condition{beam_->loaded, last_->height,
                                  HeightCondition::Unknown::load_factor};
  state.load_factor = 1;
  const NewtonReport report =
      newton(beam_->system, state, loads(with_magnitude(*last_, force), *beam_),
             {options_.tolerance, options_.max_iterations, 0,
              std::max(options_.tolerance, force_tolerance)},
             condition);
  step.iterations += static_cast<int>(report.increments.size());
  if (!report.converged) step.message = describe(report);
  force *= std::exchange(state.load_factor, 1);
  return report.converged;
}

ContactSolver::Leg ContactSolver::follow(const ContactLoad& load, BeamStep& step,
                                         const PathProgress& progress) {
  const double L = cilium_.length();
  const double end = host_length();
  // sin θ = F h²/(2EI) of a uniform cilium of the softest material: twice what it bears.
  const double natural = 4 * beam_->system.force_scale() * std::pow(L / load.height, 2);
  double increment = std::max(natural, last_->force);
  unsigned int failures = 0;
  int progressed = step.iterations;
  while (last_->force != load.force) {
    const double from = last_->force;
    const double aim = std::abs(load.force - from) <= increment
                           ? load.force
                           : from + std::copysign(increment, load.force - from);
    State trial = state_;
    const bool found = find_arclength(trial, aim, step, progress);
    if (found && trial.shift <= end + at_end * L) {
      state_ = std::move(trial);
      last_->force = aim;
      increment = 2 * std::abs(aim - from);
      failures = failures > 0 ? failures - 1 : 0;
      progressed = step.iterations;
      continue;
    }
    if (found && end - state_.shift <= at_end * L) return Leg::end_reached;
    if (found) {
      // s_c lies beyond the segment as if its material went on: the end is between the two.
      double force = force_at(end, from, state_.shift, aim, trial.shift);
      State crossing = blend(state_, trial, (force - from) / (aim - from));
      crossing.shift = end;
      if (find_force(crossing, force, step) && force >= from && force <= aim * (1 + 1e-9)) {
        state_ = std::move(crossing);
        last_->force = force;
        return Leg::end_reached;
      }
    }
    if (++failures > options_.max_cutbacks || step.iterations - progressed >= patience) {
      // Near 90 deg s_c runs away with the force; the force at a given s_c does not.
      State crossing = state_;
      crossing.shift = end;
      double force = from;
      if (from == 0 || !find_force(crossing, force, step) || force < from || force > aim)
        return Leg::failed;
      state_ = std::move(crossing);
      last_->force = force;
      return Leg::end_reached;
    }
    increment = std::abs(aim - from) / 2;
  }
  return Leg::load_reached;
}

void ContactSolver::enter_next_segment() {
  entry_force_ = last_->force;
  // The elements of no length above the vertex become those below it: same nodes, now loaded.
  const std::size_t p = options_.degree;
  const std::size_t contact = beam_->loaded * p;
  const std::size_t n = std::size_t{1} << options_.refinement;
  ++host_;
  beam_ = cilium_beam_with_moving_vertex(cilium_, options_, host_);
  const Vector3 force = state_.rotation[contact].conjugate() * (last_->force * direction(*last_));
  for (std::size_t k = contact; k < contact + n * p; ++k) {
    state_.force[k] = force;
    state_.moment[k].setZero();
  }
  state_.shift = 0;
}

BeamStep ContactSolver::solve(const ContactLoad& load, const PathProgress& progress) {
  BeamStep step;
  const auto slip = [&](double limit) {
    step.status = Status::slipped_off;
    step.slip_off_force = limit;
    step.message = slipped_off(load.height, limit, load.force);
    return step;
  };
  const auto known = slip_off_forces_.find(load.height);
  if (known != slip_off_forces_.end() && load.force > known->second) return slip(known->second);
  if (!last_ || last_->height != load.height || last_->azimuth != load.azimuth ||
      load.force < entry_force_)
    stand_straight(load);
  Leg leg = follow(load, step, progress);
  while (leg == Leg::end_reached) {
    if (host_ + 1 == cilium_.segments.size()) {
      const double limit = last_->force;
      slip_off_forces_[load.height] = limit;
      return slip(limit);
    }
    enter_next_segment();
    leg = follow(load, step, progress);
  }
  if (leg == Leg::failed) {
    const auto limit = force_that_sinks_the_tip(cilium_, options_, load.height, step.iterations);
    if (limit && load.force > *limit) {
      last_.reset();
      slip_off_forces_[load.height] = *limit;
      return slip(*limit);
    }
    std::ostringstream text;
    text << "no equilibrium found under " << load.force << " N: " << step.message
         << "; last converged under " << last_->force
         << " N; more cutbacks, elements or smaller load steps may help";
    step.message = text.str();
    last_.reset();
    return step;
  }
  applied_ = loads(load, *beam_);
  step.status = Status::converged;
  step.message.clear();
  const double begin = cilium_.interfaces()[host_];
  step.contact_arclength = std::min(begin + state_.shift, cilium_.length());
  return step;
}

}  // namespace ciliaval::fem::beam

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/sweep/sweep.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>
#include <string>

#include "fem/beam/centreline.h"
#include "fem/beam/cilium_beam.h"
#include "fem/beam/sweep/contact_law.h"
#include "fem/beam/sweep/follower.h"
#include "problem/error.h"

namespace ciliaval::fem::beam::sweep {
namespace {

constexpr std::size_t most_angles = 2000;  ///< of a dense matrix
constexpr double reported_depth = 1e-6;    ///< of what is in the surface unasked, in L

std::vector<Place> places_of(const LoadPath& path, double length) {
  require_one_surface(path);
  std::vector<Place> places;
  for (const Load& load : path) {
    const SweepLoad sweep = load.as<SweepLoad>().value();
    places.push_back({1 - sweep.interference / length, sweep.travel / length});
  }
  return places;
}

/// The sweep of one cilium.
class Solver {
 public:
  Solver(const Cilium& cilium, const LoadPath& path, const BeamOptions& options)
      : path_(path),
        system_(cilium_beam(cilium, options).system),
        beam_(system_),
        tip_(beam_, *path.front().surface(), system_.length_scale(),
             options.tip == TipShape::rim ? cilium.radius() / system_.length_scale() : 0.0,
             options.tolerance, options.max_iterations),
        follower_(tip_),
        radius_(cilium.radius() / system_.length_scale()),
        places_(places_of(path, system_.length_scale())) {}

  MechanicsStep step(std::size_t i) {
    const Sample sample = i == 0 ? follower_.begin(places_[0]) : follower_.go(places_[i]);
    const TipState& state = sample.state;
    const double L = system_.length_scale();
    MechanicsStep step;
    step.load = path_[i];
    step.status = Status::converged;
    step.contact = contact_of(sample);
    const State full = beam_.state(state.angles, state.force, azimuth(path_[i]));
    step.deformation = Deformation{centreline(system_, full), nullptr};
    step.applied_force = system_.force_scale() * state.force[0];
    step.unknowns = static_cast<std::size_t>(beam_.n_angles()) + 4;
    step.iterations = sample.iterations;
    if (const double depth = depth_of_rest(state, full); depth > reported_depth) {
      std::ostringstream text;
      text << "the surface goes " << depth * L
           << " m into the cilium beside the point of contact, which is not modelled";
      step.message = text.str();
    }
    return step;
  }

 private:
  SurfaceContact contact_of(const Sample& sample) const {
    const double P = system_.force_scale();
    const double L = system_.length_scale();
    const TipState& state = sample.state;
    SurfaceContact contact;
    if (state.status.touch != Touch::none)
      contact.state =
          state.status.slip == 0 ? SurfaceContact::State::stick : SurfaceContact::State::slip;
    contact.normal_force = P * state.normal_force;
    contact.friction_force = P * state.friction_force;
    contact.point =
        L * (state.point[0] * direction(path_.front()) + state.point[1] * Vector3::UnitZ());
    contact.elastic_energy = P * L * state.energy;
    contact.surface_work = P * L * sample.surface_work;
    contact.friction_work = P * L * sample.friction_work;
    for (const Jump& jump : sample.jumps)
      contact.energy_lost = contact.energy_lost.value_or(0) + P * L * jump.energy_lost;
    return contact;
  }

  /// Depth in the surface of the end section, and of the side at the beam's nodes.
  double depth_of_rest(const TipState& state, const State& full) const {
    double depth = deepest(tip_, state, state.place).depth;
    if (tip_.radius() == 0) return depth;
    const Vector3 e = direction(path_.front());
    for (Eigen::Index j = 0; j < state.angles.size(); ++j) {
      const Vector3& r = full.position[static_cast<std::size_t>(j) + 1] / system_.length_scale();
      const Vector2d centre(r.dot(e), r[2]);
      for (const double side : {-radius_, radius_}) {
        const Vector2d point = centre + side * d1(state.angles[j]);
        depth = std::max(depth, point[1] - state.place.height +
                                    tip_.profile(point[0] - state.place.travel).height);
      }
    }
    return depth;
  }

  const LoadPath& path_;
  System system_;
  PlaneBeam beam_;
  Tip tip_;
  Follower follower_;
  double radius_;
  std::vector<Place> places_;
};

bool has_jumped(const MechanicsStep& step) {
  return step.contact && step.contact->energy_lost;
}

bool is_open(const MechanicsStep& step) {
  return step.contact && step.contact->state == SurfaceContact::State::open;
}

}  // namespace

std::vector<MechanicsStep> solve(const Cilium& cilium, const LoadPath& path,
                                 const BeamOptions& options, const Progress& progress) {
  const std::size_t angles =
      options.degree * (std::size_t{1} << options.refinement) * cilium.segments.size();
  if (angles > most_angles)
    throw InputError("beam: a sweep takes at most " + std::to_string(most_angles) + " nodes, not " +
                     std::to_string(angles) + ": a lower refinement or degree");
  Solver solver(cilium, path, options);
  std::vector<MechanicsStep> steps;
  std::string failure;
  try {
    while (steps.size() < path.size()) {
      const auto begin = std::chrono::steady_clock::now();
      steps.push_back(solver.step(steps.size()));
      const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
      steps.back().seconds = time.count();
      report_step(progress, steps, path.size());
    }
  } catch (const SolverError& error) {
    failure = error.what();
  } catch (const InputError& error) {
    if (steps.empty()) throw;
    failure = error.what();
  }
  while (steps.size() < path.size()) {
    MechanicsStep step;
    step.load = path[steps.size()];
    step.message = failure;
    steps.push_back(std::move(step));
  }
  return steps;
}

void forget_uncertainties_near_jumps(MechanicsResult& result) {
  for (const MechanicsResult& companion : result.companions) {
    int jumps = 0;  // more than the companion's
    for (std::size_t i = 0; i < result.steps.size(); ++i) {
      MechanicsStep& step = result.steps[i];
      const MechanicsStep& other = companion.steps[i];
      if (!step.contact || !other.contact) continue;
      jumps += (has_jumped(step) ? 1 : 0) - (has_jumped(other) ? 1 : 0);
      if (jumps == 0 && is_open(step) == is_open(other)) continue;
      step.tip_uncertainty.reset();
      step.tip_angle_uncertainty.reset();
      step.applied_force_uncertainty.reset();
      step.message += std::string(step.message.empty() ? "" : "; ") +
                      "no estimate of the error: another discretisation is on the other side of a "
                      "jump here";
    }
  }
}

}  // namespace ciliaval::fem::beam::sweep

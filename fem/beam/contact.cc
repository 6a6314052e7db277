// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/contact.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "problem/error.h"

namespace ciliaval::fem::beam {
namespace {

NewtonOptions newton_options(const BeamOptions& options) {
  return {options.tolerance, options.max_iterations, options.max_cutbacks};
}

Loads tip_force(const CiliumBeam& beam, double force) {
  Loads loads;
  loads.points.push_back({beam.loaded, force * Vector3::UnitX(), Vector3::Zero()});
  return loads;
}

/// A force and the equilibrium under it.
struct Loaded {
  double force = 0;
  State state;
};

Loaded loaded(CiliumBeam& beam, const Loaded& from, double force, const NewtonOptions& options,
              int& iterations) {
  Loaded to{force, from.state};
  const PathReport report =
      advance(beam.system, to.state, tip_force(beam, from.force), tip_force(beam, force), options);
  iterations += report.iterations;
  if (!report.converged)
    throw SolverError(
        "the force that brings the cilium down to the contact height was not found: " +
        report.message);
  return to;
}

}  // namespace

double force_to_sink(CiliumBeam& beam, double height, const NewtonOptions& options,
                     int& iterations) {
  const std::size_t node = beam.system.vertex_node(beam.loaded);
  const auto above = [&](const Loaded& l) { return l.state.position[node][2] > height; };
  Loaded low{0, beam.system.reference_state()};
  Loaded high = loaded(beam, low, beam.system.force_scale(), options, iterations);
  // The height falls as sqrt(2EI/F) at worst: four times the force for half the height.
  for (int doubling = 0; above(high); ++doubling) {
    if (doubling == 100) throw SolverError("no force brings the cilium down to the contact height");
    low = std::move(high);
    high = loaded(beam, low, 2 * low.force, options, iterations);
  }
  const HeightCondition condition{beam.loaded, height, HeightCondition::Unknown::load_factor};
  for (int bisection = 0; bisection < 60; ++bisection) {
    State state = high.state;
    const NewtonReport report =
        newton(beam.system, state, tip_force(beam, high.force), options, condition);
    iterations += static_cast<int>(report.increments.size());
    const double force = state.load_factor * high.force;
    // At the bracket's upper end itself, rounding error may put the force just outside.
    if (report.converged && force >= low.force && force <= high.force * (1 + 1e-9)) return force;
    Loaded middle = loaded(beam, low, (low.force + high.force) / 2, options, iterations);
    (above(middle) ? low : high) = std::move(middle);
  }
  throw SolverError("the force that brings the cilium down to the contact height was not found");
}

const std::vector<double>& ContactSolver::limit_forces(double height, int& iterations) {
  if (const auto known = limits_.find(height); known != limits_.end()) return known->second;
  const std::vector<double> ends = cilium_.interfaces();
  std::vector<double> limits(cilium_.segments.size(), 0.0);
  for (std::size_t k = 0; k < limits.size(); ++k) {
    if (ends[k + 1] <= height) continue;
    CiliumBeam beam = cilium_beam(cilium_, options_, ends[k + 1]);
    limits[k] = force_to_sink(beam, height, newton_options(options_), iterations);
  }
  return limits_.emplace(height, std::move(limits)).first->second;
}

PathReport ContactSolver::follow(const ContactLoad& load, std::size_t host,
                                 const std::vector<double>& limits, const PathProgress& progress) {
  const bool warm =
      last_ && host == host_ && last_->height == load.height && last_->azimuth == load.azimuth;
  const NewtonOptions options = newton_options(options_);
  PathReport start;
  if (!warm) {
    host_ = host;
    beam_ = cilium_beam_with_moving_vertex(cilium_, options_, host);
    const double begin = cilium_.interfaces()[host];
    state_ = beam_->system.reference_state(std::max(load.height - begin, 0.0));
    last_ = load;
    last_->force = 0;
    if (load.height < begin) {
      // The contact enters the segment at its lower end, under the limit of the segment below.
      const Load entry = with_magnitude(load, limits[host - 1]);
      start = advance(beam_->system, state_, {}, loads(entry, *beam_), options, {}, progress);
      if (!start.converged) return start;
      last_->force = limits[host - 1];
    }
  }
  const HeightCondition condition{beam_->loaded, load.height, HeightCondition::Unknown::shift};
  applied_ = loads(load, *beam_);
  PathReport report =
      advance(beam_->system, state_, loads(*last_, *beam_), applied_, options, condition, progress);
  report.iterations += start.iterations;
  return report;
}

BeamStep ContactSolver::solve(const ContactLoad& load, const PathProgress& progress) {
  BeamStep step;
  try {
    const std::vector<double>& limits = limit_forces(load.height, step.iterations);
    step.slip_off_force = limits.back();
    const std::vector<double> ends = cilium_.interfaces();
    std::size_t host = 0;
    while (host < limits.size() && (ends[host + 1] <= load.height || limits[host] < load.force))
      ++host;
    if (host == limits.size()) {
      std::ostringstream text;
      text << "the tip sinks to the contact height of " << load.height << " m under "
           << limits.back() << " N; no equilibrium bears " << load.force << " N";
      step.status = Status::slipped_off;
      step.message = text.str();
      return step;
    }
    const PathReport report = follow(load, host, limits, progress);
    step.iterations += report.iterations;
    if (!report.converged) {
      last_.reset();
      step.message = report.message;
      return step;
    }
    last_ = load;
    step.status = Status::converged;
    step.contact_arclength = ends[host] + state_.shift;
  } catch (const SolverError& error) {
    last_.reset();
    step.message = error.what();
  }
  return step;
}

}  // namespace ciliaval::fem::beam

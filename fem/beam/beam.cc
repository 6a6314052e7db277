// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/beam.h"

#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

#include "fem/beam/centreline.h"
#include "fem/beam/cilium_beam.h"
#include "fem/beam/contact.h"
#include "fem/beam/newton.h"
#include "fem/beam/stability/pull_in.h"
#include "fem/beam/stability/stability.h"
#include "fem/beam/sweep/sweep.h"
#include "fem/beam/touch/pinned_beam.h"
#include "problem/error.h"
#include "problem/error_estimate.h"
#include "problem/joints/companions.h"
#include "problem/pin/path.h"

namespace ciliaval::fem::beam {
namespace {

void require_valid(const BeamOptions& options) {
  if (options.degree < 1 || options.degree > 20)
    throw InputError("beam: the degree must lie between 1 and 20");
  if (options.refinement > 12) throw InputError("beam: the refinement must not exceed 12");
  if (!(options.tolerance > 0 && options.tolerance <= 1e-3))
    throw InputError("beam: the tolerance must lie between 0 and 1e-3");
  if (options.max_iterations < 1) throw InputError("beam: max_iterations must be at least 1");
}

/// Dead and flow loads: the equilibrium is followed from the straight cilium to the load.
class PathSolver {
 public:
  PathSolver(Cilium cilium, BeamOptions options, joints::Corrections corrections)
      : cilium_(std::move(cilium)), options_(options), corrections_(std::move(corrections)) {}

  MechanicsStep solve(const Load& load, const PathProgress& progress) {
    std::optional<double> load_at;
    if (const auto section = load.as<SectionLoad>()) load_at = section->arclength;
    if (!beam_ || load_at != load_at_) {
      load_at_ = load_at;
      beam_ = cilium_beam(cilium_, options_, load_at, corrections_);
      eigenvalue_at_rest_.reset();
      state_ = beam_->system.reference_state();
      applied_ = {};
      magnitude_ = magnitude(nothing_of(load));
    }
    const State before = state_;
    const Loads from = applied_;
    const Loads to = loads(cilium_, load, *beam_);
    const auto unstable_modes = [this](const State& state, const Loads& at) {
      return stability::unstable_modes(beam_->system, state, at);
    };
    NewtonOptions newton{options_.tolerance, options_.max_iterations, options_.max_cutbacks};
    newton.largest_turn = largest_turn(load);
    // A flow and a dead couple, which is about a fixed axis, have no potential.
    const bool may_buckle = newton.largest_turn && !load.is<FlowLoad>() && !load.is<MomentLoad>();
    if (may_buckle) newton.unstable_modes = unstable_modes;
    const PathReport report = advance(beam_->system, state_, from, to, newton, {}, progress);
    applied_ = report.converged ? to : combine(1 - report.reached, from, report.reached, to);
    MechanicsStep step;
    step.load = load;
    step.status = report.converged ? Status::converged : Status::failed;
    step.message = report.message;
    step.iterations = report.iterations;
    if (may_buckle && report.converged) judge(unstable_modes(state_, to), step);
    const stability::Way way{before, from, to, magnitude_, magnitude(load)};
    stability::judge_pull_in(cilium_, *beam_, way, newton, state_, step);
    // The next step starts from the straight cilium.
    if (step.status == Status::pulled_in) beam_.reset();
    magnitude_ = std::lerp(magnitude_, magnitude(load), report.reached);
    return step;
  }

  const CiliumBeam& beam() const { return *beam_; }
  const State& state() const { return state_; }
  const Loads& applied() const { return applied_; }

 private:
  void judge(int unstable_modes, MechanicsStep& step) {
    System& system = beam_->system;
    const auto eigenvalue = [&](const State& state, const Loads& loads, int modes) {
      return stability::smallest_eigenvalue(system, state, loads, modes).value;
    };
    if (!eigenvalue_at_rest_) eigenvalue_at_rest_ = eigenvalue(system.reference_state(), {}, 0);
    step.unstable_modes = unstable_modes;
    // Joints of negative compliance have negative eigenvalues of their own, far below 0.
    if (unstable_modes == 0 || corrections_.empty())
      step.smallest_eigenvalue =
          eigenvalue(state_, applied_, unstable_modes) / *eigenvalue_at_rest_;
    if (unstable_modes > 0) step.message = not_stable(unstable_modes);
  }

  Cilium cilium_;
  BeamOptions options_;
  joints::Corrections corrections_;
  std::optional<double> load_at_;
  std::optional<CiliumBeam> beam_;
  std::optional<double> eigenvalue_at_rest_;
  State state_;
  Loads applied_;
  double magnitude_ = 0;  ///< of the load that is applied
};

PathProgress told(const Progress& progress, std::size_t step, std::size_t steps) {
  if (!progress) return {};
  return [progress, step, steps](double fraction, const NewtonReport& report) {
    std::ostringstream text;
    text << "step " << step + 1 << "/" << steps << ", fraction " << fraction
         << " of the increment, " << report.increments.size() << " iterations, residual "
         << report.residuals.back() << (report.converged ? "" : ", not converged");
    progress(text.str());
  };
}

MechanicsStep solve_step(const Cilium& cilium, const Load& load, PathSolver& path,
                         ContactSolver& contact, const PathProgress& progress) {
  const auto finished = [&](auto& solver) {
    MechanicsStep step = solver.solve(load, progress);
    if (step.status != Status::converged) return step;
    const System& system = solver.beam().system;
    step.unknowns = system.n_unknowns();
    const Vector3 reaction = system.reaction(system.residual(solver.state(), solver.applied()), 0);
    step.applied_force =
        -reaction.dot(direction(load)) - environment_force(cilium, load) -
        system.force_of_magnets(solver.state(), solver.applied()).dot(direction(load));
    step.deformation = Deformation{centreline(system, solver.state()), nullptr};
    if (stability::touches_magnet(cilium, step.deformation->centreline, step))
      step.deformation.reset();
    return step;
  };
  return contact_height(load) ? finished(contact) : finished(path);
}

MechanicsStep solve_touch(const Cilium& cilium, const Load& load, pin::PathSolver& touching) {
  MechanicsStep step;
  step.load = load;
  try {
    touching.solve(step);
    if (step.deformation && stability::touches_magnet(cilium, step.deformation->centreline, step))
      step.deformation.reset();
  } catch (const SolverError& error) {
    step.status = Status::failed;
    step.message = error.what();
  }
  return step;
}

std::vector<MechanicsStep> solve_path(const Cilium& cilium, const LoadPath& path,
                                      const BeamOptions& options,
                                      const joints::Corrections& corrections,
                                      const Progress& progress) {
  std::vector<MechanicsStep> steps;
  pin::PathSolver touching(
      [&](const Load& load) { return touch::pinned_beam(cilium, load, options, corrections); },
      false);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const auto start = std::chrono::steady_clock::now();
    if (!path[i].touch().is_plain()) {
      steps.push_back(solve_touch(cilium, path[i], touching));
    } else {
      // Anew for each load: a result does not depend on the steps before it.
      PathSolver path_solver(cilium, options, corrections);
      ContactSolver contact_solver(cilium, options, corrections);
      steps.push_back(
          solve_step(cilium, path[i], path_solver, contact_solver, told(progress, i, path.size())));
    }
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    steps.back().seconds = time.count();
    report_step(progress, steps, path.size());
  }
  return steps;
}

/// The degree of the companion, over that of the result, and the safety of the estimate: what the
/// companion itself may be wrong by, in parts of the difference.
constexpr unsigned int companion_degrees = 2;
constexpr double safety = 1.25;

/// Rounding of tips over L, angles and forces over the applied one: measured on random cilia, up to
/// 1.3e-15.
constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();

/// Relative error of the equilibria of a sweep, in the same units: a held tip keeps the error of
/// the place where it stopped (Sweep tests of the beam).
constexpr double sweep_error = 1e-8;

bool is_sweep(const LoadPath& path) {
  return !path.empty() && path.front().is<SweepLoad>();
}

/// The azimuth in whose frame the path is solved, that the sides of a rectangle are along the axes.
double frame_azimuth(const Cilium& cilium, const LoadPath& path) {
  if (!cilium.is_rectangular()) return 0;
  return path.empty() ? cilium.section.orientation : azimuth(path.front());
}

void turn(MechanicsResult& result, const LoadPath& path, double angle) {
  result.undeformed = turned(result.undeformed, angle);
  for (std::size_t i = 0; i < path.size(); ++i) {
    MechanicsStep& step = result.steps[i];
    step.load = path[i];
    if (step.deformation) step.deformation = turned(*step.deformation, angle);
  }
  for (MechanicsResult& companion : result.companions) turn(companion, path, angle);
}

MechanicsResult solve_all(const Cilium& cilium, const LoadPath& path, const BeamOptions& options,
                          const joints::Corrections& corrections, const Progress& progress) {
  MechanicsResult result;
  const CiliumBeam straight = cilium_beam(cilium, options);
  result.undeformed.centreline = centreline(straight.system, straight.system.reference_state());
  result.steps = is_sweep(path) ? sweep::solve(cilium, path, options, progress)
                                : solve_path(cilium, path, options, corrections, progress);
  return result;
}

}  // namespace

MechanicsResult Beam::solve(const Cilium& cilium, const LoadPath& path,
                            const Progress& progress) const {
  require_valid(options_);
  ciliaval::require_valid(cilium);
  for (const Load& load : path) {
    ciliaval::require_valid(load, cilium);
    if (load.is<SweepLoad>() && !surroundings::is_empty(load.environment()))
      throw InputError("the beam takes a sweep without an environment only");
  }
  if (const double angle = frame_azimuth(cilium, path); angle != 0) {
    LoadPath in_frame;
    for (const Load& load : path) in_frame.push_back(turned(load, -angle));
    MechanicsResult result = solve(turned(cilium, -angle), in_frame, progress);
    turn(result, path, angle);
    return result;
  }
  const bool corrects = options_.joints == joints::Correction::corrected;
  if (corrects && is_sweep(path))
    throw InputError("beam: joints = \"corrected\" takes no sweep: take joints = \"none\"");
  const joints::Corrections corrections =
      corrects ? joints::corrections(cilium) : joints::Corrections{};
  MechanicsResult result = solve_all(cilium, path, options_, corrections, progress);
  if (corrects) joints::remark_on_strains(cilium, result.steps);
  if (options_.error_estimate) {
    BeamOptions higher = options_;
    higher.degree += companion_degrees;
    result.companions.push_back(
        companion_of(result, [&] { return solve_all(cilium, path, higher, corrections, {}); }));
    result.error_parts = {{"degree", 1, 0, safety}};
    result.algebraic_error = is_sweep(path) ? sweep_error : rounding;
    for (std::size_t i = 0; i < path.size(); ++i)
      result.steps[i].seconds += result.companions.front().steps[i].seconds;
    if (corrects)
      joints::add_companion(result, cilium, corrections,
                            [&](const LoadPath& loads, const joints::Corrections& changed) {
                              return solve_path(cilium, loads, options_, changed, {});
                            });
    estimate_errors(result);
    // At slip-off the force follows from the tip's height, to Newton's tolerance.
    for (MechanicsStep& step : result.steps)
      if (step.slip_off_uncertainty)
        *step.slip_off_uncertainty += options_.tolerance * *slip_off_limit(step);
    sweep::forget_uncertainties_near_jumps(result);
  }
  return result;
}

}  // namespace ciliaval::fem::beam

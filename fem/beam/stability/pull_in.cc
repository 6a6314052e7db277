// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/stability/pull_in.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "fem/beam/centreline.h"
#include "fem/beam/stability/stability.h"
#include "problem/continuation/turning_point.h"
#include "problem/error.h"

namespace ciliaval::fem::beam::stability {
namespace {

using Eigen::Index;

/// Part of the way that is tried first: a strong magnet ends it early.
constexpr double first_part = 1.0 / 64;

/// Increment of Newton's method along a branch, of r/L, θ and t, below which it ends: its error is
/// of the square.
constexpr double increment_tolerance = 1e-8;

/// The branch of equilibria R(x, t) = 0, R the residual under (1−t) from + t to. It goes on by
/// c·(r − r₀)/L = s, c the unit vector along the displacements of the tangent dx/ds:
///
///   dx/ds = dt/ds b,   b = −K⁻¹ ∂R/∂t,   dt/ds = ±1/|b_r|,
///
/// and is solved by block elimination, a = −K⁻¹ R, Δt = (s − c·(r − r₀)/L − c·a)/(c·b),
/// Δx = a + Δt b.
class BeamBranch {
 public:
  /// An equilibrium of the branch.
  struct Point {
    State state;
    double fraction = 0;
    double rate = 0;          ///< dt/ds
    Eigen::VectorXd tangent;  ///< dx/ds
    Eigen::VectorXd along;    ///< c
  };

  BeamBranch(System& system, const Way& way, const NewtonOptions& options)
      : system_(system), way_(way), options_(options) {
    now_.state = way.start;
    set_tangent(now_, nullptr);
  }

  continuation::BranchPoint start() const { return {now_.fraction, now_.rate}; }
  const Point& accepted() const { return now_; }
  const Point& found() const { return found_; }
  Loads loads(double t) const { return combine(1 - t, way_.from, t, way_.to); }
  /// ω nearest to 0.
  double eigenvalue(const Point& point) {
    return smallest_eigenvalue(system_, point.state, loads(point.fraction), 0).value;
  }

  std::optional<continuation::BranchPoint> find(double s) {
    try {
      return corrected(s);
    } catch (const SolverError&) {  // inside a magnet, or a singular tangent
      return std::nullopt;
    }
  }
  void accept() { now_ = found_; }

 private:
  std::optional<continuation::BranchPoint> corrected(double s) {
    Point trial = now_;
    system_.update(trial.state, s * now_.tangent);
    trial.fraction += s * now_.rate;
    for (unsigned int iteration = 0; iteration < options_.max_iterations; ++iteration) {
      const Loads at = loads(trial.fraction);
      const Eigen::VectorXd residual = system_.residual(trial.state, at);
      system_.factorize(trial.state, at);
      Eigen::VectorXd change = -system_.solve(residual);
      const Eigen::VectorXd b = response(trial.state);
      const double t = (s - way_along(trial.state) - now_.along.dot(change)) / now_.along.dot(b);
      change += t * b;
      if (!change.allFinite() || !std::isfinite(t)) return std::nullopt;
      system_.update(trial.state, change);
      trial.fraction += t;
      if (turn_between(now_.state, trial.state) > turn_in_environment) return std::nullopt;
      if (std::max(nodal_size(change), std::abs(t)) > increment_tolerance) continue;
      set_tangent(trial, &now_.along);
      found_ = std::move(trial);
      return continuation::BranchPoint{found_.fraction, found_.rate, now_.along.dot(found_.along)};
    }
    return std::nullopt;
  }

  /// b of the last factors.
  Eigen::VectorXd response(const State& state) const {
    return -system_.solve(system_.residual(state, way_.to) - system_.residual(state, way_.from));
  }

  /// c·(r − r₀)/L.
  double way_along(const State& state) const {
    double sum = 0;
    for (std::size_t j = 0; j < state.position.size(); ++j)
      sum += now_.along.segment<3>(static_cast<Index>(system_.node_unknown(j, 0)))
                 .dot(state.position[j] - now_.state.position[j]);
    return sum / system_.length_scale();
  }

  double nodal_size(const Eigen::VectorXd& change) const {
    double size = 0;
    for (std::size_t j = 0; j < now_.state.position.size(); ++j)
      size = std::max(size, change.segment<6>(static_cast<Index>(system_.node_unknown(j, 0)))
                                .lpNorm<Eigen::Infinity>());
    return size;
  }

  /// dx/ds, dt/ds and c at an equilibrium; the first goes the way of t, others that of `before`.
  void set_tangent(Point& point, const Eigen::VectorXd* before) {
    system_.factorize(point.state, loads(point.fraction));
    const Eigen::VectorXd b = response(point.state);
    Eigen::VectorXd displacement = Eigen::VectorXd::Zero(b.size());
    for (std::size_t j = 0; j < point.state.position.size(); ++j) {
      const auto row = static_cast<Index>(system_.node_unknown(j, 0));
      displacement.segment<3>(row) = b.segment<3>(row);
    }
    if (displacement.isZero(0)) throw SolverError("the beam stays where it is");
    const double sign = before != nullptr && before->dot(displacement) < 0 ? -1 : 1;
    point.rate = sign / displacement.norm();
    point.tangent = point.rate * b;
    point.along = point.rate * displacement;
  }

  System& system_;
  const Way& way_;
  const NewtonOptions& options_;
  Point now_;
  Point found_;
};

/// The magnet that pulls most.
std::string strongest_magnet(const System& system, const State& state, const Loads& loads) {
  Loads one = loads;
  std::string name;
  double largest = -1;
  for (const surroundings::magnets::Magnet& magnet : loads.magnets) {
    one.magnets = {magnet};
    const double force = system.force_of_magnets(state, one).norm();
    if (force > largest) {
      largest = force;
      name = magnet.name;
    }
  }
  return name;
}

bool has_potential(const Loads& loads) {
  return loads.force_per_height.isZero(0);
}

/// A fold with the centreline there.
struct Fold {
  continuation::PullIn pull_in;
  Centreline centreline;
};

/// The fold at which the branch from the start of the way turns back before its end; none if it
/// does not, or if no statement can be made.
std::optional<Fold> find_fold(CiliumBeam& beam, const Way& way, const NewtonOptions& options) {
  if (way.from.magnets.empty() && way.to.magnets.empty()) return std::nullopt;
  try {
    System& system = beam.system;
    BeamBranch branch(system, way, options);
    continuation::PullIn result;
    double at_rest = 1;
    const bool is_judged = has_potential(way.from) && has_potential(way.to);
    if (is_judged) at_rest = smallest_eigenvalue(system, system.reference_state(), {}, 0).value;
    const auto note = [&](const BeamBranch::Point& point) {
      if (is_judged)
        result.approach.push_back({point.fraction, branch.eigenvalue(point) / at_rest});
    };
    note(branch.accepted());
    const continuation::Branch steps{[&](double s) { return branch.find(s); },
                                     [&] {
                                       branch.accept();
                                       note(branch.accepted());
                                     }};
    const auto fold = continuation::turning_point(steps, branch.start(), first_part);
    if (!fold) return std::nullopt;
    note(branch.found());
    result.fraction = fold->fraction;
    result.load = std::lerp(way.magnitude_before, way.magnitude, fold->fraction);
    result.magnet = strongest_magnet(system, branch.found().state, branch.loads(fold->fraction));
    Centreline line = centreline(system, branch.found().state);
    const CentrelinePoint tip = line.at(line.length());
    result.tip = tip.position;
    result.tip_angle = tip.theta();
    return Fold{std::move(result), std::move(line)};
  } catch (const SolverError&) {  // no statement
    return std::nullopt;
  }
}

}  // namespace

bool touches_magnet(const Cilium& cilium, const Centreline& centreline, MechanicsStep& step) {
  const auto touched =
      surroundings::touched_magnet(acting_environment(step.load), cilium, centreline);
  if (!touched) return false;
  step.status = Status::failed;
  step.message = continuation::touches_magnet(*touched);
  return true;
}

void judge_pull_in(const Cilium& cilium, CiliumBeam& beam, const Way& way,
                   const NewtonOptions& options, const State& end, MechanicsStep& step) {
  std::optional<Fold> fold = find_fold(beam, way, options);
  if (!fold || touches_magnet(cilium, fold->centreline, step)) return;
  step.pull_in = std::move(fold->pull_in);
  if (step.status == Status::converged &&
      !touches_magnet(cilium, centreline(beam.system, end), step)) {
    step.message += (step.message.empty() ? "" : "; ") + continuation::jumps(*step.pull_in);
    return;
  }
  step.status = Status::pulled_in;
  step.message = continuation::pulled_in(*step.pull_in);
}

}  // namespace ciliaval::fem::beam::stability

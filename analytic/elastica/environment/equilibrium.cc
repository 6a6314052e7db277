// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/environment/equilibrium.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <sstream>

#include "analytic/elastica/environment/series.h"
#include "problem/error.h"
#include "problem/types.h"

namespace ciliaval::analytic::elastica::environment {
namespace {

constexpr int most_iterations = 12;
constexpr double smallest_step = 1e-7;  ///< of a path
/// A step that ends at an equilibrium with more unstable modes than it started from may have leapt
/// over a bifurcation to a branch that the path does not lead to. It is halved, down to this: then
/// the path itself goes there.
constexpr double smallest_leap = 1e-3;
constexpr double largest_turn = 0.6;  ///< of the tip in a step of a path, rad

/// Accuracy of the series.
struct Accuracy {
  double tolerance = 1e-17;
  double fraction = 1;
};

/// What the integration from the tip down finds.
template <class T>
struct Descent {
  State<T> base;
  State<T> at_force;
  int sign_changes = 0;  ///< of ∂θ/∂θ(1), if T is a Dual
};

/// Sign changes of ∂θ/∂θ(1) within a step, looked for at points that are closer than its waves.
int sign_changes(const Series<Dual>& step) {
  constexpr int points = 16;
  int changes = 0;
  bool is_negative = step.at(0.0).theta.by[0] < 0;
  for (int k = 1; k <= points; ++k) {
    const bool next = step.at(static_cast<double>(k) / points).theta.by[0] < 0;
    changes += next != is_negative ? 1 : 0;
    is_negative = next;
  }
  return changes;
}
int sign_changes(const Series<double>& /*step*/) {
  return 0;
}

/// Integrates from the tip to the base, where w = z = 0 count from the tip.
template <class T>
class Down {
 public:
  Down(const Rod& rod, const T& tip_angle, const T& force, const T& at, const Accuracy& accuracy,
       std::vector<Series<T>>* steps)
      : rod_(rod), accuracy_(accuracy), steps_(steps) {
    state_.S = T(1.0);
    state_.theta = tip_angle;
    add(rod.at_ends.back());
    bool is_passed = value_of(at) >= 1;
    if (is_passed) pass(force);
    for (std::size_t i = rod.compliance.size(); i-- > 0;) {
      if (!is_passed && value_of(at) >= rod.ends[i]) {
        march(i, at);
        pass(force);
        is_passed = true;
      }
      march(i, T(rod.ends[i]));
      if (i > 0) add(rod.at_ends[i]);
    }
    result_.base = state_;
  }
  const Descent<T>& result() const { return result_; }

 private:
  void add(const PlanarForce& force) {
    state_.along += T(force.along);
    state_.vertical += T(force.vertical);
  }
  void pass(const T& force) {
    result_.at_force = state_;
    state_.along += force;
  }
  void march(std::size_t i, const T& target) {
    const Forces forces{rod_.compliance[i], rod_.per_length[i].along, rod_.per_length[i].vertical,
                        rod_.per_height};
    while (true) {
      const Series<T> step(state_, forces, target, accuracy_.tolerance, accuracy_.fraction);
      state_ = step.at_end();
      result_.sign_changes += sign_changes(step);
      if (steps_ != nullptr && step.start() != step.end()) steps_->push_back(step);
      if (step.complete()) break;
    }
    state_.S = target;
  }

  const Rod& rod_;
  Accuracy accuracy_;
  std::vector<Series<T>>* steps_;
  State<T> state_;
  Descent<T> result_;
};

Descent<Dual> descend(const Rod& rod, const Unknowns& u, const Accuracy& accuracy) {
  const auto unknown = [](double value, int i) {
    return Dual(value, Eigen::Vector3d::Unit(i).array());
  };
  return Down<Dual>(rod, unknown(u.tip_angle, 0), unknown(u.force, 1), unknown(u.at, 2), accuracy,
                    nullptr)
      .result();
}

/// The equations' left sides: θ(0), and two of the conditions'.
std::array<Dual, 3> residuals(const Descent<Dual>& descent, const Conditions& conditions,
                              const Unknowns& u) {
  const Dual height = descent.at_force.z - descent.base.z;
  const Dual deflection = descent.at_force.w - descent.base.w;
  std::array<Dual, 3> result{descent.base.theta};
  std::size_t i = 1;
  const auto add = [&](const Dual& value, const std::optional<double>& target) {
    if (target && i < result.size()) result[i++] = value - Dual(*target);
  };
  add(height, conditions.height);
  add(Dual(u.at, Eigen::Vector3d::Unit(2).array()), conditions.at);
  add(Dual(u.force, Eigen::Vector3d::Unit(1).array()), conditions.force);
  add(deflection, conditions.deflection);
  return result;
}

Accuracy accuracy_of(double tolerance) {
  return {std::clamp(1e-4 * tolerance, 1e-17, 1e-8), 1};
}

}  // namespace

Rod scaled(const Rod& rod, double t) {
  Rod result = rod;
  const auto scale = [t](PlanarForce& force) { force = {t * force.along, t * force.vertical}; };
  std::ranges::for_each(result.per_length, scale);
  std::ranges::for_each(result.at_ends, scale);
  result.per_height *= t;
  return result;
}

std::optional<Equilibrium> solve(const Rod& rod, const Conditions& conditions,
                                 const Unknowns& guess, double tolerance) {
  const Accuracy accuracy = accuracy_of(tolerance);
  Equilibrium result{guess};
  Unknowns& u = result.unknowns;
  double last = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const Descent<Dual> descent = descend(rod, u, accuracy);
    const auto r = residuals(descent, conditions, u);
    Eigen::Matrix3d jacobian;
    Eigen::Vector3d right;
    for (Eigen::Index i = 0; i < 3; ++i) {
      right[i] = -r[static_cast<std::size_t>(i)].value;
      jacobian.row(i) = r[static_cast<std::size_t>(i)].by.matrix();
    }
    // Each unknown's column by its own size: a force per angle may be 1e3 and more.
    const Eigen::RowVector3d scale =
        jacobian.colwise().norm().cwiseMax(std::numeric_limits<double>::min()).cwiseInverse();
    const Eigen::Vector3d step =
        scale.transpose().cwiseProduct((jacobian * scale.asDiagonal()).fullPivLu().solve(right));
    result.iterations = iteration + 1;
    if (!step.allFinite()) return std::nullopt;
    const double size =
        std::max({std::abs(step[0]), std::abs(step[1]) / std::max(1.0, std::abs(u.force)),
                  std::abs(step[2])});
    result.deflection = (descent.at_force.w - descent.base.w).value;
    result.height = (descent.at_force.z - descent.base.z).value;
    result.unstable_modes = descent.sign_changes;
    const double enough = 4 * epsilon * std::max(1.0, std::abs(u.tip_angle));
    // A step may vanish because the Jacobian is singular, too.
    const bool is_solved = right.cwiseAbs().maxCoeff() < 1e-10;
    if (is_solved && (size <= enough || (size < 1e-9 && size > 0.5 * last))) return result;
    if (size > 1e3 || (iteration > 4 && size > last)) return std::nullopt;
    u = {u.tip_angle + step[0], u.force + step[1], u.at + step[2]};
    if (!(u.at > 0 && u.at < 1 + 1e-3)) return std::nullopt;
    u.at = std::min(u.at, 1.0);
    last = size;
  }
  return std::nullopt;
}

Equilibrium follow(const Path& path, const Unknowns& start, double tolerance) {
  const auto at = [&](double t, const Unknowns& guess) {
    const auto [rod, conditions] = path(t);
    return solve(rod, conditions, guess, tolerance);
  };
  int iterations = 0;
  std::optional<Equilibrium> last;  // for the extrapolation
  double last_t = 0;
  std::optional<Equilibrium> now = at(0, start);
  if (!now) throw SolverError("elastica: no equilibrium to start from");
  double t = 0;
  double step = 1;
  int allowed = now->unstable_modes;
  while (t < 1) {
    const double next = std::min(1.0, t + step);
    Unknowns guess = now->unknowns;
    if (last) {
      const double factor = (next - t) / (t - last_t);
      guess.tip_angle += factor * (now->unknowns.tip_angle - last->unknowns.tip_angle);
      guess.force += factor * (now->unknowns.force - last->unknowns.force);
      guess.at += factor * (now->unknowns.at - last->unknowns.at);
      guess.at = std::clamp(guess.at, 1e-6, 1.0);
    }
    const std::optional<Equilibrium> found = at(next, guess);
    if (found) iterations += found->iterations;
    const bool is_near =
        found && std::abs(found->unknowns.tip_angle - now->unknowns.tip_angle) <= largest_turn;
    const bool leaves = is_near && found->unstable_modes > allowed && next - t > smallest_leap;
    if (is_near && !leaves) {
      allowed = std::max(allowed, found->unstable_modes);
      last = std::exchange(now, found);
      last_t = std::exchange(t, next);
      step *= 2;
      continue;
    }
    step = (next - t) / 2;
    if (step < smallest_step) {
      std::ostringstream text;
      text << "elastica: the branch of equilibria ends at " << 100 * t
           << " % of the way from the straight cilium, at a tip angle of "
           << now->unknowns.tip_angle * 180 / std::numbers::pi << " deg";
      throw SolverError(text.str());
    }
  }
  now->iterations = iterations;
  return *now;
}

PlanarShape shape(const Rod& rod, const Equilibrium& equilibrium, double tolerance) {
  const Unknowns& u = equilibrium.unknowns;
  const Accuracy accuracy = accuracy_of(tolerance);
  std::vector<Series<double>> steps;
  const auto run = [&](const Accuracy& a, std::vector<Series<double>>* kept) {
    return Down<double>(rod, u.tip_angle, u.force, u.at, a, kept).result();
  };
  const Descent<double> fine = run({accuracy.tolerance, 0.6}, &steps);
  const Descent<double> check = run(accuracy, nullptr);
  std::ranges::reverse(steps);

  PlanarShape shape;
  shape.breaks = rod.ends;
  add_break(shape.breaks, u.at);
  // θ(0), which is not quite 0, turns all of it.
  shape.error =
      std::max(std::abs(fine.base.w - check.base.w), std::abs(fine.base.z - check.base.z)) +
      std::abs(fine.base.theta);
  shape.iterations = equilibrium.iterations;
  const auto shared = std::make_shared<const std::vector<Series<double>>>(std::move(steps));
  shape.state = [shared, breaks = shape.breaks, base = fine.base](double S, std::size_t i) {
    const double inside = std::clamp(S, std::nextafter(breaks[i], breaks[i + 1]),
                                     std::nextafter(breaks[i + 1], breaks[i]));
    const auto above = std::ranges::upper_bound(*shared, inside, {},
                                                [](const Series<double>& s) { return s.end(); });
    const Series<double>& step = *(above == shared->begin() ? above : std::prev(above));
    const State<double> state = step.at((S - step.start()) / (step.end() - step.start()));
    PlanarState result;
    result.S = S;
    result.theta = state.theta;
    result.phi = std::numbers::pi / 2 - state.theta;
    result.w = state.w - base.w;
    result.z = state.z - base.z;
    result.moment = state.moment;
    result.force = state.along;
    result.vertical = state.vertical;
    result.curvature = step.flexibility() * state.moment;
    return result;
  };
  return shape;
}

std::optional<double> critical_scale(const Rod& rod, double most) {
  const auto base_angle = [&](double t) {
    return descend(scaled(rod, t), {}, accuracy_of(1e-12)).base.theta.by[0];
  };
  // By steps that are small against the distance of two critical loads.
  constexpr int steps = 400;
  double below = 0;
  double f_below = 1;
  for (int k = 1; k <= steps; ++k) {
    const double t = most * k / steps;
    const double f = base_angle(t);
    if (f <= 0) return root(base_angle, below, t, f_below, f);
    below = t;
    f_below = f;
  }
  return std::nullopt;
}

}  // namespace ciliaval::analytic::elastica::environment

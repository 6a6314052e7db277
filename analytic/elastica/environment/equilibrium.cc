// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/environment/equilibrium.h"

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <sstream>

#include "analytic/elastica/environment/descent.h"
#include "analytic/elastica/environment/series.h"
#include "problem/continuation/root.h"
#include "problem/error.h"
#include "problem/types.h"

namespace ciliaval::analytic::elastica::environment {
namespace {

constexpr int most_iterations = 12;
constexpr double smallest_step = 1e-7;  ///< of a path
/// A step that ends at an equilibrium with more unstable modes than it started from may have leapt
/// over a bifurcation to a branch that the path does not lead to. It is halved, down to this part
/// of the way so far: then the path itself goes there.
constexpr double smallest_leap = 1e-3;  ///< over t
constexpr double largest_turn = 0.6;    ///< of a section in a step of a path, rad

/// Between two nodes errors grow by e to this at most: two digits of sixteen.
constexpr double most_foldings = 4;

/// Sign changes of ∂θ/∂θ(1) within a step, looked for at points that are closer than its waves.
/// `variation` holds ∂θ, ∂M and ∂H where the descent has begun.
int sign_changes(const Series<Dual>& step, const Eigen::Vector3d& variation) {
  constexpr int points = 16;
  const auto is_negative = [&](int k) {
    const Dual theta = step.theta_at(static_cast<double>(k) / points);
    return theta.by.head<3>().matrix().dot(variation) < 0;
  };
  int changes = 0;
  bool last = is_negative(0);
  for (int k = 1; k <= points; ++k) {
    const bool next = is_negative(k);
    changes += next != last ? 1 : 0;
    last = next;
  }
  return changes;
}

/// e-foldings of errors in a step.
double e_foldings(const Series<double>& step) {
  const auto force = [](const State<double>& s) {
    return std::abs(s.along) + std::abs(s.vertical);
  };
  return std::sqrt(step.flexibility() * std::max(force(step.at(0)), force(step.at_end()))) *
         std::abs(step.end() - step.start());
}

Descent<double> from_tip(const Rod& rod, const Unknowns& u, const Accuracy& accuracy) {
  return {rod, u.tip_angle, u.force, u.at, accuracy};
}

/// From node i on.
void begin_anew(Descent<double>& descent, const Node& node) {
  descent.begin_anew(node.theta, node.moment, node.along);
}

/// Adds nodes in equal parts of e-foldings where there are too many between two of them.
std::vector<Node> with_further_nodes(const Rod& rod, const Unknowns& u, const Accuracy& accuracy) {
  std::vector<Node> nodes;
  Descent<double> descent = from_tip(rod, u, accuracy);
  for (std::size_t i = 0; i <= u.nodes.size(); ++i) {
    std::vector<Series<double>> steps;
    double sum = 0;
    descent.to(i < u.nodes.size() ? u.nodes[i].S : 0, [&](const Series<double>& step) {
      steps.push_back(step);
      sum += e_foldings(step);
    });
    const double part = sum / std::ceil(std::max(sum / most_foldings, 1.0));
    double next = part;
    double passed = 0;
    for (const Series<double>& step : steps) {
      const double size = e_foldings(step);
      for (; next < passed + size && next < (1 - 1e-6) * sum; next += part) {
        const State<double> state = step.at((next - passed) / size);
        nodes.push_back({state.S, state.theta, state.moment, state.along});
      }
      passed += size;
    }
    if (i == u.nodes.size()) break;
    nodes.push_back(u.nodes[i]);
    begin_anew(descent, u.nodes[i]);
  }
  return nodes;
}

using Vector = Eigen::VectorXd;
using Triplet = Eigen::Triplet<double>;

/// The equations' left sides and their derivatives. Unknowns: θ(1), F, its S, then θ, M, H at each
/// node. Equations: θ(0) = 0, the two conditions, then what θ, M, H come to at each node from
/// above.
class Equations {
 public:
  Equations(const Rod& rod, const Conditions& conditions, const Unknowns& u,
            const Accuracy& accuracy)
      : residuals_(Vector::Zero(size(u))), scales_(Vector::Ones(size(u))) {
    Descent<Dual> descent(rod, Dual::variable(u.tip_angle, 0), Dual::variable(u.force, 3),
                          Dual::variable(u.at, 4), accuracy);
    scale(u);
    Eigen::Vector3d variation = Eigen::Vector3d::UnitX();
    Row height;
    Row deflection;
    for (std::size_t i = 0; i <= u.nodes.size(); ++i) {
      const bool is_last = i == u.nodes.size();
      descent.to(is_last ? 0 : u.nodes[i].S, [&](const Series<Dual>& step) {
        unstable_modes_ += sign_changes(step, variation);
        note_angles(step);
      });
      const State<Dual>& end = descent.state();
      // From the point force to the base, part by part.
      if (const auto& at_force = descent.at_force()) {
        height.value = at_force->z.value;
        deflection.value = at_force->w.value;
        add_derivatives(at_force->z, i, height);
        add_derivatives(at_force->w, i, deflection);
      }
      if (descent.is_passed()) {
        add_derivatives(-end.z, i, height);
        add_derivatives(-end.w, i, deflection);
      }
      if (is_last) {
        set(0, end.theta, i);
        break;
      }
      const Node& node = u.nodes[i];
      const std::array come_to{end.theta, end.moment, end.along};
      const std::array begins{node.theta, node.moment, node.along};
      Eigen::Vector3d next;
      for (int c = 0; c < 3; ++c) {
        const auto k = static_cast<std::size_t>(c);
        set(node_unknown(i) + c, come_to[k] - Dual(begins[k]), i);
        triplets_.emplace_back(node_unknown(i) + c, node_unknown(i) + c, -1);
        next[c] = come_to[k].by.head<3>().matrix().dot(variation);
      }
      variation = next.normalized();
      descent.begin_anew(Dual::variable(node.theta, 0), Dual::variable(node.moment, 1),
                         Dual::variable(node.along, 2));
    }
    height.value -= descent.state().z.value;
    deflection.value -= descent.state().w.value;
    height_ = height.value;
    deflection_ = deflection.value;
    set(conditions, u, height, deflection);
  }

  const Vector& residuals() const { return residuals_; }  ///< over their scales
  /// Sizes of the unknowns of the nodes and of their equations; 1 of the others.
  const Vector& scales() const { return scales_; }
  double height() const { return height_; }
  double deflection() const { return deflection_; }
  int unstable_modes() const { return unstable_modes_; }
  const std::array<double, 16>& angles() const { return angles_; }

  /// The step of Newton's method, over the scales; none where the Jacobian is singular.
  std::optional<Vector> step() const {
    Eigen::SparseMatrix<double> jacobian(residuals_.size(), residuals_.size());
    jacobian.setFromTriplets(triplets_.begin(), triplets_.end());
    jacobian = scales_.cwiseInverse().asDiagonal() * jacobian * scales_.asDiagonal();
    const Eigen::SparseLU<Eigen::SparseMatrix<double>> factors(jacobian);
    if (factors.info() != Eigen::Success) return std::nullopt;
    Vector result = factors.solve(-residuals_);
    if (!result.allFinite()) return std::nullopt;
    return result;
  }

  static Eigen::Index size(const Unknowns& u) { return node_unknown(u.nodes.size()); }
  static int node_unknown(std::size_t i) { return 3 + 3 * static_cast<int>(i); }

 private:
  /// A left side.
  struct Row {
    double value = 0;
    std::vector<std::pair<int, double>> by;  ///< column, derivative
  };

  /// Adds those of a term of part i, which begins at node i − 1 or at the tip.
  static void add_derivatives(const Dual& term, std::size_t i, Row& row) {
    const int first = i == 0 ? 0 : node_unknown(i - 1);
    for (int k = 0; k < (i == 0 ? 1 : 3); ++k) row.by.emplace_back(first + k, term.by[k]);
    row.by.emplace_back(1, term.by[3]);
    row.by.emplace_back(2, term.by[4]);
  }
  void set(int number, const Row& row, double target) {
    residuals_[number] = (row.value - target) / scales_[number];
    for (const auto& [column, derivative] : row.by)
      triplets_.emplace_back(number, column, derivative);
  }
  void set(int number, const Dual& value, std::size_t i) {
    Row row{value.value, {}};
    add_derivatives(value, i, row);
    set(number, row, 0);
  }
  void set(const Conditions& conditions, const Unknowns& u, const Row& height,
           const Row& deflection) {
    int number = 1;
    const auto set_if = [&](const Row& row, const std::optional<double>& target) {
      if (target && number < 3) set(number++, row, *target);
    };
    set_if(height, conditions.height);
    set_if({u.at, {{2, 1}}}, conditions.at);
    set_if({u.force, {{1, 1}}}, conditions.force);
    set_if(deflection, conditions.deflection);
  }
  void note_angles(const Series<Dual>& step) {
    for (std::size_t k = 0; k < angles_.size(); ++k) {
      const double S = static_cast<double>(k) / static_cast<double>(angles_.size());
      if (S < step.end() || S >= step.start()) continue;
      angles_[k] = step.theta_at((S - step.start()) / (step.end() - step.start())).value;
    }
  }
  void scale(const Unknowns& u) {
    double moment = 1;
    double force = 1;
    for (const Node& node : u.nodes) {
      moment = std::max(moment, std::abs(node.moment));
      force = std::max(force, std::abs(node.along));
    }
    for (std::size_t i = 0; i < u.nodes.size(); ++i) {
      scales_[node_unknown(i) + 1] = moment;
      scales_[node_unknown(i) + 2] = force;
    }
  }

  Vector residuals_;
  Vector scales_;
  std::vector<Triplet> triplets_;
  double height_ = 0;
  double deflection_ = 0;
  int unstable_modes_ = 0;
  std::array<double, 16> angles_{};
};

/// u + step · scales.
Unknowns moved(Unknowns u, const Vector& step) {
  u.tip_angle += step[0];
  u.force += step[1];
  u.at += step[2];
  for (std::size_t i = 0; i < u.nodes.size(); ++i) {
    const Eigen::Index k = Equations::node_unknown(i);
    u.nodes[i].theta += step[k];
    u.nodes[i].moment += step[k + 1];
    u.nodes[i].along += step[k + 2];
  }
  return u;
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
  result.tip_moment *= t;
  return result;
}

double e_foldings(const Rod& rod, double force) {
  double sum = 0;
  PlanarForce above{force, 0};
  for (std::size_t i = rod.compliance.size(); i-- > 0;) {
    const double length = rod.ends[i + 1] - rod.ends[i];
    above.along += rod.at_ends[i + 1].along;
    above.vertical += rod.at_ends[i + 1].vertical;
    const PlanarForce top = above;
    above.along += (rod.per_length[i].along + rod.per_height) * length;
    above.vertical += rod.per_length[i].vertical * length;
    const double largest = std::max(std::abs(top.along) + std::abs(top.vertical),
                                    std::abs(above.along) + std::abs(above.vertical));
    sum += length * std::sqrt(rod.compliance[i] * largest);
  }
  return sum;
}

Unknowns interpolate(const Unknowns& a, const Unknowns& b, double t) {
  Unknowns result = b;
  result.tip_angle = std::lerp(a.tip_angle, b.tip_angle, t);
  result.force = std::lerp(a.force, b.force, t);
  result.at = std::lerp(a.at, b.at, t);
  if (a.nodes.size() != b.nodes.size()) return result;
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    result.nodes[i].theta = std::lerp(a.nodes[i].theta, b.nodes[i].theta, t);
    result.nodes[i].moment = std::lerp(a.nodes[i].moment, b.nodes[i].moment, t);
    result.nodes[i].along = std::lerp(a.nodes[i].along, b.nodes[i].along, t);
  }
  return result;
}

namespace {

std::optional<Equilibrium> newton(const Rod& rod, const Conditions& conditions,
                                  const Unknowns& guess, const Accuracy& accuracy) {
  Equilibrium result{guess};
  Unknowns& u = result.unknowns;
  u.nodes = with_further_nodes(rod, guess, accuracy);
  double last = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const Equations equations(rod, conditions, u, accuracy);
    const std::optional<Vector> step = equations.step();
    if (!step) return std::nullopt;
    Vector change = step->cwiseProduct(equations.scales());
    Vector relative = *step;
    relative[1] /= std::max(1.0, std::abs(u.force));
    const double size = relative.lpNorm<Eigen::Infinity>();
    result.iterations = iteration + 1;
    result.deflection = equations.deflection();
    result.height = equations.height();
    result.unstable_modes = equations.unstable_modes();
    result.angles = equations.angles();
    const double enough = 4 * epsilon * std::max(1.0, std::abs(u.tip_angle));
    // A step may vanish because the Jacobian is singular, too.
    const bool is_solved = equations.residuals().lpNorm<Eigen::Infinity>() < 1e-10;
    if (is_solved && (size <= enough || (size < 1e-9 && size > 0.5 * last))) return result;
    if (size > 1e3 || (iteration > 4 && size > last)) return std::nullopt;
    u = moved(std::move(u), change);
    if (!(u.at > 0 && u.at < 1 + 1e-3)) return std::nullopt;
    u.at = std::min(u.at, 1.0);
    last = size;
  }
  return std::nullopt;
}

/// The largest turn of a section from one equilibrium to the other, rad.
double turn_between(const Equilibrium& a, const Equilibrium& b) {
  double turn = std::abs(a.unknowns.tip_angle - b.unknowns.tip_angle);
  for (std::size_t k = 0; k < a.angles.size(); ++k)
    turn = std::max(turn, std::abs(a.angles[k] - b.angles[k]));
  return turn;
}

}  // namespace

std::optional<Equilibrium> solve(const Rod& rod, const Conditions& conditions,
                                 const Unknowns& guess, double tolerance) {
  try {
    return newton(rod, conditions, guess, accuracy_of(tolerance));
  } catch (const SolverError&) {
    return std::nullopt;  // a trial that coils up
  }
}

Equilibrium follow(const Path& path, const Unknowns& start, double tolerance, int attempts) {
  int used = 0;
  const auto at = [&](double t, const Unknowns& guess) {
    ++used;
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
      guess = interpolate(last->unknowns, now->unknowns, (next - last_t) / (t - last_t));
      guess.at = std::clamp(guess.at, 1e-6, 1.0);
    }
    const std::optional<Equilibrium> found = at(next, guess);
    if (found) iterations += found->iterations;
    const bool is_near = found && turn_between(*now, *found) <= largest_turn;
    const bool leaves =
        is_near && found->unstable_modes > allowed && next - t > smallest_leap * next;
    if (is_near && !leaves) {
      allowed = std::max(allowed, found->unstable_modes);
      last = std::exchange(now, found);
      last_t = std::exchange(t, next);
      step *= 2;
    } else {
      step = (next - t) / 2;
    }
    const bool is_short_of_attempts = t < 1 && used >= attempts;
    if (step >= smallest_step && !is_short_of_attempts) continue;
    std::ostringstream text;
    text << "elastica: "
         << (is_short_of_attempts ? std::to_string(attempts) + " attempts do not lead beyond "
                                  : std::string("the branch of equilibria ends at "))
         << 100 * t << " % of the way from the straight cilium, at a tip angle of "
         << now->unknowns.tip_angle * 180 / std::numbers::pi << " deg";
    throw SolverError(text.str());
  }
  now->iterations = iterations;
  now->attempts = used;
  return *now;
}

PlanarShape shape(const Rod& rod, const Equilibrium& equilibrium, double tolerance) {
  const Unknowns& u = equilibrium.unknowns;
  const Accuracy accuracy = accuracy_of(tolerance);
  std::vector<Series<double>> steps;
  double mismatch = 0;  // of θ at the nodes, which turns all on one side of them
  const auto run = [&](const Accuracy& a) {
    steps.clear();
    mismatch = 0;
    Descent<double> descent = from_tip(rod, u, a);
    const auto keep = [&](const Series<double>& step) {
      if (step.start() != step.end()) steps.push_back(step);
    };
    for (const Node& node : u.nodes) {
      descent.to(node.S, keep);
      mismatch += std::abs(descent.state().theta - node.theta);
      begin_anew(descent, node);
    }
    descent.to(0, keep);
    return descent.state();
  };
  const State<double> check = run(accuracy);
  const State<double> base = run({accuracy.tolerance, 0.6});
  std::ranges::reverse(steps);

  PlanarShape shape;
  shape.breaks = rod.ends;
  add_break(shape.breaks, u.at);
  for (const Node& node : u.nodes) add_break(shape.breaks, node.S);
  // θ(0), which is not quite 0, turns all of it.
  shape.error = std::max(std::abs(base.w - check.w), std::abs(base.z - check.z)) +
                std::abs(base.theta) + mismatch;
  shape.iterations = equilibrium.iterations;
  const auto shared = std::make_shared<const std::vector<Series<double>>>(std::move(steps));
  shape.state = [shared, breaks = shape.breaks, base](double S, std::size_t i) {
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
    const Rod at_t = scaled(rod, t);
    Descent<Dual> descent(at_t, Dual::variable(0, 0), 0, 1, accuracy_of(1e-12));
    descent.to(0, [](const Series<Dual>&) {});
    return descent.state().theta.by[0];
  };
  // By steps that are small against the distance of two critical loads.
  constexpr int steps = 400;
  double below = 0;
  double f_below = 1;
  for (int k = 1; k <= steps; ++k) {
    const double t = most * k / steps;
    const double f = base_angle(t);
    if (f <= 0) return continuation::root(base_angle, below, t, f_below, f);
    below = t;
    f_below = f;
  }
  return std::nullopt;
}

}  // namespace ciliaval::analytic::elastica::environment

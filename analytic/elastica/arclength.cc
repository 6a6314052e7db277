// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/arclength.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <sstream>
#include <utility>

#include "analytic/elastica/jumps/jump.h"
#include "analytic/elastica/taylor.h"
#include "problem/continuation/root.h"
#include "problem/error.h"
#include "problem/support/interruption.h"
#include "problem/types.h"

namespace ciliaval::analytic::elastica {
namespace {

constexpr double right_angle = std::numbers::pi / 2;

/// Accuracy of the Taylor steps.
struct Accuracy {
  double tolerance;  ///< of the last terms of a step
  double fraction;   ///< of the longest step
};

// ------------------------------------------------------------------------------------- contact

enum class Reached {
  contact,  ///< z = h
  tip,      ///< S = 1 with z < h
  level     ///< θ = 90° with z < h: the height h is out of reach
};

/// Integrates from the base to z = h, of a couple to the tip, and keeps the steps if asked.
std::pair<Reached, PlanarState> climb(const PlanarProblem& problem, double load,
                                      const Accuracy& accuracy, std::vector<TaylorStep>* steps) {
  PlanarState state;
  const bool is_couple = problem.kind == PlanarLoad::moment;
  const auto is_level = [&] { return !is_couple && state.phi <= 0; };
  state.moment = is_couple ? 1 : problem.point;
  state.force = is_couple ? 0 : 1;
  for (std::size_t i = 0; i < problem.compliance.size(); ++i) {
    if (!problem.joints.empty()) {
      const PlanarState lower = state;
      const PlanarJoint joint = problem.joint(i, load);
      state = jumps::across(joint, ForceLaw::constant, lower, jumps::Side::lower);
      if (state.moment <= 0) return {Reached::contact, jumps::inside(joint, lower)};
      if (is_level()) return {Reached::level, state};
    }
    while (state.S < problem.ends[i + 1]) {
      support::check_interruption();
      TaylorStep step(state, problem.flexibility(i, load), ForceLaw::constant, problem.ends[i + 1],
                      accuracy.tolerance, accuracy.fraction);
      state = step.end_state();
      const bool contact = state.moment <= 0;
      if (contact) {
        step.cut(step.zero_moment());
        state = step.end_state();
      }
      if (steps != nullptr) steps->push_back(step);
      if (contact) return {Reached::contact, state};
      if (is_level()) return {Reached::level, state};
    }
  }
  return {Reached::tip, state};
}

/// Height of the tip above the contact point, z(1) − h, decreasing with the load; below zero no
/// equilibrium exists and its value has no meaning but its sign.
double tip_above_contact(const PlanarProblem& problem, double load, const Accuracy& accuracy) {
  const auto [reached, state] = climb(problem, load, accuracy, nullptr);
  switch (reached) {
    case Reached::contact:
      return (1 - state.S) * std::sin(state.phi);
    case Reached::tip:
      return -state.moment;
    case Reached::level:
      break;
  }
  return -state.moment - (1 - state.S);
}

std::optional<PlanarState> contact_tip(const PlanarProblem& problem, const Accuracy& accuracy,
                                       std::vector<TaylorStep>* steps) {
  auto [reached, state] = climb(problem, problem.load, accuracy, steps);
  if (reached != Reached::contact) return std::nullopt;
  if (1 - state.S >= shortest_piece) {  // else there is no break to take the jump of H
    state.force = 0;
    const TaylorStep tail = TaylorStep::straight(state, ForceLaw::constant, 1);
    if (steps != nullptr) steps->push_back(tail);
    state = tail.end_state();
  }
  return state;
}

// ------------------------------------------------------------------------- loads on a free top

ForceLaw force_law(PlanarLoad kind) {
  if (kind == PlanarLoad::flow) return ForceLaw::height;
  return kind == PlanarLoad::dead ? ForceLaw::length : ForceLaw::constant;
}

/// Highest loaded point: s of a section load, else the tip.
double top(const PlanarProblem& problem) {
  return problem.kind == PlanarLoad::section ? problem.point : 1;
}

/// ∫ √(load · compliance · H) dS from a to b in segment i, the number of e-foldings of π/2 − θ
/// where θ is close to 90°. A flow has none: H → 0 there.
double e_foldings(const PlanarProblem& problem, std::size_t i, double a, double b) {
  const double rate = std::sqrt(problem.load * problem.compliance[i]);
  if (problem.kind == PlanarLoad::section) return rate * (b - a);
  if (problem.kind == PlanarLoad::dead)
    return rate * (2.0 / 3.0) * (std::pow(1 - a, 1.5) - std::pow(1 - b, 1.5));
  return 0;
}

/// Start of the shooting, and a guess of its unknown.
struct Launch {
  double S;  ///< the top, or where θ is 90° to 1e-30 at any rate: above it the cilium is level
  double x;
};

Launch launch(const PlanarProblem& problem) {
  constexpr double enough = 100;  // e^-80 at least is left of π/2 − θ
  const double last = top(problem);
  double linear_angle = 0;  // ∫ M/(EI) of the straight cilium
  double foldings = 0;
  double start = last;
  for (std::size_t i = 0; i < problem.compliance.size() && problem.ends[i] < last; ++i) {
    const double a = problem.ends[i];
    const double b = std::min(problem.ends[i + 1], last);
    const double f = problem.load * problem.compliance[i];
    linear_angle += problem.kind == PlanarLoad::section
                        ? f * (b - a) * (last - std::midpoint(a, b))
                        : f * (std::pow(1 - a, 3) - std::pow(1 - b, 3)) / 6;
    const double more = e_foldings(problem, i, a, b);
    if (start == last && foldings + more > enough) {
      double low = a;
      double high = b;
      for (int k = 0; k < 50; ++k) {
        const double middle = std::midpoint(low, high);
        (foldings + e_foldings(problem, i, a, middle) > enough ? high : low) = middle;
      }
      start = high;
    }
    foldings += more;
  }
  const double x = std::max(std::log(linear_angle), std::min(foldings, enough) - std::log(3.3));
  return {start, foldings > 3 ? x : std::log(linear_angle)};
}

/// Integrates from `S` down to the base; w, z and H of a flow count from there. Stops below −90°. A
/// load at an interface acts below its joint.
PlanarState descend(const PlanarProblem& problem, const Launch& from, const Accuracy& accuracy,
                    std::vector<TaylorStep>* steps) {
  PlanarState state;
  state.S = from.S;
  state.theta = std::atan(std::exp(from.x));
  state.phi = std::atan(std::exp(-from.x));
  if (problem.kind == PlanarLoad::section) state.force = 1;
  if (problem.kind == PlanarLoad::dead) state.force = 1 - from.S;
  for (std::size_t i = problem.compliance.size(); i-- > 0;) {
    while (state.S > problem.ends[i]) {
      support::check_interruption();
      const TaylorStep step(state, problem.flexibility(i, problem.load), force_law(problem.kind),
                            problem.ends[i], accuracy.tolerance, accuracy.fraction);
      if (steps != nullptr) steps->push_back(step);
      state = step.end_state();
      if (state.theta < -right_angle) return state;
    }
    if (!problem.joints.empty() && from.S > problem.ends[i])
      state = jumps::across(problem.joint(i, problem.load), force_law(problem.kind), state,
                            jumps::Side::upper);
  }
  return state;
}

/// Root of a smooth function by secants from a and b; nothing if they lead away. The error of a
/// secant's root is about the product of the last two steps: it ends where that is rounding error.
template <class Function>
std::optional<double> secant_root(const Function& function, double a, double b, double f_a,
                                  double f_b) {
  for (int k = 0; k < 10; ++k) {
    const double next = b - f_b * (b - a) / (f_b - f_a);
    if (!(std::abs(next - b) <= 0.5)) return std::nullopt;
    const double enough = epsilon * std::max(1.0, std::abs(next));
    if (std::abs(next - b) * std::abs(b - a) <= enough / 4 || std::abs(next - b) <= enough)
      return next;
    a = std::exchange(b, next);
    f_a = std::exchange(f_b, function(next));
  }
  return std::nullopt;
}

/// Solves θ(0) = 0 for x.
double shoot(const PlanarProblem& problem, Launch from, const Accuracy& accuracy, int& iterations) {
  const auto base_angle = [&](double x) {
    ++iterations;
    const PlanarState state = descend(problem, {from.S, x}, accuracy, nullptr);
    return state.theta - state.S;  // S > 0 where it stopped early
  };
  double a = from.x;
  double f_a = base_angle(a);
  // dθ(0)/dθ(top) ≥ 1, as a larger angle shortens the lever, and dθ(top)/dx = sin(2θ)/2: a step for
  // the slope 1 goes beyond the root, but not far.
  const double slope = std::sin(2 * std::atan(std::exp(a))) / 2;
  double step = std::copysign(std::clamp(1.02 * std::abs(f_a) / slope, 1e-14, 0.5), -f_a);
  for (int k = 0; k < 60; ++k) {
    const double b = a + step;
    const double f_b = base_angle(b);
    if (k == 0)
      if (const auto x = secant_root(base_angle, a, b, f_a, f_b)) return *x;
    if ((f_a > 0) != (f_b > 0)) return continuation::root(base_angle, a, b, f_a, f_b);
    a = b;
    f_a = f_b;
    step *= 2;
  }
  throw SolverError("elastica: no angle at the top makes the base upright");
}

/// The level part above the launch and the straight part above a section load, then all in the
/// order of S with w = z = 0 at the base.
void complete_from_top(const PlanarProblem& problem, double launch_S, const PlanarState& base,
                       std::vector<TaylorStep>& steps) {
  std::reverse(steps.begin(), steps.end());
  for (TaylorStep& step : steps) step.translate(-base.w, -base.z);
  PlanarState state = steps.back().at(launch_S);
  const ForceLaw law = force_law(problem.kind);
  while (state.S < top(problem)) {
    state.theta = right_angle;
    state.phi = 0;
    double target = top(problem);
    double extension = 0;
    std::size_t above = 0;  // the joint at the target
    if (!problem.joints.empty()) {
      const auto end = std::upper_bound(problem.ends.begin(), problem.ends.end(), state.S);
      above = static_cast<std::size_t>(end - problem.ends.begin());
      extension = problem.flexibility(above - 1, problem.load).extension;
      target = std::min(target, *end);
    }
    steps.push_back(TaylorStep::straight(state, law, target, extension));
    state = steps.back().end_state();
    if (target < top(problem))
      state = jumps::across(problem.joint(above, problem.load), law, state, jumps::Side::lower);
  }
  if (top(problem) < 1) {
    state.force = 0;
    steps.push_back(TaylorStep::straight(state, ForceLaw::constant, 1));
  }
}

// ------------------------------------------------------------------------------------- shape

/// State at S in the piece [a, b] of the breaks.
PlanarState look_up(const std::vector<TaylorStep>& steps, double S, double a, double b) {
  const double inside = std::clamp(S, std::nextafter(a, b), std::nextafter(b, a));
  auto above = std::upper_bound(steps.begin(), steps.end(), inside,
                                [](double s, const TaylorStep& step) { return s < step.lower(); });
  if (above != steps.begin()) --above;
  return above->at(S);
}

/// The error, from two integrations with different steps.
struct ErrorEstimate {
  double position = 0;  ///< of the tip, over the length
  double angle = 0;     ///< relative
  double rounding = 0;  ///< of either, by the last bits of the load and of S
};

ErrorEstimate difference(const PlanarState& a, const PlanarState& b, double angle) {
  return {std::max(std::abs(a.w - b.w), std::abs(a.z - b.z)), std::abs(a.theta - b.theta) / angle,
          0};
}

PlanarShape shape_of(const PlanarProblem& problem, std::vector<TaylorStep> steps,
                     std::optional<double> contact, const ErrorEstimate& error, int iterations,
                     double tolerance) {
  if (!(std::max(error.position, error.angle) <= std::max(tolerance, error.rounding)))
    throw SolverError((std::ostringstream()
                       << "elastica: two integrations with different steps differ by "
                       << error.position << " of the length and by " << error.angle
                       << " of the angle, more than the tolerance of " << tolerance)
                          .str());
  PlanarShape shape;
  shape.breaks = problem.ends;
  if (contact) add_break(shape.breaks, *contact);
  if (problem.kind == PlanarLoad::section) add_break(shape.breaks, problem.point);
  shape.contact = contact;
  shape.error = error.position;
  shape.iterations = iterations;
  const auto shared = std::make_shared<const std::vector<TaylorStep>>(std::move(steps));
  shape.state = [shared, breaks = shape.breaks](double S, std::size_t i) {
    return look_up(*shared, S, breaks[i], breaks[i + 1]);
  };
  return shape;
}

std::optional<PlanarShape> solve_contact(const PlanarProblem& problem, const Accuracy& accuracy,
                                         const Accuracy& finer, double tolerance) {
  std::vector<TaylorStep> steps;
  const auto tip = contact_tip(problem, finer, &steps);
  if (!tip) return std::nullopt;
  const auto check = contact_tip(problem, accuracy, nullptr);
  ErrorEstimate error = check ? difference(*tip, *check, tip->theta) : ErrorEstimate{1, 1, 0};
  // The last bit of the load moves cos θ at the contact by ε/cos θ.
  error.rounding = 16 * epsilon / std::max(std::sin(tip->phi), epsilon);
  const PlanarState last = steps.back().end_state();
  const bool tail = last.moment == 0 && last.force == 0;
  const double contact = tail ? steps.back().start() : last.S;
  const bool is_at_joint = !problem.joints.empty() && std::ranges::count(problem.ends, contact) > 0;
  std::optional<double> deflection;
  if (tail && is_at_joint) deflection = steps.back().at(contact).w;
  PlanarShape shape = shape_of(problem, std::move(steps), contact, error, 2, tolerance);
  shape.deflection = deflection;
  return shape;
}

PlanarShape solve_couple(const PlanarProblem& problem, const Accuracy& accuracy,
                         const Accuracy& finer, double tolerance) {
  constexpr double most_turns = 100;
  double turns = 0;
  for (std::size_t i = 0; i < problem.compliance.size(); ++i)
    turns += problem.load * problem.compliance[i] * (problem.ends[i + 1] - problem.ends[i]) /
             (2 * std::numbers::pi);
  if (turns > most_turns)
    throw SolverError((std::ostringstream()
                       << "elastica: the moment rolls the cilium up by " << turns
                       << " turns; the elastica goes to " << most_turns
                       << ": check the units of moment and Young's modulus, or state less")
                          .str());
  std::vector<TaylorStep> steps;
  const PlanarState tip = climb(problem, problem.load, finer, &steps).second;
  const PlanarState check = climb(problem, problem.load, accuracy, nullptr).second;
  ErrorEstimate error = difference(tip, check, tip.theta);
  error.rounding = 4 * epsilon * (1 + tip.theta) * static_cast<double>(steps.size());
  return shape_of(problem, std::move(steps), std::nullopt, error, 2, tolerance);
}

PlanarShape solve_from_top(const PlanarProblem& problem, const Accuracy& accuracy,
                           const Accuracy& finer, double tolerance) {
  int iterations = 0;
  Launch from = launch(problem);
  from.x = shoot(problem, from, accuracy, iterations);
  std::vector<TaylorStep> steps;
  const PlanarState base = descend(problem, from, finer, &steps);
  const PlanarState check = descend(problem, from, accuracy, nullptr);
  const double angle = std::atan(std::exp(from.x));
  ErrorEstimate error = difference(base, check, angle);
  error.position += std::abs(base.theta);  // turns the whole cilium
  error.angle += std::abs(base.theta) / angle;
  double curvature = 0;  // the last bit of S moves θ by εθ', in every step
  for (const TaylorStep& step : steps) curvature = std::max(curvature, step.end_state().curvature);
  error.rounding = 4 * epsilon * curvature / angle * static_cast<double>(steps.size());
  complete_from_top(problem, from.S, base, steps);
  return shape_of(problem, std::move(steps), std::nullopt, error, iterations + 2, tolerance);
}

PlanarShape upright(const PlanarProblem& problem) {
  PlanarState base;
  std::vector<TaylorStep> steps{TaylorStep::straight(base, ForceLaw::constant, 1)};
  const auto contact =
      problem.kind == PlanarLoad::contact ? std::optional(problem.point) : std::nullopt;
  return shape_of(problem, std::move(steps), contact, {}, 0, 1);
}

Accuracy step_accuracy(double tolerance) {
  return {std::clamp(1e-4 * tolerance, 1e-17, 1e-8), 1};
}

}  // namespace

std::optional<PlanarShape> solve_arclength(const PlanarProblem& problem, double tolerance) {
  constexpr double negligible = 1e-280;  // the angle would not be representable
  if (problem.load < negligible) return upright(problem);
  const Accuracy accuracy = step_accuracy(tolerance);
  const Accuracy finer{accuracy.tolerance, 0.6};
  if (problem.kind == PlanarLoad::contact)
    return solve_contact(problem, accuracy, finer, tolerance);
  if (problem.kind == PlanarLoad::moment) return solve_couple(problem, accuracy, finer, tolerance);
  return solve_from_top(problem, accuracy, finer, tolerance);
}

double slip_off_arclength(const PlanarProblem& problem, double tolerance) {
  const Accuracy accuracy = step_accuracy(tolerance);
  return slip_off_load(problem, [&](double log_load) {
    try {
      return tip_above_contact(problem, std::exp(log_load), accuracy);
    } catch (const SolverError&) {
      if (problem.joints.empty()) throw;
      return -1.0;  // a joint turns too far: no load in an equilibrium
    }
  });
}

}  // namespace ciliaval::analytic::elastica

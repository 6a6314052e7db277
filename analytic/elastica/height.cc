// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/height.h"

#include <algorithm>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "problem/continuation/root.h"
#include "problem/error.h"
#include "problem/support/interruption.h"

namespace ciliaval::analytic::elastica {
namespace {

double integral(const auto& integrand, double a, double b) {
  static boost::math::quadrature::tanh_sinh<double> rule;
  support::check_interruption();
  if (!(b > a)) return 0;
  // On the unit interval: tanh-sinh asserts that a, b are many ulps apart.
  return (b - a) *
         rule.integrate([&](double t) { return integrand(a + (b - a) * t); }, 0.0, 1.0, 1e-12);
}

/// S̃ of one material above a point where it is known, as a function of the depth u below the height
/// where M = 0: S̃ = S̃₀ + f [U(u₀) − U(u)] with U' = M, U = u²/2 (contact) or u³/6 (flow). In terms
/// of z it is Eq. 1 and 3: 2U(h) − 2U(h − z) = z(2h − z), 6U(z₂) − 6U(z₂ − z) = z(3z₂² − 3z₂z +
/// z²).
struct Arc {
  bool flow = false;
  double flexibility = 0;  ///< f = PL²/EI
  double u = 0;            ///< depth of the lower end
  double sine = 0;         ///< S̃ there
  double S = 0;            ///< arc length there
  double w = 0;            ///< deflection there

  double potential(double depth) const {
    return flow ? depth * depth * depth / 6 : depth * depth / 2;
  }
  double moment(double depth) const { return flow ? depth * depth / 2 : depth; }
  double sine_at(double depth) const {
    return sine + flexibility * (potential(u) - potential(depth));
  }
  double cosine_at(double depth) const {
    const double s = sine_at(depth);
    return s < 1 ? std::sqrt((1 - s) * (1 + s)) : 0.0;
  }
  /// Depth at which S̃ = 1, or 0 if it stays below.
  double lowest_depth() const {
    const double rest = potential(u) - (1 - sine) / flexibility;
    if (!(rest > 0)) return 0;
    return flow ? std::cbrt(6 * rest) : std::sqrt(2 * rest);
  }
  /// ∫ dz/cos θ from the lower end up to a depth, above lowest_depth().
  double length_to(double depth) const {
    return integral([this](double v) { return 1 / std::max(cosine_at(v), 1e-16); }, depth, u);
  }
  double deflection_to(double depth) const {
    return integral([this](double v) { return sine_at(v) / std::max(cosine_at(v), 1e-16); }, depth,
                    u);
  }
  /// Depth at the arc length `reach` above the lower end, between `shallow` and u; `whole` is the
  /// length to `shallow`.
  double depth_at(double reach, double shallow, double whole) const {
    if (reach <= 0) return u;
    if (reach >= whole) return shallow;
    return continuation::root([&](double depth) { return length_to(depth) - reach; }, shallow, u,
                              whole - reach, -reach);
  }
  /// The same law above `depth`, with another flexibility.
  Arc above(double depth, double reach, double next_flexibility) const {
    return {flow, next_flexibility, depth, sine_at(depth), S + reach, w + deflection_to(depth)};
  }
};

/// The segments below M = 0, and the arc length there.
struct Stack {
  std::vector<Arc> arcs;    ///< from the base
  std::vector<double> end;  ///< S of their upper ends
  std::vector<double> tip;  ///< depth of their upper ends
  bool level = false;       ///< S̃ reaches 1 below: no such shape
  double excess = 0;        ///< S where M = 0, less the length 1; > 0 if level
};

/// Marches up from the base; u = 0 is at the height `top` (h, or z_tip).
Stack march(const PlanarProblem& problem, double load, double top) {
  const bool flow = problem.kind == PlanarLoad::flow;
  Stack stack;
  Arc arc{flow, load * problem.compliance[0], top, 0, 0, 0};
  for (std::size_t i = 0; i < problem.compliance.size(); ++i) {
    const double lowest = arc.lowest_depth();
    const double whole = arc.length_to(lowest);
    const double reach = problem.ends[i + 1] - problem.ends[i];
    const bool last = i + 1 == problem.compliance.size();
    stack.arcs.push_back(arc);
    // The last segment is left to end where M = 0: its excess length is the residual.
    if (whole <= reach || last) {
      stack.level = lowest > 0;
      stack.excess = stack.level ? 2 : arc.S + whole - 1;
      stack.end.push_back(arc.S + whole);
      stack.tip.push_back(lowest);
      return stack;
    }
    const double depth = arc.depth_at(reach, lowest, whole);
    stack.end.push_back(problem.ends[i + 1]);
    stack.tip.push_back(depth);
    arc = arc.above(depth, reach, load * problem.compliance[i + 1]);
    arc.S = problem.ends[i + 1];
  }
  return stack;
}

/// z_tip of a flow: the one for which the arc up to it has the length 1.
double tip_height(const PlanarProblem& problem, int& iterations) {
  const auto excess = [&](double top) {
    ++iterations;
    return march(problem, problem.load, top).excess;
  };
  const double f_b = excess(1);
  double b = 1;
  for (int k = 0; k < 60; ++k) {
    const double a = b / 2;
    const double f_a = excess(a);
    if (f_a < 0) return continuation::root(excess, a, b, f_a, k == 0 ? f_b : excess(b));
    b = a;
  }
  throw SolverError("elastica, height form: no height of the tip gives the length");
}

/// State at S on one segment.
PlanarState state_on(const Arc& arc, double S, double end, double shallow, double top) {
  const double depth = arc.depth_at(S - arc.S, shallow, end - arc.S);
  PlanarState state;
  state.S = S;
  const double sine = arc.sine_at(depth);
  const double cosine = arc.cosine_at(depth);
  state.theta = std::atan2(sine, cosine);
  state.phi = std::atan2(cosine, sine);
  state.z = top - depth;
  state.w = arc.w + arc.deflection_to(depth);
  state.moment = arc.moment(depth);
  state.force = arc.flow ? depth : 1;
  state.curvature = arc.flexibility * state.moment;
  return state;
}

PlanarShape shape_of(const PlanarProblem& problem, Stack stack, double top) {
  PlanarShape shape;
  shape.breaks = problem.ends;
  const double free = stack.end.back();  // S where M = 0
  if (problem.kind == PlanarLoad::contact) {
    shape.contact = std::min(free, 1.0);
    add_break(shape.breaks, *shape.contact);
  }
  const std::size_t last = stack.arcs.size() - 1;
  const PlanarState contact = state_on(stack.arcs[last], free, free, stack.tip.back(), top);
  const auto shared = std::make_shared<const Stack>(std::move(stack));
  shape.state = [shared, contact, top, breaks = shape.breaks](double S, std::size_t piece) {
    const double inside = std::midpoint(breaks[piece], breaks[piece + 1]);
    for (std::size_t i = 0; i < shared->arcs.size(); ++i)
      if (inside < shared->end[i] || (i + 1 == shared->arcs.size() && shared->arcs[i].flow))
        return state_on(shared->arcs[i], S, shared->end[i], shared->tip[i], top);
    PlanarState state = contact;  // straight above the contact point
    state.S = S;
    state.w += (S - contact.S) * std::sin(contact.theta);
    state.z += (S - contact.S) * std::sin(contact.phi);
    state.moment = state.force = state.curvature = 0;
    return state;
  };
  return shape;
}

void require_height_form(const PlanarProblem& problem) {
  if (problem.kind != PlanarLoad::contact && problem.kind != PlanarLoad::flow)
    throw InputError(
        "elastica: the height form is the paper's Eq. 1-4, which give the moment as a function of "
        "the height z for the loads 'contact' and 'flow' only; use form = \"arclength\"");
}

}  // namespace

std::optional<PlanarShape> solve_height(const PlanarProblem& problem) {
  require_height_form(problem);
  int iterations = 1;
  const double top =
      problem.kind == PlanarLoad::flow ? tip_height(problem, iterations) : problem.point;
  Stack stack = march(problem, problem.load, top);
  if (problem.kind == PlanarLoad::contact && (stack.level || stack.excess > 0)) return std::nullopt;
  if (stack.level)
    throw SolverError(
        "elastica, height form: sin(theta) reaches 1, where the quadrature in z is "
        "singular; use form = \"arclength\"");
  const double residual = problem.kind == PlanarLoad::flow ? std::abs(stack.excess) : 0;
  PlanarShape shape = shape_of(problem, std::move(stack), top);
  shape.error = residual;
  shape.iterations = iterations;
  return shape;
}

double slip_off_height(const PlanarProblem& problem) {
  require_height_form(problem);
  return slip_off_load(problem, [&](double log_load) {
    return -march(problem, std::exp(log_load), problem.point).excess;
  });
}

}  // namespace ciliaval::analytic::elastica

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/probe.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <utility>

#include "problem/error.h"
#include "problem/types.h"

namespace ciliaval::analytic::elastica {
namespace {

/// Root of an increasing function of the order of 1 between a and b, with f(a) = f_a and f(b) =
/// f_b, to the last digits: the end on the negative side.
template <class Function>
double increasing_root(const Function& function, double a, double b, double f_a, double f_b) {
  if (f_a >= 0) return a;
  if (f_b <= 0) return b;
  std::uintmax_t evaluations = 200;
  return boost::math::tools::toms748_solve(
             function, a, b, f_a, f_b,
             [](double l, double r) { return r - l <= 2 * epsilon * std::max(1.0, std::abs(l)); },
             evaluations)
      .first;
}

/// The same without a bracket: from x = 0 in steps that grow fourfold. Empty if there is no change
/// of sign.
template <class Function>
std::optional<double> increasing_root_near_zero(const Function& function, double step) {
  constexpr double far_away = 700;  // exp(−700) is about the smallest number
  double a = 0;
  double b = 0;
  double f_a = function(0);
  double f_b = f_a;
  while (f_a > 0 || f_b < 0) {
    if (step > far_away) return std::nullopt;
    if (f_a > 0) {
      b = std::exchange(a, a - step);
      f_b = std::exchange(f_a, function(a));
    } else {
      a = std::exchange(b, b + step);
      f_a = std::exchange(f_b, function(b));
    }
    step *= 4;
  }
  return increasing_root(function, a, b, f_a, f_b);
}

/// State at S, from below.
PlanarState state_below(const PlanarShape& shape, double S) {
  std::size_t piece = 0;
  while (piece + 2 < shape.breaks.size() && shape.breaks[piece + 1] < S) ++piece;
  return shape.state(S, piece);
}

/// δ per unit of load of the nearly straight cilium: ∫ M (h − S) compliance dS, M = h − S.
double linear_response(const PlanarProblem& problem) {
  double sum = 0;
  for (std::size_t i = 0; i < problem.compliance.size() && problem.ends[i] < problem.point; ++i) {
    const double below = problem.point - problem.ends[i];
    const double above = std::max(problem.point - problem.ends[i + 1], 0.0);
    sum += problem.compliance[i] * (std::pow(below, 3) - std::pow(above, 3)) / 3;
  }
  return sum;
}

/// Dead force at the material point problem.point that brings it down to the height h.
PlanarProbe sinking_force(PlanarProblem problem, double height, double guess,
                          const PlanarSolver& solver, int& iterations) {
  PlanarShape shape;
  const auto sunk = [&](double log_factor) {  // increases with the load
    problem.load = guess * std::exp(log_factor);
    shape = solver(problem).value();
    iterations += shape.iterations;
    return height - state_below(shape, problem.point).z;
  };
  const auto x = increasing_root_near_zero(sunk, 1e-4);
  if (!x) throw SolverError("elastica: no force brings the contact point down to the height h");
  sunk(*x);
  return {problem.load, std::move(shape)};
}

/// Change of δ near 90° by a relative change of the load: h change/cos²θ_c.
double uncertainty(const PlanarShape& shape, double height, double change) {
  const double cosine = std::sin(state_below(shape, shape.contact.value()).phi);
  return change * height / (cosine * cosine);
}

}  // namespace

double contact_deflection(const PlanarShape& shape) {
  if (shape.deflection) return *shape.deflection;
  return state_below(shape, shape.contact.value()).w;
}

std::optional<double> slip_off_deflection(PlanarProblem problem, const PlanarSolver& solver,
                                          bool knows_section, double tolerance) {
  if (knows_section) {
    problem.kind = PlanarLoad::section;
    problem.point = 1;
    return state_below(solver(problem).value(), 1).w;
  }
  const double load = problem.load;
  for (const double steps : {4, 16, 64, 256, 1024}) {
    const double below = steps * epsilon;
    problem.load = load * (1 - below);
    const auto shape = solver(problem);
    if (!shape) continue;
    const double w = contact_deflection(*shape);
    if (uncertainty(*shape, problem.point, below) <= tolerance * std::max(w, problem.point))
      return w;
    break;
  }
  return std::nullopt;
}

std::optional<PlanarProbe> probe_by_load(PlanarProblem problem, double deflection,
                                         double slip_off_load, const PlanarSolver& solver,
                                         double tolerance) {
  std::optional<PlanarShape> shape;
  int iterations = 0;
  const double guess = std::min(deflection / linear_response(problem), slip_off_load);
  // ln(w/δ): linear in ln of the load where both are small.
  const auto excess = [&](double log_factor) {
    constexpr double slipped_off = 100;
    problem.load = guess * std::exp(log_factor);
    shape.reset();
    if (problem.load < slip_off_load) {
      try {
        shape = solver(problem);
      } catch (const SolverError&) {
        // So near to 90° that even the shape misses the tolerance: counts as slipped off.
      }
    }
    if (!shape) return slipped_off;
    iterations += shape->iterations;
    return std::log(contact_deflection(*shape) / deflection);
  };
  const auto x = increasing_root_near_zero(excess, 0.01);
  if (!x) return std::nullopt;
  excess(*x);
  if (!shape) return std::nullopt;
  const double miss = std::max(std::abs(contact_deflection(*shape) - deflection),
                               uncertainty(*shape, problem.point, 4 * epsilon));
  if (!(miss <= tolerance * std::max(deflection, problem.point))) return std::nullopt;
  shape->iterations = iterations;
  return PlanarProbe{problem.load, *std::move(shape)};
}

PlanarProbe probe_by_arclength(PlanarProblem problem, double deflection, double guess,
                               const PlanarSolver& solver) {
  const double height = std::exchange(problem.point, 1);
  problem.kind = PlanarLoad::section;
  PlanarProbe probe{guess, {}};
  int iterations = 0;
  const auto excess = [&](double S) {
    problem.point = 1 - S < shortest_piece ? 1 : S;
    probe = sinking_force(problem, height, probe.load, solver, iterations);
    return state_below(probe.shape, problem.point).w - deflection;
  };
  // S_c lies between the chord and the two other sides of its triangle: w and z increase with S.
  const double a = std::min(std::hypot(height, deflection), 1.0);
  const double b = std::min(height + deflection, 1.0);
  const double S = a < b ? increasing_root(excess, a, b, excess(a), excess(b)) : b;
  const double missed = excess(S);
  if (!problem.joints.empty() && !(std::abs(missed) <= 1e-9 * std::max(deflection, height)))
    throw SolverError(
        "elastica: no equilibrium with this displacement found: its contact is at an interface of "
        "two segments, between the sides of its joint");
  probe.shape.contact = problem.point;
  probe.shape.iterations = iterations;
  return probe;
}

}  // namespace ciliaval::analytic::elastica

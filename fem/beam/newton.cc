// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/newton.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "problem/error.h"

namespace ciliaval::fem::beam {
namespace {

using Eigen::Index;

/// Largest turn of a section in one iteration, rad: beyond it the linearisation says nothing.
constexpr double max_spin = 2.0;

/// Maximum norms of a vector of unknowns or residuals by kind.
struct Norms {
  double nodal = 0;    ///< r and θ, or the equilibrium equations
  double spin = 0;     ///< θ alone
  double section = 0;  ///< n and m, or the strain equations
};

Norms norms(const System& system, const State& state, const Eigen::VectorXd& vector) {
  Norms result;
  const auto at = [&](std::size_t i) {
    return system.supported()[i] ? 0.0 : std::abs(vector[static_cast<Index>(i)]);
  };
  for (std::size_t c = 0; c < 6; ++c) {
    for (std::size_t j = 0; j < state.position.size(); ++j) {
      const double value = at(system.node_unknown(j, c));
      result.nodal = std::max(result.nodal, value);
      if (c >= 3) result.spin = std::max(result.spin, value);
    }
    for (std::size_t k = 0; k < state.force.size(); ++k)
      result.section = std::max(result.section, at(system.point_unknown(k, c)));
  }
  return result;
}

/// Largest section force, dimensionless.
double load_level(const System& system, const State& state) {
  double level = 0;
  for (std::size_t k = 0; k < state.force.size(); ++k)
    level = std::max({level, state.force[k].lpNorm<Eigen::Infinity>() / system.force_scale(),
                      state.moment[k].lpNorm<Eigen::Infinity>() /
                          (system.force_scale() * system.length_scale())});
  return level;
}

/// The interpolation of quaternions needs neighbours on the same half of the sphere.
bool neighbours_agree(const State& state) {
  for (std::size_t j = 1; j < state.rotation.size(); ++j)
    if (!(state.rotation[j].dot(state.rotation[j - 1]) > 0)) return false;
  return true;
}

/// Derivative of the residual by a condition's unknown.
Eigen::VectorXd derivative(const System& system, const State& state, const Loads& loads,
                           Condition::Unknown unknown) {
  using Unknown = Condition::Unknown;
  switch (unknown) {
    case Unknown::shift:
      return system.shift_derivative(state, loads);
    case Unknown::load_factor:
      return system.point_load_derivative(loads);
    default:
      return system.pin_derivative(state, loads, unknown == Unknown::tangential_force ? 1 : 0);
  }
}

/// The derivative of a number by a condition's unknown itself.
double by_scalar(const Row& row, Condition::Unknown unknown) {
  using Unknown = Condition::Unknown;
  if (unknown == Unknown::shift) return row.by_shift;
  if (unknown == Unknown::load_factor) return 0;
  return row.by_pin[unknown == Unknown::tangential_force ? 1 : 0];
}

/// The derivative of a number of a vertex along a change of the beam's unknowns.
double along(const Row& row, const System& system, std::size_t vertex,
             const Eigen::Ref<const Eigen::VectorXd>& beam) {
  const auto first = static_cast<Index>(system.node_unknown(system.vertex_node(vertex), 0));
  return row.by_position.dot(beam.segment<3>(first)) + row.by_spin.dot(beam.segment<3>(first + 3));
}

/// Block elimination: with the responses X = −K⁻¹ ∂R/∂s to the scalars s, a number changes by
/// (∂g/∂u X + ∂g/∂s) s.
struct Bordered {
  Eigen::MatrixXd responses;  ///< X
  Eigen::MatrixXd inverse;    ///< of the changes of all conditions' numbers by all scalars
};

Bordered bordered(const System& system, const State& state, const Loads& loads,
                  std::span<const Condition> conditions, std::span<const Row> rows) {
  const auto n = static_cast<Index>(conditions.size());
  Bordered result;
  result.responses.resize(static_cast<Index>(system.n_unknowns()), n);
  Eigen::MatrixXd border(n, n);
  for (Index k = 0; k < n; ++k) {
    const Condition& column = conditions[static_cast<std::size_t>(k)];
    result.responses.col(k) = -system.solve(derivative(system, state, loads, column.unknown));
    for (Index i = 0; i < n; ++i) {
      const auto at = static_cast<std::size_t>(i);
      border(i, k) = along(rows[at], system, conditions[at].vertex, result.responses.col(k)) +
                     by_scalar(rows[at], column.unknown);
    }
  }
  result.inverse = border.inverse();
  return result;
}

std::vector<Row> rows_of(const System& system, const State& state,
                         std::span<const Condition> conditions) {
  std::vector<Row> rows;
  for (const Condition& condition : conditions) rows.push_back(condition.number(system, state));
  return rows;
}

/// Newton's increment of the bordered system.
Increment increment(System& system, const State& state, const Loads& loads,
                    const Eigen::VectorXd& residual, std::span<const Condition> conditions) {
  system.factorize(state, loads);
  const auto n = static_cast<Index>(conditions.size());
  Increment result{-system.solve(residual), Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  if (n == 0) return result;
  const std::vector<Row> rows = rows_of(system, state, conditions);
  const Bordered border = bordered(system, state, loads, conditions, rows);
  Eigen::VectorXd gap(n);
  Eigen::VectorXd rounding(n);
  for (Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const std::size_t vertex = conditions[at].vertex;
    gap[i] = -rows[at].value - along(rows[at], system, vertex, result.beam);
    rounding[i] = 4 * std::numeric_limits<double>::epsilon() *
                  state.position[system.vertex_node(vertex)].norm() / system.length_scale();
  }
  result.scalars = border.inverse * gap;
  result.rounding = border.inverse.cwiseAbs() * rounding;
  result.beam += border.responses * result.scalars;
  return result;
}

void apply(const System& system, State& state, const Increment& step,
           std::span<const Condition> conditions) {
  system.update(state, step.beam);
  for (std::size_t k = 0; k < conditions.size(); ++k) {
    const double scalar = step.scalars[static_cast<Index>(k)];
    using Unknown = Condition::Unknown;
    const Unknown unknown = conditions[k].unknown;
    if (unknown == Unknown::shift)
      state.shift += scalar * system.length_scale();
    else if (unknown == Unknown::load_factor)
      state.load_factor += scalar;
    else
      state.pin[unknown == Unknown::tangential_force ? 1 : 0] += scalar * system.force_scale();
  }
}

std::string history(const std::vector<double>& values) {
  std::ostringstream text;
  text.precision(2);
  text << std::scientific;
  for (std::size_t i = 0; i < values.size(); ++i) text << (i == 0 ? "" : ", ") << values[i];
  return text.str();
}

}  // namespace

std::string describe(const NewtonReport& report) {
  return report.reason + " (residuals " + history(report.residuals) + ")";
}

std::string too_many_increments(unsigned int max_iterations) {
  return std::to_string(most_increments) +
         " increments do not reach the load: a larger max_iterations (" +
         std::to_string(max_iterations) + " now) lets them grow";
}

double Increment::largest_resolved() const {
  double largest = 0;
  for (Index k = 0; k < scalars.size(); ++k)
    if (std::abs(scalars[k]) > rounding[k]) largest = std::max(largest, std::abs(scalars[k]));
  return largest;
}

Condition at_place(std::size_t vertex, const Vector3& normal, double value,
                   Condition::Unknown unknown) {
  const auto number = [=](const System& system, const State& state) {
    const Vector3& position = state.position[system.vertex_node(vertex)];
    Row row;
    row.value = (normal.dot(position) - value) / system.length_scale();
    row.by_position = normal.transpose();
    return row;
  };
  return {vertex, number, unknown};
}

Condition at_height(std::size_t vertex, double height, Condition::Unknown unknown) {
  return at_place(vertex, Vector3::UnitZ(), height, unknown);
}

double change(const Row& row, const System& system, std::span<const Condition> conditions,
              const Increment& step) {
  double sum = along(row, system, conditions.front().vertex, step.beam);
  for (std::size_t k = 0; k < conditions.size(); ++k)
    sum += by_scalar(row, conditions[k].unknown) * step.scalars[static_cast<Index>(k)];
  return sum;
}

Increment response(System& system, const State& state, const Loads& loads,
                   std::span<const Condition> conditions) {
  system.factorize(state, loads);
  const Bordered border =
      bordered(system, state, loads, conditions, rows_of(system, state, conditions));
  Increment result;
  result.scalars = border.inverse.col(border.inverse.cols() - 1);
  result.beam = border.responses * result.scalars;
  return result;
}

NewtonReport newton(System& system, State& state, const Loads& loads, const NewtonOptions& options,
                    std::span<const Condition> conditions) {
  NewtonReport report;
  State trial = state;
  system.prescribe(trial, loads);
  double last_increment = INFINITY;
  const double increment_tolerance = options.increment_tolerance.value_or(options.tolerance);
  for (unsigned int iteration = 0; iteration <= options.max_iterations; ++iteration) {
    Eigen::VectorXd residual;
    try {
      residual = system.residual(trial, loads);
    } catch (const SolverError& error) {  // inside a magnet
      report.residuals.push_back(INFINITY);
      report.reason = error.what();
      return report;
    }
    // The level's floor decides only about an unloaded beam, whose residual is rounding error.
    const double level = std::max(load_level(system, trial), 1e-8);
    const Norms r = norms(system, trial, residual);
    report.residuals.push_back(std::max(r.nodal / std::max(level, 1.0), r.section));
    if (!std::isfinite(report.residuals.back()) || !residual.allFinite()) {
      report.reason = "the residual is not a number";
      return report;
    }
    if (r.nodal <= options.tolerance * level && r.section <= options.tolerance &&
        last_increment <= increment_tolerance) {
      report.converged = true;
      state = std::move(trial);
      return report;
    }
    if (iteration == options.max_iterations) break;
    Increment step;
    try {
      step = increment(system, trial, loads, residual, conditions);
    } catch (const SolverError& error) {
      report.reason = error.what();
      return report;
    }
    const Norms d = norms(system, trial, step.beam);
    last_increment = std::max(d.nodal, d.section / std::max(level, 1.0));
    report.increments.push_back(std::max(last_increment, step.largest_scalar()));
    last_increment = std::max(last_increment, step.largest_resolved());
    if (!std::isfinite(last_increment) || !step.scalars.allFinite() || d.spin > max_spin) {
      report.reason = "a section would turn by more than 2 rad in one iteration";
      return report;
    }
    apply(system, trial, step, conditions);
    if (!neighbours_agree(trial)) {
      report.reason = "neighbouring sections are turned by more than 180 deg to each other";
      return report;
    }
  }
  report.reason =
      "no convergence in " + std::to_string(options.max_iterations) + " Newton iterations";
  return report;
}

double turn_between(const State& a, const State& b) {
  double turn = 0;
  for (std::size_t j = 0; j < a.rotation.size(); ++j)
    turn = std::max(turn, a.rotation[j].angularDistance(b.rotation[j]));
  return turn;
}

PathReport advance(System& system, State& state, const Loads& from, const Loads& to,
                   const NewtonOptions& options, std::span<const Condition> conditions,
                   const PathProgress& progress) {
  PathReport report;
  double step = 1;
  const double part = std::ldexp(1.0, -static_cast<int>(options.max_cutbacks));
  int allowed = options.unstable_modes ? options.unstable_modes(state, from) : 0;
  for (int increments = 1; report.reached < 1; ++increments) {
    const double aim = std::min(1.0, report.reached + step);
    // The way from rest may bend the beam most at its very beginning.
    const double smallest = part * std::max(report.reached, part);
    const bool is_judged = options.largest_turn || options.unstable_modes;
    const State before = is_judged ? state : State{};
    const Loads loads = combine(1 - aim, from, aim, to);
    report.last = newton(system, state, loads, options, conditions);
    if (options.largest_turn && report.last.converged &&
        turn_between(before, state) > *options.largest_turn) {
      state = before;
      report.last.converged = false;
      report.last.reason = "a section turned too far in one increment";
    }
    if (options.unstable_modes && report.last.converged) {
      const int modes = options.unstable_modes(state, loads);
      if (modes > allowed && (aim - report.reached) / 2 >= smallest) {
        state = before;
        report.last.converged = false;
        report.last.reason = "the equilibrium is less stable";
      } else {
        allowed = std::max(allowed, modes);
      }
    }
    report.iterations += static_cast<int>(report.last.increments.size());
    if (progress) progress(aim, report.last);
    if (report.last.converged) {
      report.reached = aim;
      step *= 2;
    } else {
      step = (aim - report.reached) / 2;
      ++report.cutbacks;
    }
    const bool too_many = increments >= most_increments && report.reached < 1;
    if (step >= smallest && !too_many) continue;
    std::ostringstream text;
    text << "no equilibrium found at the fraction " << aim << " of the load increment: "
         << (too_many ? too_many_increments(options.max_iterations) : describe(report.last))
         << "; last converged at the fraction " << report.reached
         << "; more cutbacks or elements may help";
    report.message = text.str();
    return report;
  }
  report.converged = true;
  return report;
}

}  // namespace ciliaval::fem::beam

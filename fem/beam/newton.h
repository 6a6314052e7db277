// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fem/beam/system.h"

namespace ciliaval::fem::beam {

struct NewtonOptions {
  double tolerance = 1e-12;  ///< of the dimensionless residual and of the dimensionless increment
  unsigned int max_iterations = 30;
  /// The smallest increment is 2^−this of the way so far; at its beginning of 2^−this of the whole.
  unsigned int max_cutbacks = 8;
  /// Tolerance of the increment, if not the same: the state's error is of the order of its square.
  std::optional<double> increment_tolerance = {};
  /// Largest turn of a section in one increment of a path, rad: where equilibria are several, as in
  /// a field, a long increment may end at another one than the path leads to.
  std::optional<double> largest_turn = {};
  /// Ways in which the energy decreases at an equilibrium of a path, if it is asked for: an
  /// increment that ends with more than it started from may have leapt over a bifurcation, and is
  /// halved. At the smallest increment the path itself leads there.
  std::function<int(const State&, const Loads&)> unstable_modes = {};
};
/// largest_turn under an environment.
inline constexpr double turn_in_environment = 0.5;
/// The largest angle between a section in one state and in the other, rad.
double turn_between(const State& a, const State& b);

/// Increments of one load after which it is given up: with few iterations and many cutbacks they
/// may be ever so small, and all converge.
inline constexpr int most_increments = 1000;
/// Says so, and which option helps.
std::string too_many_increments(unsigned int max_iterations);

/// A number of the state at a vertex and its derivatives, all without units: lengths in L, forces
/// in P.
struct Row {
  double value = 0;
  Eigen::RowVector3d by_position = Eigen::RowVector3d::Zero();
  Eigen::RowVector3d by_spin = Eigen::RowVector3d::Zero();
  double by_shift = 0;
  Eigen::RowVector2d by_pin = Eigen::RowVector2d::Zero();
};

/// One more equation, a number that vanishes, with one more unknown: the shift of a moving mesh
/// (State::shift), the factor on the point loads (State::load_factor), or the pin's N or T
/// (State::pin).
struct Condition {
  enum class Unknown { shift, load_factor, normal_force, tangential_force };
  std::size_t vertex = 0;
  std::function<Row(const System&, const State&)> number;
  Unknown unknown = Unknown::shift;
};
/// n·r = value (m) at a vertex.
Condition at_place(std::size_t vertex, const Vector3& normal, double value,
                   Condition::Unknown unknown);
/// z = height at a vertex.
Condition at_height(std::size_t vertex, double height, Condition::Unknown unknown);

/// A change of the beam's unknowns and of those of the conditions.
struct Increment {
  Eigen::VectorXd beam;
  Eigen::VectorXd scalars;   ///< of s/L, of the load factor, of N/P or T/P
  Eigen::VectorXd rounding;  ///< of the scalars, by the rounding of r

  double largest_scalar() const {
    return scalars.size() == 0 ? 0 : scalars.lpNorm<Eigen::Infinity>();
  }
  /// The largest scalar that is not rounding error.
  double largest_resolved() const;
};
/// How a number changes with the increment.
double change(const Row& row, const System& system, std::span<const Condition> conditions,
              const Increment& step);

/// How an equilibrium changes with the value that the last of the conditions gives its number.
Increment response(System& system, const State& state, const Loads& loads,
                   std::span<const Condition> conditions);

/// The course of Newton's method: dimensionless maximum norms, one for each iteration.
struct NewtonReport {
  bool converged = false;
  std::vector<double> residuals;   ///< before the iteration's update
  std::vector<double> increments;  ///< of the iteration's update
  std::string reason;              ///< why it did not converge
};

/// Description of a failure of Newton's method, with the history of its residuals.
std::string describe(const NewtonReport& report);

/// Newton's method with the consistent tangent from the given state. Converged: the strain
/// equations hold to tolerance × L, the equilibrium equations to tolerance × the section forces,
/// and the last increment is below tolerance × L, tolerance rad and tolerance × the section forces;
/// the increment of a condition's unknown may also be rounding error. Each condition has an unknown
/// of its own. Unless it converges, the state is left as it was.
NewtonReport newton(System& system, State& state, const Loads& loads, const NewtonOptions& options,
                    std::span<const Condition> conditions = {});

/// The course of a load path.
struct PathReport {
  bool converged = false;
  double reached = 0;  ///< fraction t of the path that the state has reached, 1 if converged
  int iterations = 0;  ///< of all attempts
  int cutbacks = 0;
  NewtonReport last;    ///< of the last attempt
  std::string message;  ///< empty if converged: step, residual history, last converged load
};

/// Called with the fraction aimed at and the report of the attempt.
using PathProgress = std::function<void(double fraction, const NewtonReport& report)>;

/// Follows the loads (1−t) from + t to, t = 0…1, from a state in equilibrium with `from`. The first
/// attempt is the whole path; an increment that fails is halved, one that converges is doubled. If
/// it fails, the state is the last converged one.
PathReport advance(System& system, State& state, const Loads& from, const Loads& to,
                   const NewtonOptions& options, std::span<const Condition> conditions = {},
                   const PathProgress& progress = {});

}  // namespace ciliaval::fem::beam

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/study/range.h"

#include <fmt/core.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cstdint>
#include <utility>

#include "problem/error.h"

namespace ciliaval::compare::study {
namespace {

/// The limit that the step knows, if it does.
std::optional<double> known_limit(const MechanicsStep& step) {
  return step.load.is<ProbeLoad>() ? step.slip_off_displacement : step.slip_off_force;
}

MechanicsStep solve_one(const MechanicsModel& model, const Cilium& cilium, const Load& load,
                        const Progress& progress) {
  return model.solve(cilium, {load}, progress).steps.at(0);
}

/// The magnitude that bends the softest material by some radians over the whole length.
double soft_magnitude(const Cilium& cilium, const Load& load) {
  double E = 0;
  for (const Segment& s : cilium.segments)
    E = E == 0 ? s.young_modulus : std::min(E, s.young_modulus);
  const double L = cilium.length();
  const double force = E * cilium.second_moment() / (L * L);
  return load.is<SectionLoad>() ? force : force / L;
}

}  // namespace

double slip_off(const MechanicsModel& model, const Cilium& cilium, const MechanicsStep& step,
                const analytic::elastica::ElasticaOptions& elastica, const Progress& progress) {
  if (const auto limit = known_limit(step)) return *limit;
  // A model that meets its limit on the way says so: any load beyond will do, and that of the
  // elastica is near.
  const MechanicsStep guess =
      solve_one(analytic::elastica::Elastica(elastica), cilium, step.load, progress);
  double magnitude = 1.5 * known_limit(guess).value_or(ciliaval::magnitude(step.load));
  constexpr int most_trials = 8;
  for (int i = 0; i < most_trials; ++i, magnitude *= 2) {
    const MechanicsStep trial =
        solve_one(model, cilium, with_magnitude(step.load, magnitude), progress);
    if (const auto limit = known_limit(trial)) return *limit;
    if (trial.status == Status::failed)
      throw SolverError(fmt::format("range: under {:g} {} the model failed: {}", magnitude,
                                    magnitude_unit(step.load), trial.message));
  }
  throw SolverError(fmt::format("range: the contact does not slip off up to {:g} {}", magnitude / 2,
                                magnitude_unit(step.load)));
}

double magnitude_at_rotation(const MechanicsModel& model, const Cilium& cilium, const Load& load,
                             double rotation, const Progress& progress) {
  const auto excess = [&](double magnitude) {
    if (magnitude == 0) return -rotation;
    const MechanicsStep step = solve_one(model, cilium, with_magnitude(load, magnitude), progress);
    if (step.status != Status::converged)
      throw SolverError(fmt::format("range: under {:g} {} the model failed: {}", magnitude,
                                    magnitude_unit(load), step.message));
    const Centreline& centreline = step.deformation->centreline;
    return centreline.at(centreline.length()).theta() - rotation;
  };
  double lower = 0;
  double at_lower = -rotation;
  double upper = magnitude(load) > 0 ? magnitude(load) : soft_magnitude(cilium, load);
  double at_upper = excess(upper);
  constexpr int most_doublings = 60;
  for (int i = 0; at_upper < 0; ++i) {
    if (i == most_doublings)
      throw SolverError("range: no load turns the tip as far as the rotation asked for");
    lower = upper;
    at_lower = at_upper;
    upper *= 2;
    at_upper = excess(upper);
  }
  constexpr double tolerance = 1e-6;
  std::uintmax_t trials = 100;
  const auto close = [](double a, double b) { return b - a <= tolerance * b; };
  const auto [a, b] =
      boost::math::tools::toms748_solve(excess, lower, upper, at_lower, at_upper, close, trials);
  return (a + b) / 2;
}

}  // namespace ciliaval::compare::study

// SPDX-License-Identifier: LGPL-2.1-or-later
// How often does the error lie inside the stated interval? Each random case is computed with a
// model and with a reference: finer options, or a closed form. The difference of the two counts as
// the error. Exit code 1: less than 95 % of a quantity inside, or one more than three times
// outside, a tenth of the cases without an interval, or a hundredth of the intervals without a
// reference.
//   build/release/tests/coverage/coverage SUBJECT [number of cases [first seed]]
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analytic/elastica/elastica.h"
#include "compare/models/errors.h"
#include "compare/models/registry.h"
#include "compare/models/run.h"
#include "compare/results/quantity.h"
#include "fem/beam/beam.h"
#include "fem/potential/potential.h"
#include "fem/solid/solid.h"
#include "problem/error.h"
#include "tests/coverage/random_case.h"

namespace ciliaval::test {
namespace {

using namespace compare;

/// A pair of models, and its reference.
struct Subject {
  std::string name;
  std::string mechanics;
  std::string field;
  std::function<void(input::ModelOptions&)> set;  ///< the options of both
  std::string reference_field;
  std::function<void(input::ModelOptions&)> refine;  ///< those of the reference
  RandomCase (*draw)(std::uint32_t seed) = random_case;
};

const std::vector<Subject>& subjects() {
  const auto as_they_are = [](input::ModelOptions&) {};
  const auto next_mesh = [](input::ModelOptions& options) {
    auto& solid = options.of<fem::solid::SolidOptions>();
    ++solid.refinement;
    // GMRES is slow where a segment is nearly incompressible.
    solid.solver = fem::solid::solvers::SolverKind::direct;
  };
  const auto finer_beam = [](input::ModelOptions& options) {
    auto& beam = options.of<fem::beam::BeamOptions>();
    beam.refinement = 2;
    beam.degree = 8;
  };
  const auto accurate_elastica = [](input::ModelOptions& options) {
    options.of<analytic::elastica::ElasticaOptions>().tolerance = 1e-15;
  };
  static const std::vector<Subject> all{
      {"solid", "solid", "mesh", as_they_are, "mesh", next_mesh},
      {"solid-sweep", "solid", "mesh", as_they_are, "mesh", next_mesh, random_sweep},
      {"beam-sweep", "beam", "line", as_they_are, "line", finer_beam, random_sweep},
      {"coarse-solid", "solid", "mesh",
       [](input::ModelOptions& options) { options.of<fem::solid::SolidOptions>().refinement = 0; },
       "mesh", next_mesh},
      {"beam", "beam", "line", as_they_are, "line", finer_beam},
      {"elastica", "elastica", "volume", as_they_are, "volume", accurate_elastica},
      {"elastica-sweep", "elastica", "volume", as_they_are, "volume", accurate_elastica,
       random_sweep},
      // The magnet of a rod in vacuum has a closed form.
      {"potential", "elastica", "potential",
       [](input::ModelOptions& options) {
         options.of<fem::potential::PotentialOptions>().relative_permeability = 1;
       },
       "volume", as_they_are}};
  return all;
}

/// Error and estimate of a quantity of one case.
struct Sample {
  std::string group;
  double error = 0;                ///< m, rad or T
  std::optional<double> estimate;  ///< likewise

  double effectivity() const {
    if (!estimate) return std::numeric_limits<double>::infinity();
    return error == 0 ? 0 : error / *estimate;
  }
};

input::Case problem_of(const RandomCase& drawn, const Subject& subject) {
  input::Case problem;
  problem.name = "random";
  problem.cilium = drawn.cilium;
  problem.load_path = {drawn.load};
  problem.sensors = drawn.sensors;
  problem.mechanics = {subject.mechanics};
  problem.fields = {subject.field};
  problem.options.of<fem::solid::SolidOptions>().kernel_width = drawn.kernel_width;
  subject.set(problem.options);
  return problem;
}

/// Errors of a run against a finer one.
std::vector<Sample> samples(const input::Case& problem, const models::CaseResult& result,
                            const models::CaseResult& finer) {
  const models::MechanicsRun& run = result.mechanics.front();
  const MechanicsStep& step = run.result.steps.front();
  const MechanicsStep& truth = finer.mechanics.front().result.steps.front();
  const bool same_mechanics = result.problem.fields != finer.problem.fields;
  std::vector<Sample> all;
  if (const auto limit = slip_off_limit(step); limit && !same_mechanics) {
    // A reference that bears the load tells a lower bound of the error.
    const double true_limit = slip_off_limit(truth).value_or(magnitude(truth.load));
    all.push_back({"slip-off", std::abs(*limit - true_limit), step.slip_off_uncertainty});
  }
  if (step.status == Status::slipped_off) return all;
  const double L = problem.cilium.length();
  const CentrelinePoint tip = step.deformation->centreline.at(L);
  const CentrelinePoint true_tip = truth.deformation->centreline.at(L);
  const std::string load = " under " + std::string(type(step.load));
  if (!same_mechanics) {
    all.push_back({"tip" + load, (tip.position - true_tip.position).norm(), step.tip_uncertainty});
    all.push_back({"tip angle", std::abs(tip.theta() - true_tip.theta()),
                   results::tip_angle_uncertainty(step)});
    all.push_back({"applied force" + load, std::abs(step.applied_force - truth.applied_force),
                   step.applied_force_uncertainty});
  }
  const auto& fields = result.fields.front();
  const auto& true_fields = finer.fields.front();
  for (std::size_t s = 0; s < problem.sensors.size(); ++s) {
    const auto& dB = fields.steps.front()->dB[s];
    const auto& true_dB = true_fields.steps.front()->dB[s];
    if (!dB || !true_dB) continue;
    const double depth = -problem.sensors[s].z();
    const char* where = depth < problem.cilium.diameter ? "below a diameter"
                        : depth < L                     ? "below a length"
                                                        : "farther";
    all.push_back({std::string("dB at a sensor ") + where, (*dB - *true_dB).cwiseAbs().maxCoeff(),
                   models::change_uncertainty(run, fields, 0, s)});
  }
  return all;
}

double quantile(const std::vector<double>& sorted, double q) {
  return sorted[static_cast<std::size_t>(std::lround(q * static_cast<double>(sorted.size() - 1)))];
}

void print_table(const std::map<std::string, std::vector<double>>& effectivities) {
  fmt::print("\n{:<32} {:>5} {:>7} {:>9} {:>9} {:>9} {:>9} {:>5}\n", "error/estimate", "n",
             "inside", "5 %", "median", "95 %", "largest", "> 3");
  for (const auto& entry : effectivities) {
    const std::string& group = entry.first;
    std::vector<double> values = entry.second;
    std::sort(values.begin(), values.end());
    const auto above = [&](double limit) {
      return values.end() - std::upper_bound(values.begin(), values.end(), limit);
    };
    fmt::print("{:<32} {:>5} {:>6.0f}% {:>9.2g} {:>9.2g} {:>9.2g} {:>9.2g} {:>5}\n", group,
               values.size(),
               100 * (1 - static_cast<double>(above(1)) / static_cast<double>(values.size())),
               quantile(values, 0.05), quantile(values, 0.5), quantile(values, 0.95), values.back(),
               above(3));
  }
}

/// True if for each quantity, over all loads, 95 % lie inside and none more than three times
/// outside.
bool holds(const std::map<std::string, std::vector<double>>& effectivities) {
  std::map<std::string, std::vector<double>> of_quantity;
  for (const auto& [group, values] : effectivities) {
    auto& all = of_quantity[group.substr(0, group.find(" under "))];
    all.insert(all.end(), values.begin(), values.end());
  }
  bool all_hold = !of_quantity.empty();
  for (const auto& entry : of_quantity) {
    const std::string& quantity = entry.first;
    const std::vector<double>& values = entry.second;
    const auto outside = [&](double limit) {
      return std::ranges::count_if(values, [&](double value) { return !(value <= limit); });
    };
    const double part = static_cast<double>(outside(1)) / static_cast<double>(values.size());
    const bool good = part <= 0.05 && outside(3) == 0;
    fmt::print("{}: {:.1f} % inside, {} more than 3 times outside{}\n", quantity, 100 * (1 - part),
               outside(3), good ? "" : ": NOT what is promised");
    all_hold = all_hold && good;
  }
  return all_hold;
}

bool cover(const Subject& subject, std::uint32_t cases, std::uint32_t first_seed) {
  std::map<std::string, std::vector<double>> effectivities;
  unsigned int left_out = 0;           // the model states no interval
  unsigned int without_reference = 0;  // it does, and nothing tells whether it holds
  const auto leave_out = [&](const std::string& why) {
    fmt::print("left out: {}\n", why);
    std::fflush(stdout);
    ++left_out;
  };
  for (std::uint32_t seed = first_seed; seed < first_seed + cases; ++seed) {
    const RandomCase drawn = subject.draw(seed);
    input::Case problem = problem_of(drawn, subject);
    fmt::print("seed {}: {}, {} segments, L/d {:.1f}, {:.0f} deg: ", seed, type(drawn.load),
               drawn.cilium.segments.size(), drawn.cilium.length() / drawn.cilium.diameter,
               drawn.tip_angle * 180 / std::numbers::pi);
    const auto solve = [&] {
      return models::run(problem, models::mechanics_models(), models::field_models());
    };
    const models::CaseResult result = solve();
    const auto step_of = [](const models::CaseResult& of) -> const MechanicsStep& {
      return of.mechanics.front().result.steps.front();
    };
    const MechanicsStep& step = step_of(result);
    // No equilibrium, or one whose error the model says it does not know.
    if (step.status == Status::failed ||
        (step.status == Status::converged && !step.tip_uncertainty) ||
        (step.status == Status::slipped_off && !step.slip_off_uncertainty)) {
      leave_out(step.message);
      continue;
    }
    problem.fields = {subject.reference_field};
    subject.refine(problem.options);
    const models::CaseResult finer = solve();
    const MechanicsStep& truth = step_of(finer);
    if (truth.status == Status::failed ||
        (step.status == Status::converged && truth.status == Status::slipped_off)) {
      fmt::print("NOT REFUTED, for want of a reference: {}\n", truth.message);
      ++without_reference;
      continue;
    }
    for (const Sample& sample : samples(problem, result, finer)) {
      // The elastica, and it alone, does not know the error of a probe's force.
      if (subject.name == "elastica" && sample.group == "applied force under probe") continue;
      effectivities[sample.group].push_back(sample.effectivity());
      fmt::print(" {:.2g}", sample.effectivity());
    }
    fmt::print("  {:.1f} s, reference {:.1f} s\n", step.seconds, truth.seconds);
    std::fflush(stdout);
  }
  print_table(effectivities);
  fmt::print("{} of {} cases without an interval, {} intervals without a reference\n", left_out,
             cases, without_reference);
  // Intervals that are stated or tried on few of the cases are worth little.
  return holds(effectivities) && 10 * left_out <= cases && 100 * without_reference <= cases;
}

}  // namespace
}  // namespace ciliaval::test

int main(int argc, char** argv) {
  using namespace ciliaval;
  const std::span<char*> arguments(argv, static_cast<std::size_t>(argc));
  try {
    for (const test::Subject& subject : test::subjects())
      if (arguments.size() > 1 && subject.name == arguments[1]) {
        const auto number = [&](std::size_t i, std::uint32_t fallback) {
          return arguments.size() > i ? static_cast<std::uint32_t>(std::stoul(arguments[i]))
                                      : fallback;
        };
        return test::cover(subject, number(2, 20), number(3, 0)) ? 0 : 1;
      }
    throw InputError(
        "usage: coverage solid|coarse-solid|beam|elastica|potential|solid-sweep|beam-sweep|"
        "elastica-sweep [number of cases [first seed]]");
  } catch (const std::exception& error) {
    fmt::print(stderr, "coverage: {}\n", error.what());
    return 2;
  }
}

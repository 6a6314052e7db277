// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/regression/check.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string_view>

#include "compare/models/errors.h"

namespace ciliaval::compare::regression {
namespace {

/// A reference's tolerance beyond this part of the quantity's group checks nothing.
constexpr double widest_of_reference = 0.1;

using ById = std::map<std::string, const Measurement*>;

void fail(CheckReport& report, std::string id, std::string message) {
  report.findings.push_back(
      {false, std::move(id), "baseline", std::move(message), {}, {}, {}, {}, {}});
}

/// Whether an entry is of one of the models.
bool belongs_to(const std::string& id, const std::vector<std::string>& models) {
  return std::ranges::any_of(models_of(id), [&](const std::string& model) {
    return std::ranges::find(models, model) != models.end();
  });
}

/// " It looks like …", if the wrong value looks like a known mistake.
std::string likely_cause(const Measurement& measured, const Expected& expected, double limit,
                         const ById& all, const std::map<std::string, double>& accepted) {
  const double a = measured.value;
  const double b = expected.value;
  if (std::abs(a + b) <= limit) return "; the sign is flipped";
  const auto slash = measured.id.rfind('/');
  const std::string group = measured.id.substr(0, slash + 1);
  const std::string axis = measured.id.substr(slash + 1);
  for (const std::string other : {"x", "y", "z"}) {
    const auto sibling = all.find(group + other);
    const auto partner = accepted.find(group + other);
    if (other == axis || sibling == all.end() || partner == accepted.end()) continue;
    if (std::abs(sibling->second->value - b) <= limit && std::abs(a - partner->second) <= limit)
      return fmt::format("; {} and {} are swapped", axis, other);
  }
  if (b == 0) return {};
  const double ratio = std::abs(a / b);
  for (int power = -9; power <= 9; ++power)
    if (power != 0 && std::abs(ratio / std::pow(10.0, power) - 1) < 1e-6)
      return fmt::format("; a factor of 1e{}: a unit?", power);
  for (const double factor : {std::numbers::pi / 180, 180 / std::numbers::pi})
    if (std::abs(ratio / factor - 1) < 1e-6) return "; degrees and radians are mixed up";
  return {};
}

/// Holds one number against another. No part of the tolerance may be wider than `widest`.
Finding compare(const Measurement& measured, double expected, const AllowedDeviation& tolerance,
                const AllowedDeviation& widest, std::string against) {
  Finding finding{false,
                  measured.id,
                  std::move(against),
                  {},
                  measured.unit,
                  measured.value,
                  expected,
                  tolerance.limit(measured.value, expected),
                  measured.uncertainty};
  if (!std::isfinite(measured.value)) {
    finding.limit.reset();
    finding.message = "is not finite";
  } else if (!(std::abs(measured.value - expected) <= *finding.limit)) {
    finding.message =
        fmt::format("is {} {}, not {}: off by {:.3g}, {:.3g} allowed", measured.value,
                    measured.unit, expected, measured.value - expected, *finding.limit);
  } else if (tolerance.relative > widest.relative || tolerance.absolute > widest.absolute) {
    finding.message = fmt::format(
        "its tolerance, relative {} and absolute {} {}, is wider than {} and {:.3g} {}, hence "
        "checks too little",
        tolerance.relative, tolerance.absolute, measured.unit, widest.relative, widest.absolute,
        measured.unit);
  } else {
    finding.passed = true;
  }
  return finding;
}

void check_case(const input::Case& asked, const Baseline& baseline, CheckReport& report) {
  if (baseline.case_name != asked.name)
    fail(report, "case", fmt::format("the baseline is that of case \"{}\"", baseline.case_name));
  const std::vector<std::string> now = case_text(asked);
  const auto [is, was] =
      std::mismatch(now.begin(), now.end(), baseline.case_text.begin(), baseline.case_text.end());
  if (is != now.end() || was != baseline.case_text.end())
    fail(report, "case",
         fmt::format("the baseline is that of another version of the case: it has `{}` where the "
                     "case now has `{}`; --accept makes a new one",
                     was != baseline.case_text.end() ? *was : "nothing",
                     is != now.end() ? *is : "nothing"));
  if (const std::string there = references(baseline); there != asked.references)
    fail(report, "references",
         fmt::format("the baseline has the references \"{}\", and the case states \"{}\" under "
                     "[case]: was one removed or loosened?",
                     there, asked.references));
}

void check_outcomes(const std::vector<Outcome>& measured, const Baseline& baseline,
                    const std::vector<std::string>& left_out, CheckReport& report) {
  std::map<std::string, std::string> now;
  for (const Outcome& outcome : measured) now[outcome.id] = outcome.value;
  for (const Outcome& expected : baseline.outcomes) {
    const auto found = now.find(expected.id);
    if (belongs_to(expected.id, left_out)) {
      ++report.left_out;
    } else if (found == now.end()) {
      fail(report, expected.id, "is in the baseline but was not computed: is a model missing?");
    } else {
      fail(report, expected.id,
           fmt::format("is \"{}\", not \"{}\"", found->second, expected.value));
      Finding& finding = report.findings.back();
      finding.passed = found->second == expected.value;
      if (finding.passed) finding.message.clear();
      report.model_failed = report.model_failed || (!finding.passed && found->second == "failed");
      now.erase(found);
    }
  }
  for (const auto& [id, value] : now)
    fail(report, id,
         fmt::format("is \"{}\", and the baseline does not have it; --accept adds it", value));
}

void check_quantities(const std::vector<Measurement>& measured, const Baseline& baseline,
                      const std::vector<std::string>& left_out, CheckReport& report) {
  ById now;
  for (const Measurement& quantity : measured) now[quantity.id] = &quantity;
  std::map<std::string, double> accepted;
  for (const Expected& expected : baseline.quantities) accepted[expected.id] = expected.value;
  for (const Expected& expected : baseline.quantities) {
    if (belongs_to(expected.id, left_out)) {
      ++report.left_out;
      continue;
    }
    const auto found = now.find(expected.id);
    if (found == now.end()) {
      fail(report, expected.id,
           "is in the baseline but was not computed: nothing reads its tolerance");
      continue;
    }
    const Measurement& quantity = *found->second;
    if (quantity.unit != expected.unit) {
      fail(report, expected.id,
           fmt::format("is in {}, the baseline is in {}", quantity.unit, expected.unit));
      continue;
    }
    AllowedDeviation widest = allowed_deviation(quantity);
    widest.absolute *= 1.1;  // its second digit may be rounded otherwise in this run
    Finding finding = compare(quantity, expected.value, expected.allowed, widest, "baseline");
    if (!finding.passed && finding.limit)
      finding.message += likely_cause(quantity, expected, *finding.limit, now, accepted);
    report.findings.push_back(std::move(finding));
    if (const auto& reference = expected.reference)
      report.findings.push_back(
          compare(quantity, reference->value, reference->allowed,
                  {widest_of_reference, widest_of_reference * quantity.size()}, reference->label));
  }
  for (const Measurement& quantity : measured)
    if (!accepted.contains(quantity.id))
      fail(report, quantity.id,
           fmt::format("is {} {}, and the baseline does not have it; --accept adds it",
                       quantity.value, quantity.unit));
}

/// ΔB must be B − B(undeformed), to rounding.
void check_differences(const models::CaseResult& result, CheckReport& report) {
  for (const models::FieldRun& run : result.fields)
    for (std::size_t i = 0; i < run.steps.size(); ++i) {
      if (!run.steps[i]) continue;
      const models::FieldStep& step = *run.steps[i];
      for (std::size_t s = 0; s < step.dB.size(); ++s) {
        if (!step.dB[s] || (run.measured && !step.B[s])) continue;  // readings of ΔB alone
        const std::string id = fmt::format("steps/{}/fields/{}/dB/{}", i, run.name(), s);
        const bool complete =
            s < step.B.size() && step.B[s] && s < run.undeformed.B.size() && run.undeformed.B[s];
        if (!complete || !((*step.B[s] - *run.undeformed.B[s] - *step.dB[s]).norm() <=
                           1e-12 * run.undeformed.B[s]->norm()))
          fail(report, id, "is not B − B(undeformed)");
      }
    }
}

/// The length and eight points of a step's centreline; empty without a deformation.
std::vector<Vector3> bits(const MechanicsStep& step) {
  if (!step.deformation) return {};
  const double L = step.deformation->centreline.length();
  std::vector<Vector3> points{{L, 0, 0}};
  for (int i = 1; i <= 8; ++i)
    points.push_back(step.deformation->centreline.at(L * i / 8).position);
  return points;
}

/// B of a step; empty without a field.
models::AtSensors bits(const std::optional<models::FieldStep>& step) {
  return step && step->any() ? step->B : models::AtSensors();
}

/// Whether two lists of steps have a pair with results, and in all such pairs they are the same to
/// the last bit.
template <class Step>
bool all_same(const std::vector<Step>& a, const std::vector<Step>& b) {
  bool found = false;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    const auto one = bits(a[i]);
    const auto other = bits(b[i]);
    if (one.empty() || other.empty()) continue;
    if (one != other) return false;
    found = true;
  }
  return found;
}

/// Models that are compared must be two, and something must be compared.
void check_independence(const models::CaseResult& result, const Baseline& baseline, bool complete,
                        CheckReport& report) {
  const auto check_pairs = [&](const auto& runs, const auto& name_of, const auto& same) {
    for (std::size_t b = 0; b < runs.size(); ++b)
      for (std::size_t a = 0; a < b; ++a) {
        const bool one = name_of(runs[a]) == name_of(runs[b]);
        if (one || same(runs[a], runs[b]))
          fail(report, fmt::format("{} and {}", name_of(runs[a]), name_of(runs[b])),
               one ? "a model is compared with itself"
                   : "give the same bits everywhere: a model is compared with itself");
      }
  };
  check_pairs(
      result.mechanics, [](const models::MechanicsRun& run) { return run.model; },
      [](const models::MechanicsRun& a, const models::MechanicsRun& b) {
        return all_same(a.result.steps, b.result.steps);
      });
  check_pairs(
      result.fields, [](const models::FieldRun& run) { return run.name(); },
      [](const models::FieldRun& a, const models::FieldRun& b) {
        return a.mechanics == b.mechanics && all_same(a.steps, b.steps);
      });
  if (complete && references(baseline).empty() && models::compare_models(result).empty())
    fail(report, "comparison",
         "is empty: no two models have a result at the same step, and the baseline has no "
         "reference; the case is compared with nothing but its own past");
}

}  // namespace

std::size_t CheckReport::failures() const {
  return static_cast<std::size_t>(
      std::count_if(findings.begin(), findings.end(), [](const Finding& f) { return !f.passed; }));
}

std::size_t CheckReport::compared() const {
  return static_cast<std::size_t>(std::count_if(
      findings.begin(), findings.end(), [](const Finding& f) { return f.limit.has_value(); }));
}

CheckReport check(const input::Case& asked, const models::CaseResult& result,
                  const Baseline& baseline, const std::vector<std::string>& left_out) {
  CheckReport report;
  report.case_name = asked.name;
  for (const models::MechanicsRun& run : result.mechanics)
    for (const MechanicsStep& step : run.result.steps) report.seconds += step.seconds;
  const Measurements measured = measurements(result);
  check_case(asked, baseline, report);
  check_outcomes(measured.outcomes, baseline, left_out, report);
  check_quantities(measured.quantities, baseline, left_out, report);
  check_differences(result, report);
  check_independence(result, baseline, left_out.empty(), report);
  if (report.compared() == 0) fail(report, "comparison", "no number was compared with any other");
  return report;
}

}  // namespace ciliaval::compare::regression

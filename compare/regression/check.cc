// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/regression/check.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace ciliaval::compare::regression {
namespace {

/// A reference's tolerance beyond this part of the quantity's group checks nothing.
constexpr double widest_of_reference = 0.1;

void fail(CheckReport& report, std::string id, std::string message) {
  report.findings.push_back(
      {false, std::move(id), "baseline", std::move(message), {}, {}, {}, {}, {}});
}

/// True if an entry belongs to one of the models.
bool belongs_to(const std::string& id, const std::vector<std::string>& models) {
  return std::ranges::any_of(models_of(id), [&](const std::string& model) {
    return std::ranges::find(models, model) != models.end();
  });
}

/// Holds one number against another. No part of the tolerance may be wider than `widest`.
Finding compare(const results::Observation& measured, double expected,
                const AllowedDeviation& tolerance, const AllowedDeviation& widest,
                std::string against) {
  Finding finding{false,
                  measured.id(),
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

void check_quantities(const std::vector<results::Observation>& measured, const Baseline& baseline,
                      const std::vector<std::string>& left_out, CheckReport& report) {
  std::map<std::string, const results::Observation*> now;
  for (const results::Observation& quantity : measured) now[quantity.id()] = &quantity;
  std::set<std::string> accepted;
  for (const Expected& expected : baseline.quantities) accepted.insert(expected.id);
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
    const results::Observation& quantity = *found->second;
    if (quantity.unit != expected.unit) {
      fail(report, expected.id,
           fmt::format("is in {}, the baseline is in {}", quantity.unit, expected.unit));
      continue;
    }
    AllowedDeviation widest = allowed_deviation(quantity);
    widest.absolute *= 1.1;  // its second digit may be rounded otherwise in this run
    report.findings.push_back(
        compare(quantity, expected.value, expected.allowed, widest, "baseline"));
    if (const auto& reference = expected.reference)
      report.findings.push_back(
          compare(quantity, reference->value, reference->allowed,
                  {widest_of_reference, widest_of_reference * quantity.size()}, reference->label));
  }
  for (const auto& [id, quantity] : now)
    if (!accepted.contains(id))
      fail(report, id,
           fmt::format("is {} {}, and the baseline does not have it; --accept adds it",
                       quantity->value, quantity->unit));
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
  if (report.compared() == 0) fail(report, "comparison", "no number was compared with any other");
  return report;
}

}  // namespace ciliaval::compare::regression

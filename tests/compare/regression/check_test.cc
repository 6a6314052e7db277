// SPDX-License-Identifier: LGPL-2.1-or-later
// Faults planted into a run that passes: each must fail, with a message that names it.
#include "compare/regression/check.h"
#include "analytic/rod/field_models.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "compare/input/case.h"
#include "compare/models/registry.h"
#include "tests/support/case_texts.h"
#include "tests/support/synthetic.h"

namespace ciliaval::compare {
namespace {

using testing::HasSubstr;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// A case, what two rods and two field models make of it, and the baseline of that.
struct Checked {
  input::Case problem;
  models::CaseResult result;
  regression::Baseline baseline;
  std::vector<std::string> left_out{};

  regression::CheckReport report() const {
    return regression::check(problem, result, baseline, left_out);
  }
  MechanicsStep& step(std::size_t model, std::size_t step) {
    return result.mechanics[model].result.steps[step];
  }
  regression::Expected& expected(const std::string& id) {
    for (regression::Expected& e : baseline.quantities)
      if (e.id == id) return e;
    throw std::out_of_range(id);
  }
};

Checked make_checked() {
  Checked setup;
  setup.problem = input::read_case(
      test::case_text({.name = "planted", .force = R"(["1 mN", "2 mN", "7 mN"])"},
                      "mechanics = [\"elastica\", \"beam\"]\nfields = [\"line\", \"volume\"]\n"),
      "planted.toml", models::known());
  setup.problem.sensors.emplace_back(0.5e-3, 0, -2e-3);
  setup.result = models::run(setup.problem, models::mechanics_models(), models::field_models());
  setup.baseline =
      regression::make_baseline(setup.problem, regression::measurements(setup.result), {}, nullptr);
  return setup;
}

/// Changes every point of a deformation.
void change_shape(MechanicsStep& step, const std::function<void(SectionState&)>& change) {
  std::vector<Centreline::Piece> pieces = step.deformation->centreline.pieces();
  for (Centreline::Piece& piece : pieces)
    for (SectionState& state : piece.states) change(state);
  step.deformation->centreline = Centreline(pieces);
}

struct Fault {
  std::string name;
  std::string message;  ///< part of what the failure must say, or of its id
  std::function<void(Checked&)> plant;
};

std::vector<Fault> faults_of_values() {
  return {
      {"NaN in a tip", "steps/1/mechanics/beam/tip/x",
       [](Checked& s) {
         change_shape(s.step(1, 1), [](SectionState& p) { p.position.x() = nan; });
       }},
      {"NaN in B", "is not finite",
       [](Checked& s) { s.result.fields[0].steps[0]->B[0]->x() = nan; }},
      {"infinite B", "is not finite",
       [](Checked& s) { s.result.fields[1].steps[1]->B[1]->z() = infinity; }},
      {"infinite force", "applied_force",
       [](Checked& s) { s.step(0, 0).applied_force = infinity; }},
      {"1e-8 of a deflection", "off by",
       [](Checked& s) {
         change_shape(s.step(0, 1), [](SectionState& p) { p.position.x() *= 1 + 1e-8; });
       }},
      {"opposite errors that cancel in a mean", "quarter/x",
       [](Checked& s) {
         change_shape(s.step(0, 0), [](SectionState& p) {
           const double S = p.position.z();
           p.position.x() += 1e-6 * std::sin(2 * 3.14159265 * S / 19e-3);
         });
       }},
      {"opposite errors at two sensors", "fields/elastica/line/B/0/x",
       [](Checked& s) {
         s.result.fields[0].steps[0]->B[0]->x() += 1e-9;
         s.result.fields[0].steps[0]->B[1]->x() -= 1e-9;
       }},
      {"flipped sign", "fields/elastica/line/B/0/y: is",
       [](Checked& s) { s.result.fields[0].steps[0]->B[0]->y() *= -1; }},
      {"flipped azimuth", "steps/1/mechanics/elastica/tip/y: is",
       [](Checked& s) {
         change_shape(s.step(0, 1), [](SectionState& p) { p.position.y() *= -1; });
       }},
      {"swapped components", "steps/1/fields/elastica/line/B/0/y: is",
       [](Checked& s) {
         Vector3& B = *s.result.fields[0].steps[1]->B[0];
         std::swap(B.x(), B.y());
       }},
      {"swapped axes of a shape", "steps/0/mechanics/beam/tip/z: is",
       [](Checked& s) {
         change_shape(s.step(1, 0),
                      [](SectionState& p) { std::swap(p.position.x(), p.position.z()); });
       }},
      {"mT for T", "steps/0/fields/elastica/volume/B/0/x: is",
       [](Checked& s) { *s.result.fields[1].steps[0]->B[0] *= 1e3; }},
      {"mm for m", "steps/0/mechanics/elastica/tip/x: is",
       [](Checked& s) { change_shape(s.step(0, 0), [](SectionState& p) { p.position *= 1e3; }); }},
      {"mN for N", "steps/0/mechanics/elastica/applied_force: is",
       [](Checked& s) { s.step(0, 0).applied_force *= 1e3; }},
      {"swapped sensors", "fields/beam/volume/B/0",
       [](Checked& s) {
         auto& B = s.result.fields[3].steps[0]->B;
         std::swap(B[0], B[1]);
       }},
      {"swapped load steps", "steps/0/mechanics/elastica/tip/x",
       [](Checked& s) { std::swap(s.step(0, 0), s.step(0, 1)); }},
      {"swapped models", "mechanics/beam/tip/x",
       [](Checked& s) { std::swap(s.result.mechanics[0].result, s.result.mechanics[1].result); }},
      {"dB that is not B - B0", "fields/elastica/line/dB/0/x: is",
       [](Checked& s) { s.result.fields[0].steps[0]->dB[0]->x() *= 1 + 1e-9; }},
      {"another slip-off", "slip_off_force",
       [](Checked& s) { *s.step(0, 2).slip_off_force *= 1 + 1e-6; }},
  };
}

std::vector<Fault> faults_of_what_is_there() {
  return {
      {"missing mechanics model", "is a model missing?",
       [](Checked& s) { s.result.mechanics.pop_back(); }},
      {"missing pair", "fields/beam/volume", [](Checked& s) { s.result.fields.pop_back(); }},
      {"missing step", "steps/2/mechanics/beam/status",
       [](Checked& s) { s.result.mechanics[1].result.steps.pop_back(); }},
      {"missing field of a step", "steps/1/fields/elastica/line/status",
       [](Checked& s) { s.result.fields[0].steps[1].reset(); }},
      {"missing sensor", "B/1/x",
       [](Checked& s) {
         for (auto& step : s.result.fields[0].steps)
           if (step) step->B[1].reset();
       }},
      {"missing slip-off force", "slip_off_force",
       [](Checked& s) { s.step(1, 2).slip_off_force.reset(); }},
      {"a model that fails", "is \"failed\", not \"converged\"",
       [](Checked& s) {
         s.step(1, 1).status = Status::failed;
         s.step(1, 1).deformation.reset();
       }},
      {"slipped off where it converged", "is \"slipped_off\", not \"converged\"",
       [](Checked& s) { s.step(0, 1).status = Status::slipped_off; }},
      {"a field that fails", "is \"failed\", not \"computed\"",
       [](Checked& s) { s.result.fields[0].steps[0]->failure = "no field"; }},
      {"a result without an accepted one", "the baseline does not have it",
       [](Checked& s) { s.baseline.quantities.pop_back(); }},
      {"a status without an accepted one", "the baseline does not have it",
       [](Checked& s) { s.baseline.outcomes.pop_back(); }},
      {"a tolerance that nothing reads", "nothing reads its tolerance",
       [](Checked& s) {
         regression::Expected extra = s.baseline.quantities.front();
         extra.id += "/mean";
         s.baseline.quantities.push_back(extra);
       }},
      {"no result at all", "no number was compared",
       [](Checked& s) {
         s.result.mechanics.clear();
         s.result.fields.clear();
         s.baseline.quantities.clear();
         s.baseline.outcomes.clear();
       }},
      {"all models left out", "no number was compared",
       [](Checked& s) {
         s.result.mechanics.clear();
         s.result.fields.clear();
         s.left_out = {"elastica", "beam"};
       }},
  };
}

std::vector<Fault> faults_of_the_baseline() {
  return {
      {"another case's baseline", "that of case \"other\"",
       [](Checked& s) { s.baseline.case_name = "other"; }},
      {"a stale baseline", "another version of the case",
       [](Checked& s) { s.problem.cilium.segments[0].young_modulus *= 1.01; }},
      {"a stale default", "another version of the case",
       [](Checked& s) { s.problem.options.of<analytic::rod::LineOptions>().tolerance *= 2; }},
      {"another unit", "is in m, the baseline is in mm",
       [](Checked& s) { s.expected("steps/0/mechanics/beam/tip/x").unit = "mm"; }},
      {"a tolerance that checks nothing", "checks too little",
       [](Checked& s) { s.expected("steps/0/mechanics/beam/tip/x").allowed.absolute = 1; }},
      {"all tolerances at 10 % and all values 9 % off", "relative 0.1",
       [](Checked& s) {
         for (regression::Expected& e : s.baseline.quantities) {
           e.value *= 1.09;
           e.allowed = {0.1, 0.1 * std::abs(e.value)};
         }
       }},
      {"a tolerance of 1e-9 of a rod's", "wider than 1e-10",
       [](Checked& s) { s.expected("steps/0/mechanics/beam/tip/x").allowed.relative = 1e-9; }},
      {"a tolerance of twice the class", "checks too little",
       [](Checked& s) { s.expected("steps/0/fields/beam/line/dB/0/x").allowed.absolute *= 2; }},
      {"a tolerance of ΔB as a part of |B|, and all ΔB zero", "dB/1/z",
       [](Checked& s) {
         for (regression::Expected& e : s.baseline.quantities)
           if (e.id.find("/dB/") != std::string::npos) e.allowed.absolute = 0.1 * 2.5e-3;
         for (models::FieldRun& run : s.result.fields)
           for (auto& step : run.steps)
             if (step)
               for (auto& dB : step->dB) dB = Vector3::Zero();
       }},
      {"a tolerance of a deflection as a part of L", "tip/x",
       [](Checked& s) {
         s.expected("steps/0/mechanics/beam/tip/x").allowed.absolute = 1e-10 * 20e-3;
       }},
      {"a reference's tolerance that checks nothing", "checks too little",
       [](Checked& s) {
         regression::Expected& e = s.expected("steps/0/mechanics/beam/tip/x");
         e.reference = regression::Reference{"Mattiasson", e.value, {0, 1e-3}};
       }},
      {"a reference that is not met, though the baseline is", "Mattiasson",
       [](Checked& s) {
         regression::Expected& e = s.expected("steps/0/mechanics/beam/tip/x");
         e.reference = regression::Reference{"Mattiasson", e.value * 1.001, {1e-4, 0}};
       }},
      {"a NaN in the baseline", "off by",
       [](Checked& s) { s.expected("steps/0/mechanics/beam/tip/x").value = nan; }},
  };
}

std::string text(const regression::CheckReport& report) {
  std::string result;
  for (const regression::Finding& finding : report.findings)
    if (!finding.passed)
      result += finding.id + ": " + finding.message + " (" + finding.against + ")\n";
  return result;
}

TEST(Check, ARunThatIsAsItsBaselinePasses) {
  const Checked setup = make_checked();
  const regression::CheckReport report = setup.report();
  EXPECT_TRUE(report.passed()) << text(report);
  EXPECT_EQ(report.compared(), setup.baseline.quantities.size());
  EXPECT_GT(report.compared(), 150u);
}

// Models left out on purpose are counted, and the rest is checked.
TEST(Check, ModelsLeftOutOnPurposeAreCounted) {
  Checked setup = make_checked();
  setup.left_out = {"beam"};
  setup.result.mechanics.pop_back();
  std::erase_if(setup.result.fields,
                [](const models::FieldRun& run) { return run.mechanics == "beam"; });
  const regression::CheckReport report = setup.report();
  EXPECT_TRUE(report.passed()) << text(report);
  EXPECT_EQ(report.left_out + report.findings.size(),
            setup.baseline.quantities.size() + setup.baseline.outcomes.size());
}

TEST(Check, FieldModelsLeftOutOnPurposeAreCounted) {
  Checked checked = make_checked();
  checked.left_out = {"volume"};
  std::erase_if(checked.result.fields,
                [](const models::FieldRun& run) { return run.field == "volume"; });
  const regression::CheckReport report = checked.report();
  EXPECT_TRUE(report.passed()) << text(report);
  EXPECT_EQ(report.left_out + report.findings.size(),
            checked.baseline.quantities.size() + checked.baseline.outcomes.size());
}

// Oracle: the fault that was planted.
TEST(Check, EveryPlantedFaultFailsAndIsNamed) {
  const Checked good = make_checked();
  int planted = 0;
  int caught = 0;
  for (const auto& faults :
       {faults_of_values(), faults_of_what_is_there(), faults_of_the_baseline()})
    for (const Fault& fault : faults) {
      Checked bad = good;
      fault.plant(bad);
      const regression::CheckReport report = bad.report();
      const std::string said = text(report);
      ++planted;
      const bool named = said.find(fault.message) != std::string::npos;
      caught += !report.passed() && named;
      EXPECT_FALSE(report.passed()) << fault.name;
      EXPECT_TRUE(named) << fault.name << " gave:\n" << said.substr(0, 2000);
    }
  std::printf("caught %d of %d planted faults\n", caught, planted);
  EXPECT_GE(planted, 30);
}

// The law |a − b| ≤ max(ρ max(|a|, |b|), ε), on both sides of its limit.
TEST(Check, AToleranceHoldsToItsLimitAndNotBeyond) {
  const regression::AllowedDeviation tolerance{1e-3, 1e-6};
  EXPECT_DOUBLE_EQ(tolerance.limit(2, -5), 5e-3);
  EXPECT_DOUBLE_EQ(tolerance.limit(1e-5, 0), 1e-6);
  Checked setup = make_checked();
  regression::Expected& e = setup.expected("steps/0/mechanics/elastica/tip/x");
  const double value = e.value;
  for (const double sign : {-1.0, 1.0}) {
    e.allowed = {1e-10, 0};
    e.value = value * (1 + sign * 0.99e-10);
    EXPECT_TRUE(setup.report().passed());
    e.value = value * (1 + sign * 1.01e-10);
    EXPECT_EQ(setup.report().failures(), 1u);
  }
}

// Every quantity and outcome names its models, of a sweep too.
TEST(Check, LeavesOutAllThatAModelOfASweepHasInTheBaseline) {
  const std::string text = plateau_sweep("travel = \"4 mm\"\nsamples = 3\n") +
                           "[sensor]\nposition = [\"1 mm\", \"0 mm\", \"-2 mm\"]\n";
  Checked setup{read(replaced(text, "[\"elastica\"]", "[\"elastica\", \"beam\"]")), {}, {}};
  setup.result = models::run(setup.problem, models::mechanics_models(), models::field_models());
  const regression::Measurements all = regression::measurements(setup.result);
  for (const results::Observation& quantity : all.quantities) {
    std::vector<std::string> models{quantity.mechanics};
    if (!quantity.field.empty()) models.push_back(quantity.field);
    EXPECT_EQ(regression::models_of(quantity.id()), models) << quantity.id();
  }
  for (const regression::Outcome& outcome : all.outcomes)
    EXPECT_FALSE(regression::models_of(outcome.id).empty()) << outcome.id;
  setup.baseline = regression::make_baseline(setup.problem, all, {}, nullptr);
  std::erase_if(setup.result.mechanics, [](const auto& run) { return run.model == "beam"; });
  std::erase_if(setup.result.fields, [](const auto& run) { return run.mechanics == "beam"; });
  setup.left_out = {"beam"};
  const regression::CheckReport report = setup.report();
  EXPECT_EQ(report.failures(), 0u) << regression::report_text({report});
  EXPECT_GT(report.left_out, 0u);
}

}  // namespace
}  // namespace ciliaval::compare

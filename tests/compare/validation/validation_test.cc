// SPDX-License-Identifier: LGPL-2.1-or-later
// Models against measurements: a linear toy of known sensitivities, a model that stands in for a
// slow one, and the hard-magnetic elastica.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "compare/models/registry.h"
#include "compare/output/results.h"
#include "compare/results/band.h"
#include "compare/validation/input_part.h"
#include "compare/validation/report.h"
#include "compare/validation/validation.h"
#include "problem/error.h"
#include "tests/support/case_texts.h"
#include "tests/support/synthetic.h"

namespace ciliaval::compare::validation {
namespace {

using input::measurement::Measurand;
using testing::HasSubstr;
using Kind = Measurand::Kind;

constexpr double a = 2.0;      ///< m/N
constexpr double b = 1e-9;     ///< m/Pa
constexpr double tesla = 0.1;  ///< T/m, of the toy's field
constexpr double u_num = 2e-6;

/// The tip moves by factor (a F + b E) along x, or with the cube of the force.
class Toy : public MechanicsModel {
 public:
  explicit Toy(double factor, bool is_cubic = false) : factor_(factor), is_cubic_(is_cubic) {}
  MechanicsResult solve(const Cilium& cilium, const LoadPath& path,
                        const Progress&) const override {
    MechanicsResult result;
    result.undeformed.centreline = straight_centreline(cilium.interfaces());
    const double L = cilium.length();
    for (const Load& load : path) {
      const double F = magnitude(load);
      const double x = factor_ * (is_cubic_ ? 1e6 * a * F * F * F
                                            : a * F + b * cilium.segments[0].young_modulus);
      result.steps.push_back(test::converged(
          load,
          test::planar_curve(
              L, 3e-3, Vector3::UnitX(), [=](double S) { return Vector3(x * S / L, 0, S); },
              [](double) { return 0; }, [](double) { return 0; }),
          u_num));
    }
    return result;
  }

 private:
  double factor_;
  bool is_cubic_;
};

models::MechanicsEntry toy(std::string id, double factor, bool is_cubic = false) {
  return {std::move(id), "a toy",
          [=](const input::ModelOptions&) { return std::make_unique<Toy>(factor, is_cubic); }};
}

/// B = (tesla x_tip + 1 mT, 0, 0), known to 1 nT.
models::FieldEntry lamp(std::string id) {
  return test::field_entry(
      std::move(id),
      [](const Deformation& deformation, const Vector3&) -> Vector3 {
        const Centreline& line = deformation.centreline;
        return Vector3(tesla * line.at(line.length()).position.x() + 1e-3, 0, 0);
      },
      Vector3(1e-9, 0, 0));
}

input::measurement::InputUncertainty uncertain(std::string number, std::string uncertainty) {
  return {std::move(number), {std::move(uncertainty)}, false, "", "here", "there"};
}

constexpr std::array<double, 2> forces{1e-3, 2e-3};
constexpr double u_D = 20e-6;

/// The toy's tip measured at both forces: at the first 0.3 mm less than it says, at the second 10
/// µm more. The force is known to 1 %, E (0.1 MPa) to 5 kPa.
input::Case measured_case() {
  input::Case c = test::paper_case({forces[0], forces[1]});
  const Measurand tip{.name = "tip.x", .kind = Kind::position, .axis = 0};
  const double of_E = b * c.cilium.segments[0].young_modulus;
  c.measured.measurements = {{tip, 0, a * forces[0] + of_E - 0.3e-3, u_D, "a photograph", false},
                             {tip, 1, a * forces[1] + of_E + 10e-6, u_D, "a photograph", true}};
  c.measured.inputs = {uncertain("load.force", "1 %"),
                       uncertain("cilium.segment.base.young_modulus", "5 kPa")};
  return c;
}

Validation validated(input::Case c, std::vector<models::MechanicsEntry> mechanics,
                     std::vector<models::FieldEntry> fields = {},
                     Sensitivities whose = Sensitivities::quick) {
  c.mechanics.clear();
  for (const auto& entry : mechanics) c.mechanics.push_back(entry.id);
  c.fields.clear();
  for (const auto& entry : fields) c.fields.push_back(entry.id);
  return validate(models::run(c, mechanics, fields), mechanics, fields, {}, whose).value();
}

// Oracle: by hand, and the inverse of a matrix of two rows.
TEST(LinearToy, HasTheUncertaintiesAndVerdictsOfAHandCalculation) {
  const Validation v = validated(measured_case(), {toy("toy", 1)});
  ASSERT_EQ(v.series.size(), 1U);
  const Series& series = v.series[0];
  EXPECT_EQ(series.model, "toy");
  EXPECT_EQ(series.sensitivities_by, "toy");
  ASSERT_EQ(series.points.size(), 2U);
  std::array<std::array<double, 2>, 2> C{};
  for (std::size_t i = 0; i < 2; ++i) {
    C.at(i) = {0.01 * a * forces.at(i), b * 5e3};
    const Point& point = series.points[i];
    for (std::size_t k = 0; k < 2; ++k)
      EXPECT_NEAR(point.contributions[k].value(), C.at(i).at(k), 1e-12 * C.at(i).at(k) + 1e-16);
    EXPECT_EQ(point.u_num, u_num);
    EXPECT_NEAR(point.u_input.value(), std::hypot(C.at(i)[0], C.at(i)[1]), 1e-15);
    EXPECT_NEAR(point.assessment->u_val, std::hypot(u_num, std::hypot(C.at(i)[0], C.at(i)[1]), u_D),
                1e-15);
  }
  EXPECT_NEAR(series.points[0].assessment->error, 0.3e-3, 1e-15);
  EXPECT_EQ(series.points[0].verdict(), Verdict::bounded);
  EXPECT_NEAR(series.points[1].assessment->error, -10e-6, 1e-15);
  EXPECT_EQ(series.points[1].verdict(), Verdict::not_resolved);
  const double independent = u_num * u_num + u_D * u_D;
  const auto V = [&](std::size_t i, std::size_t j) {
    return C.at(i)[0] * C.at(j)[0] + C.at(i)[1] * C.at(j)[1] + (i == j ? independent : 0);
  };
  const double E0 = 0.3e-3;
  const double E1 = -10e-6;
  const double chi2 = (V(1, 1) * E0 * E0 - 2 * V(0, 1) * E0 * E1 + V(0, 0) * E1 * E1) /
                      (V(0, 0) * V(1, 1) - V(0, 1) * V(0, 1));
  EXPECT_NEAR(series.chi_squared.value(), chi2, 1e-9 * chi2);
  EXPECT_NEAR(series.rms_error.value(), std::sqrt((E0 * E0 + E1 * E1) / 2), 1e-15);
  EXPECT_EQ(series.assessed, 2U);
  EXPECT_EQ(series.fitted(), 1U);
  EXPECT_THAT(v.remarks, testing::ElementsAre(HasSubstr("fitted to 1 of the 2 values")));
}

// (S(+h) − S(−h))/(2h) of F³ is 3 F² (1 + h²/3), h = 0.1 · 1 % of F.
TEST(CubicToy, HasTheDerivativeToTheSquareOfTheShift) {
  input::Case c = measured_case();
  c.measured.inputs.resize(1);
  const Validation v = validated(c, {toy("toy", 1, true)});
  for (std::size_t i = 0; i < 2; ++i) {
    const double exact = 0.01 * 3 * 1e6 * a * std::pow(forces.at(i), 3);
    const double found = v.series[0].points[i].contributions[0].value();
    EXPECT_NEAR(found / exact, 1 + 1e-6 / 3, 1e-8);
  }
}

TEST(SlowToy, TakesTheSensitivitiesOfTheQuickOne) {
  models::MechanicsEntry slow = toy("slow", 1.5);
  slow.is_slow = true;
  const Validation v = validated(measured_case(), {toy("first", 3), toy("toy", 1), slow});
  ASSERT_EQ(v.series.size(), 3U);
  EXPECT_EQ(v.series[0].sensitivities_by, "first");
  EXPECT_EQ(v.series[1].sensitivities_by, "toy");
  EXPECT_EQ(v.series[2].model, "slow");
  EXPECT_EQ(v.series[2].sensitivities_by, "toy");  // the most detailed quick one
  const Point& point = v.series[2].points[1];
  EXPECT_NEAR(point.simulated.value(), 1.5 * (a * forces[1] + b * 0.1e6), 1e-15);
  EXPECT_NEAR(point.contributions[0].value(), 0.01 * a * forces[1], 1e-15);
}

TEST(SlowToy, TakesItsOwnSensitivitiesIfAsked) {
  models::MechanicsEntry slow = toy("slow", 1.5);
  slow.is_slow = true;
  models::FieldEntry slow_field = lamp("slow_lamp");
  slow_field.is_slow = true;
  input::Case c = measured_case();
  c.measured.measurements.push_back(
      {{.name = "dB.0.x", .kind = Kind::dB, .axis = 0}, 1, 3e-4, 1e-6, "a Hall sensor", false});
  const Validation v =
      validated(c, {toy("toy", 1), slow}, {lamp("lamp"), slow_field}, Sensitivities::own);
  for (const Series& series : v.series) {
    EXPECT_EQ(series.sensitivities_by, series.model);
    EXPECT_FALSE(series.has_sensitivities_of_another());
    const double of_tip = (series.model.starts_with("slow") ? 1.5 : 1) * 0.01 * a * forces[1];
    const double of_value = series.measurand().is_field() ? tesla * of_tip : of_tip;
    EXPECT_NEAR(series.points.back().contributions[0].value(), of_value, 1e-14) << series.model;
  }
}

// Oracle: by hand, x = a F + b E, the force known to 1 %, E to 5 kPa; dB_x = tesla x.
TEST(InputParts, AreThoseOfTheToysFormula) {
  input::Case c = measured_case();
  c.measured.measurements.clear();
  models::MechanicsEntry slow = toy("slow", 1.5);
  slow.is_slow = true;
  const std::vector<models::MechanicsEntry> mechanics{toy("toy", 1), slow};
  const std::vector<models::FieldEntry> fields{lamp("lamp")};
  c.mechanics = {"toy", "slow"};
  c.fields = {"lamp"};
  models::CaseResult result = models::run(c, mechanics, fields);
  add_input_parts(result, mechanics, fields);
  EXPECT_THAT(result.inputs,
              testing::ElementsAre("load.force", "cilium.segment.base.young_modulus"));
  for (const models::MechanicsRun& run :
       result.mechanics)  // the slow one has those of the quick one
    for (std::size_t i = 0; i < 2; ++i) {
      const auto& parts = run.input_parts[i];
      EXPECT_NEAR(parts[0].tip.value(), 0.01 * a * forces.at(i), 1e-14);
      EXPECT_NEAR(parts[1].tip.value(), b * 5e3, 1e-14);
      const results::Band tip = results::shape_band(run, i, results::ShapeQuantity::tip);
      EXPECT_NEAR(tip.input.value(), std::hypot(0.01 * a * forces.at(i), b * 5e3), 1e-14);
      EXPECT_FALSE(tip.total) << "the toy has no better model";
    }
  const auto field = results::field_bands(result, result.fields[0], 1, true);
  const double of_tip = std::hypot(0.01 * a * forces[1], b * 5e3);
  EXPECT_NEAR(field.input.at(0)->x(), tesla * of_tip, 1e-14);
  EXPECT_EQ(field.input.at(0)->y(), 0);
  const auto json = nlohmann::json::parse(output::summary_json(result, {}, {}, ""));
  EXPECT_EQ(json["inputs"].size(), 2U);
  EXPECT_NEAR(json["steps"][1]["mechanics"]["toy"]["input_uncertainty"]["tip"].get<double>(),
              of_tip, 1e-14);
  const auto& of_inputs = json["steps"][1]["fields"]["toy/lamp"]["dB_input_contributions"];
  EXPECT_NEAR(of_inputs[1][0][0].get<double>(), tesla * b * 5e3, 1e-14);
  c.measured.inputs = {uncertain("load.farce", "1 %")};
  result.problem = c;
  EXPECT_THROW(add_input_parts(result, mechanics, fields), InputError);
}

TEST(ToyField, IsHeldAgainstAReadingOfASensor) {
  input::Case c = measured_case();
  const Measurand dB{.name = "dB.0.x", .kind = Kind::dB, .axis = 0};
  const Measurand B{.name = "B.0.x", .kind = Kind::B, .axis = 0};
  c.measured.measurements = {{dB, 1, 3e-4, 1e-6, "a Hall sensor", false},
                             {B, 1, 1.4e-3, 1e-6, "a Hall sensor", false}};
  models::FieldEntry slow = lamp("slow");
  slow.is_slow = true;
  const Validation v = validated(c, {toy("toy", 1)}, {lamp("lamp"), slow});
  ASSERT_EQ(v.series.size(), 4U);
  EXPECT_EQ(v.series[0].model, "toy/lamp");
  EXPECT_EQ(v.series[1].model, "toy/slow");
  EXPECT_EQ(v.series[1].sensitivities_by, "toy/lamp");
  const double x = a * forces[1] + b * 0.1e6;
  for (const Series& series : v.series) {
    const Point& point = series.points[0];
    const bool change = series.measurand().kind == Kind::dB;
    EXPECT_NEAR(point.simulated.value(), tesla * x + (change ? 0 : 1e-3), 1e-15);
    EXPECT_NEAR(point.contributions[0].value(), tesla * 0.01 * a * forces[1], 1e-15);
    EXPECT_GT(point.u_num.value(), change ? 2e-9 : 1e-9);  // the field's, and the shape's
    EXPECT_NE(point.verdict(), Verdict::not_known);
  }
}

TEST(Toy, IsNotJudgedWithoutItsUncertaintyOrAValue) {
  models::MechanicsEntry vague = test::mechanics_entry("vague", [](const Load& load) {
    return test::converged(load, test::tilted(20e-3, 3e-3, Vector3::UnitX(), 0.1));
  });
  models::MechanicsEntry gone = test::mechanics_entry("gone", [](const Load& load) {
    MechanicsStep step;
    step.load = load;
    step.status = Status::slipped_off;
    return step;
  });
  const Validation v = validated(measured_case(), {vague, gone});
  for (const Series& series : v.series) {
    EXPECT_EQ(series.count(Verdict::not_known), 2U);
    EXPECT_EQ(series.assessed, 0U);
    EXPECT_FALSE(series.chi_squared);
  }
  EXPECT_EQ(v.series[0].points[0].note, "u_num is not known");
  EXPECT_EQ(v.series[1].points[0].note, "slipped_off");
}

TEST(Toy, SaysThatTheInputsCountAsExactIfNoneIsStated) {
  input::Case c = measured_case();
  c.measured.inputs.clear();
  const Validation v = validated(c, {toy("toy", 1)});
  EXPECT_EQ(v.series[0].points[0].u_input, 0);
  EXPECT_THAT(v.remarks, testing::Contains(HasSubstr("u_input is 0")));
}

TEST(Toy, WithoutMeasurementsThereIsNoValidation) {
  const std::vector<models::MechanicsEntry> mechanics{toy("toy", 1)};
  input::Case c = test::paper_case({1e-3});
  c.mechanics = {"toy"};
  EXPECT_FALSE(validate(models::run(c, mechanics, {}), mechanics, {}));
}

TEST(Report, FitsATerminalAndNeverSaysValidated) {
  models::MechanicsEntry slow = toy("a_slow_model", 1.5);
  slow.is_slow = true;
  const Validation v = validated(measured_case(), {toy("toy", 1), slow});
  const std::string shown = text(v, output::Footnotes::text);
  for (const std::string& line : lines(shown)) EXPECT_LE(line.size(), 80U) << line;
  EXPECT_THAT(shown, HasSubstr("a_slow_model (u_in by toy)"));
  EXPECT_THAT(shown, HasSubstr("seen with twice the u_in of toy: "));
  EXPECT_THAT(shown, HasSubstr("not seen, < "));
  EXPECT_THAT(shown, HasSubstr("model error seen at 1, not seen at 1"));
  EXPECT_EQ(shown.find("validated"), std::string::npos);
  const auto json = nlohmann::json::parse(validation::json(v));
  EXPECT_EQ(json["series"][0]["points"][0]["verdict"], "bounded");
  EXPECT_EQ(json["series"][0]["points"][0]["bound"], v.series[0].points[0].assessment->bound);
  EXPECT_EQ(json["series"][0]["points"][1]["bound"], v.series[0].points[1].assessment->bound);
  EXPECT_EQ(json["series"][0]["points"][1]["least"], 0);
  // With a u_D of another size by hand: |E| against 2 sqrt(u_num^2 + u_in^2 + (f u_D)^2).
  for (const auto& entry : json["series"][0]["bounded_with_u_D"]) {
    int seen = 0;
    for (const Point& p : v.series[0].points)
      seen += std::abs(p.assessment->error) >
                      2 * std::hypot(*p.u_num, *p.u_input,
                                     entry["factor"].get<double>() * p.measured.uncertainty)
                  ? 1
                  : 0;
    EXPECT_EQ(entry["bounded"], seen) << entry;
  }
  EXPECT_EQ(json["series"][0]["chi_squared"], v.series[0].chi_squared.value());
  EXPECT_EQ(json["inputs"][0]["number"], "load.force");
  EXPECT_EQ(json["inputs"][0]["relative"], true);
  EXPECT_EQ(json["domain"]["load"]["to"], forces[1]);
}

// ------------------------------------------------------------------- the hard-magnetic elastica

constexpr double length = 17.2e-3;
constexpr double diameter = 0.84e-3;
constexpr double E = 909e3;
constexpr double M = 114e3;

/// λ, and the deflection over L and its derivative to ln λ by SciPy (the quadrature of θ' in
/// θ_L − u², adaptive; differences of fourth order): 1 % of λ is worth 0.27, 0.16, 0.09, 0.05 % of
/// L.
struct Elastica {
  double lambda;
  double deflection;
  double slope;
};
constexpr std::array<Elastica, 4> elastica{{{1.2, 0.349010076194174, 0.26897802723},
                                            {6, 0.7445711488895151, 0.15711352317},
                                            {12, 0.8285931711479312, 0.09234708395},
                                            {30, 0.8930069095906658, 0.05371141951}}};

std::string elastica_text() {
  std::string fields;
  std::string rows;
  for (std::size_t i = 0; i < elastica.size(); ++i) {
    // λ = M B A L²/(E I), I/A = d²/16
    const double B = elastica.at(i).lambda * E * diameter * diameter / 16 / (M * length * length);
    fields += fmt::format("{}[\"{:.17g} T\", \"0 T\", \"0 T\"]", i == 0 ? "" : ", ", B);
    rows += fmt::format(R"([[measurement]]
quantity = "tip.deflection"
step = {}
value = "{:.17g} m"
uncertainty = "0.1 mm"
source = "SciPy"
)",
                        i, elastica.at(i).deflection * length);
  }
  return fmt::format(R"([case]
name = "zhao"
[cilium]
diameter = "{} m"
[[cilium.segment]]
name = "beam"
length = "{} m"
young_modulus = "{} Pa"
poisson_ratio = 0.49
magnetization = "{} A/m"
[environment]
uniform_field = [{}]
[models]
mechanics = ["elastica"]
{}[[input_uncertainty]]
number = "environment.uniform_field.x"
uncertainty = "1 %"
[[input_uncertainty]]
number = "cilium.segment.beam.magnetization"
uncertainty = "1 %"
[[input_uncertainty]]
number = "cilium.segment.beam.young_modulus"
uncertainty = "{} Pa"
)",
                     diameter, length, E, M, fields, rows, E / 100);
}

TEST(HardMagneticElastica, HasTheSensitivitiesOfTheClosedForm) {
  const input::Case c = input::read_case(elastica_text(), "zhao.toml", models::known());
  const Validation v = validate(models::run(c, models::mechanics_models(), models::field_models()),
                                models::mechanics_models(), models::field_models())
                           .value();
  ASSERT_EQ(v.series.size(), 1U);
  for (std::size_t i = 0; i < elastica.size(); ++i) {
    const Point& point = v.series[0].points.at(i);
    const double per_percent = 0.01 * elastica.at(i).slope * length;
    EXPECT_NEAR(point.simulated.value(), elastica.at(i).deflection * length, 1e-9 * length);
    // Differences of the second order over 0.1 %.
    EXPECT_NEAR(point.contributions[0].value() / per_percent, 1, 3e-6);
    EXPECT_NEAR(point.contributions[1].value() / per_percent, 1, 3e-6);
    EXPECT_NEAR(point.contributions[2].value() / per_percent, -1, 3e-6);
    EXPECT_EQ(point.verdict(), Verdict::not_resolved);  // the truth itself
  }
  EXPECT_LT(v.series[0].chi_squared.value(), 1e-6);
  const auto number = std::ranges::find(v.domain, "field_number", &Extent::name);
  ASSERT_NE(number, v.domain.end());
  EXPECT_NEAR(number->from, 1.2, 1e-12);
  EXPECT_NEAR(number->to, 30, 1e-11);
  const auto slender = std::ranges::find(v.domain, "slenderness", &Extent::name);
  EXPECT_NEAR(slender->from, length / diameter, 1e-12);
}

}  // namespace
}  // namespace ciliaval::compare::validation

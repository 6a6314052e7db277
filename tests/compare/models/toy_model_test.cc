// SPDX-License-Identifier: LGPL-2.1-or-later
// A mechanics model and a field model that only this file declares go through the program: list,
// validate, run, study, converge and check.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "compare/app/commands/commands.h"
#include "compare/input/case.h"
#include "compare/input/described.h"
#include "compare/models/registry.h"
#include "compare/study/case_number.h"
#include "compare/study/evaluate.h"
#include "compare/study/reader/study_reader.h"
#include "problem/error.h"
#include "tests/support/key_table.h"
#include "tests/support/synthetic.h"

namespace ciliaval::compare {
namespace {

namespace fs = std::filesystem;
using app::commands::ExitCode;
using testing::HasSubstr;

struct HingeOptions {
  double stiffness = 1e-3;   ///< of the spring at the base, N m
  unsigned int pieces = 16;  ///< the error of the angle is 1/n²
};

/// A rigid rod on a spring: tilted by the contact force's moment over the stiffness.
class Hinge : public MechanicsModel {
 public:
  explicit Hinge(HingeOptions options) : options_(options) {}
  MechanicsResult solve(const Cilium& cilium, const LoadPath& path,
                        const Progress&) const override {
    const double joint = cilium.segments.front().length;
    MechanicsResult result;
    result.undeformed.centreline = straight_centreline(cilium.interfaces());
    for (const Load& load : path) {
      const auto contact = load.as<ContactLoad>().value();
      const double error = 1.0 / (options_.pieces * options_.pieces);
      const double angle = contact.force * contact.height / options_.stiffness * (1 + error);
      result.steps.push_back(test::converged(
          load, test::tilted(cilium.length(), joint, direction(load), angle), error * 1e-3));
    }
    return result;
  }

 private:
  HingeOptions options_;
};

struct LampOptions {
  double strength = 1e-6;  ///< T m
  double tolerance = 1e-8;
};

/// B = strength r/r² about the tip, with an error below the tolerance.
class Lamp : public FieldModel {
 public:
  explicit Lamp(LampOptions options) : options_(options) {}
  Field field(const Cilium&, const Deformation& deformation,
              std::span<const Vector3> points) const override {
    const Centreline& line = deformation.centreline;
    Field result;
    for (const Vector3& point : points) {
      const Vector3 r = point - line.at(line.length()).position;
      result.B.emplace_back(options_.strength * (1 + options_.tolerance / 4) / r.squaredNorm() * r);
      result.uncertainty.emplace_back(options_.tolerance * result.B.back().cwiseAbs());
    }
    return result;
  }

 private:
  LampOptions options_;
};

input::MechanicsEntry hinge() {
  return {
      .id = "hinge",
      .description = "a rigid rod on a spring",
      .make = input::make<Hinge, HingeOptions>,
      .options = {input::option(&HingeOptions::stiffness, "stiffness",
                                {"a", "moment", "N m", "1 mN m"}, {1e-9, 1, false, "a spring"},
                                "Of the spring at the base."),
                  input::option(&HingeOptions::pieces, "pieces", {1, 1000, false, "enough"},
                                "The error of the angle is one over their square.")},
      .refinements = {{.option = "pieces",
                       .values = {4, 8, 16, 32},
                       .size = [](double pieces) { return 1 / pieces; },
                       .size_name = "length of the pieces"}},
      .loads = {&ContactLoad::type()},
      .check =
          [](const input::CaseCheck& check) {
            if (check.is_asked_for && check.problem.options.of<HingeOptions>().pieces == 13)
              check.report("models.hinge.pieces", "thirteen pieces are not made");
          },
      .budget_stages =
          [](const input::ModelOptions&) {
            return std::vector<input::BudgetStage>{{.physics = "a stiff rod on a soft joint"}};
          },
  };
}

input::FieldEntry lamp() {
  return {.id = "lamp",
          .description = "a source at the tip",
          .make = input::make<Lamp, LampOptions>,
          .options = {input::option(&LampOptions::strength, "strength", {0, 1, false, "a lamp"},
                                    "B times the distance."),
                      input::option(&LampOptions::tolerance, "tolerance",
                                    {1e-15, 1, false, "an accuracy"}, "Relative.")},
          .refinements = {{.option = "tolerance",
                           .values = {1e-2, 1e-4, 1e-6},
                           .size = [](double tolerance) { return tolerance; },
                           .size_name = "tolerance",
                           .law = input::Refinement::Law::tolerance}},
          .is_slow = true,
          .accuracy = 1e-5,
          .budget_stages = [](const input::ModelOptions&) {
            const auto twice = [](input::ModelOptions& o) { o.of<LampOptions>().strength *= 2; };
            return std::vector<input::BudgetStage>{
                {.physics = "light in place of poles", .variant = "single"},
                {.physics = "twice the light", .variant = "double", .set = twice}};
          }};
}

class ToyModel : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    models::add_model(hinge());
    models::add_model(lamp());
  }

  /// A case of the toy models under 1 and 2 mN at h = 16 mm.
  static std::string case_text(const std::string& options = "") {
    return test::case_text({.name = "toy", .force = R"(["1 mN", "2 mN"])"},
                           "mechanics = [\"hinge\"]\nfields = [\"lamp\"]\n" + options);
  }
  static std::string faults_of(const std::string& text) {
    try {
      input::read_case(text, "toy.toml", models::known());
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name) << text;
    return folder_.path() / name;
  }
  /// Text that the program prints.
  std::string program(const std::string& words, ExitCode expected = ExitCode::pass) const {
    CLI::App program;
    app::commands::CommandLine line{program, words, {}};
    for (const auto add :
         {app::commands::add_run, app::commands::add_check, app::commands::add_converge,
          app::commands::add_study, app::commands::add_list, app::commands::add_schema,
          app::commands::add_budget})
      add(line);
    program.parse(words);
    testing::internal::CaptureStdout();
    const ExitCode code = line.chosen();
    std::fflush(stdout);
    std::string output = testing::internal::GetCapturedStdout();
    EXPECT_EQ(code, expected) << words << '\n' << output;
    return output;
  }
  nlohmann::json json(const fs::path& file) const {
    return nlohmann::json::parse(test::read_text(folder_.path() / file));
  }

  test::TemporaryFolder folder_;
};

/// θ of the toy case under a force, with n pieces.
double angle(double force, double pieces = 16, double stiffness = 1e-3) {
  return force * 16e-3 / stiffness * (1 + 1 / (pieces * pieces));
}

TEST_F(ToyModel, IsListedAndSoIsALoad) {
  static const LoadType tug{"tug", "a load of this test", ContactLoad::type().parameters};
  add_load_type(tug);
  const std::string list = program("list");
  EXPECT_THAT(list, HasSubstr("tug        a load of this test\n"));
  EXPECT_THAT(list, HasSubstr("hinge      a rigid rod on a spring\n"));
  EXPECT_THAT(list, HasSubstr("lamp       a source at the tip; slow\n"));
}

TEST_F(ToyModel, IsReadWrittenBackAndDocumentedFromItsDeclaration) {
  const input::Case c = input::read_case(case_text("[models.hinge]\nstiffness = \"2 mN m\"\n"),
                                         "toy.toml", models::known());
  EXPECT_EQ(c.options.of<HingeOptions>().stiffness, 2e-3);
  EXPECT_EQ(c.options.of<HingeOptions>().pieces, 16u);
  const std::string written = input::to_toml(c, models::known());
  EXPECT_THAT(written, HasSubstr("[models.hinge]\nstiffness = \"0.002 N m\"\npieces = 16\n"));
  const input::Case again = input::read_case(written, "again.toml", models::known());
  EXPECT_EQ(input::to_toml(again, models::known()), written);
  const std::string keys = test::key_table(models::known());
  EXPECT_THAT(
      keys,
      HasSubstr("| `models.hinge.stiffness` | moment, `\"1 mN m\"` | from 1e-09 N m to 1 N m |"));
  EXPECT_THAT(keys, HasSubstr("`solid`, `hinge` |"));
  const auto schema = nlohmann::json::parse(program("schema"));
  EXPECT_THAT(schema.dump(), HasSubstr("Of the spring at the base."));
}

TEST_F(ToyModel, IsRefusedWithItsOwnRangeLoadsAndCheck) {
  EXPECT_THAT(faults_of(case_text("[models.hinge]\npieces = 0\n")),
              HasSubstr("'pieces' is 0, but must be from 1 to 1000: enough"));
  EXPECT_THAT(faults_of(case_text("[models.hinge]\npieces = 13\n")),
              HasSubstr("toy.toml:28:10: thirteen pieces are not made"));
  std::string dead = case_text();
  dead.replace(dead.find("\"contact\""), 9, "\"dead\"");
  dead.replace(dead.find("force ="), 7, "force_per_length =");
  dead.replace(dead.find(R"("1 mN", "2 mN")"), 14, R"("1 N/m", "2 N/m")");
  dead.erase(dead.find("height ="), 17);
  EXPECT_THAT(faults_of(dead), HasSubstr("hinge takes the load types 'contact', not 'dead'"));
}

TEST_F(ToyModel, IsRun) {
  const fs::path file = write("toy.toml", case_text());
  EXPECT_THAT(program("run " + file.string() + " -o " + (folder_.path() / "out").string()),
              HasSubstr("hinge"));
  const auto step = json("out/toy/summary.json").at("steps").at(1);
  const auto tip = step.at("mechanics").at("hinge").at("tip");
  EXPECT_NEAR(tip.at(2).get<double>(), 20e-3 * std::cos(angle(2e-3)), 1e-15);
  EXPECT_TRUE(step.at("fields").contains("hinge/lamp"));
}

TEST_F(ToyModel, IsVariedByAStudy) {
  write("toy.toml", case_text());
  const fs::path file = write("toy.study.toml", R"([study]
name = "stiffness"
case = "toy.toml"
pairs = ["hinge/lamp"]
outputs = ["dB_norm"]
[fixed]
load.force = "1 mN"
[[parameter]]
path = "models.hinge.stiffness"
values = ["1 mN m", "2 mN m"]
)");
  // The program's own study is Python's, whose process knows the shipped models alone.
  const study::Study study = study::reader::read_study(file);
  ASSERT_EQ(study.point_count(), 2u);
  const Vector3 sensor(-0.1e-3, 0.2e-3, -1.55e-3);
  const auto field = [&](double theta) -> Vector3 {
    const Vector3 e(std::cos(M_PI / 6), std::sin(M_PI / 6), 0);
    const Vector3 r = sensor - 20e-3 * (std::sin(theta) * e + std::cos(theta) * Vector3::UnitZ());
    return 1e-6 / r.squaredNorm() * r;
  };
  for (const std::size_t point : {0, 1}) {
    const double theta = angle(1e-3, 16, point == 0 ? 1e-3 : 2e-3);
    const auto results = study::evaluate(study, study.case_at(point), "hinge",
                                         models::mechanics_models(), models::field_models());
    const double dB = results.at(0).values.at(0).value();
    EXPECT_NEAR(dB, (field(theta) - field(0)).norm(), 1e-8 * field(0).norm());
  }
}

TEST_F(ToyModel, IsRefinedByItsOwnLevels) {
  const fs::path file = write("toy.toml", case_text());
  program("converge " + file.string() + " --json " + (folder_.path() / "study.json").string());
  const auto studies = json("study.json").at("studies");
  ASSERT_EQ(studies.size(), 2u);
  EXPECT_EQ(studies.at(0).at("model"), "hinge");
  EXPECT_EQ(studies.at(0).at("option"), "pieces");
  bool found = false;
  for (const auto& quantity : studies.at(0).at("quantities")) {
    if (quantity.at("id") != "steps/0/mechanics/hinge/tip_angle") continue;
    found = true;
    EXPECT_NEAR(quantity.at("order").get<double>(), 2, 1e-3);
    EXPECT_NEAR(quantity.at("limit").get<double>(), 16e-3, 1e-6);
  }
  EXPECT_TRUE(found);
  EXPECT_EQ(studies.at(1).at("model"), "lamp");
}

// The fields of the best mechanics model, which the hinge is, being the last one; the lamp's is the
// number of the closed form, and twice that.
TEST_F(ToyModel, AddsItsStagesToTheBudget) {
  const fs::path file = write("toy.toml", case_text());
  const std::string text =
      program("budget " + file.string() + " --without solid --without potential --json " +
              (folder_.path() / "budget.json").string());
  EXPECT_THAT(text, HasSubstr("-> hinge/line            a stiff rod on a soft joint\n"));
  const auto budget = json("budget.json");
  std::vector<std::string> chain;
  for (const auto& stage : budget.at("chain")) chain.push_back(stage.at("name"));
  EXPECT_THAT(chain, testing::ElementsAre("elastica/line", "beam/line", "hinge/line",
                                          "hinge/volume stacked", "hinge/volume wedge",
                                          "hinge/lamp single", "hinge/lamp double"));
  bool found = false;
  for (const auto& row : budget.at("rows")) {
    if (row.at("quantity") == "tip_angle" && row.at("step") == 1) {
      EXPECT_NEAR(row.at("best").get<double>(), angle(2e-3), 1e-12);
    }
    if (row.at("quantity") != "B") continue;
    found = true;
    const auto& links = row.at("links");
    EXPECT_NEAR(links.back().at("value").get<double>() * 2, row.at("best").get<double>(), 1e-16);
  }
  EXPECT_TRUE(found);
}

TEST_F(ToyModel, IsCheckedAgainstItsBaseline) {
  // Beside the elastica: a model that is compared with nothing fails the check.
  std::string text = case_text();
  text.replace(text.find("[\"hinge\"]"), 9, R"(["elastica", "hinge"])");
  const fs::path file = write("toy.toml", text);
  program("check --accept " + file.string());
  fs::rename(folder_.path() / "toy.baseline.candidate.json", folder_.path() / "toy.baseline.json");
  const auto baseline = json("toy.baseline.json");
  double widest = 0;
  for (const auto& quantity : baseline.at("quantities"))
    if (quantity.at("id").get<std::string>().find("/lamp/") != std::string::npos)
      widest = std::max(widest, quantity.at("relative").get<double>());
  EXPECT_EQ(widest, 1e-5);
  EXPECT_THAT(program("check " + file.string()), HasSubstr("toy"));
  EXPECT_THAT(
      program("check --quick " + file.string()),
      testing::ContainsRegex(
          "[0-9]+ numbers compared, 0 failures, [0-9]+ entries of models that were left out"));
  write("toy.toml", text + "[models.hinge]\npieces = 17\n");
  program("check " + file.string(), ExitCode::tolerance);
}

}  // namespace
}  // namespace ciliaval::compare

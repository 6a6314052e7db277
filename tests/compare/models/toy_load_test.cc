// SPDX-License-Identifier: LGPL-2.1-or-later
// A load type that only this file declares goes through everything that the declaration promises:
// case files in and out, studies, interpolation, tables and results.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "compare/input/case.h"
#include "compare/models/registry.h"
#include "compare/models/run.h"
#include "compare/output/provenance.h"
#include "compare/output/results.h"
#include "compare/output/table.h"
#include "compare/study/case_number.h"
#include "problem/error.h"
#include "problem/load.h"
#include "tests/support/key_table.h"
#include "tests/support/synthetic.h"

namespace ciliaval::compare {
namespace {

using testing::HasSubstr;

/// A couple about the direction's normal at a material section.
struct CoupleLoad {
  static const LoadType& type();
  double couple = 0;     ///< N m
  double arclength = 0;  ///< S, m
  double azimuth = 0;    ///< rad
};

const LoadType& CoupleLoad::type() {
  static const LoadType type{
      "couple",
      "a couple at a material section",
      {load_parameter("couple", {"a", "moment", "N m", "1 mN mm"},
                      {0, 1e3, false, "a couple is not negative"}, "`couple`: the moment.",
                      ", couple {:g} mN mm", 1e6),
       load_parameter("arclength", quantity::length, length_range, "`couple`: where.",
                      " at arc length {:g} mm", 1e3, LoadParameter::Site::arclength),
       ContactLoad::type().parameters.back()}};
  return type;
}

std::string couple_case(const std::string& load) {
  std::string text = test::case_text({.name = "toy"}, "mechanics = [\"elastica\"]\n");
  const std::size_t begin = text.find("[load]");
  const std::size_t end = text.find("\n[", begin);
  return text.replace(begin, end - begin, "[load]\ntype = \"couple\"\n" + load);
}

class ToyLoad : public testing::Test {
 protected:
  static void SetUpTestSuite() { add_load_type(CoupleLoad::type()); }

  const input::Case problem =
      input::read_case(couple_case("couple = [\"1 mN mm\", \"3 mN mm\"]\narclength = \"17 mm\"\n"
                                   "azimuth = \"90 deg\"\n"),
                       "toy.toml", models::known());
};

TEST_F(ToyLoad, IsReadFromACaseFileAndWrittenBack) {
  ASSERT_EQ(problem.load_path.size(), 2u);
  const auto couple = problem.load_path[1].as<CoupleLoad>();
  ASSERT_TRUE(couple);
  EXPECT_DOUBLE_EQ(couple->couple, 3e-6);
  EXPECT_DOUBLE_EQ(couple->arclength, 17e-3);
  EXPECT_EQ(
      input::read_case(input::to_toml(problem, models::known()), "again.toml", models::known())
          .load_path,
      problem.load_path);
  EXPECT_THAT(test::key_table(models::known()), HasSubstr("| `load.couple` |"));
}

TEST_F(ToyLoad, IsRefusedWithItsOwnRangeAndKeys) {
  const auto message = [](const std::string& load) {
    try {
      input::read_case(couple_case(load), "toy.toml", models::known());
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(message("couple = \"-1 N m\"\narclength = \"17 mm\"\n"),
              HasSubstr("a couple is not negative"));
  EXPECT_THAT(message("couple = \"1 mN\"\narclength = \"17 mm\"\n"), HasSubstr("moment"));
  EXPECT_THAT(message("couple = \"1 mN mm\"\n"), HasSubstr("arclength"));
  EXPECT_THAT(message("couple = \"1 mN mm\"\narclength = \"21 mm\"\n"),
              HasSubstr("beyond the tip"));
}

TEST_F(ToyLoad, IsInterpolatedAndChecked) {
  const Load half = interpolate(CoupleLoad{0, 10e-3, 0}, CoupleLoad{2e-6, 20e-3, 1}, 0.5);
  EXPECT_EQ(half, Load(CoupleLoad{1e-6, 15e-3, 0.5}));
  EXPECT_NO_THROW(require_valid(half, problem.cilium));
  EXPECT_THROW(require_valid(CoupleLoad{1e-6, 30e-3, 0}, problem.cilium), InputError);
  EXPECT_THROW(interpolate(half, ContactLoad{}, 0.5), InputError);
}

TEST_F(ToyLoad, IsANumberOfAStudy) {
  const std::vector<study::CaseNumber> numbers = study::case_numbers(problem);
  const auto found =
      std::find_if(numbers.begin(), numbers.end(),
                   [](const study::CaseNumber& number) { return number.path == "load.couple"; });
  ASSERT_NE(found, numbers.end());
  const input::Case changed = study::with_settings(problem, {{*found, 5e-6}});
  EXPECT_EQ(changed.load_path[0].as<CoupleLoad>()->couple, 5e-6);
  EXPECT_EQ(changed.load_path[1].as<CoupleLoad>()->couple, 5e-6);
}

TEST_F(ToyLoad, IsRunByAModelThatTakesItAndStandsInTableAndResults) {
  const double L = problem.cilium.length();
  const std::vector<models::MechanicsEntry> mechanics{
      test::mechanics_entry("elastica", [L](const Load& load) {
        const CoupleLoad couple = load.as<CoupleLoad>().value();
        return test::converged(load, test::arc(L, L / 2, direction(load), 1e6 * couple.couple));
      })};
  const models::CaseResult result = models::run(problem, mechanics, {});
  ASSERT_TRUE(models::all_solved(result));
  EXPECT_EQ(output::describe(problem.load_path[1]),
            "couple, couple 3 mN mm at arc length 17 mm, azimuth 90 deg");
  const test::TemporaryFolder folder;
  output::write_results(result, {}, output::provenance("test"), folder.path());
  const auto json = nlohmann::json::parse(test::read_text(folder.path() / "summary.json"));
  const auto& load = json.at("steps").at(1).at("load");
  EXPECT_EQ(load.at("type"), "couple");
  EXPECT_DOUBLE_EQ(load.at("couple").get<double>(), 3e-6);
  EXPECT_DOUBLE_EQ(load.at("arclength").get<double>(), 17e-3);
}

// The models that know only their own loads say so, instead of solving another problem.
TEST_F(ToyLoad, IsRefusedByTheModelsThatDoNotKnowIt) {
  input::Case all = problem;
  all.mechanics = {"elastica", "beam", "solid"};
  all.load_path.resize(1);
  const models::CaseResult result = models::run(all, models::mechanics_models(), {});
  ASSERT_EQ(result.mechanics.size(), 3u);
  for (const models::MechanicsRun& run : result.mechanics) {
    EXPECT_EQ(run.result.steps.at(0).status, Status::failed) << run.model;
    EXPECT_THAT(run.result.steps.at(0).message, HasSubstr("couple")) << run.model;
  }
}

}  // namespace
}  // namespace ciliaval::compare

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/study/optimum/optimise.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/models/registry.h"
#include "compare/study/reader/study_reader.h"
#include "compare/study/summary/report.h"
#include "compare/study/sweep.h"
#include "problem/error.h"
#include "tests/support/study_texts.h"

namespace ciliaval::compare::study::optimum {
namespace {

namespace fs = std::filesystem;
using test::study_text;
using test::TemporaryFolder;
using testing::HasSubstr;

const std::string volume = "pairs = [\"elastica/volume\"]\noutputs = [\"dB_norm\", \"range\"]\n";

std::string bounds(const std::string& path, const std::string& from, const std::string& to,
                   const std::string& more = "") {
  return "[[parameter]]\npath = \"cilium." + path + "\"\nfrom = " + from + "\nto = " + to + "\n" +
         more;
}
const std::string proportion = bounds("segment.magnet.proportion", "0.05", "0.95");
const std::string diameter = bounds("diameter", "\"1 mm\"", "\"5 mm\"");

Study study_of(const fs::path& folder, const std::string& header, const std::string& rest) {
  test::write_study_case(folder);
  return reader::read_study(test::write_study(folder, study_text(header, rest)));
}

struct Models {
  std::vector<models::MechanicsEntry> mechanics{models::mechanics_models().begin(),
                                                models::mechanics_models().end()};
  std::vector<models::FieldEntry> fields{models::field_models().begin(),
                                         models::field_models().end()};
};

Optimum optimum_of(const Study& study, const Models& models = {}) {
  Solutions in_memory;
  return run_optimisation(study, in_memory, models.mechanics, models.fields);
}

Optimum optimum_of(const std::string& header, const std::string& rest) {
  const TemporaryFolder folder;
  return optimum_of(study_of(folder.path(), header, rest));
}

/// An output of the first pair at the best design.
double best_value(const Optimum& optimum, std::size_t output) {
  return optimum.designs.at(1).pairs.at(0).values.at(output).value();
}

// Oracle: the peak of the scan of Fig. 4c, a parabola through its three highest points, 0.001
// apart.
TEST(Optimise, OneParametersOptimumIsThePeakOfItsScan) {
  const std::string fixed =
      "[fixed]\ncilium.segment.base.young_modulus = \"0.5 MPa\"\n"
      "cilium.segment.magnet.young_modulus = \"1 MPa\"\n";
  const std::string scanned = fixed +
                              "[[parameter]]\npath = \"cilium.segment.magnet.proportion\"\n"
                              "from = 0.855\nto = 0.905\ncount = 51\n";
  const std::string searched = fixed + "[optimise]\nmaximise = \"dB_norm\"\n" + proportion;
  for (const char* field : {"line", "volume"}) {
    const TemporaryFolder folder;
    const std::string header =
        fmt::format("pairs = [\"elastica/{}\"]\noutputs = [\"dB_norm\"]\n", field);
    const Study scan = study_of(folder.path(), header, scanned);
    Solutions in_memory;
    const summary::Trend peak = summary::trend(
        run_study(scan, in_memory, models::mechanics_models(), models::field_models()), 0, 0);
    ASSERT_EQ(peak.kind, summary::Trend::Kind::peak);
    const Optimum optimum = optimum_of(header, searched);
    ASSERT_TRUE(optimum.found());
    EXPECT_NEAR(optimum.designs[1].values[0], peak.extreme_at, 1e-4) << field;
    EXPECT_NEAR(best_value(optimum, 0), peak.largest, 1e-6 * peak.largest) << field;
    EXPECT_LT(optimum.search.optima[0].residual, 1e-6);
  }
}

// Of a smooth problem with a limit: the slice through the best design has it, none that keeps the
// limit is better, and some break it.
TEST(Optimise, SlicesGoThroughTheBestDesign) {
  const TemporaryFolder folder;
  const Study study = study_of(
      folder.path(), volume,
      "[optimise]\nmaximise = \"dB_norm\"\nat_least.range = \"2 mN\"\n" + diameter + proportion);
  const Optimum optimum = optimum_of(study);
  const auto slices = json(study, optimum)["slices"];
  ASSERT_EQ(slices.size(), 2U);
  const double best = best_value(optimum, 0);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& slice = slices[i];
    EXPECT_EQ(slice["path"], study.optimisation->parameters[i].number.path);
    const std::vector<double> at = slice["at"];
    EXPECT_TRUE(std::is_sorted(at.begin(), at.end()));
    EXPECT_DOUBLE_EQ(at.front(), i == 0 ? 1e-3 : 0.05);
    EXPECT_DOUBLE_EQ(at.back(), i == 0 ? 5e-3 : 0.95);
    bool has_best = false;
    int broken = 0;
    for (std::size_t k = 0; k < at.size(); ++k) {
      broken += slice["kept"][k] ? 0 : 1;
      if (slice["values"][k].is_null()) continue;
      const double value = slice["values"][k];
      if (at[k] == slice["best"]) has_best = std::abs(value - best) < 1e-12 * best;
      if (slice["kept"][k]) {
        EXPECT_LE(value, best * (1 + 1e-6)) << at[k];
      }
    }
    EXPECT_TRUE(has_best);
    EXPECT_GT(broken, 0);
  }
}

// Oracle: a grid of 81 × 81 designs, of which none that keeps the limit may be better, and of which
// the best is near.
TEST(Optimise, TwoParametersOptimumUnderALimitIsThatOfAGrid) {
  const std::string goal = "[optimise]\nmaximise = \"dB_norm\"\nat_least.range = \"2 mN\"\n";
  const Optimum optimum = optimum_of(volume, goal + diameter + proportion);
  ASSERT_TRUE(optimum.found());
  EXPECT_NEAR(best_value(optimum, 1), 2e-3, 2e-8 * 2e-3);
  const double best = best_value(optimum, 0);
  const TemporaryFolder folder;
  const Study grid =
      study_of(folder.path(), volume,
               bounds("diameter", "\"1 mm\"", "\"3 mm\"", "count = 81\n") +
                   bounds("segment.magnet.proportion", "0.55", "0.95", "count = 81\n"));
  Solutions in_memory;
  const StudyResult result =
      run_study(grid, in_memory, models::mechanics_models(), models::field_models());
  double largest = 0;
  std::vector<double> at;
  for (std::size_t i = 0; i < result.points.size(); ++i) {
    const auto& values = result.points[i][0].values;
    if (!values[0] || *values[1] < 2e-3 || *values[0] <= largest) continue;
    largest = *values[0];
    at = grid.values_at(i);
  }
  EXPECT_LE(largest, best * (1 + 1e-6));
  EXPECT_GE(largest, best * 0.98);
  EXPECT_NEAR(optimum.designs[1].values[0], at.at(0), 2 * 0.025e-3);
  EXPECT_NEAR(optimum.designs[1].values[1], at.at(1), 4 * 0.005);
}

// Oracle: the optima with the limit, or the bound, 0.5 % to both sides.
TEST(Optimise, MultipliersAreTheGainOfARelaxedLimitAndBound) {
  const auto solve = [](const std::string& range, const std::string& modulus) {
    return optimum_of(volume,
                      "[optimise]\nmaximise = \"dB_norm\"\nglobal_evaluations = 0\nstarts "
                      "= 1\nat_least.range = \"" +
                          range + " mN\"\n" + proportion + diameter +
                          bounds("segment.base.young_modulus", "\"" + modulus + " MPa\"",
                                 "\"3 MPa\"", "spacing = \"logarithmic\"\n"));
  };
  const Optimum middle = solve("2", "0.1");
  ASSERT_TRUE(middle.found());
  const LocalOptimum& optimum = middle.search.optima[0];
  EXPECT_EQ(optimum.at_bound[2], -1);
  EXPECT_LT(optimum.residual, 1e-6);
  const double step = std::log(2.01 / 1.99);
  const double by_limit =
      std::log(best_value(solve("1.99", "0.1"), 0) / best_value(solve("2.01", "0.1"), 0)) / step;
  const double by_bound =
      std::log(best_value(solve("2", "0.0995"), 0) / best_value(solve("2", "0.1005"), 0)) / step;
  EXPECT_NEAR(optimum.multipliers[0], by_limit, 1e-3 * by_limit);
  // In u = ln(E/E_from)/ln(E_to/E_from).
  EXPECT_NEAR(optimum.bound_multipliers[2] / std::log(30), by_bound, 1e-3 * by_bound);
}

// Along E2 at E1 = 1 MPa |ΔB| has a trough at 0.17 MPa (docs/evidence/studies.md): both ends are
// optima, the lower one of a basin that a tenth of the starts hit.
TEST(Optimise, ListsBothSidesOfATrough) {
  const Optimum optimum =
      optimum_of("pairs = [\"elastica/line\"]\noutputs = [\"dB_norm\"]\n",
                 "[fixed]\ncilium.segment.base.young_modulus = \"1 MPa\"\n[optimise]\nmaximise = "
                 "\"dB_norm\"\nstarts = 40\n" +
                     bounds("segment.magnet.young_modulus", "\"0.1 MPa\"", "\"10 MPa\"",
                            "spacing = \"logarithmic\"\n"));
  ASSERT_EQ(optimum.designs.size(), 3u);
  EXPECT_EQ(optimum.designs[1].values[0], 1e7);
  EXPECT_EQ(optimum.designs[2].values[0], 1e5);
  EXPECT_GT(best_value(optimum, 0), optimum.designs[2].pairs[0].values[0].value());
  EXPECT_EQ(optimum.search.optima[0].starts + optimum.search.optima[1].starts, 42u);
}

TEST(Optimise, KeepsAnUpperLimitToo) {
  const Optimum optimum = optimum_of(
      "pairs = [\"elastica/volume\"]\noutputs = [\"B_z\", \"dB_norm\"]\n",
      "[optimise]\nmaximise = \"dB_norm\"\nat_least.range = \"2 mN\"\nat_most.B_z = \"1 mT\"\n" +
          diameter + proportion);
  ASSERT_TRUE(optimum.found());
  EXPECT_NEAR(best_value(optimum, 0), 1e-3, 2e-8 * 1e-3);
  EXPECT_GE(best_value(optimum, 2), 2e-3 * (1 - 2e-8));
  EXPECT_GT(optimum.search.optima[0].multipliers[1], 0);
}

// Without a limit the thinnest cilium that still bears the load, and loads 2 % around it, wins.
TEST(Optimise, TheLoadItselfIsTheLimitWhereNoneIsStated) {
  const Optimum optimum =
      optimum_of("pairs = [\"elastica/volume\"]\noutputs = [\"range\", \"sensitivity\"]\n",
                 "[optimise]\nmaximise = \"sensitivity\"\n" + diameter);
  ASSERT_TRUE(optimum.found());
  EXPECT_NEAR(best_value(optimum, 1), 1.021e-3, 1e-9);
  // The start is the case's own diameter.
  EXPECT_EQ(optimum.designs[0].values[0], 3e-3);
}

TEST(Optimise, AStartThatSlipsOffIsNoObstacle) {
  const Optimum optimum =
      optimum_of(volume,
                 "[optimise]\nmaximise = \"dB_norm\"\nat_least.range = \"2 mN\"\n"
                 "global_evaluations = 0\nstarts = 0\n" +
                     bounds("diameter", "\"1 mm\"", "\"5 mm\"", "start = \"1.2 mm\"\n"));
  EXPECT_EQ(optimum.designs[0].pairs[0].status, Status::slipped_off);
  ASSERT_TRUE(optimum.found());
  EXPECT_EQ(optimum.search.local_searches, 1u);
  EXPECT_NEAR(best_value(optimum, 1), 2e-3, 2e-8 * 2e-3);
}

TEST(Optimise, WithoutADesignThatKeepsTheLimitsThereIsNone) {
  const TemporaryFolder folder;
  const Study study =
      study_of(folder.path(), volume,
               "[optimise]\nmaximise = \"dB_norm\"\nat_least.range = \"1 N\"\n" + diameter);
  const Optimum optimum = optimum_of(study);
  EXPECT_FALSE(optimum.found());
  EXPECT_EQ(optimum.designs.size(), 1u);
  EXPECT_THAT(text(study, optimum), HasSubstr("No design was found that keeps the limits"));
  EXPECT_FALSE(json(study, optimum)["found"].get<bool>());
}

// |ΔB| = 5 T/rad² θ² with θ = 100 F/N · 3 mm/d: the largest at the smallest d that the model does
// not break at; the other models do not share its range.
TEST(Optimise, DesignsAtWhichTheModelFailsAreLeftOutAndOtherPairsConfirm) {
  const TemporaryFolder folder;
  Models models;
  const auto entry = [](const std::string& id, double range) {
    return test::mechanics_entry(id, [=](const Load& load) {
      MechanicsStep step =
          test::converged(load, test::tilted(0.02, 0.01, direction(load), 100 * magnitude(load)));
      step.slip_off_force = range;
      return step;
    });
  };
  models.mechanics = {entry("elastica", 5e-3), entry("beam", 4.9e-3)};
  models.fields = {test::field_entry("line", [](const Deformation& d, const Vector3& x) -> Vector3 {
    if (x.z() > -1.2e-3) throw SolverError("too near");
    const double theta = d.centreline.at(0.02).theta();
    return 5e-6 * theta * theta / -x.z() * Vector3::UnitX();
  })};
  const Study study =
      study_of(folder.path(),
               "pairs = [\"elastica/line\", \"beam/line\"]\noutputs = [\"dB_norm\", \"range\"]\n",
               "[optimise]\nmaximise = \"dB_norm\"\nat_least.range = \"5 mN\"\n"
               "[[parameter]]\npath = \"sensor.position.z\"\nname = \"z\"\nfrom = \"-3 mm\"\nto = "
               "\"-1 mm\"\n");
  const Optimum optimum = optimum_of(study, models);
  ASSERT_TRUE(optimum.found());
  EXPECT_NEAR(optimum.designs[1].values[0], -1.2e-3, 0.01e-3);
  EXPECT_LE(optimum.designs[1].values[0], -1.2e-3);
  ASSERT_EQ(optimum.designs[1].models.size(), 2u);
  const std::string shown = text(study, optimum);
  EXPECT_THAT(shown, HasSubstr("range missed by 2 %"));
  EXPECT_THAT(shown, HasSubstr("kept"));
}

TEST(Optimise, GoesOnFromTheStoreAndEvaluatesNothingTwice) {
  const TemporaryFolder folder;
  const Study study = study_of(folder.path(), volume,
                               "[optimise]\nmaximise = \"dB_norm\"\nat_least.range = \"2 mN\"\n"
                               "global_evaluations = 60\nstarts = 2\n" +
                                   diameter + proportion);
  int solved = 0;
  int limit = 1'000'000;
  Models models;
  const auto genuine = models.mechanics.front();
  ASSERT_EQ(genuine.id, "elastica");
  models.mechanics.front().make = [&](const input::ModelOptions& options) {
    if (solved++ == limit) throw RankFailure("stopped");
    return genuine.make(options);
  };
  const auto run = [&](const std::string& name) {
    output::store::Store store(folder.path() / name);
    Solutions solutions(store, study, "test");
    const Optimum optimum = run_optimisation(study, solutions, models.mechanics, models.fields);
    return text(study, optimum) + csv(study, optimum) + json(study, optimum).dump();
  };
  const std::string whole = run("whole");
  const int all = solved;
  ASSERT_GT(all, 100);
  // Each design makes two models: for its load, and for its range.
  for (const int part : {2, 30, 78, all - 2}) {
    const std::string name = "part" + std::to_string(part);
    solved = 0;
    limit = part;
    EXPECT_THROW(run(name), RankFailure);
    limit = 1'000'000;
    solved = 0;
    EXPECT_EQ(run(name), whole);
    EXPECT_EQ(solved, all - part);
    EXPECT_EQ(output::store::Store(folder.path() / name).read("study"),
              output::store::Store(folder.path() / "whole").read("study"));
  }
}

TEST(Optimise, ReportsEachDesignByEachPair) {
  const TemporaryFolder folder;
  const Study study = study_of(
      folder.path(),
      "pairs = [\"elastica/line\", \"elastica/volume\", \"beam/volume\"]\noutputs = [\"dB_norm\", "
      "\"range\"]\n",
      "[optimise]\nmaximise = \"dB_norm\"\nat_least.range = \"2 mN\"\nglobal_evaluations = 0\n"
      "starts = 1\n" +
          diameter);
  const Optimum optimum = optimum_of(study);
  const std::string lines = csv(study, optimum);
  EXPECT_THAT(lines,
              testing::StartsWith("design,cilium.diameter,pair,status,dB_norm,range,message\n"
                                  "# units: cilium.diameter m, dB_norm T, range N\n"
                                  "start,0.003,elastica/line,converged,"));
  EXPECT_THAT(lines, HasSubstr("\noptimum 1,0.00"));
  const auto document = json(study, optimum);
  EXPECT_EQ(document["designs"].size(), 2u);
  const auto& best = document["designs"][1];
  EXPECT_EQ(best["pairs"].size(), 3u);
  EXPECT_EQ(best["parameters"]["cilium.diameter"].get<double>(), optimum.designs[1].values[0]);
  EXPECT_EQ(best["pairs"]["beam/volume"]["range"].get<double>(),
            optimum.designs[1].pairs[2].values[1].value());
  EXPECT_TRUE(best["constraints"][0]["reached"].get<bool>());
  EXPECT_FALSE(best["constraints"][1]["reached"].get<bool>());
  const std::string shown = text(study, optimum);
  for (const char* words : {"range >= 2 mN: reached; 1 % less would give", "diameter(mm)",
                            "|dB| of start", "range missed by"})
    EXPECT_THAT(shown, HasSubstr(words));
}

}  // namespace
}  // namespace ciliaval::compare::study::optimum

// SPDX-License-Identifier: LGPL-2.1-or-later
// The outputs of a point, with models whose results are known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "analytic/elastica/elastica.h"
#include "compare/models/registry.h"
#include "compare/output/table.h"
#include "compare/study/evaluate.h"
#include "compare/study/reader/study_reader.h"
#include "compare/study/sweep.h"
#include "fem/beam/beam.h"
#include "problem/error.h"
#include "tests/support/study_texts.h"
#include "tests/support/synthetic.h"

namespace ciliaval::compare::study {
namespace {

namespace fs = std::filesystem;
using test::study_text;
using test::TemporaryFolder;
using testing::HasSubstr;

using test::L;

Study study_of(const fs::path& folder, const std::string& header, const std::string& rest) {
  test::write_study_case(folder);
  return reader::read_study(test::write_study(folder, study_text(header, rest)));
}

std::string parameter(const std::string& path, const std::string& values) {
  return "[[parameter]]\npath = \"" + path + "\"\nvalues = [" + values + "]\n";
}

/// A cilium that tilts by 0.1 rad under each mN, up to 5 mN.
MechanicsStep tilting(const Load& load) {
  const double F = magnitude(load);
  if (F > 5e-3) {
    MechanicsStep step;
    step.load = load;
    step.status = Status::slipped_off;
    step.message = "slipped";
    step.slip_off_force = 5e-3;
    return step;
  }
  return test::converged(load, test::tilted(L, L / 2, direction(load), 100 * F));
}

/// B = (3, 0, 4) T/rad² θ² (1 + x/m) at the sensor x.
Vector3 quadratic(const Deformation& deformation, const Vector3& x) {
  const Centreline& centreline = deformation.centreline;
  const double theta = centreline.at(centreline.length()).theta();
  return theta * theta * (1 + x.x()) * Vector3(3, 0, 4);
}

struct Models {
  std::vector<models::MechanicsEntry> mechanics{test::mechanics_entry("elastica", tilting)};
  std::vector<models::FieldEntry> fields{test::field_entry("line", quadratic)};
};

std::vector<PairResult> evaluate_with(const Models& models, const Study& study, std::size_t point) {
  return evaluate(study, study.case_at(point), "elastica", models.mechanics, models.fields);
}

// Oracle: |ΔB| = 5 (0.1 rad/mN)² F² (1 + x), its slope by hand, noise over it.
TEST(StudyOutputs, AreThoseOfTheFormulas) {
  const TemporaryFolder folder;
  const Study study = study_of(
      folder.path(),
      "pairs = [\"elastica/line\"]\nnoise = \"1 mT\"\noutputs = [\"dB_x\", \"dB_y\", \"dB_z\", "
      "\"dB_norm\", \"sensitivity\", \"range\", \"resolution\"]\n",
      parameter("load.force", "\"0 mN\", \"2 mN\", \"4.95 mN\", \"6 mN\"") +
          parameter("sensor.position.x", "\"0 mm\", \"1 mm\""));
  for (std::size_t point = 2; point < 4; ++point) {
    const double x = point == 2 ? 0 : 1e-3;
    const std::vector<PairResult> results = evaluate_with({}, study, point);
    ASSERT_EQ(results.size(), 1u);
    EXPECT_EQ(results[0].status, Status::converged);
    EXPECT_EQ(results[0].message, "");
    const double scale = 0.2 * 0.2 * (1 + x);
    const std::vector<double> expected{3 * scale,
                                       0,
                                       4 * scale,
                                       5 * scale,
                                       5 * 2 * 1e4 * 2e-3 * (1 + x),
                                       5e-3,
                                       1e-3 / (5 * 2 * 1e4 * 2e-3 * (1 + x))};
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_NEAR(results[0].values[i].value(), expected[i], 1e-10 * std::abs(expected[i])) << i;
  }
  // No load: a field, but no direction of |ΔB|'s slope.
  const PairResult none = evaluate_with({}, study, 0)[0];
  EXPECT_EQ(none.status, Status::converged);
  EXPECT_EQ(none.values[3], 0.0);
  EXPECT_FALSE(none.values[4].has_value());
  EXPECT_THAT(none.message, HasSubstr("the load is zero"));
  // 2 % more would slip off.
  const PairResult near = evaluate_with({}, study, 4)[0];
  EXPECT_EQ(near.status, Status::converged);
  EXPECT_TRUE(near.values[3].has_value());
  EXPECT_FALSE(near.values[4].has_value());
  EXPECT_THAT(near.message, HasSubstr("2 % higher"));
  // Slipped off: the range alone.
  const PairResult off = evaluate_with({}, study, 6)[0];
  EXPECT_EQ(off.status, Status::slipped_off);
  EXPECT_THAT(off.message, HasSubstr("slipped"));
  for (std::size_t i = 0; i < off.values.size(); ++i)
    EXPECT_EQ(off.values[i].has_value(), study.outputs[i] == Output::range) << i;
}

TEST(StudyOutputs, WhatAModelThrowsIsTheFailureOfItsPointAlone) {
  const TemporaryFolder folder;
  const Study study = study_of(folder.path(), "pairs = [\"elastica/line\"]\n",
                               parameter("load.force", "\"1 mN\", \"2 mN\", \"3 mN\""));
  Models models;
  models.mechanics = {test::mechanics_entry("elastica", [](const Load& load) {
    if (magnitude(load) == 2e-3) throw std::runtime_error("the model is \"broken\",\nso it is");
    return tilting(load);
  })};
  Solutions in_memory;
  const StudyResult result = run_study(study, in_memory, models.mechanics, models.fields);
  EXPECT_EQ(result.points[0][0].status, Status::converged);
  EXPECT_EQ(result.points[1][0].status, Status::failed);
  EXPECT_THAT(result.points[1][0].message, HasSubstr("so it is"));
  for (const auto& value : result.points[1][0].values) EXPECT_FALSE(value.has_value());
  EXPECT_EQ(result.points[2][0].status, Status::converged);
  models = {};
  models.fields = {test::field_entry("line", [](const Deformation&, const Vector3&) -> Vector3 {
    throw SolverError("no field here");
  })};
  const PairResult without = evaluate_with(models, study, 0)[0];
  EXPECT_EQ(without.status, Status::failed);
  EXPECT_THAT(without.message, HasSubstr("no field here"));
}

TEST(StudySweep, SolvesWhatTheStoreDoesNotHoldAndNothingElse) {
  const TemporaryFolder folder;
  const Study study = study_of(folder.path(), "pairs = [\"elastica/line\"]\n",
                               "[[parameter]]\npath = \"load.force\"\nfrom = \"1 mN\"\nto = \"4 "
                               "mN\"\ncount = 40\n");
  std::atomic<int> solved = 0;
  std::atomic<int> limit = 1'000'000;
  Models models;
  models.mechanics = {test::mechanics_entry("elastica", [&](const Load& load) {
    if (++solved > limit) throw RankFailure("stopped");
    return tilting(load);
  })};
  const auto run = [&](const std::string& name) {
    output::store::Store store(folder.path() / name);
    Solutions solutions(store, study, "test");
    return run_study(study, solutions, models.mechanics, models.fields);
  };
  const StudyResult whole = run("whole");
  EXPECT_EQ(solved, 40);
  solved = 0;
  limit = 15;
  EXPECT_THROW(run("parts"), RankFailure);
  const std::size_t kept = output::store::Store(folder.path() / "parts").read("study").size();
  EXPECT_GT(kept, 0u);
  EXPECT_LE(kept, 15u);
  solved = 0;
  limit = 1'000'000;
  const StudyResult parts = run("parts");
  EXPECT_EQ(solved, 40 - static_cast<int>(kept));
  ASSERT_EQ(parts.points.size(), whole.points.size());
  for (std::size_t i = 0; i < whole.points.size(); ++i)
    EXPECT_EQ(parts.points[i][0].values, whole.points[i][0].values) << i;
  solved = 0;
  run("parts");
  EXPECT_EQ(solved, 0);
}

// A study of the same points in other words is the same one.
TEST(StudySweep, AnotherStudysStoreIsRefusedByWhatDiffers) {
  const TemporaryFolder folder;
  output::store::Store store(folder.path() / "store");
  const auto refusal = [&](const std::string& parameters, const std::string& program) {
    const Study study = study_of(folder.path(), "pairs = [\"elastica/line\"]\n", parameters);
    try {
      Solutions(store, study, program).add("elastica at point 0", {});
    } catch (const CheckpointError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string azimuths = parameter("load.azimuth", "\"0 deg\", \"10 deg\"");
  const std::string forces = parameter("load.force", "\"1 mN\", \"2 mN\"");
  EXPECT_EQ(refusal(forces + azimuths, "ciliaval 1"), "");
  EXPECT_EQ(refusal(parameter("load.force", "\"1000 uN\", \"2 mN\"") + azimuths, "ciliaval 1"), "");
  EXPECT_THAT(
      refusal(parameter("load.force", "\"1 mN\", \"3 mN\"") + azimuths, "ciliaval 1"),
      HasSubstr("parameter 1 was load.force = 0.001 0.002, now it is load.force = 0.001 0.003"));
  EXPECT_THAT(refusal(azimuths + forces, "ciliaval 1"), HasSubstr("parameter 2 was load.azimuth"));
  EXPECT_THAT(refusal(forces + azimuths, "ciliaval 2"),
              HasSubstr("program was ciliaval 1, now it is ciliaval 2"));
}

// Oracle: two models that share no code; and the elastica's own limit, 5.862 mN for the paper's
// cilium (design).
TEST(StudyRange, OfRodsIsTheForceAtWhichTheContactSlipsOff) {
  const TemporaryFolder folder;
  const Study study =
      study_of(folder.path(), "pairs = [\"elastica/line\", \"beam/line\"]\noutputs = [\"range\"]\n",
               parameter("load.force", "\"0 mN\", \"1 mN\", \"9 mN\""));
  for (std::size_t point = 0; point < 3; ++point) {
    const auto range = [&](const std::string& mechanics) {
      return evaluate(study, study.case_at(point), mechanics, models::mechanics_models(),
                      models::field_models())[0]
          .values[0]
          .value();
    };
    EXPECT_NEAR(range("elastica"), 5.862e-3, 1e-6);
    EXPECT_NEAR(range("beam"), 5.862e-3, 0.02 * 5.862e-3);
    // A shear-rigid beam is an elastica.
    input::Case rigid = study.case_at(point);
    rigid.options.of<fem::beam::BeamOptions>().shear_rigid = true;
    const auto beam = fem::beam::Beam(rigid.options.of<fem::beam::BeamOptions>());
    const MechanicsStep step = beam.solve(rigid.cilium, rigid.load_path).steps[0];
    EXPECT_NEAR(slip_off(beam, rigid.cilium, step, analytic::elastica::Elastica()).magnitude,
                range("elastica"), 1e-6 * 5.862e-3);
  }
}

// Oracle: a cantilever of one material under a dead tip force with PL²/EI = 1 turns its tip by
// 0.4613519497 rad (Mattiasson).
TEST(StudyRange, OfADeadForceIsThatAtARotation) {
  Cilium cilium{0.003, {{"rod", 0.02, 1e6, 0.49, 0}}};
  const double P = 1e6 * cilium.second_moment() / (0.02 * 0.02);
  for (const double start : {0.0, 0.1 * P, P, 7 * P})
    EXPECT_NEAR(magnitude_at_rotation(analytic::elastica::Elastica(), cilium,
                                      SectionLoad{start, 0.02, 0}, 0.4613519497)
                    .magnitude,
                P, 1e-6 * P)
        << start;
}

// The same oracle, which has ten digits: the interval holds the load.
TEST(StudyRange, AtARotationHasAnInterval) {
  const Cilium cilium{0.003, {{"rod", 0.02, 1e6, 0.49, 0}}};
  const double P = 1e6 * cilium.second_moment() / (0.02 * 0.02);
  const LargestLoad range = magnitude_at_rotation(analytic::elastica::Elastica(), cilium,
                                                  SectionLoad{P, 0.02, 0}, 0.4613519497);
  ASSERT_TRUE(range.uncertainty);
  EXPECT_LE(std::abs(range.magnitude - P), *range.uncertainty + 2e-10 * P);
  EXPECT_LE(*range.uncertainty, 1.1e-6 * P);
}

TEST(StudyRange, WhereThereIsNoneIsSaid) {
  const test::ShapeModel stiff(
      [](const Load& load) {
        return test::converged(load, test::tilted(L, L / 2, direction(load), 0.1));
      },
      test::tilted(L, L / 2, Vector3::UnitX(), 0));
  const Cilium cilium{0.003, {{"rod", 0.02, 1e6, 0.49, 0}}};
  EXPECT_THROW(magnitude_at_rotation(stiff, cilium, FlowLoad{1, 0}, 0.5), SolverError);
  const Load contact = ContactLoad{1e-3, 0.016, 0};
  EXPECT_THROW(
      slip_off(stiff, cilium, test::converged(contact, {}), analytic::elastica::Elastica()),
      SolverError);
}

// Trends of the paper, section 3.4; its figures are curves without numbers.
TEST(ShippedStudies, ShowThePapersTrendsWithThePapersModels) {
  const auto values = [](const std::string& name, std::size_t output) {
    Study study = reader::read_study(CILIAVAL_SOURCE_DIR "/cases/paper/" + name + ".study.toml");
    study.pairs = {{"elastica", "line"}};
    study.outputs = {Output::dB_x, Output::dB_norm};
    std::vector<double> all;
    for (std::size_t i = 0; i < study.point_count(); ++i)
      if (const auto value = evaluate(study, study.case_at(i), "elastica",
                                      models::mechanics_models(), models::field_models())[0]
                                 .values[output])
        all.push_back(*value);
    return all;
  };
  const std::vector<double> e1 = values("fig4a-e1", 1);
  EXPECT_EQ(e1.size(), 41u);
  EXPECT_TRUE(std::is_sorted(e1.rbegin(), e1.rend()));
  // E2 from 0.1 to 1 MPa, then to 10 MPa: a plateau.
  const std::vector<double> e2 = values("fig4a-e2", 0);
  EXPECT_TRUE(std::is_sorted(e2.begin(), e2.end()));
  EXPECT_LT(e2[40] - e2[20], 0.2 * (e2[20] - e2[0]));
  const std::vector<double> d = values("fig4b", 1);
  EXPECT_EQ(d.size(), 36u);  // thinner ones slip off
  EXPECT_TRUE(std::is_sorted(d.rbegin(), d.rend()));
  const std::vector<double> part = values("fig4c", 1);
  const auto peak = std::max_element(part.begin(), part.end());
  const double at = 0.05 + 0.01 * static_cast<double>(peak - part.begin());
  EXPECT_GE(at, 0.7);
  EXPECT_LE(at, 0.9);
}

}  // namespace
}  // namespace ciliaval::compare::study

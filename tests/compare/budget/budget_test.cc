// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/budget/budget.h"
#include "analytic/body/mesh_field.h"
#include "analytic/elastica/elastica.h"
#include "analytic/rod/field_models.h"
#include "fem/beam/beam.h"
#include "fem/potential/potential.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "compare/budget/report.h"
#include "compare/budget/sensitivity.h"
#include "problem/error.h"
#include "problem/lagrange.h"
#include "tests/support/synthetic.h"

namespace ciliaval::compare {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

using test::L;

/// A world of known answers. Mechanics: a straight cilium tilted by a·F, with an a of each model.
/// Fields: B = c·(tip position), with a c of each variant.
struct World {
  std::map<std::string, double> tilt{{"elastica", 20}, {"beam", 22}, {"solid", 17}};  // rad/N
  std::map<std::string, std::optional<double>> tip_uncertainty{
      {"elastica", 0}, {"beam", 1e-9}, {"solid", 2e-6}};              // m
  std::optional<Vector3> uncertainty = Vector3(1e-12, 1e-12, 1e-12);  // T
  double slip_off = 1;                                                // N
  std::string fails;                                                  // mechanics

  static double factor(const input::ModelOptions& o, const std::string& id) {  // T/m
    if (id == "dipole") return 0.7e-2;
    if (id == "volume")
      return o.of<analytic::rod::VolumeOptions>().slices ==
                     analytic::rod::VolumeOptions::Slices::stacked
                 ? 1.1e-2
                 : 1.12e-2;
    if (id == "mesh")
      return o.of<analytic::body::MeshOptions>().push_forward == analytic::sources::PushForward::R
                 ? 1.15e-2
                 : 1.14e-2;
    if (id == "potential")
      return 1.14e-2 + 1e-2 * (o.of<fem::potential::PotentialOptions>().relative_permeability - 1) +
             1e-3 * static_cast<double>(o.of<fem::potential::PotentialOptions>().plates.size());
    return 1e-2;
  }

  MechanicsStep solve(const std::string& id, const Load& load) const {
    if (magnitude(load) > slip_off || id == fails) {
      MechanicsStep step;
      step.load = load;
      step.status = id == fails ? Status::failed : Status::slipped_off;
      step.message = "as planned";
      return step;
    }
    MechanicsStep step = test::converged(
        load, test::tilted(L, 3e-3, Vector3::UnitX(), tilt.at(id) * magnitude(load)),
        tip_uncertainty.at(id));
    if (id == "solid")
      step.deformation->body = std::make_shared<SolidBody>(test::BentBricks::body());
    return step;
  }

  std::vector<models::MechanicsEntry> mechanics() const {
    std::vector<models::MechanicsEntry> entries;
    for (const std::string id : {"elastica", "beam", "solid"}) {
      entries.push_back(
          test::mechanics_entry(id, [*this, id](const Load& load) { return solve(id, load); }));
      const models::MechanicsEntry& shipped = models::entry_of(models::mechanics_models(), id);
      entries.back().has_body = shipped.has_body;
      entries.back().budget_stages = shipped.budget_stages;
    }
    return entries;
  }

  std::vector<models::FieldEntry> fields() const {
    std::vector<models::FieldEntry> entries;
    for (const std::string id : {"dipole", "line", "volume", "mesh", "potential"})
      entries.push_back(
          {.id = id,
           .description = "",
           .make =
               [*this, id](const input::ModelOptions& options) {
                 const double c = factor(options, id);
                 return std::make_unique<test::FormulaField>(
                     [c](const Deformation& d, const Vector3&) -> Vector3 {
                       return c * d.centreline.at(L).position;
                     },
                     uncertainty);
               },
           .has_body = id == "mesh",
           .budget_stages = models::entry_of(models::field_models(), id).budget_stages});
    return entries;
  }

  budget::Budget budget(const std::vector<double>& forces,
                        const std::vector<std::string>& without = {}) const {
    return budget::error_budget(test::paper_case(forces), mechanics(), fields(), without);
  }
};

const budget::BudgetRow& row_of(const budget::Budget& budget, std::size_t step,
                                const std::string& quantity, const std::string& component) {
  for (const budget::BudgetRow& row : budget.rows)
    if (row.step == step && row.quantity == quantity && row.component == component) return row;
  throw std::out_of_range(quantity + " " + component);
}

/// The links lead from the paper's model to the best one and add up to their difference.
void expect_no_fault(const budget::Budget& budget) {
  for (const budget::BudgetRow& row : budget.rows) {
    ASSERT_FALSE(row.links.empty());
    double sum = 0;
    double size = std::abs(row.paper) + std::abs(row.best);
    std::string at = row.total.from;
    for (const budget::BudgetLink& link : row.links) {
      EXPECT_EQ(link.from, at);
      at = link.to;
      sum += link.value;
      size += std::abs(link.value);
    }
    EXPECT_EQ(at, row.total.to);
    const double rounding = 1e-15 * static_cast<double>(row.links.size()) * size;
    EXPECT_NEAR(sum, row.best - row.paper, rounding) << row.quantity;
    EXPECT_NEAR(row.total.value, row.best - row.paper, rounding) << row.quantity;
  }
}

std::vector<std::string> names(const std::vector<budget::Stage>& stages) {
  std::vector<std::string> result;
  result.reserve(stages.size());
  for (const budget::Stage& stage : stages) result.push_back(stage.name());
  return result;
}

// Oracle: the known factors and tilts.
TEST(Budget, ALinkIsTheNextModelLessThePreviousOne) {
  const double F = 2e-3;
  const budget::Budget budget = World{}.budget({F});
  EXPECT_THAT(names(budget.chain.stages),
              ElementsAre("elastica/line", "beam/line", "solid/line", "solid/volume stacked",
                          "solid/volume wedge", "solid/mesh R", "solid/mesh F",
                          "solid/potential mu_r = 1", "solid/potential mu_r = 1.05"));
  EXPECT_FALSE(budget.failed);
  expect_no_fault(budget);
  const auto x = [&](double a) { return L * std::sin(a * F); };
  const budget::BudgetRow& dB = row_of(budget, 0, "dB", "x");
  const std::vector<double> expected{1e-2 * (x(22) - x(20)),
                                     1e-2 * (x(17) - x(22)),
                                     0.1e-2 * x(17),
                                     0.02e-2 * x(17),
                                     0.03e-2 * x(17),
                                     -0.01e-2 * x(17),
                                     0,
                                     0.05e-2 * x(17)};
  ASSERT_EQ(dB.links.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(dB.links[i].value, expected[i], 1e-16) << i;
    EXPECT_EQ(dB.links[i].from, budget.chain.stages[i].name());
    EXPECT_EQ(dB.links[i].to, budget.chain.stages[i + 1].name());
  }
  EXPECT_NEAR(dB.paper, 1e-2 * x(20), 1e-16);
  EXPECT_NEAR(dB.best, 1.19e-2 * x(17), 1e-16);
  EXPECT_NEAR(dB.total.value, 1.19e-2 * x(17) - 1e-2 * x(20), 1e-16);
  const budget::BudgetRow& tip = row_of(budget, 0, "tip", "x");
  ASSERT_EQ(tip.links.size(), 2U);
  EXPECT_NEAR(tip.links[0].value, x(22) - x(20), 1e-16);
  EXPECT_NEAR(tip.links[1].value, x(17) - x(22), 1e-16);
  EXPECT_EQ(tip.links[1].to, "solid");
  EXPECT_NEAR(row_of(budget, 0, "tip_angle", "").total.value, (17 - 20) * F, 1e-12);
}

TEST(Budget, TheDipoleStandsBesideTheSum) {
  const budget::Budget budget = World{}.budget({2e-3});
  const budget::BudgetRow& dB = row_of(budget, 0, "dB", "x");
  ASSERT_TRUE(dB.beside);
  EXPECT_EQ(dB.beside->to, "elastica/dipole");
  EXPECT_NEAR(dB.beside->value, -0.3e-2 * L * std::sin(20 * 2e-3), 1e-16);
  for (const budget::BudgetLink& link : dB.links) EXPECT_THAT(link.to, Not(HasSubstr("dipole")));
  EXPECT_FALSE(row_of(budget, 0, "tip", "x").beside);
  EXPECT_FALSE(row_of(World{}.budget({2e-3}, {"dipole"}), 0, "dB", "x").beside);
}

// 1e-12 T of each field model; ΔB has twice that, and a pair the sum of both.
TEST(Budget, ModelsOnOneDeformationHaveTheFieldsUncertaintiesOnly) {
  const budget::Budget budget = World{}.budget({2e-3});
  const budget::BudgetRow& dB = row_of(budget, 0, "dB", "x");
  for (std::size_t i = 2; i < dB.links.size(); ++i)
    EXPECT_NEAR(*dB.links[i].uncertainty, 4e-12, 1e-20) << i;
  EXPECT_EQ(dB.links[6].verdict, models::Verdict::below_uncertainty);  // the two are the same
  EXPECT_EQ(dB.links[7].verdict, models::Verdict::resolved);
  // Solid and beam differ by more than the 2 µm of their deformations carry into ΔB:
  // |ΔB| u/|tip displacement| = c u in this world.
  EXPECT_NEAR(*dB.links[1].uncertainty, 1e-2 * (2e-6 + 1e-9) + 4e-12, 1e-13);
  EXPECT_EQ(dB.links[1].verdict, models::Verdict::resolved);
  EXPECT_NEAR(*row_of(budget, 0, "tip", "x").links[1].uncertainty, 2.001e-6, 1e-18);
}

TEST(Budget, AnUnknownUncertaintyIsInconclusive) {
  World world;
  world.tip_uncertainty["solid"] = std::nullopt;
  budget::Budget budget = world.budget({2e-3});
  for (const auto& [quantity, component] :
       {std::pair("tip", "x"), {"tip_angle", ""}, {"dB", "x"}, {"B", "z"}, {"sensitivity", "x"}}) {
    const budget::BudgetRow& row = row_of(budget, 0, quantity, component);
    EXPECT_NE(row.links[0].verdict, models::Verdict::inconclusive) << quantity;
    EXPECT_EQ(row.links[1].verdict, models::Verdict::inconclusive) << quantity;
    EXPECT_EQ(row.total.verdict, models::Verdict::inconclusive) << quantity;
  }
  EXPECT_TRUE(budget.decided());
  world.uncertainty.reset();
  world.tip_uncertainty["beam"] = std::nullopt;
  budget = world.budget({2e-3});
  EXPECT_FALSE(budget.decided());
  EXPECT_THAT(budget::budget_text(budget, output::Footnotes::text), HasSubstr("?"));
}

// Oracle: d/dF c L sin(a F) = c L a cos(a F); the truncation of the five-point formula is
// h⁴ F⁴ a⁵/30: 2e-15 of it here, below rounding.
TEST(Budget, SensitivityIsTheDerivativeByTheLoad) {
  const double F = 2e-3;
  const budget::Budget budget = World{}.budget({F, 0});
  const auto slope = [&](double c, double a) { return c * L * a * std::cos(a * F); };
  const budget::BudgetRow& row = row_of(budget, 0, "sensitivity", "x");
  EXPECT_EQ(row.unit, "T/N");
  EXPECT_NEAR(row.paper, slope(1e-2, 20), 1e-12 * slope(1e-2, 20));
  EXPECT_NEAR(row.links[1].value, slope(1e-2, 17) - slope(1e-2, 22), 1e-12 * row.paper);
  EXPECT_EQ(row.total.to, "solid/mesh F");
  EXPECT_NEAR(row.best, slope(1.14e-2, 17), 1e-12 * row.paper);
  EXPECT_THAT(budget.remarks, testing::Contains(HasSubstr("dB/dF ends at solid/mesh F")));
  EXPECT_THAT(budget.remarks, testing::Contains(HasSubstr("step 2: no dB/dF at a load of zero")));
  // The truncation of D(h) = h² F² a²/6 of the slope is in the uncertainty, with that of ΔB.
  const double truncation = std::pow(budget::sensitivity_step * F, 2) / 6 *
                            (17 * 17 * slope(1e-2, 17) - 22 * 22 * slope(1e-2, 22));
  const double relative = *row_of(budget, 0, "dB", "x").links[1].uncertainty /
                          (1e-2 * 2 * L * std::sin(17 * F / 2));  // |ΔB|, of a chord
  EXPECT_NEAR(*row.links[1].uncertainty, std::abs(truncation) + relative * 1e-2 * L * 17,
              1e-6 * *row.links[1].uncertainty);
}

TEST(Budget, AStepThatSlipsOffHasNoRowsAndIsSaid) {
  World world;
  world.slip_off = 3e-3;
  const budget::Budget budget = world.budget({2e-3, 4e-3, 2.99e-3});
  EXPECT_FALSE(budget.failed);
  for (const budget::BudgetRow& row : budget.rows) EXPECT_NE(row.step, 1U);
  EXPECT_THAT(budget.remarks,
              testing::Contains(HasSubstr("step 2: no budget: elastica slipped off")));
  // A neighbour of the third step slips off.
  EXPECT_THAT(budget.remarks,
              testing::Contains(AllOf(HasSubstr("step 3: dB/dF"), HasSubstr("1.01 of the load"))));
  EXPECT_THROW(row_of(budget, 2, "sensitivity", "x"), std::out_of_range);
  EXPECT_EQ(row_of(budget, 2, "dB", "x").links.size(), 8U);
  expect_no_fault(budget);
}

TEST(Budget, AModelThatFailsIsSaidAndCanBeLeftOut) {
  World world;
  world.fails = "solid";
  budget::Budget budget = world.budget({2e-3});
  EXPECT_TRUE(budget.failed);
  EXPECT_TRUE(budget.rows.empty());
  EXPECT_THAT(budget.remarks, testing::Contains(HasSubstr("solid failed: as planned")));
  budget = world.budget({2e-3}, {"solid"});
  EXPECT_FALSE(budget.failed);
  EXPECT_EQ(row_of(budget, 0, "dB", "x").total.to, "beam/potential mu_r = 1.05");
  EXPECT_THAT(budget.chain.not_run,
              ElementsAre("solid/line: without solid", "beam/mesh R: without solid",
                          "beam/mesh F: without solid"));
  expect_no_fault(budget);
}

// Where the wedges fail at one step, the link from slices to mesh holds both changes.
TEST(Budget, LinksJoinOverAStationWithoutValue) {
  const World world;
  auto fields = world.fields();
  const auto right = fields[2].make;
  fields[2].make = [right](const input::ModelOptions& options) -> std::unique_ptr<FieldModel> {
    if (options.of<analytic::rod::VolumeOptions>().slices ==
        analytic::rod::VolumeOptions::Slices::stacked)
      return right(options);
    return std::make_unique<test::FormulaField>(
        [](const Deformation& d, const Vector3&) -> Vector3 {
          if (d.centreline.at(L).position.x() > 1e-3) throw SolverError("too bent");
          return 1.12e-2 * d.centreline.at(L).position;
        },
        Vector3::Constant(1e-12));
  };
  const budget::Budget budget =
      budget::error_budget(test::paper_case({1e-3, 4e-3}), world.mechanics(), fields, {});
  EXPECT_TRUE(budget.failed);
  EXPECT_THAT(budget.remarks, testing::Contains(HasSubstr("solid/volume wedge: too bent")));
  EXPECT_EQ(row_of(budget, 0, "dB", "x").links.size(), 8U);
  const budget::BudgetRow& row = row_of(budget, 1, "dB", "x");
  ASSERT_EQ(row.links.size(), 7U);
  EXPECT_EQ(row.links[3].from, "solid/volume stacked");
  EXPECT_EQ(row.links[3].to, "solid/mesh R");
  EXPECT_THAT(row.links[3].physics, AllOf(HasSubstr("Jacobian"), HasSubstr("own sections")));
  expect_no_fault(budget);
  EXPECT_THAT(budget::budget_text(budget, output::Footnotes::text), HasSubstr("-> solid/mesh R"));
}

budget::Chain chain_of(const input::Case& problem, const std::vector<std::string>& without) {
  return budget::make_chain(problem, models::mechanics_models(), models::field_models(), without);
}

TEST(Chain, FollowsTheCase) {
  input::Case problem = test::paper_case({1e-3});
  problem.options.of<fem::potential::PotentialOptions>().relative_permeability = 1;
  EXPECT_EQ(chain_of(problem, {}).stages.back().name(), "solid/potential mu_r = 1");
  problem.options.of<fem::potential::PotentialOptions>().plates.resize(1);
  EXPECT_EQ(chain_of(problem, {}).stages.back().name(), "solid/potential mu_r = 1, plates");
  problem.options.of<fem::potential::PotentialOptions>().relative_permeability = 1.1;
  const budget::Chain chain = chain_of(problem, {});
  ASSERT_EQ(chain.stages.size(), 10U);
  input::ModelOptions options = problem.options;
  chain.stages[7].set(options);
  EXPECT_EQ(options.of<fem::potential::PotentialOptions>().relative_permeability, 1);
  EXPECT_TRUE(options.of<fem::potential::PotentialOptions>().plates.empty());
  options = problem.options;
  chain.stages[9].set(options);
  EXPECT_EQ(options.of<fem::potential::PotentialOptions>().relative_permeability, 1.1);
  EXPECT_EQ(options.of<fem::potential::PotentialOptions>().plates.size(), 1U);
  EXPECT_THAT(names(chain_of(problem, {"beam", "solid", "volume", "potential"}).stages),
              ElementsAre("elastica/line"));
}

TEST(Chain, HasALinkForTheJoints) {
  input::Case problem = test::paper_case({1e-3});
  problem.options.of<fem::beam::BeamOptions>().joints = joints::Correction::corrected;
  problem.options.of<analytic::elastica::ElasticaOptions>().joints = joints::Correction::corrected;
  const budget::Chain chain = chain_of(problem, {"mesh", "potential"});
  EXPECT_THAT(names(chain.stages),
              ElementsAre("elastica/line", "beam/line", "beam, joints corrected/line", "solid/line",
                          "solid/volume stacked", "solid/volume wedge"));
  for (const budget::Stage& stage : chain.mechanics) {
    input::ModelOptions options = problem.options;
    stage.set(options);
    const auto joints = stage.mechanics == "elastica"
                            ? options.of<analytic::elastica::ElasticaOptions>().joints
                            : options.of<fem::beam::BeamOptions>().joints;
    if (stage.mechanics != "solid") {  // which has no corrections
      EXPECT_EQ(joints == joints::Correction::corrected, stage.mechanics_name() != stage.mechanics);
    }
  }
  EXPECT_THAT(
      names(chain_of(problem, {"solid", "mesh", "potential"}).stages),
      ElementsAre("elastica/line", "beam/line", "beam, joints corrected/line",
                  "beam, joints corrected/volume stacked", "beam, joints corrected/volume wedge"));
}

TEST(Chain, BeginsWithoutWhatIsAround) {
  input::Case problem = test::paper_case({1e-3});
  const auto chain = [&](const surroundings::Environment& around) {
    problem.load_path.front().set_environment(around);
    return chain_of(problem, {"volume", "mesh", "potential"});
  };
  EXPECT_THAT(names(chain({.gravity = {0, 0, -9.81}}).stages),
              ElementsAre("elastica alone/line", "elastica/line", "beam/line", "solid/line"));
  EXPECT_THAT(names(chain({.uniform_field = {1e-3, 0, 0}}).stages),
              ElementsAre("elastica alone/line", "elastica/line", "beam/line",
                          "solid by the other law/line", "solid/line"));
  EXPECT_EQ(chain({.uniform_field = {1e-3, 0, 0}}).stages.back().physics,
            "the magnetic energy by F, in place of R");
  surroundings::Environment magnets;
  magnets.magnets.push_back(
      {.name = "ball", .position = {0.05, 0, 0}, .diameter = 1e-3, .magnetization = {0, 0, 1e6}});
  EXPECT_THAT(names(chain(magnets).stages),
              ElementsAre("elastica alone/line", "beam alone/line", "beam/line",
                          "solid by the other law/line", "solid/line"));
  EXPECT_EQ(chain(magnets).beside->name(), "elastica alone/dipole");
  EXPECT_THAT(names(chain_of(problem, {"beam", "solid", "mesh", "potential"}).stages),
              ElementsAre("elastica alone/line", "elastica alone/volume stacked",
                          "elastica alone/volume wedge"));
  EXPECT_THAT(names(chain({.gravity = {0, 1, 0}}).stages),
              ElementsAre("elastica alone/line", "beam alone/line", "beam/line", "solid/line"));
}

// Oracle: the elastica itself with and without what is around it.
TEST(Budget, HasALinkOfWhatIsAround) {
  input::Case problem = test::paper_case({1e-3});
  for (Segment& segment : problem.cilium.segments) segment.density = 1500;
  const surroundings::Environment around{.gravity = {0, 0, -9.81}};
  const Load bare = problem.load_path.front();
  problem.load_path.front().set_environment(around);
  const budget::Budget budget =
      budget::error_budget(problem, models::mechanics_models(), models::field_models(),
                           {"beam", "solid", "volume", "mesh", "potential", "sensitivity"});
  const auto tip = [&](const Load& load) {
    const MechanicsStep step =
        analytic::elastica::Elastica().solve(problem.cilium, {load}).steps.at(0);
    return step.deformation->centreline.at(problem.cilium.length()).position;
  };
  const Vector3 change = tip(problem.load_path.front()) - tip(bare);
  ASSERT_GE(budget.rows.size(), 3U);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const budget::BudgetRow& row = budget.rows[axis];
    EXPECT_EQ(row.quantity, "tip");
    ASSERT_EQ(row.links.size(), 1U);
    EXPECT_EQ(row.links[0].from, "elastica alone");
    EXPECT_EQ(row.links[0].to, "elastica");
    EXPECT_NEAR(row.links[0].value, change[static_cast<Eigen::Index>(axis)], 1e-12);
    if (axis != 1) {  // across the plane there is nothing
      EXPECT_EQ(row.links[0].verdict, models::Verdict::resolved);
    }
  }
}

TEST(Chain, RefusesWhatItDoesNotKnow) {
  const input::Case problem = test::paper_case({1e-3});
  const auto message = [&](const std::string& word) {
    try {
      chain_of(problem, {word});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(message("potentail"), HasSubstr("did you mean 'potential'?"));
  EXPECT_THAT(message("line"), HasSubstr("the paper's model"));
  EXPECT_THAT(message("elastica"), HasSubstr("the paper's model"));
  EXPECT_THAT(message(""), HasSubstr("beam, solid"));
  EXPECT_EQ(message("sensitivity"), "accepted");
}

// The texts hold what the budget holds.
TEST(BudgetReport, JsonAndCsvGiveTheNumbersBack) {
  input::Case problem = test::paper_case({2e-3});
  problem.sensors.emplace_back(0, 0, -2e-3);
  World world;
  world.tip_uncertainty["solid"] = std::nullopt;
  const budget::Budget budget =
      budget::error_budget(problem, world.mechanics(), world.fields(), {});
  const auto json = nlohmann::json::parse(budget::budget_json(budget, {}));
  std::istringstream csv(budget::budget_csv(budget));
  std::string line;
  ASSERT_TRUE(std::getline(csv, line));
  ASSERT_EQ(json["rows"].size(), budget.rows.size());
  EXPECT_EQ(budget.rows.size(), 4U + 2 * 9);
  const auto check = [&](const nlohmann::json& entry, const budget::BudgetLink& link) {
    EXPECT_EQ(entry["value"].get<double>(), link.value);
    EXPECT_EQ(entry["to"], link.to);
    EXPECT_EQ(entry["uncertainty"].is_null(), !link.uncertainty);
    ASSERT_TRUE(std::getline(csv, line));
    EXPECT_THAT(line, HasSubstr("," + link.from + "," + link.to + ","));
    const std::string models = "," + link.from + "," + link.to + ",";
    const std::string rest = line.substr(line.find(models) + models.size());
    EXPECT_EQ(std::stod(rest), link.value) << line;
    EXPECT_THAT(line, testing::EndsWith("," + std::string(to_string(link.verdict))));
    if (link.uncertainty) {
      EXPECT_EQ(std::stod(rest.substr(rest.find(',') + 1)), *link.uncertainty) << line;
      EXPECT_EQ(entry["uncertainty"].get<double>(), *link.uncertainty);
    } else {
      EXPECT_THAT(line, HasSubstr(",,inconclusive"));
    }
  };
  for (std::size_t i = 0; i < budget.rows.size(); ++i) {
    const budget::BudgetRow& row = budget.rows[i];
    const auto& entry = json["rows"][i];
    EXPECT_EQ(entry["paper"].get<double>(), row.paper);
    EXPECT_EQ(entry["best"].get<double>(), row.best);
    EXPECT_EQ(entry["sensor"].is_null(), !row.sensor);
    for (std::size_t k = 0; k < row.links.size(); ++k) check(entry["links"][k], row.links[k]);
    check(entry["total"], row.total);
    if (row.beside) check(entry["beside"], *row.beside);
  }
  EXPECT_FALSE(std::getline(csv, line));
}

// Oracle: the known lengths in mm and µT.
TEST(BudgetReport, TheTableIsInReadableUnitsAndMarksWhatIsNotResolved) {
  const std::string text = budget::budget_text(World{}.budget({2e-3}), output::Footnotes::text);
  EXPECT_THAT(text,
              testing::ContainsRegex("shape +tip x .mm. +tip y .mm. +tip z .mm. +tip angle .deg."));
  EXPECT_THAT(text, testing::ContainsRegex("elastica +0.79979 "));  // 20 sin 0.04
  EXPECT_THAT(text,
              testing::ContainsRegex("-> beam/line +0.799 "));  // 200 (sin 0.044 − sin 0.04)
  EXPECT_THAT(text, testing::ContainsRegex("-> solid/potential mu_r = 1 +0.000 +.- +4e-06 ~"));
  EXPECT_THAT(text, HasSubstr("one dipole at its centroid; not in the sum"));
}

// The table of the same step has each link's part of dB, in its last column.
TEST(BudgetReport, BeginsWithTheThreeLinksThatChangeTheSignalMost) {
  const std::string text = budget::budget_text(World{}.budget({2e-3}), output::Footnotes::text);
  const std::string table = text.substr(text.find("  dB at sensor"));
  std::vector<double> percent;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line) && !line.starts_with("  total");)
    if (line.starts_with("  ->")) percent.push_back(std::stod(line.substr(line.rfind(' '))));
  ASSERT_GT(percent.size(), 3U);
  std::ranges::sort(percent, std::greater{});
  const std::string head = text.substr(text.find("What changes dB most at step 1, in % of it:\n"));
  std::istringstream first(head);
  std::string line;
  std::getline(first, line);
  for (int i = 0; i < 3; ++i) {
    std::getline(first, line);
    EXPECT_NEAR(std::stod(line) / percent[i], 1, 0.06) << line;
    EXPECT_GT(line.size(), 12U) << line;  // and the assumption
  }
}

// The paper's cilium by the rods. Oracle of dB/dF: the derivative of the polynomial through
// fourteen Chebyshev points of B(F) over ±10 % of F, by the same two models run apart.
TEST(Budget, RodsOfThePaperAddUpAndTheirSensitivityIsTheDerivative) {
  input::Case problem = test::paper_case({1e-3, 4e-3});
  const budget::Budget budget = budget::error_budget(
      problem, models::mechanics_models(), models::field_models(), {"solid", "potential"});
  EXPECT_FALSE(budget.failed);
  EXPECT_EQ(budget.rows.size(), 2U * 13);
  expect_no_fault(budget);
  problem.load_path.clear();
  const LagrangeBasis basis(chebyshev_points(15, 3.6e-3, 4.4e-3));
  for (const double F : basis.nodes()) problem.load_path.emplace_back(ContactLoad{F, 16e-3, 0});
  problem.mechanics = {"elastica"};
  problem.fields = {"line"};
  const models::CaseResult result =
      models::run(problem, models::mechanics_models(), models::field_models());
  Vector3 slope = Vector3::Zero();
  for (std::size_t i = 0; i < basis.size(); ++i)
    slope += basis.slope(i, 7) * *result.fields.front().steps[i]->B[0];
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const budget::BudgetRow& row = row_of(budget, 1, "sensitivity", std::string(1, "xyz"[axis]));
    std::printf("dB/dF, relative error: %.1e\n", std::abs(row.paper - slope[axis]) / slope.norm());
    EXPECT_NEAR(row.paper, slope[axis], 1e-9 * slope.norm());  // measured: 2e-11
  }
}

// Everything, one load. Oracle: the models run apart by run().
TEST(BudgetSlow, AllModelsOfThePapersCiliumAddUp) {
  input::Case problem = test::paper_case({});
  problem.load_path.emplace_back(ContactLoad{2e-3, 16e-3, std::numbers::pi / 6});
  const budget::Budget budget =
      budget::error_budget(problem, models::mechanics_models(), models::field_models(), {});
  EXPECT_FALSE(budget.failed);
  ASSERT_EQ(budget.rows.size(), 13U);
  expect_no_fault(budget);
  const budget::BudgetRow& dB = row_of(budget, 0, "dB", "x");
  ASSERT_EQ(dB.links.size(), 8U);
  // The potential at μ_r = 1 solves what the charged faces are the closed form of.
  for (const char* axis : {"x", "y", "z"})
    EXPECT_EQ(row_of(budget, 0, "dB", axis).links[6].verdict, models::Verdict::below_uncertainty)
        << axis;
  problem.mechanics = {"elastica", "solid"};
  problem.fields = {"line", "mesh"};
  const models::CaseResult result =
      models::run(problem, models::mechanics_models(), models::field_models());
  const double paper = result.fields.front().steps[0]->dB[0]->x();
  const double mesh = result.fields.back().steps[0]->dB[0]->x();
  EXPECT_EQ(result.fields.back().name(), "solid/mesh");
  EXPECT_NEAR(dB.paper, paper, 1e-10 * std::abs(paper));
  double at = dB.paper;
  for (std::size_t i = 0; i < 6; ++i) at += dB.links[i].value;
  EXPECT_NEAR(at, mesh, 1e-7 * std::abs(mesh));  // two solutions by Newton's method to 1e-9
}

}  // namespace
}  // namespace ciliaval::compare

// SPDX-License-Identifier: LGPL-2.1-or-later
// Output of a run of a sweep: the elastica over a step, up and down.
#include "compare/output/sweep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "compare/models/errors.h"
#include "compare/models/registry.h"
#include "compare/models/run.h"
#include "compare/output/results.h"
#include "compare/output/vtk/output.h"
#include "compare/regression/quantities.h"
#include "tests/support/case_texts.h"
#include "tests/support/synthetic.h"

namespace ciliaval::compare {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr std::size_t samples = 41;
const output::Provenance run_origin{"1.2.3", "abc", {}, "ciliaval run x.toml", "today"};

const models::CaseResult& result() {
  static const models::CaseResult value = [] {
    return models::run(input::read_case(plateau_sweep(R"(travel = "22 mm"
samples = 41
azimuth = "30 deg"
[signal]
sampling_rate = "50 Hz"
cutoff = "1 Hz"
[sensor]
position = ["0 mm", "0 mm", "-1.55 mm"]
)"),
                                        "sweep.toml", models::known()),
                       models::mechanics_models(), models::field_models());
  }();
  return value;
}

json summary() {
  return json::parse(output::summary_json(result(), models::compare_models(result()), run_origin));
}

std::vector<std::vector<std::string>> rows_of(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("#")) continue;
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

TEST(SweepResults, ColumnsHaveTheSensorsNames) {
  models::CaseResult named = result();
  named.problem.sensor_names = {"left"};
  const auto header = rows_of(output::sweep_csv(named)).front();
  const auto has = [&](const std::string& part) {
    return std::ranges::any_of(
        header, [&](const std::string& cell) { return cell.find(part) != std::string::npos; });
  };
  EXPECT_TRUE(has(".dB_left_x"));
  EXPECT_FALSE(has(".dB0_x"));
}

// Oracle: the contract (design, section 10).
TEST(SweepResults, SummaryHasTheContactOfEachSample) {
  const json whole = summary();
  ASSERT_EQ(whole["steps"].size(), samples);
  int jumps = 0;
  for (const json& step : whole["steps"]) {
    EXPECT_EQ(step["load"]["type"], "sweep");
    EXPECT_EQ(step["load"]["interference"], 1e-3);
    const json& model = step["mechanics"]["elastica"];
    ASSERT_EQ(model["status"], "converged");
    const json& contact = model["contact"];
    EXPECT_EQ(contact["state"], "slip");
    EXPECT_TRUE(contact["where"] == "rim" || contact["where"] == "mantle");
    // It slides with Coulomb's friction.
    EXPECT_NEAR(contact["friction_force"].get<double>(),
                0.3 * contact["normal_force"].get<double>(),
                1e-8 * contact["normal_force"].get<double>());
    // The point lies in the plane of the azimuth, on the surface.
    const auto point = contact["point"].get<std::vector<double>>();
    const double x = std::hypot(point[0], point[1]);
    EXPECT_NEAR(point[1] / x, 0.5, 1e-12);
    const double p = result()
                         .problem.load_path.front()
                         .surface()
                         ->at(x - step["load"]["travel"].get<double>())
                         .height;
    EXPECT_NEAR(point[2], 20e-3 - 1e-3 - p, 1e-11);
    if (model.contains("jump")) {
      ++jumps;
      EXPECT_GT(model["jump"]["energy_lost"].get<double>(), 0);
    }
  }
  EXPECT_EQ(jumps, 1);
  const json& balance = whole["energy_balance"]["elastica"];
  EXPECT_LT(std::abs(balance["relative_rest"].get<double>()), 1e-6);
  EXPECT_NEAR(balance["surface_work"].get<double>() - balance["friction_work"].get<double>() -
                  balance["energy_lost"].get<double>() - balance["stored"].get<double>(),
              balance["rest"].get<double>(), 1e-18);
}

TEST(SweepResults, SeriesRepeatsTheSummary) {
  const auto rows = rows_of(output::sweep_csv(result()));
  const json whole = summary();
  ASSERT_EQ(rows.size(), samples + 1);
  const auto column = [&](const std::string& name) {
    const auto at = std::find(rows[0].begin(), rows[0].end(), name);
    EXPECT_NE(at, rows[0].end()) << name;
    return static_cast<std::size_t>(at - rows[0].begin());
  };
  for (std::size_t i = 0; i < samples; ++i) {
    const json& step = whole["steps"][i];
    const auto number = [&](const char* name) { return std::stod(rows[i + 1][column(name)]); };
    EXPECT_EQ(number("travel"), step["load"]["travel"]);
    EXPECT_NEAR(number("time"), number("way") / 0.01, 1e-12);
    EXPECT_EQ(number("elastica.normal_force"),
              step["mechanics"]["elastica"]["contact"]["normal_force"]);
    EXPECT_EQ(number("elastica.tip_z"), step["mechanics"]["elastica"]["tip"][2]);
    EXPECT_EQ(number("elastica/volume.dB0_x"), step["fields"]["elastica/volume"]["dB"][0][0]);
  }
}

TEST(SweepResults, TableFitsATerminalAndTellsTheJump) {
  const std::string text = output::sweep_table(result(), 1);
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 105U) << line;
  EXPECT_THAT(text, HasSubstr("41 samples: interference 1 mm, travel 22 mm, azimuth 30 deg"));
  EXPECT_THAT(text, HasSubstr("has jumped at the travel"));
}

TEST(SweepResults, VtkHasTheSurfaceAndTheForceOfEachSample) {
  const test::TemporaryFolder folder;
  output::vtk::write_vtk(result(), std::nullopt, run_origin,
                         output::vtk::drawn_steps(result().problem.load_path.size(), true),
                         folder.path());
  for (const char* series : {"surface.pvd", "contact_elastica.pvd", "centreline_elastica.pvd"})
    EXPECT_TRUE(std::filesystem::exists(folder.path() / series)) << series;
  const MechanicsStep& step = result().mechanics[0].result.steps[7];
  const vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName((folder.path() / "contact_elastica_0007.vtp").c_str());
  reader->Update();
  const Vector3 force(reader->GetOutput()->GetPointData()->GetArray("force")->GetTuple3(0));
  const Vector3 e = direction(step.load);
  EXPECT_NEAR(force.norm(), step.contact->normal_force * std::hypot(1, 0.3), 1e-8 * force.norm());
  EXPECT_NEAR(force.dot(e), step.applied_force, 1e-9 * force.norm());
  reader->SetFileName((folder.path() / "surface_0007.vtp").c_str());
  reader->Update();
  const Vector3 point = step.contact->point;
  double nearest = 1;
  for (vtkIdType i = 0; i < reader->GetOutput()->GetNumberOfPoints(); ++i) {
    const Vector3 x(reader->GetOutput()->GetPoint(i));
    nearest = std::min(
        nearest, (x - x.dot(Vector3::UnitZ().cross(e)) * Vector3::UnitZ().cross(e) - point).norm());
  }
  EXPECT_LT(nearest, 0.03e-3);
  // The time of a series is the way of the surface.
  EXPECT_THAT(test::read_text(folder.path() / "surface.pvd"), HasSubstr("timestep=\"0.022\""));
}

TEST(SweepResults, BaselineHasForcesOfSomeStepsAndTheNumberOfJumps) {
  const regression::Measurements measured = regression::measurements(result());
  const auto forces = std::ranges::count_if(measured.quantities, [](const auto& m) {
    return m.quantity == "contact/normal_force" && m.value > 0;
  });
  EXPECT_EQ(forces, 27);
  const auto jumps = std::ranges::find(measured.outcomes, "energy_balance/elastica/jumps",
                                       &regression::Outcome::id);
  ASSERT_NE(jumps, measured.outcomes.end());
  EXPECT_EQ(jumps->value, "1");
}

}  // namespace
}  // namespace ciliaval::compare

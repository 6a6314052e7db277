// SPDX-License-Identifier: LGPL-2.1-or-later
// Reading of a result folder by a real ParaView. Oracle: ParaView's own readers and filters against
// summary.json and the case.
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/program.h"

namespace ciliaval {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::read_text;
using testing::HasSubstr;

constexpr double radius = 1.5e-3;
constexpr double length = 20e-3;

/// ParaView's Python: of the environment, or as scripts/paraview.sh unpacks it; empty if neither.
std::string pvpython() {
  const char* given = std::getenv("CILIAVAL_PVPYTHON");
  if (given != nullptr) return given;
  const fs::path unpacked = fs::path(CILIAVAL_SOURCE_DIR) / "build/paraview/pvpython";
  return fs::exists(unpacked) ? unpacked.string() : "";
}

/// Runs a script of the sources in a folder; stdout and stderr go to `out.txt` and `err.txt` there.
int run_script(const std::string& script, const fs::path& folder, const std::string& arguments) {
  const std::string command = "cd '" + folder.string() + "' && '" + pvpython() + "' '" +
                              CILIAVAL_SOURCE_DIR "/" + script + "' " + arguments +
                              " >out.txt 2>err.txt";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

class ParaView : public testing::Test {
 protected:
  void SetUp() override {
    if (pvpython().empty())
      GTEST_SKIP() << "no ParaView: scripts/paraview.sh unpacks it, or set CILIAVAL_PVPYTHON";
  }

  /// Runs the paper's cilium under two forces.
  void run_case(const std::string& models) {
    std::ofstream(path() / "one.toml")
        << test::case_text({.name = "one", .force = R"(["1 mN", "2 mN"])"}, models);
    ASSERT_EQ(test::run_program(path(), "run one.toml").code, 0) << read_text(path() / "err.txt");
    summary_ = json::parse(read_text(path() / "results/one/summary.json"));
  }

  const fs::path& path() const { return folder_.path(); }
  const json& step(std::size_t i) const { return summary_["steps"][i]; }

 private:
  test::TemporaryFolder folder_;
  json summary_;
};

/// Every kind of file.
constexpr const char* all_models =
    "mechanics = [\"elastica\", \"beam\", \"solid\"]\n"
    "fields = [\"line\", \"volume\", \"potential\"]\n"
    "[models.solid]\nrefinement = 0\n"
    "[models.potential]\ntolerance = 0.05\n";

using Types = std::map<std::string, std::pair<std::string, int>>;  // name: type, components

/// Name, type and number of components of each array.
Types types(const json& arrays) {
  Types result;
  for (const json& array : arrays)
    result[array["name"]] = {array["type"], array.value("components", 0)};
  return result;
}

const json& array_of(const json& arrays, const std::string& name) {
  for (const json& array : arrays)
    if (array["name"] == name) return array;
  throw std::out_of_range(name);
}

void expect_range(const json& arrays, const std::string& name, std::size_t component, double least,
                  double largest, double tolerance) {
  const json& range = array_of(arrays, name)["ranges"][component];
  EXPECT_NEAR(range[0].get<double>(), least, tolerance) << name << ' ' << component;
  EXPECT_NEAR(range[1].get<double>(), largest, tolerance) << name << ' ' << component;
}

const std::map<std::string, std::string> vtk_kinds{
    {"body_solid", "vtkUnstructuredGrid"},
    {"centreline_beam", "vtkPolyData"},
    {"centreline_elastica", "vtkPolyData"},
    {"centreline_solid", "vtkPolyData"},
    {"dipoles_beam", "vtkPolyData"},
    {"dipoles_elastica", "vtkPolyData"},
    {"dipoles_solid", "vtkPolyData"},
    {"field_beam_potential", "vtkUnstructuredGrid"},
    {"field_elastica_potential", "vtkUnstructuredGrid"},
    {"field_solid_potential", "vtkUnstructuredGrid"},
    {"field_solid_volume", "vtkImageData"},
    {"sensors", "vtkPolyData"}};

/// The arrays at the points, as docs/guide/meshes.md lists them.
Types point_arrays(const std::string& series) {
  if (series == "body_solid")
    return {{"displacement", {"double", 3}},
            {"J", {"double", 1}},
            {"cauchy_stress", {"double", 6}},
            {"magnetization", {"double", 3}}};
  if (series.starts_with("centreline_"))
    return {{"S", {"double", 1}},
            {"radius", {"double", 1}},
            {"displacement", {"double", 3}},
            {"d1", {"double", 3}},
            {"d2", {"double", 3}},
            {"d3", {"double", 3}},
            {"theta", {"double", 1}},
            {"kappa", {"double", 1}},
            {"curvature", {"double", 3}},
            {"section_force", {"double", 3}},
            {"section_moment", {"double", 3}},
            {"segment", {"int", 1}}};
  if (series.starts_with("dipoles_")) return {{"moment", {"double", 3}}};
  if (series.ends_with("_potential"))
    return {{"psi", {"double", 1}}, {"H", {"double", 3}}, {"B", {"double", 3}}};
  if (series.starts_with("field_")) return {{"B", {"double", 3}}, {"valid", {"unsigned char", 1}}};
  Types sensors;
  for (const char* mechanics : {"elastica", "beam", "solid"})
    for (const char* field : {"line", "volume", "potential"})
      for (const std::string kind : {"B", "dB", "band_dB"}) {
        // The solid has no model part, thus no band.
        if (kind == "band_dB" && std::string(mechanics) == "solid") continue;
        const std::string name = kind + "_" + mechanics + "_" + field;
        sensors[name] = {"double", 3};
        sensors["valid_" + name] = {"unsigned char", 1};
      }
  return sensors;
}

void expect_kinds_and_types(const json& data, const std::string& series, double force) {
  SCOPED_TRACE(series);
  EXPECT_EQ(data["kind"], vtk_kinds.at(series));
  EXPECT_EQ(data["time"], force);
  EXPECT_EQ(types(data["point_data"]), point_arrays(series));
  for (const json& array : data["point_data"]) EXPECT_EQ(array["tuples"], data["points"]);
  for (const json& array : data["cell_data"]) EXPECT_EQ(array["tuples"], data["cells"]);
  EXPECT_EQ(array_of(data["field_data"], "load")["ranges"][0][0], force);
  EXPECT_EQ(array_of(data["field_data"], "load_unit")["values"], json({"N"}));
  EXPECT_THAT(array_of(data["field_data"], "provenance")["values"].dump(),
              HasSubstr("ciliaval run one.toml"));
}

void expect_centreline(const json& rod, const json& result, bool is_solid) {
  const json& tip = result["tip"];
  expect_range(rod, "S", 0, 0, length, 1e-15);
  expect_range(rod, "radius", 0, radius, radius, 1e-15);
  // The solid's clamped face is clamped at its nodes, its rims bulge.
  for (const std::size_t axis : {0u, 1u})
    expect_range(rod, "displacement", axis, 0, tip[axis], is_solid ? 1e-8 : 1e-12);
  EXPECT_NEAR(array_of(rod, "displacement")["ranges"][2][0].get<double>(),
              tip[2].get<double>() - length, 1e-12);
  EXPECT_NEAR(array_of(rod, "theta")["ranges"][0][1].get<double>(), result["tip_angle"],
              is_solid ? 1e-2 : 1e-12);
  expect_range(rod, "segment", 0, 0, 1, 0);
}

void expect_body(const json& body, const json& result) {
  expect_range(body["cell_data"], "MaterialIDs", 0, 0, 1, 0);
  expect_range(body["point_data"], "J", 0, 1, 1, 0.3);
  for (const std::size_t axis : {0u, 1u}) {  // the end face turns about its centre
    const double tip = result["tip"][axis];
    EXPECT_NEAR(array_of(body["point_data"], "displacement")["ranges"][axis][1].get<double>(), tip,
                0.03 * tip);
  }
  // The stiff magnet hardly stretches: m is M, turned by nearly the tip's angle.
  const double angle = result["tip_angle"];
  expect_range(body["point_data"], "magnetization", 2, 0, 75e3 * std::cos(angle),
               75e3 * (1 - std::cos(angle)));
}

TEST_F(ParaView, ReadsEveryArrayWithItsNameTypeAndRange) {
  run_case(all_models);
  ASSERT_EQ(run_script("paraview/arrays.py", path(), "results/one/vtk arrays.json"), 0)
      << read_text(path() / "err.txt");
  const json series = json::parse(read_text(path() / "arrays.json"));
  EXPECT_EQ(series.size(), vtk_kinds.size());
  for (const auto& [name, kind] : vtk_kinds) {
    ASSERT_TRUE(series.contains(name)) << name;
    ASSERT_EQ(series[name].size(), 2u) << name;
  }
  for (const std::size_t i : {0u, 1u}) {
    for (const auto& [name, kind] : vtk_kinds)
      expect_kinds_and_types(series[name][i], name, i == 0 ? 1e-3 : 2e-3);
    for (const std::string model : {"elastica", "beam", "solid"}) {
      SCOPED_TRACE(model);
      expect_centreline(series["centreline_" + model][i]["point_data"], step(i)["mechanics"][model],
                        model == "solid");
      for (const std::string field : {"line", "volume", "potential"})
        for (const std::size_t axis : {0u, 1u, 2u})
          for (const std::string kind : {"B", "dB"}) {
            const double value =
                step(i)["fields"][fmt::format("{}/{}", model, field)][kind][0][axis];
            expect_range(series["sensors"][i]["point_data"],
                         fmt::format("{}_{}_{}", kind, model, field), axis, value, value, 1e-15);
          }
    }
    expect_body(series["body_solid"][i], step(i)["mechanics"]["solid"]);
  }
}

TEST_F(ParaView, OpensTheFolderWarpedWithTubesArrowsAndFieldLines) {
  run_case(all_models);
  ASSERT_EQ(
      run_script("tests/paraview/pipeline.py", path(), "results/one/vtk picture.png pipeline.json"),
      0)
      << read_text(path() / "err.txt");
  EXPECT_THAT(read_text(path() / "err.txt"), testing::Not(HasSubstr("ERROR")));
  const json objects = json::parse(read_text(path() / "pipeline.json"));
  const auto shown = [&](const std::string& name, const std::string& type) -> const json& {
    const json& object = objects.at(name);
    EXPECT_EQ(object["type"], type) << name;
    EXPECT_GT(object["points"], 0) << name;
    EXPECT_TRUE(object["shown"]) << name;
    return object;
  };
  const json& body = shown("body_solid deformed", "WarpVector");
  EXPECT_EQ(body["coloured_by"], "MaterialIDs");
  EXPECT_FALSE(objects["body_solid"]["shown"]);
  // Without warp the body's largest x is its radius (a chord's less); warped, the tip's far edge.
  const json& tip = step(1)["mechanics"]["solid"]["tip"];
  EXPECT_NEAR(objects["body_solid"]["bounds"][1].get<double>(), radius, 0.02 * radius);
  EXPECT_NEAR(body["bounds"][1].get<double>(), tip[0].get<double>() + radius, 0.05 * radius);
  // The reference is the body; the others are lines.
  EXPECT_FALSE(objects.at("centreline_solid")["shown"]);
  EXPECT_EQ(shown("centreline_elastica", "PVDReader")["coloured_by"], "");
  EXPECT_EQ(shown("centreline_beam", "PVDReader")["coloured_by"], "");
  const json& tube = objects.at("centreline_beam tube");
  EXPECT_EQ(tube["type"], "TubeFilter");
  EXPECT_FALSE(tube["shown"]);
  EXPECT_NEAR(tube["bounds"][1].get<double>(),
              step(1)["mechanics"]["beam"]["tip"][0].get<double>() + radius, 0.05 * radius);
  EXPECT_GT(objects.at("dipoles_beam arrows")["points"], 64);
  EXPECT_EQ(shown("strength of the field", "Calculator")["coloured_by"], "B in mT");
  for (const char* end : {"tip", "base"}) {
    const json& lines = shown(std::string("field_solid_volume lines, ") + end, "StreamTracer");
    EXPECT_GT(lines["points"], 200);  // of six lines
    EXPECT_GT(lines["median_cosine"], 0.9999) << "the lines do not follow B";
  }
  shown("load", "Glyph");
  EXPECT_TRUE(objects.at("line")["shown"]);  // case, step, load and change of B
  // The arrow of the drawn step is a diameter long.
  const json& arrow = shown("dB_solid_volume", "Glyph");
  double length = 0;
  for (const std::size_t axis : {0, 2, 4})
    length = std::max(
        length, arrow["bounds"][axis + 1].get<double>() - arrow["bounds"][axis].get<double>());
  EXPECT_NEAR(length, 2 * radius, 0.3 * radius);
  EXPECT_FALSE(objects.at("dB_elastica_line")["shown"]);
  EXPECT_GE(objects["picture"]["size"][0], 860);
  EXPECT_EQ(objects["picture"]["size"][1], 900);
  EXPECT_GT(objects["picture"]["drawn"], 0.5) << "the field does not fill the picture";
  EXPECT_GT(objects["picture"]["colours"], 1000);
}

// A folder without results, and a file that is cut off.
TEST_F(ParaView, SaysWhatItCannotRead) {
  run_case("mechanics = [\"beam\"]\n");
  fs::create_directory(path() / "empty");
  EXPECT_EQ(run_script("paraview/arrays.py", path(), "empty"), 1);
  EXPECT_THAT(read_text(path() / "err.txt"), HasSubstr("there is no .pvd file in empty"));
  const fs::path vtk = path() / "results/one/vtk";
  const fs::path torn = path() / "torn";
  fs::create_directory(torn);
  for (const char* name :
       {"centreline_beam.pvd", "centreline_beam_0000.vtp", "centreline_beam_0001.vtp"})
    fs::copy(vtk / name, torn / name);
  EXPECT_EQ(run_script("paraview/arrays.py", path(), "torn"), 0);
  fs::resize_file(torn / "centreline_beam_0001.vtp", 2000);
  EXPECT_EQ(run_script("paraview/arrays.py", path(), "torn"), 1);
  EXPECT_THAT(read_text(path() / "err.txt"),
              HasSubstr("centreline_beam.pvd: no points at time 0.002"));
}

TEST_F(ParaView, SeveralAtOnceEachHaveTheirScreen) {
  std::ofstream(path() / "render.py")
      << "from paraview.simple import *\nShow(Sphere())\nRender()\n";
  for (int round = 0; round < 2; ++round) {
    const std::string command =
        "cd '" + path().string() + "' && for i in 1 2 3 4; do ('" + pvpython() +
        "' render.py >>err.txt 2>&1 || echo $i >>failed) & done; wait; test ! -e failed";
    EXPECT_EQ(std::system(command.c_str()), 0) << read_text(path() / "err.txt");
  }
}

}  // namespace
}  // namespace ciliaval

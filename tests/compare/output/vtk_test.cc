// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <array>
#include <cmath>
#include <numbers>
#include <regex>

#include "compare/output/vtk/datasets.h"
#include "compare/output/vtk/files.h"
#include "compare/output/vtk/output.h"
#include "problem/error.h"
#include "tests/support/synthetic.h"

namespace ciliaval::compare::vtk {
namespace {

namespace fs = std::filesystem;
using test::BentBricks;
using test::read_text;
using test::TemporaryFolder;

using test::L;
const output::Provenance origin{"1.2.3", "abc", {{"VTK", "9.1.0"}}, "ciliaval run x.toml", "today"};

template <class Reader>
vtkSmartPointer<Reader> read_back(const fs::path& file) {
  auto reader = vtkSmartPointer<Reader>::New();
  reader->SetFileName(file.c_str());
  reader->Update();
  return reader;
}

Vector3 tuple(vtkDataSet* data, const char* array, vtkIdType i) {
  return Vector3(data->GetPointData()->GetArray(array)->GetTuple3(i));
}

std::vector<std::string> strings(vtkDataSet* data, const char* name) {
  auto* array = vtkStringArray::SafeDownCast(data->GetFieldData()->GetAbstractArray(name));
  std::vector<std::string> result;
  for (vtkIdType i = 0; array != nullptr && i < array->GetNumberOfValues(); ++i)
    result.push_back(array->GetValue(i));
  return result;
}

/// Checks that a file is light and exact: appended, compressed, no Float32.
void expect_appended_compressed_float64(const fs::path& file) {
  const std::string text = read_text(file);
  EXPECT_THAT(text, testing::HasSubstr("compressor=\"vtkZLibDataCompressor\"")) << file;
  EXPECT_THAT(text, testing::HasSubstr("<AppendedData")) << file;
  EXPECT_THAT(text, testing::HasSubstr("format=\"appended\"")) << file;
  EXPECT_THAT(text, testing::HasSubstr("type=\"Float64\"")) << file;
  EXPECT_THAT(text, testing::Not(testing::HasSubstr("Float32"))) << file;
}

/// A case of one body and one rod, two loads; the second load of the rod slips off.
models::CaseResult two_models() {
  input::Case c = test::paper_case({1e-3, 2e-3});
  c.mechanics = {"rod", "solid"};
  c.fields = {"line"};
  const auto bend = [](const Load& load) {
    return test::converged(load, test::arc(L, 3e-3, Vector3::UnitX(), 2e4 * magnitude(load)));
  };
  const std::vector<models::MechanicsEntry> mechanics{
      test::mechanics_entry("rod",
                            [=](const Load& load) {
                              MechanicsStep step = bend(load);
                              if (magnitude(load) < 1.5e-3) return step;
                              step.status = Status::slipped_off;
                              step.deformation.reset();
                              return step;
                            }),
      test::mechanics_entry("solid", [=](const Load& load) {
        MechanicsStep step = bend(load);
        step.deformation->body = std::make_shared<SolidBody>(BentBricks::body());
        return step;
      })};
  const std::vector<models::FieldEntry> fields{
      test::field_entry("line", [](const Deformation& d, const Vector3& x) -> Vector3 {
        return d.centreline.at(L).position + x;
      })};
  return models::run(c, mechanics, fields);
}

// Oracle: the bricks' deformation, of degree 2, in closed form: 27 nodes give it exactly. Error is
// rounding, measured below 1e-15 relative; F by differentiation of degree-3 patches 1e-13.
TEST(SolidFile, HoldsTheBodyOnItsUndeformedMesh) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "body.vtu";
  output::vtk::write(*output::vtk::solid_grid(BentBricks::body()), file);
  expect_appended_compressed_float64(file);
  const auto reader = read_back<vtkXMLUnstructuredGridReader>(file);
  vtkUnstructuredGrid* grid = reader->GetOutput();
  ASSERT_EQ(grid->GetNumberOfCells(), 2);
  ASSERT_EQ(grid->GetNumberOfPoints(), 54);
  EXPECT_EQ(grid->GetCellType(0), VTK_TRIQUADRATIC_HEXAHEDRON);
  for (vtkIdType i = 0; i < 54; ++i) {
    const Vector3 X(grid->GetPoint(i));
    const std::size_t cell = i < 27 ? 0 : 1;
    const Matrix3 F = BentBricks::deformation_gradient(X);
    EXPECT_LT((X + tuple(grid, "displacement", i) - BentBricks::current(X)).norm(), 1e-16);
    const Vector3 m =
        cell == 1 ? Vector3(F * Vector3(0, 0, 75e3) / F.determinant()) : Vector3(0, 0, 0);
    EXPECT_LT((tuple(grid, "magnetization", i) - m).norm(), 1e-12 * 75e3);
    EXPECT_NEAR(grid->GetPointData()->GetArray("J")->GetTuple1(i), F.determinant(), 1e-14);
    std::array<double, 6> s{};
    grid->GetPointData()->GetArray("cauchy_stress")->GetTuple(i, s.data());
    const Matrix3 sigma = BentBricks::stress(X, cell);
    const std::array<double, 6> expected{sigma(0, 0), sigma(1, 1), sigma(2, 2),
                                         sigma(0, 1), sigma(1, 2), sigma(0, 2)};
    for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(s[k], expected[k], 1e-11 * 6e3);
  }
  vtkDataArray* stress = grid->GetPointData()->GetArray("cauchy_stress");
  for (const auto& [k, name] : std::vector<std::pair<vtkIdType, const char*>>{
           {0, "XX"}, {1, "YY"}, {2, "ZZ"}, {3, "XY"}, {4, "YZ"}, {5, "XZ"}})
    EXPECT_STREQ(stress->GetComponentName(k), name);
  vtkDataArray* material = grid->GetCellData()->GetArray("MaterialIDs");
  EXPECT_EQ(material->GetTuple1(0), 0);
  EXPECT_EQ(material->GetTuple1(1), 1);
  EXPECT_THAT(strings(grid, "units"), testing::Contains("displacement: m"));
}

// The order of the 27 nodes: VTK's own shape functions must find the point that the brick's
// trilinear map has at the same local coordinates.
TEST(SolidFile, OrdersTheNodesAsVtkReadsThem) {
  const auto grid = output::vtk::solid_grid(BentBricks::body());
  vtkCell* cell = grid->GetCell(1);
  const std::array<double, 3> xi{0.3, 0.6, 0.2};
  std::array<double, 3> X{};
  std::array<double, 27> weights{};
  int sub = 0;
  cell->EvaluateLocation(sub, xi.data(), X.data(), weights.data());
  const Vector3 expected(2e-3 * 0.3 - 1e-3, 2e-3 * 0.6 - 1e-3, 10e-3 * 1.2);
  EXPECT_LT((Vector3(X.data()) - expected).norm(), 1e-16);
  Vector3 displacement = Vector3::Zero();
  for (int i = 0; i < 27; ++i)
    displacement +=
        weights[static_cast<std::size_t>(i)] * tuple(grid, "displacement", cell->GetPointId(i));
  EXPECT_LT((expected + displacement - BentBricks::current(expected)).norm(), 1e-16);
}

// Oracle: the arc in closed form: director, angle and curvature.
TEST(RodFile, HoldsTheDeformedCentrelineWithItsFrame) {
  const TemporaryFolder folder;
  const double k = 40;
  const Cilium cilium = test::paper_case({1e-3}).cilium;
  const fs::path file = folder.path() / "rod.vtp";
  output::vtk::write(*output::vtk::rod_polyline(cilium, test::arc(L, 3e-3, Vector3::UnitX(), k)),
                     file);
  expect_appended_compressed_float64(file);
  const auto reader = read_back<vtkXMLPolyDataReader>(file);
  vtkPolyData* rod = reader->GetOutput();
  ASSERT_EQ(rod->GetNumberOfLines(), 1);
  ASSERT_EQ(rod->GetNumberOfPoints(), 201);
  EXPECT_EQ(rod->GetCell(0)->GetNumberOfPoints(), 201);
  const auto scalar = [&](const char* name, vtkIdType i) {
    return rod->GetPointData()->GetArray(name)->GetTuple1(i);
  };
  for (vtkIdType i = 0; i < 201; ++i) {
    const double S = scalar("S", i);
    const Vector3 r((1 - std::cos(k * S)) / k, 0, std::sin(k * S) / k);
    EXPECT_LT((Vector3(rod->GetPoint(i)) - r).norm(), 1e-15);
    EXPECT_LT((tuple(rod, "displacement", i) + S * Vector3::UnitZ() - r).norm(), 1e-15);
    EXPECT_LT((tuple(rod, "d1", i) - Vector3(std::cos(k * S), 0, -std::sin(k * S))).norm(), 1e-12);
    EXPECT_LT((tuple(rod, "d2", i) - Vector3::UnitY()).norm(), 1e-12);
    EXPECT_LT((tuple(rod, "d3", i) - Vector3(std::sin(k * S), 0, std::cos(k * S))).norm(), 1e-12);
    EXPECT_NEAR(scalar("theta", i), k * S, 1e-12);
    EXPECT_NEAR(scalar("kappa", i), k, 1e-10);
    EXPECT_EQ(scalar("radius", i), 1.5e-3);
    EXPECT_EQ(scalar("segment", i), S < 3e-3 ? 0 : 1);
  }
  for (const char* name : {"section_force", "section_moment", "curvature"})
    EXPECT_EQ(rod->GetPointData()->GetArray(name)->GetNumberOfComponents(), 3) << name;
}

// Oracle: with push-forward F the moments sum to A·M·(r_top − r_bottom), whatever lies between;
// with R, for an arc without extension, slice by slice to A·M·d₃ dS.
TEST(DipoleFile, HoldsTheMomentsOfTheMagneticSegment) {
  const TemporaryFolder folder;
  const double k = 40;
  const Cilium cilium = test::paper_case({1e-3}).cilium;
  const Centreline curve = test::arc(L, 3e-3, Vector3::UnitX(), k);
  const double AM = std::numbers::pi * 1.5e-3 * 1.5e-3 * 75e3;
  for (const auto push : {analytic::sources::PushForward::F, analytic::sources::PushForward::R}) {
    const fs::path file = folder.path() / "dipoles.vtp";
    output::vtk::write(*output::vtk::dipoles(cilium, curve, push), file);
    expect_appended_compressed_float64(file);
    const auto reader = read_back<vtkXMLPolyDataReader>(file);
    vtkPolyData* data = reader->GetOutput();
    ASSERT_EQ(data->GetNumberOfPoints(), 64);
    ASSERT_EQ(data->GetNumberOfVerts(), 64);
    Vector3 sum = Vector3::Zero();
    for (vtkIdType i = 0; i < 64; ++i) {
      const double S = 3e-3 + 17e-3 * (static_cast<double>(i) + 0.5) / 64;
      const Vector3 d3(std::sin(k * S), 0, std::cos(k * S));
      const Vector3 moment = tuple(data, "moment", i);
      sum += moment;
      // A chord is shorter than its arc by (k dS)²/24 = 5e-6.
      const double tolerance = push == analytic::sources::PushForward::R ? 1e-13 : 1e-5;
      EXPECT_LT((moment - AM * 17e-3 / 64 * d3).norm(), tolerance * moment.norm());
    }
    if (push == analytic::sources::PushForward::F) {
      EXPECT_LT((sum - AM * (curve.at(L).position - curve.at(3e-3).position)).norm(),
                1e-14 * sum.norm());
    }
  }
}

TEST(FieldFile, HoldsTheGridAndTheMask) {
  const TemporaryFolder folder;
  output::FieldGrid grid;
  grid.points = {2, 3, 4};
  grid.origin = Vector3(-1, -2, -3);
  grid.spacing = Vector3(0.1, 0.2, 0.3);
  output::FieldGrid::Step step;
  for (int i = 0; i < 24; ++i) {
    step.B.emplace_back(i, 1.0 / (i + 1), -i);
    step.valid.push_back(i == 5 ? 0 : 1);
  }
  const fs::path file = folder.path() / "field.vti";
  output::vtk::write(*output::vtk::field_image(grid, step), file);
  expect_appended_compressed_float64(file);
  const auto reader = read_back<vtkXMLImageDataReader>(file);
  vtkImageData* image = reader->GetOutput();
  ASSERT_EQ(image->GetNumberOfPoints(), 24);
  std::array<int, 3> corner{1, 2, 3};
  const vtkIdType last = image->ComputePointId(corner.data());
  EXPECT_LT((Vector3(image->GetPoint(last)) - Vector3(-0.9, -1.6, -2.1)).norm(), 1e-15);
  EXPECT_EQ(tuple(image, "B", last), Vector3(23, 1.0 / 24, -23));
  EXPECT_EQ(image->GetPointData()->GetArray("valid")->GetTuple1(5), 0);
  EXPECT_EQ(image->GetPointData()->GetArray("valid")->GetTuple1(6), 1);
}

// Oracle: ψ = x² − y² + 3z, which the leaves' quadratic functions hold exactly, and its gradient.
TEST(OctreeFile, HoldsThePotentialAndItsFields) {
  const auto psi = [](const Vector3& x) { return x[0] * x[0] - x[1] * x[1] + 3 * x[2]; };
  FieldMesh mesh;
  for (const double size : {2.0, 0.5}) {
    FieldMesh::Leaf leaf;
    leaf.lower = Vector3(1, -2, size);
    leaf.size = size;
    leaf.magnetization = Vector3(0, 5, size);
    leaf.relative_permeability = 1 + size;
    for (std::size_t node = 0; node < 27; ++node)
      leaf.psi[node] = psi(leaf.lower + size / 2 *
                                            Vector3(static_cast<double>(node % 3),
                                                    static_cast<double>(node / 3 % 3),
                                                    static_cast<double>(node / 9)));
    mesh.leaves.push_back(leaf);
  }
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "octree.vtu";
  output::vtk::write(*output::vtk::octree_grid(mesh), file);
  expect_appended_compressed_float64(file);
  const auto reader = read_back<vtkXMLUnstructuredGridReader>(file);
  vtkDataSet* data = reader->GetOutput();
  ASSERT_EQ(data->GetNumberOfCells(), 2);
  ASSERT_EQ(data->GetNumberOfPoints(), 54);
  EXPECT_THAT(strings(data, "units"), testing::ElementsAre("psi: A", "H: A/m", "B: T"));
  for (vtkIdType i = 0; i < 54; ++i) {
    const Vector3 x(data->GetPoint(i));
    const FieldMesh::Leaf& leaf = mesh.leaves[i < 27 ? 0 : 1];
    const Vector3 H(-2 * x[0], 2 * x[1], -3);
    const Vector3 B = vacuum_permeability * (leaf.relative_permeability * H + leaf.magnetization);
    EXPECT_NEAR(data->GetPointData()->GetArray("psi")->GetTuple1(i), psi(x), 1e-13);
    EXPECT_LT((tuple(data, "H", i) - H).norm(), 1e-12);
    EXPECT_LT((tuple(data, "B", i) - B).norm(), 1e-18);
  }
  EXPECT_EQ(data->GetCellData()->GetArray("relative_permeability")->GetTuple1(1), 1.5);
}

TEST(Write, SaysWhichFileAndWhyOnAFullDisk) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "full.vtu";
  fs::create_symlink("/dev/full", file);  // VTK removes what it could not write: the link only
  try {
    output::vtk::write(*output::vtk::solid_grid(BentBricks::body()), file);
    FAIL() << "the disk is full";
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("full.vtu"));
  }
  EXPECT_THROW(output::vtk::write(*output::vtk::solid_grid(BentBricks::body()),
                                  folder.path() / "none" / "a.vtu"),
               FileError);
}

TEST(FieldData, HoldsTheEnvironmentOfTheStep) {
  const vtkNew<vtkPolyData> data;
  Load load = ContactLoad{1e-3, 16e-3, 0};
  output::vtk::add_provenance(*data, {}, load);
  EXPECT_EQ(data->GetFieldData()->GetArray("uniform_field"), nullptr);
  surroundings::Environment around;
  around.gravity = {0, 0, -9.81};
  around.uniform_field = {5e-3, 0, 1e-3};
  load.set_environment(around);
  output::vtk::add_provenance(*data, {}, load);
  EXPECT_EQ(data->GetFieldData()->GetArray("gravity")->GetComponent(0, 2), -9.81);
  EXPECT_EQ(data->GetFieldData()->GetArray("uniform_field")->GetComponent(0, 0), 5e-3);
}

TEST(SeriesTimes, AreTheLoadsIfTheyIncreaseElseTheSteps) {
  EXPECT_EQ(output::vtk::series_times(test::paper_case({1e-3, 4e-3}).load_path),
            (std::vector<double>{1e-3, 4e-3}));
  EXPECT_EQ(output::vtk::series_times(test::paper_case({1e-3, 4e-3, 1e-3}).load_path),
            (std::vector<double>{0, 1, 2}));
}

TEST(SeriesTimes, OfAProbeAreItsDisplacements) {
  const LoadPath path{ProbeLoad{1e-3, 16e-3, 0}, ProbeLoad{2e-3, 16e-3, 0}};
  EXPECT_EQ(output::vtk::series_times(path), (std::vector<double>{1e-3, 2e-3}));
  const auto grid = output::vtk::solid_grid(BentBricks::body());
  output::vtk::add_provenance(*grid, {}, path[1]);
  EXPECT_EQ(grid->GetFieldData()->GetArray("load")->GetTuple1(0), 2e-3);
  EXPECT_THAT(strings(grid, "load_unit"), testing::ElementsAre("m"));
}

// Every series lists the files that exist, with the load as its time; all of them carry the load
// and where they come from.
TEST(WriteVtk, DrawsSomeStepsOfALongPath) {
  EXPECT_THAT(output::vtk::drawn_steps(3, false), testing::ElementsAre(0, 1, 2));
  const std::vector<std::size_t> some = output::vtk::drawn_steps(10'000, false);
  EXPECT_EQ(some.size(), 200U);
  EXPECT_EQ(some.front(), 0U);
  EXPECT_EQ(some.back(), 9'999U);
  EXPECT_TRUE(std::is_sorted(some.begin(), some.end()));
  EXPECT_EQ(output::vtk::drawn_steps(10'000, true).size(), 10'000U);
}

TEST(WriteVtk, MakesASeriesOfEachKindFromWhatExists) {
  const TemporaryFolder folder;
  const models::CaseResult result = two_models();
  output::FieldGrid grid;
  grid.mechanics = "rod";
  grid.field = "line";
  grid.points = {2, 2, 2};
  grid.spacing = Vector3(1, 1, 1);
  grid.sample = [](std::size_t step) -> std::optional<output::FieldGrid::Step> {
    if (step == 1) return std::nullopt;
    return output::FieldGrid::Step{std::vector<Vector3>(8, Vector3::Ones()),
                                   std::vector<std::uint8_t>(8, 1)};
  };
  output::vtk::write_vtk(result, grid, origin,
                         output::vtk::drawn_steps(result.problem.load_path.size(), true),
                         folder.path() / "vtk");

  std::map<std::string, std::vector<std::string>> listed;
  for (const auto& entry : fs::directory_iterator(folder.path() / "vtk")) {
    if (entry.path().extension() != ".pvd") continue;
    const std::string text = read_text(entry.path());
    const std::regex dataset("timestep=\"([^\"]*)\" file=\"([^\"]*)\"");
    for (std::sregex_iterator m(text.begin(), text.end(), dataset), end; m != end; ++m) {
      EXPECT_TRUE(fs::exists(folder.path() / "vtk" / (*m)[2].str())) << (*m)[2];
      listed[entry.path().stem().string()].push_back((*m)[1]);
    }
  }
  const std::vector<std::string> both{"0.001", "0.002"};
  const std::map<std::string, std::vector<std::string>> expected{{"centreline_rod", {"0.001"}},
                                                                 {"dipoles_rod", {"0.001"}},
                                                                 {"centreline_solid", both},
                                                                 {"dipoles_solid", both},
                                                                 {"body_solid", both},
                                                                 {"field_rod_line", {"0.001"}},
                                                                 {"sensors", both}};
  EXPECT_EQ(listed, expected);
  EXPECT_THAT(read_text(folder.path() / "vtk" / "open.py"), testing::HasSubstr("paraview.simple"));

  const auto reader = read_back<vtkXMLPolyDataReader>(folder.path() / "vtk" / "sensors_0000.vtp");
  vtkPolyData* sensors = reader->GetOutput();
  EXPECT_EQ(tuple(sensors, "B_rod_line", 0), result.fields[0].steps[0]->B[0]);
  EXPECT_EQ(tuple(sensors, "dB_solid_line", 0), result.fields[1].steps[0]->dB[0]);
  EXPECT_EQ(sensors->GetFieldData()->GetArray("load")->GetTuple1(0), 1e-3);
  EXPECT_THAT(strings(sensors, "load_unit"), testing::ElementsAre("N"));
  EXPECT_THAT(strings(sensors, "units"), testing::Contains("dB_solid_line: T"));
  EXPECT_THAT(strings(sensors, "provenance"), testing::Contains("git: abc"));
}

// Sensors: the first has both, the second B alone, the third nothing; at the second step no model
// converged, and a file without any array would only confuse.
TEST(WriteVtk, WritesSensorsWhereThereIsAFieldAndMasksThoseWithoutOne) {
  const TemporaryFolder folder;
  input::Case c = test::paper_case({1e-3, 2e-3});
  c.sensors = {Vector3(1, 0, 0), Vector3(2, 0, 0), Vector3(3, 0, 0)};
  c.mechanics = {"rod"};
  c.fields = {"line"};
  const std::vector<models::MechanicsEntry> mechanics{
      test::mechanics_entry("rod", [](const Load& load) {
        if (magnitude(load) < 1.5e-3)
          return test::converged(load, test::arc(L, 3e-3, Vector3::UnitX(), 20));
        MechanicsStep step;
        step.load = load;
        step.status = Status::slipped_off;
        return step;
      })};
  const std::vector<models::FieldEntry> fields{
      test::field_entry("line", [](const Deformation& d, const Vector3& x) -> Vector3 {
        const bool straight = d.centreline.at(L).position.x() == 0;
        if (x.x() > 2.5 || (straight && x.x() > 1.5)) throw InputError("B diverges here");
        return d.centreline.at(L).position + x;
      })};
  const models::CaseResult result = models::run(c, mechanics, fields);
  output::vtk::write_vtk(result, std::nullopt, origin,
                         output::vtk::drawn_steps(result.problem.load_path.size(), true),
                         folder.path() / "vtk");
  EXPECT_FALSE(fs::exists(folder.path() / "vtk" / "sensors_0001.vtp"));
  const auto reader = read_back<vtkXMLPolyDataReader>(folder.path() / "vtk" / "sensors_0000.vtp");
  vtkPolyData* sensors = reader->GetOutput();
  const auto valid = [&](const char* name) {
    vtkDataArray* mask = sensors->GetPointData()->GetArray(name);
    return std::vector<double>{mask->GetTuple1(0), mask->GetTuple1(1), mask->GetTuple1(2)};
  };
  EXPECT_EQ(valid("valid_B_rod_line"), (std::vector<double>{1, 1, 0}));
  EXPECT_EQ(valid("valid_dB_rod_line"), (std::vector<double>{1, 0, 0}));
  EXPECT_EQ(tuple(sensors, "B_rod_line", 1), *result.fields[0].steps[0]->B[1]);
  EXPECT_EQ(tuple(sensors, "B_rod_line", 2), Vector3(0, 0, 0));
}

}  // namespace
}  // namespace ciliaval::compare::vtk

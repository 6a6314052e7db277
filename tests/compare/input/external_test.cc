// SPDX-License-Identifier: LGPL-2.1-or-later
// Centrelines and readings from CSV files: what is read, and what is said of files that are wrong.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "compare/input/case.h"
#include "compare/input/external/background.h"
#include "compare/models/registry.h"
#include "problem/error.h"
#include "tests/support/planted_fault.h"

namespace ciliaval::compare {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// A cilium 10 mm long; two load steps at 30°, two sensors.
constexpr const char* head = R"toml([case]
name = "bench"
[cilium]
diameter = "1 mm"
[[cilium.segment]]
name = "base"
length = "4 mm"
young_modulus = "1 MPa"
poisson_ratio = 0.49
[[cilium.segment]]
name = "magnet"
length = "6 mm"
young_modulus = "1 MPa"
poisson_ratio = 0.49
magnetization = "75 kA/m"
[load]
type = "contact"
force = ["1 mN", "2 mN"]
height = "8 mm"
azimuth = AZIMUTH
[sensor]
position = [["0 mm", "0 mm", "-2 mm"], ["1 mm", "0 mm", "-2 mm"]]
[models]
mechanics = ["elastica"]
fields = ["line"]
[[models.external]]
name = "bench"
)toml";

/// An upright cilium.
constexpr const char* straight =
    "S [mm],x [mm],y [mm],z [mm]\n0,0,0,0\n3,0,0,3\n6,0,0,6\n10,0,0,10\n";
constexpr const char* readings =
    "step,sensor,Bx [uT],By [uT],Bz [uT]\nundeformed,0,1,2,3\nundeformed,1,4,5,6\n"
    "0,0,11,12,13\n0,1,14,15,16\n1,0,21,22,23\n1,1,24,25,26\n";

class External : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const { folder_.write(name, text); }
  static std::string text(const std::string& keys, std::string_view azimuth) {
    return replaced(head, "AZIMUTH", azimuth) + keys;
  }
  input::Case read(const std::string& keys, std::string_view azimuth = "\"30 deg\"") const {
    return input::read_case(text(keys, azimuth), (folder_.path() / "case.toml").string(),
                            models::known());
  }
  std::string faults(const std::string& keys, std::string_view azimuth = "\"30 deg\"") const {
    return faults_beside(folder_, text(keys, azimuth));
  }
  /// The faults of a first centreline.
  std::string centreline_faults(const std::string& csv) const {
    write("a.csv", csv);
    write("b.csv", straight);
    return faults("centrelines = [\"a.csv\", \"b.csv\"]\n");
  }
  std::string readings_faults(const std::string& csv, const std::string& more = "") const {
    write("r.csv", csv);
    return faults("readings = \"r.csv\"\n" + more);
  }
  std::string background_faults(const std::string& csv) const {
    write("earth.csv", csv);
    return readings_faults(readings, "background = \"earth.csv\"\n");
  }

  test::TemporaryFolder folder_;
};

TEST_F(External, ReadsUnitsAsTheHeaderStatesThem) {
  write("a.csv",
        "x (cm),y [m],z [um],S [inch]\n0,0,0,0\n0.01,-0.0002,3000,0.118\n"
        "0.02,-0.0003,6000,0.236\n0.03,-0.0004,9900,0.393700787401575\n");
  write("b.csv", straight);
  write("r.csv", readings);
  const input::Case c = read(
      "centrelines = [\"a.csv\", \"b.csv\"]\nreadings = \"r.csv\"\n"
      "tip_uncertainty = \"5 um\"\nfield_uncertainty = \"1 milligauss\"\n");
  ASSERT_EQ(c.external.size(), 1U);
  const input::external::ExternalModel& model = c.external[0];
  ASSERT_EQ(model.centrelines.size(), 2U);
  const Centreline& line = model.centrelines[0];
  EXPECT_EQ(line.length(), c.cilium.length());
  EXPECT_NEAR((line.at(line.length()).position - Vector3(3e-4, -4e-4, 9.9e-3)).norm(), 0, 1e-17);
  EXPECT_NEAR((line.at(0.236 * 0.0254).position - Vector3(2e-4, -3e-4, 6e-3)).norm(), 0, 1e-17);
  EXPECT_EQ(model.tip_uncertainty, 5e-6);
  EXPECT_NEAR(*model.field_uncertainty, 1e-7, 1e-20);
  ASSERT_EQ(model.readings.size(), 2U);
  EXPECT_NEAR((*model.readings[1].B[0] - Vector3(21e-6, 22e-6, 23e-6)).norm(), 0, 1e-19);
  EXPECT_NEAR((*model.readings[1].dB[1] - Vector3::Constant(20e-6)).norm(), 0, 1e-19);
  EXPECT_EQ(model.remarks[0], "");
}

TEST_F(External, WrittenCaseReadsBack) {
  write("a.csv", straight);
  write("r.csv", readings);
  write("earth.csv", "azimuth [deg],Bx [uT],By [uT],Bz [uT]\n30,1,1,1\n");
  const input::Case c = read(
      "centrelines = [\"a.csv\", \"a.csv\"]\nreadings = \"r.csv\"\n"
      "background = \"earth.csv\"\ntip_uncertainty = \"5 um\"\n");
  const input::Case again =
      input::read_case(input::to_toml(c, models::known()), "elsewhere/case.toml", models::known());
  EXPECT_EQ(input::to_toml(again, models::known()), input::to_toml(c, models::known()));
  ASSERT_EQ(again.external.size(), 1U);
  EXPECT_EQ(again.external[0].centreline_files, c.external[0].centreline_files);
  EXPECT_EQ(*again.external[0].readings[0].B[1], *c.external[0].readings[0].B[1]);
  const std::string without = replaced(head, "AZIMUTH", "\"0 deg\"");
  EXPECT_THAT(input::to_toml(input::read_case(without.substr(0, without.find("[[models.ext")),
                                              "x.toml", models::known()),
                             models::known()),
              Not(HasSubstr("external")));
}

// A file that is no table of readings is refused before it takes memory in proportion to its
// commas.
TEST_F(External, BoundsTheSizeOfATable) {
  EXPECT_THAT(centreline_faults(std::string(2'000'000, ',')), HasSubstr("more than 1000 columns"));
  std::string rows = "S [mm],x [mm],y [mm],z [mm]\n";
  for (int i = 0; i <= 1'000'000; ++i) rows += "0,0,0,0\n";
  EXPECT_THAT(centreline_faults(rows),
              HasSubstr("a.csv:1000002:1: there are more than 1000000 rows"));
}

TEST_F(External, TakesMarksOfOtherProgramsInItsStride) {
  const std::string plain = straight;
  std::string crlf;
  for (const char c : plain) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(centreline_faults(crlf), "no fault");
  EXPECT_EQ(centreline_faults("\xEF\xBB\xBF" + plain), "no fault");
  EXPECT_EQ(centreline_faults("% COMSOL\n\n# note, with a comma\n" + plain + "\n\n"), "no fault");
  EXPECT_EQ(centreline_faults(replaced(plain, "S [mm],x [mm]", "\"S [mm]\",\"x [mm]\"")),
            "no fault");
  EXPECT_EQ(centreline_faults("# units: S m, x m, y m, z m, theta rad, kappa 1/m\n"
                              "S,x,y,z,theta,kappa\n0,0,0,0,0,0\n0.003,0,0,0.003,0,0\n"
                              "0.006,0,0,0.006,0,0\n0.01,0,0,0.01,0,0\n"),
            "no fault");
  // As the program writes them: units below the names.
  EXPECT_EQ(centreline_faults("S,x,y,z,theta,kappa\n# units: S mm, x mm, y mm, z mm, theta deg, "
                              "kappa 1/m\n0,0,0,0,0,0\n3,0,0,3,0,0\n6,0,0,6,0,0\n10,0,0,10,0,0\n"),
            "no fault");
  EXPECT_THAT(centreline_faults("S,x,y,z\n0,0,0,0\n# units: S mm, x mm, y mm, z mm\n3,0,0,3\n"),
              HasSubstr("a.csv:1:1: the column 'S' needs the unit"));
}

TEST_F(External, ReadsFilesAsOtherProgramsWriteThem) {
  const std::vector<std::string> files{
      // COMSOL: a table, a line plot, a text file.
      "% Model,a.mph\n% Date,\"Nov 25 2026, 10:18\"\n% Nodes,4\n% Description,\"x, y\"\n"
      "% X,Y,Z,x (mm),y (mm),z (mm)\n0,0,0,0,0,0\n0,0,3,0,0,3\n0,0,6,0,0,6\n0,0,10,0,0,10\n",
      "% Nodes,4\n% Arc length (mm),x (mm),y (mm),z (mm)\n0,0,0,0\n3,0,0,3\n6,0,0,6\n10,0,0,10\n",
      "% Model:              a.mph\n% Length unit:        mm\n"
      "% x                       y                        z\n"
      "0     0     0     \n0     0     3     \n0     0     6     \n0     0     10    \n",
      "% Length unit,mm\n% x,y,z\n0,0,0\n0,0,3\n0,0,6\n0,0,10\n",
      // A spreadsheet of a country with decimal commas.
      "\xEF\xBB\xBFS [mm];x [mm];y [mm];z [mm]\r\n0,0;0,0;0,0;0,0\r\n3,0;0,0;0,0;3,0\r\n"
      "6,0;0,0;0,0;6,0\r\n10,0;0,0;0,0;10,0\r\n",
      "S [mm]\tx [mm]\ty [mm]\tz [mm]\n0\t0\t0\t0\n3\t0\t0\t3,0\n6\t0\t0\t6\n10\t0\t0\t10\n",
      "x (mm) y (mm) z (mm)\n0 0 0\n0 0 3\n 0  0  6\n0 0 10\n",
      // pandas and R: the number of each row comes first.
      ",S [mm],x [mm],y [mm],z [mm]\n0,0,0,0,0\n1,3,0,0,3\n2,6,0,0,6\n3,10,0,0,10\n",
      "\"x [mm]\" \"y [mm]\" \"z [mm]\"\n\"1\" 0 0 0\n\"2\" 0 0 3\n\"3\" 0 0 6\n\"4\" 0 0 10\n",
      // A point of an interface, of both parts.
      "x [mm],y [mm],z [mm]\n0,0,0\n0,0,3\n0,0,3\n0,0,6\n0,0,10\n"};
  for (const std::string& text : files) {
    SCOPED_TRACE(text);
    ASSERT_EQ(centreline_faults(text), "no fault");
    const Centreline centreline =
        read("centrelines = [\"a.csv\", \"a.csv\"]\n").external[0].centrelines[0];
    for (const double S : {0.0, 2e-3, 3e-3, 10e-3})
      EXPECT_LT((centreline.at(S).position - Vector3(0, 0, S)).norm(), 1e-12) << S;
  }
  write("a.csv", files[1]);
  EXPECT_THAT(read("centrelines = [\"a.csv\", \"a.csv\"]\n").external[0].remarks[0],
              StartsWith("columns not read: Arc length; S is the length"));
  // One decimal mark in a file: "1,250" is no number of thousands in silence.
  EXPECT_THAT(centreline_faults("x [mm];y [mm];z [mm]\n0;0;0\n0;0;3.0\n0;0;6,000\n0;0;10\n"),
              StartsWith("a.csv:4:5: there are decimal points and decimal commas"));
  // A cell before the first name is the number of the row, or nothing that is known.
  EXPECT_THAT(centreline_faults("x [mm];y [mm];z [mm]\n0;0;0;0\n3;0;0;3\n"),
              StartsWith("a.csv:3:1: the rows have a cell more than the header has names"));
  // A comment that states units is no header.
  EXPECT_EQ(centreline_faults("# x,y,z\n# units: x mm, y mm, z mm\n0,0,0\n0,0,3\n0,0,6\n0,0,10\n"),
            "no fault");
  EXPECT_EQ(
      centreline_faults("% Length unit,\"m\"\n# units: x mm, y mm, z mm\nx,y,z\n0,0,0\n0,0,3\n"
                        "0,0,6\n0,0,10\n"),
      "no fault");
  // Between commas a cell too many is no number of a row.
  EXPECT_THAT(centreline_faults("x [mm],y [mm],z [mm]\n0,0,0,0\n"),
              HasSubstr("are there commas in the numbers?"));
}

// Upright for 4 mm, then an arc: a point that is there twice parts them, so that no polynomial runs
// over both.
TEST_F(External, APointThatIsThereTwiceIsABreak) {
  const double R = 10e-3;
  const auto deflection = [&](bool is_break) {
    std::string csv = "x [m],y [m],z [m]\n0,0,0\n0,0,0.001\n0,0,0.002\n0,0,0.003\n0,0,0.004\n";
    for (int i = is_break ? 0 : 1; i <= 6; ++i) {
      const double a = 1e-3 * i / R;
      csv += fmt::format("{},0,{}\n", R * (1 - std::cos(a)), 4e-3 + R * std::sin(a));
    }
    write("a.csv", csv);
    const auto model = read("centrelines = [\"a.csv\", \"a.csv\"]\n").external[0];
    double largest = 0;
    for (const double S : {3.2e-3, 3.4e-3, 3.6e-3, 3.8e-3})
      largest = std::max(largest, std::abs(model.centrelines[0].at(S).position.x()));
    return largest;
  };
  EXPECT_LT(deflection(true), 1e-15);
  EXPECT_GT(deflection(false), 1e-7);
}

// Oracle: a quarter of a circle. Without S it is the chords' length, scaled: exact for equal steps.
TEST_F(External, TakesTheLengthAlongThePointsWhereThereIsNoS) {
  std::string csv = "x [m],y [m],z [m]\n";
  const double R = 0.01 / (std::numbers::pi / 2);
  for (int i = 0; i <= 60; ++i) {
    const double a = std::numbers::pi / 2 * i / 60;
    csv += std::to_string(R * (1 - std::cos(a)) * 1e6) + "e-6,0," +
           std::to_string(R * std::sin(a) * 1e6) + "e-6\n";
  }
  write("a.csv", csv);
  write("b.csv", straight);
  const input::external::ExternalModel model =
      read("centrelines = [\"a.csv\", \"b.csv\"]\n").external[0];
  EXPECT_THAT(model.remarks[0], StartsWith("S is the length along the points times 1.000029"));
  for (const double S : {0.0, 1.234e-3, 5e-3, 9.87e-3, 10e-3}) {
    const CentrelinePoint p = model.centrelines[0].at(S);
    const Vector3 exact(R * (1 - std::cos(S / R)), 0, R * std::sin(S / R));
    EXPECT_NEAR((p.position - exact).norm(), 0, 1e-10) << S;  // six digits after the µm
    EXPECT_NEAR(p.theta(), S / R, 1e-5) << S;
    EXPECT_NEAR(p.bending_curvature(), 1 / R, 0.01 / R) << S;
  }
}

TEST_F(External, SaysWhereACentrelineIsWrong) {
  const std::string plain = straight;
  const auto fault = [&](const std::string& old, const std::string& with) {
    return centreline_faults(replaced(plain, old, with));
  };
  EXPECT_EQ(centreline_faults(""),
            "a.csv:1:1: the file is empty: it needs a header line with the "
            "names and units of the columns");
  EXPECT_EQ(centreline_faults("\xFF\xFEx"), "a.csv:1:1: the file is in UTF-16: save it as UTF-8");
  EXPECT_EQ(centreline_faults("S [mm],x [mm],y [mm],z [mm]\n"),
            "a.csv:1:1: there are no rows below the header");
  EXPECT_EQ(centreline_faults("0,0,0\n0,0,3\n"),
            "a.csv:1:1: there is no header above the numbers '0,0,0': put a line with the names "
            "and units of the columns first, such as \"B [mT],tip [mm]\"");
  EXPECT_EQ(centreline_faults("% Model,a.mph\n% Nodes,4,1\n0,0,0\n"),
            "a.csv:3:1: there is no header above the numbers '0,0,0': put a line with the names "
            "and units of the columns first, such as \"B [mT],tip [mm]\"");
  EXPECT_EQ(fault(",z [mm]", ",w [mm]"), "a.csv:1:1: there is no column 'z'; there is 'w'");
  EXPECT_EQ(fault(",z [mm]", ",x [mm]"),
            "a.csv:1:1: there is no column 'z'\n"
            "a.csv:1:22: there is a second column 'x'");
  EXPECT_EQ(fault("z [mm]", "z"),
            "a.csv:1:22: the column 'z' needs the unit of a length: write "
            "\"z [mm]\"");
  EXPECT_THAT(fault("z [mm]", "z [mN]"), StartsWith("a.csv:1:22: the column 'z': 'mN' is not a "
                                                    "unit of a length"));
  EXPECT_THAT(fault("z [mm]", "z [mmm]"), StartsWith("a.csv:1:22: the column 'z': "));
  EXPECT_EQ(fault("3,0,0,3", "3,0,nan,3"), "a.csv:3:5: 'nan' is not a finite number");
  EXPECT_EQ(fault("3,0,0,3", "3,0,inf,3"), "a.csv:3:5: 'inf' is not a finite number");
  EXPECT_EQ(fault("3,0,0,3", "3,0,one,3"), "a.csv:3:5: 'one' is not a number");
  EXPECT_EQ(fault("3,0,0,3", "3,0,,3"), "a.csv:3:5: the cell of 'y' is empty");
  EXPECT_EQ(fault("3,0,0,3", "3,0,0"), "a.csv:3:5: the row has 3 cells and the header 4");
  EXPECT_EQ(fault("3,0,0,3", "3,0,0,3,1"),
            "a.csv:3:9: the row has 5 cells and the header 4: are there commas in the numbers?");
  EXPECT_EQ(fault("6,0,0,6", "4,0,0,3"), "a.csv:4:1: the row has the same point as the one above");
  EXPECT_EQ(fault("6,0,0,6", "3,0,0,3\n3,0,0,3"),
            "a.csv:5:1: the row has the same point as the one above");
  EXPECT_EQ(fault("6,0,0,6", "2,0,0,6"),
            "a.csv:4:1: S must increase from row to row: 0.002 m is not more than 0.003 m");
  EXPECT_EQ(fault("10,0,0,10", "9,0,0,10"),
            "a.csv:1:1: S must run from 0 to the cilium's length 0.01 m, not from 0 m to 0.009 m");
  EXPECT_EQ(centreline_faults("x [m],y [m],z [m]\n0,0,0\n0,0,3\n0,0,6\n0,0,10\n"),
            "a.csv:5:1: the points' line is 10 m long and the cilium 0.01 m: is the unit right, "
            "and is it all of it?");
  EXPECT_EQ(fault("6,0,0,6\n", ""), "a.csv:4:1: a centreline has 4 points or more, not 3");
  EXPECT_EQ(fault("\n0,0,0,0", "\n0,0,1,0"),
            "a.csv:2:1: the first point must be the cilium's base, the origin; it is 0.001 m from "
            "there");
  const std::string angles =
      "S [mm],x [mm],y [mm],z [mm],theta [deg]\n0,0,0,0,A\n3,0,0,3,A\n"
      "6,0,0,6,A\n10,0,0,10,A\n";
  std::string upright = angles;
  for (auto at = upright.find(",A"); at != std::string::npos; at = upright.find(",A"))
    upright.replace(at, 2, ",90");
  EXPECT_EQ(centreline_faults(upright),
            "a.csv:2:1: 'theta' must be the angle of the section's normal from +z; here it is "
            "1.5708 rad and that of the curve 0 rad");
  EXPECT_THAT(centreline_faults("S [mm],x [mm],y [mm],z [mm],theta [deg]\n0,0,0,0,0\n3,0,1,2.8,0\n"
                                "6,0,1,5.8,0\n10,1,0,9.6,0\n"),
              StartsWith("a.csv:1:29: 'theta' goes with a plane centreline"));
}

TEST_F(External, SaysWhereReadingsAreWrong) {
  const std::string plain = readings;
  const auto fault = [&](const std::string& old, const std::string& with) {
    return readings_faults(replaced(plain, old, with));
  };
  EXPECT_EQ(readings_faults(plain), "no fault");
  EXPECT_EQ(fault("1,1,24,25,26\n", ""), "r.csv:6:1: there is no row of step 1, sensor 1");
  EXPECT_EQ(fault("undeformed,1,4,5,6\n", ""),
            "r.csv:6:1: there is no row of step undeformed, sensor 1");
  EXPECT_EQ(fault("1,1,24", "1,0,24"), "r.csv:7:1: there is a second row of step 1, sensor 0");
  EXPECT_EQ(fault("1,1,24", "2,1,24"),
            "r.csv:7:1: the step '2' is neither 'undeformed' nor a load "
            "step of the case, 0 to 1");
  EXPECT_EQ(fault("1,1,24", "1,2,24"), "r.csv:7:1: the sensor '2' is none of the case's, 0 to 1");
  EXPECT_EQ(fault("step,", "force,"),
            "r.csv:1:1: unknown column 'force' (valid: step, sensor, Bx, By, Bz, dBx, dBy, dBz)\n"
            "r.csv:1:1: there is no column 'step'");
  EXPECT_EQ(readings_faults("step,Bx [T],By [T],Bz [T]\n0,1,1,1\n1,1,1,1\n"),
            "r.csv:1:1: there is no column 'sensor', and the case has 2 sensors");
  EXPECT_THAT(fault("Bz [uT]", "dBz [uT]"), HasSubstr("must be either Bx, By, Bz, or dBx"));
  EXPECT_THAT(fault("Bz [uT]", "Bz [uA]"), HasSubstr("r.csv:1:29: the column 'Bz': 'uA' is not a "
                                                     "unit of a flux density"));
  EXPECT_THAT(readings_faults("step,sensor,dBx [T],dBy [T],dBz [T]\nundeformed,0,0,0,0\n"
                              "undeformed,1,0,0,0\n0,0,1,1,1\n0,1,1,1,1\n1,0,1,1,1\n1,1,1,1,1\n"),
              HasSubstr("the change dB of the undeformed cilium is zero"));
}

TEST_F(External, SaysWhatIsWrongWithItsTables) {
  write("a.csv", straight);
  EXPECT_EQ(
      faults("centrelines = [\"a.csv\"]\n"),
      "case.toml:28:15: there are 1 files of centrelines and 2 load steps: one file for each");
  EXPECT_EQ(faults("centrelines = \"a.csv\"\n"),
            "case.toml:28:15: 'centrelines' must be a list of files, one for each load step");
  EXPECT_THAT(faults("centrelines = [\"a.csv\", \"none.csv\"]\n"),
              StartsWith("none.csv:1:1: there is no such file"));
  EXPECT_THAT(faults(""), HasSubstr("[[models.external]] needs 'centrelines' or 'readings'"));
  EXPECT_THAT(faults("background = \"a.csv\"\n"), HasSubstr("'background' goes with 'readings'"));
  EXPECT_THAT(faults("reading = \"a.csv\"\n"), HasSubstr("did you mean 'readings'?"));
  EXPECT_THAT(faults("tip_uncertainty = 3\nreadings = \"a.csv\"\n"), HasSubstr("has no unit"));
  EXPECT_THAT(faults("readings = \"a.csv\"\n[[models.external]]\nname = \"bench\"\n"),
              HasSubstr("the name 'bench' is already that of a model"));
  EXPECT_THAT(faults("readings = \"a.csv\"\n[[models.external]]\nname = \"a/b\"\n"),
              HasSubstr("the name 'a/b' must be a plain file name"));
  EXPECT_THAT(faults("readings = \"a.csv\"\n[[models.external]]\nname = \"solid\"\n"),
              HasSubstr("the name 'solid' is already that of a model"));
}

/// B of step 0 at both sensors and the undeformed one at sensor 0, µT, with a background.
struct Cleaned {
  Vector3 undeformed, first, second;
};

TEST_F(External, TakesTheBackgroundOfTheLoadsAzimuthOff) {
  write("r.csv", readings);
  const auto cleaned = [&](const std::string& csv, const std::string& azimuth) {
    write("earth.csv", "azimuth [deg],Bx [uT],By [uT],Bz [uT]\n" + csv);
    const input::external::ExternalModel model =
        read("readings = \"r.csv\"\nbackground = \"earth.csv\"\n", azimuth).external[0];
    return Cleaned{1e6 * *model.undeformed->B[0], 1e6 * *model.readings[0].B[0],
                   1e6 * *model.readings[0].B[1]};
  };
  const double digits = 1e-13;
  // The row of the azimuth, also a turn away.
  for (const char* phi : {"\"30 deg\"", "\"390 deg\"", "\"-330 deg\""}) {
    const Cleaned c = cleaned("0,9,9,9\n30,1,2,3\n60,9,9,9\n", phi);
    EXPECT_NEAR((c.undeformed - Vector3(0, 0, 0)).norm(), 0, digits);
    EXPECT_NEAR((c.first - Vector3(10, 10, 10)).norm(), 0, digits);
    EXPECT_NEAR((c.second - Vector3(13, 13, 13)).norm(), 0, digits);
  }
  // Between rows, and over the turn from 330° to 0°; rows in any order.
  EXPECT_NEAR((cleaned("60,4,0,0\n0,0,0,0\n", "\"15 deg\"").first - Vector3(10, 12, 13)).norm(), 0,
              digits);
  for (const char* phi : {"\"345 deg\"", "\"-15 deg\""})
    EXPECT_NEAR((cleaned("0,0,0,0\n90,50,0,0\n330,0,8,0\n", phi).first - Vector3(11, 8, 13)).norm(),
                0, digits)
        << phi;
}

// Oracle: by hand. (1 + 3)/2 = 2 at 0 deg, (2 + 5)/2 = 3.5 half-way to 90 deg.
TEST(Background, RowsOfOneAzimuthAreAveraged) {
  const std::vector<std::string> sensors{"left", "right"};
  input::Faults faults;
  const input::external::Background background(
      "azimuth [deg],Bx [uT],By [uT],Bz [uT]\n0,1,0,0\n90,5,0,0\n360,3,0,0\n", sensors, faults);
  EXPECT_TRUE(faults.empty());
  EXPECT_NEAR(background.at(0, 0).value().x(), 2e-6, 1e-20);
  EXPECT_NEAR(background.at(std::numbers::pi / 4, 1).value().x(), 3.5e-6, 1e-20);
}

TEST_F(External, SaysWhatIsWrongWithABackground) {
  const std::string header = "azimuth [deg],Bx [uT],By [uT],Bz [uT]\n";
  EXPECT_EQ(background_faults(header + "30,1,1,1\n"), "no fault");
  EXPECT_EQ(background_faults(header + "0,1,1,1\n"),
            "r.csv:1:1: the background has a single azimuth, and the load's is 30 deg: measure it "
            "at more of them");
  EXPECT_EQ(background_faults("azimuth [deg],sensor,Bx [uT],By [uT],Bz [uT]\n30,0,1,1,1\n"),
            "earth.csv:1:1: there is no row of sensor 1");
  EXPECT_EQ(background_faults("Bx [uT],By [uT],Bz [uT]\n1,1,1\n"),
            "earth.csv:1:1: there is no column 'azimuth'");
  write("earth.csv", header + "30,1,1,1\n60,1,1,1\n");
  write("r.csv", readings);
  EXPECT_THAT(
      faults("readings = \"r.csv\"\nbackground = \"earth.csv\"\n", "[\"30 deg\", \"60 deg\"]"),
      HasSubstr("the background of the undeformed cilium's reading is not known"));
  write("r.csv",
        "step,sensor,dBx [T],dBy [T],dBz [T]\n0,0,1,1,1\n0,1,1,1,1\n1,0,1,1,1\n1,1,1,1,1\n");
  EXPECT_THAT(faults("readings = \"r.csv\"\nbackground = \"earth.csv\"\n"),
              HasSubstr("the change dB has no background any more"));
}

}  // namespace
}  // namespace ciliaval::compare

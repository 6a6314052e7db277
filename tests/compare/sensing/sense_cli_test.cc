// SPDX-License-Identifier: LGPL-2.1-or-later
// `ciliaval sense CASE READINGS` as a user calls it.
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "tests/support/program.h"

namespace ciliaval {
namespace {

using test::read_text;
using test::TemporaryFolder;
using testing::HasSubstr;

constexpr double degree = std::numbers::pi / 180;

/// A case under forces of one azimuth, and what `ciliaval run` says the sensor reads.
class Sense : public testing::Test {
 protected:
  void SetUp() override {
    write("one.toml", test::case_text({.name = "one", .force = R"(["1 mN", "2.5 mN", "4 mN"])"},
                                      "mechanics = [\"beam\"]\nfields = [\"line\"]\n"));
    ASSERT_EQ(ciliaval("run one.toml"), 0);
    summary_ = nlohmann::json::parse(read_text(folder_.path() / "results/one/summary.json"));
  }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.path() / name) << text;
  }
  int ciliaval(const std::string& arguments) {
    const test::Outcome outcome = test::run_program(folder_.path(), arguments);
    err_ = outcome.err;
    out_ = outcome.out;
    return outcome.code;
  }
  /// Bx, By, Bz of a step in T, with an offset.
  std::string row(const std::string& name, const nlohmann::json& B, const std::string& more = "",
                  const Vector3& offset = Vector3::Zero()) const {
    return fmt::format("{}{},{:.17g},{:.17g},{:.17g}\n", name, more,
                       B[0][0].get<double>() + offset.x(), B[0][1].get<double>() + offset.y(),
                       B[0][2].get<double>() + offset.z());
  }
  const nlohmann::json& field(std::size_t step, const char* what) const {
    return summary_["steps"][step]["fields"]["beam/line"][what];
  }
  void expect_the_forces(double offset_azimuth = 0) {
    const auto json = nlohmann::json::parse(read_text(folder_.path() / "found.json"));
    ASSERT_EQ(json["samples"].size(), 3u);
    const double forces[] = {1e-3, 2.5e-3, 4e-3};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& sample = json["samples"][i];
      EXPECT_EQ(sample["status"], "found");
      EXPECT_NEAR(sample["magnitude"].get<double>(), forces[i], 1e-8 * forces[i]);
      EXPECT_NEAR(sample["azimuth"].get<double>(), 30 * degree + offset_azimuth, 1e-7);
      EXPECT_LT(sample["magnitude_interval"].get<double>(), 0.1 * forces[i]);
    }
  }

  TemporaryFolder folder_;
  nlohmann::json summary_;
  std::string out_;
  std::string err_;
};

// Oracle: the forces with which `run` has made the readings.
TEST_F(Sense, FindsTheForcesBehindReadingsWithTheOffsetOfTheEarthAndTheMagnet) {
  const Vector3 earth(20e-6, -3e-6, -43e-6);
  std::string text = "sample,Bx [T],By [T],Bz [T]\n";
  const auto& straight = summary_["undeformed"]["fields"]["beam/line"]["B"];
  text += row("unloaded", straight, "", earth + Vector3(1e-6, 0, 0));
  text += row("unloaded", straight, "", earth - Vector3(1e-6, 0, 0));
  for (std::size_t i = 0; i < 3; ++i) text += row(fmt::format("{}", i), field(i, "B"), "", earth);
  write("readings.csv", text);
  ASSERT_EQ(ciliaval("sense one.toml readings.csv --models beam/line --json found.json --csv "
                     "found.csv"),
            0)
      << err_;
  expect_the_forces();
  EXPECT_THAT(out_, HasSubstr("2.5 "));
  // The mean of two unloaded readings adds its noise: √(1 + 1/2).
  const auto interval = [&](const std::string& file) {
    return nlohmann::json::parse(
               read_text(folder_.path() / file))["samples"][1]["magnitude_interval"]
        .get<double>();
  };
  std::string change = "sample,dBx [T],dBy [T],dBz [T]\n";
  for (std::size_t i = 0; i < 3; ++i) change += row(fmt::format("{}", i), field(i, "dB"));
  write("change.csv", change);
  ASSERT_EQ(ciliaval("sense one.toml change.csv --models beam/line --json change.json"), 0);
  EXPECT_NEAR(interval("found.json") / interval("change.json"), std::sqrt(1.5), 1e-6);
  EXPECT_THAT(read_text(folder_.path() / "found.csv"), HasSubstr("\n1,found,"));
}

TEST_F(Sense, RefusesOptionsWithoutEffect) {
  write("readings.csv", "sample,dBx [T],dBy [T],dBz [T]\n" + row("0", field(0, "dB")));
  EXPECT_EQ(ciliaval("sense one.toml readings.csv --plot one.txt"), 2);
  EXPECT_THAT(err_, HasSubstr("ends in .svg, .pdf or .png"));
  EXPECT_EQ(out_, "");
  write("b.sense.toml", "[bench]\ncase = \"one.toml\"\nmodels = \"elastica/line\"\n[errors]\n");
  EXPECT_EQ(ciliaval("sense b.sense.toml --noise '2 uT'"), 2);
  EXPECT_THAT(err_, HasSubstr("--noise"));
  EXPECT_EQ(ciliaval("sense b.sense.toml --unit uT"), 2);
  EXPECT_THAT(err_, HasSubstr("--unit"));
}

// A logger's file: semicolons, decimal commas, mG, times, a column more. Oracle: the forces of
// `run`; options and the table [readings] say the same.
TEST_F(Sense, FindsTheForcesInALoggersFile) {
  const Vector3 earth(20e-6, -3e-6, -43e-6);
  std::string text = "Sensor 7;started\nTime (ms);Mag X;Mag Y;Mag Z;Temp\n";
  const auto add = [&](int time, const nlohmann::json& B) {
    std::string line = fmt::format("{}", time);
    for (int i = 0; i < 3; ++i)
      line += fmt::format(";{:.17g}", 1e7 * (B[0][i].get<double>() + earth[i]));
    std::ranges::replace(line, '.', ',');
    text += line + ";21,5\n";
  };
  add(0, summary_["undeformed"]["fields"]["beam/line"]["B"]);
  add(500, summary_["undeformed"]["fields"]["beam/line"]["B"]);
  for (int i = 0; i < 3; ++i) add(2000 + 1000 * i, field(static_cast<std::size_t>(i), "B"));
  write("log.csv", text);
  ASSERT_EQ(ciliaval("sense one.toml log.csv --unit mG --unloaded '0 s..1 s' --models beam/line "
                     "--json found.json --csv found.csv"),
            0)
      << err_;
  expect_the_forces();
  EXPECT_THAT(out_,
              HasSubstr("log.csv: 5 rows, B from 'Mag X' in mG, 'Mag Y' in mG, 'Mag Z' in mG; "
                        "columns not read: 'Temp'; 1 lines above the header not read; 2 "
                        "unloaded."));
  const auto json = nlohmann::json::parse(read_text(folder_.path() / "found.json"));
  EXPECT_EQ(json["samples"][1]["time"], 3.0);
  EXPECT_THAT(read_text(folder_.path() / "found.csv"), HasSubstr("time [s]\n"));
  const std::string one = read_text(folder_.path() / "one.toml");
  write("one.toml", one + "[readings]\nunit = \"mG\"\nunloaded = \"0 s..1 s\"\n");
  ASSERT_EQ(ciliaval("sense one.toml log.csv --models beam/line --json found.json"), 0) << err_;
  expect_the_forces();
  // The command line goes before the case, whose line a message names.
  EXPECT_EQ(ciliaval("sense one.toml log.csv --unloaded 'rows 7..9'"), 2);
  EXPECT_THAT(err_, HasSubstr("no row lies in \"rows 7..9\" of --unloaded: the file has the rows "
                              "1..5"));
  write("one.toml", one + "[readings]\nunit = \"mm\"\n");
  EXPECT_EQ(ciliaval("sense one.toml log.csv"), 2);
  EXPECT_THAT(err_, HasSubstr("[readings] unit: 'mm' is not a unit of a flux density"));
}

TEST_F(Sense, LeavesTheReadingsAloneThatItWouldOverwrite) {
  std::string text = "sample,dBx [T],dBy [T],dBz [T]\n";
  text += row("0", field(0, "dB"));
  write("readings.csv", text);
  EXPECT_EQ(ciliaval("sense one.toml readings.csv --models beam/line --csv readings.csv"), 2);
  EXPECT_THAT(err_, HasSubstr("readings.csv"));
  EXPECT_EQ(read_text(folder_.path() / "readings.csv"), text);
}

// The stage turns, and with it the ambient field that the sensor sees.
TEST_F(Sense, TakesTheBackgroundOffAtEachAzimuth) {
  const Vector3 earth(20e-6, -3e-6, -43e-6);
  const auto seen = [&](double azimuth) {
    return Vector3(Eigen::AngleAxisd(-azimuth, Vector3::UnitZ()) * earth);
  };
  std::string background = "azimuth [deg],Bx [T],By [T],Bz [T]\n";
  for (int a = 0; a < 360; a += 30)
    background += fmt::format("{},{:.17g},{:.17g},{:.17g}\n", a, seen(a * degree).x(),
                              seen(a * degree).y(), seen(a * degree).z());
  write("background.csv", background);
  const auto& straight = summary_["undeformed"]["fields"]["beam/line"]["B"];
  std::string text = "sample,azimuth [deg],Bx [T],By [T],Bz [T]\n" +
                     row("unloaded", straight, ",60", seen(60 * degree));
  for (std::size_t i = 0; i < 3; ++i)
    text += row(fmt::format("{}", i), field(i, "B"), fmt::format(",{}", 90 * i),
                seen(90 * degree * static_cast<double>(i)));
  write("readings.csv", text);
  ASSERT_EQ(ciliaval("sense one.toml readings.csv --background background.csv --models beam/line "
                     "--json found.json"),
            0)
      << err_;
  expect_the_forces();
}

// Without unloaded rows the model's own B is taken off if the user wants it, and it is said.
TEST_F(Sense, TakesTheModelsOffsetOnlyWhereItIsAskedFor) {
  std::string text = "sample,Bx [T],By [T],Bz [T]\n";
  for (std::size_t i = 0; i < 3; ++i) text += row(fmt::format("{}", i), field(i, "B"));
  write("readings.csv", text);
  EXPECT_EQ(ciliaval("sense one.toml readings.csv --models beam/line"), 2);
  EXPECT_THAT(err_, HasSubstr("readings.csv:1:1: there is no reading of the unloaded cilium"));
  EXPECT_THAT(err_, HasSubstr("--unloaded \"0 s..1 s\""));
  ASSERT_EQ(ciliaval("sense one.toml readings.csv --unloaded model --models beam/line --json "
                     "found.json"),
            0)
      << err_;
  expect_the_forces();
  EXPECT_THAT(out_, HasSubstr("no reading of the unloaded cilium"));
}

// Changes need no offset. Readings that no model of a load makes are said to be so.
TEST_F(Sense, ReadsChangesAndSaysWhatIsNoLoad) {
  std::string text = "time [s],dBx [T],dBy [T],dBz [T]\n";
  for (std::size_t i = 0; i < 3; ++i) text += row("0", field(i, "dB"));
  write("readings.csv", text);
  ASSERT_EQ(ciliaval("sense one.toml readings.csv --models beam/line --json found.json"), 0);
  expect_the_forces();
  write("odd.csv", "sample,dBx [uT],dBy [uT],dBz [uT]\nnone,0.1,0,0\nodd,0,0,500\nhuge,900,0,0\n");
  ASSERT_EQ(ciliaval("sense one.toml odd.csv --models beam/line --json odd.json"), 0);
  const auto odd = nlohmann::json::parse(read_text(folder_.path() / "odd.json"))["samples"];
  EXPECT_EQ(odd[0]["status"], "nothing");
  EXPECT_EQ(odd[1]["status"], "misfit");
  EXPECT_EQ(odd[2]["status"], "beyond range");
  write("odd.csv", "sample,dBx [uT],dBy [uT],dBz [uT]\nodd,0,0,500\n");
  EXPECT_EQ(ciliaval("sense one.toml odd.csv --models beam/line"), 5);
}

// A flow: the speed, with an interval that does not fall below zero. Oracle: the case's velocities.
TEST_F(Sense, FindsTheSpeedOfAFlow) {
  std::string flow =
      test::case_text({.name = "flow"}, "mechanics = [\"elastica\"]\nfields = [\"volume\"]\n");
  const std::size_t load = flow.find("[load]");
  flow =
      flow.substr(0, load) +
      "[load]\ntype = \"flow\"\nvelocity = [\"0.01 m/s\", \"0.3 m/s\"]\nazimuth = \"200 deg\"\n" +
      flow.substr(flow.find("[sensor]"));
  write("flow.toml", flow);
  ASSERT_EQ(ciliaval("run flow.toml"), 0) << err_;
  const auto summary =
      nlohmann::json::parse(read_text(folder_.path() / "results/flow/summary.json"));
  std::string text = "dBx [T],dBy [T],dBz [T]\n";
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& dB = summary["steps"][i]["fields"]["elastica/volume"]["dB"][0];
    text += fmt::format("{:.17g},{:.17g},{:.17g}\n", dB[0].get<double>(), dB[1].get<double>(),
                        dB[2].get<double>());
  }
  write("readings.csv", text);
  ASSERT_EQ(ciliaval("sense flow.toml readings.csv --noise '0.5 uT' --json found.json"), 0) << err_;
  const auto samples = nlohmann::json::parse(read_text(folder_.path() / "found.json"))["samples"];
  EXPECT_NEAR(samples[0]["velocity"].get<double>(), 0.01, 1e-5);
  EXPECT_NEAR(samples[1]["velocity"].get<double>(), 0.3, 1e-7);
  EXPECT_NEAR(samples[1]["azimuth"].get<double>(), -160 * degree, 1e-6);
  EXPECT_EQ(samples[0]["velocity_interval"][0], 0.0);
  EXPECT_GT(samples[0]["velocity_interval"][1].get<double>(), 0.01);
  EXPECT_THAT(out_, HasSubstr("v (m/s)"));
}

TEST_F(Sense, BadReadingsAndOptionsAreRefusedWithTheirPlace) {
  const auto expect_error = [&](const std::string& text, const std::string& message,
                                const std::string& more = "") {
    write("bad.csv", text);
    EXPECT_EQ(ciliaval("sense one.toml bad.csv " + more), 2) << text;
    EXPECT_THAT(err_, HasSubstr(message)) << text;
  };
  const std::string header = "sample,Bx [uT],By [uT],Bz [uT]\n";
  expect_error("sample,Bx [uT],By [uT]\na,1,2\n", "either Bx, By, Bz, or dBx, dBy, dBz");
  expect_error(header + "a,1,2\n", "bad.csv:2");
  expect_error(header + "a,1,2,nan\n", "bad.csv:2");
  expect_error("sample,Bx [mm],By [uT],Bz [uT]\na,1,2,3\n", "bad.csv:1");
  expect_error(header + "unloaded,1,2,3\n", "no reading but of the unloaded cilium");
  expect_error("sample,dBx [uT],dBy [uT],dBz [uT]\nunloaded,1,2,3\na,1,2,3\n",
               "leave its rows out");
  const std::string good = header + "a,1,2,3\n";
  expect_error(good, "flux density", "--noise '1 mm'");
  expect_error(good, "--noise: the noise of a reading lies between", "--noise '0 uT'");
  expect_error(good, "elastica/volume", "--models volume");
  expect_error(good, "force", "--largest '4 mm'");
  write("background.csv", "azimuth [deg],Bx [uT],By [uT],Bz [uT]\n0,1,2,3\n");
  expect_error(good, "need a column 'azimuth'", "--background background.csv");
  expect_error("azimuth [deg],Bx [uT],By [uT],Bz [uT]\n10,1,2,3\n", "a single azimuth",
               "--background background.csv --unloaded model");
}

// A range beyond the slip-off ends there, and it is said. Oracle: the limit that `run` states.
TEST_F(Sense, RangesEndAtTheSlipOff) {
  write("readings.csv", "sample,dBx [T],dBy [T],dBz [T]\n" + row("0", field(0, "dB")) +
                            row("1", field(1, "dB")) + row("2", field(2, "dB")));
  for (const char* largest : {"9 mN", "1 kN"}) {
    ASSERT_EQ(ciliaval(fmt::format("sense one.toml readings.csv --models beam/line --largest '{}' "
                                   "--json found.json",
                                   largest)),
              0)
        << err_;
    expect_the_forces();
    EXPECT_THAT(out_, HasSubstr("Loads are looked for up to 5.8"));
    EXPECT_THAT(out_, HasSubstr(fmt::format("not {} ", largest[0] == '9' ? "9" : "1e+06")));
    const auto json = nlohmann::json::parse(read_text(folder_.path() / "found.json"));
    EXPECT_LT(json["largest"].get<double>(), 5.9e-3);
    EXPECT_GT(json["largest"].get<double>(), 5.8e-3);
  }
}

// Numbers that no sensor has would end as NaN in the loads found.
TEST_F(Sense, RefusesNoiseAndReadingsThatNoSensorHas) {
  write("good.csv", "sample,dBx [uT],dBy [uT],dBz [uT]\na,1,2,3\n");
  for (const char* noise : {"1e300 uT", "1e-300 uT", "2 T"}) {
    EXPECT_EQ(ciliaval(fmt::format("sense one.toml good.csv --noise '{}'", noise)), 2) << out_;
    EXPECT_THAT(err_, HasSubstr(fmt::format("not `{}`", noise)));
  }
  write("huge.csv", "sample,dBx [uT],dBy [uT],dBz [uT]\na,1,2,3\nb,1,1e160,3\n");
  EXPECT_EQ(ciliaval("sense one.toml huge.csv"), 2) << err_;
  EXPECT_THAT(err_, HasSubstr("huge.csv:3:"));
  EXPECT_THAT(err_, HasSubstr("1e+154 T"));
  write("background.csv", "azimuth [deg],Bx [uT],By [uT],Bz [uT]\n0,1,2,3\n90,1e200,2,3\n");
  write("turned.csv", "sample,azimuth [deg],Bx [uT],By [uT],Bz [uT]\na,0,1,2,3\n");
  EXPECT_EQ(ciliaval("sense one.toml turned.csv --background background.csv"), 2) << err_;
  EXPECT_THAT(err_, HasSubstr("background.csv:3:"));
}

// Two sensors: a row for each in a sample. Oracle: the force of `run`.
TEST_F(Sense, TakesTheReadingsOfSeveralSensorsTogether) {
  write(
      "two.toml",
      test::case_text({.name = "two",
                       .force = R"("3 mN")",
                       .sensor = R"([["1 mm", "0 mm", "-1.5 mm"], ["0 mm", "-2 mm", "-1.5 mm"]])"},
                      "mechanics = [\"elastica\"]\nfields = [\"volume\"]\n"));
  ASSERT_EQ(ciliaval("run two.toml"), 0) << err_;
  const auto dB = nlohmann::json::parse(read_text(
      folder_.path() / "results/two/summary.json"))["steps"][0]["fields"]["elastica/volume"]["dB"];
  std::string text = "sample,sensor,dBx [T],dBy [T],dBz [T]\n";
  for (const std::size_t s : {1u, 0u})
    text += fmt::format("a,{},{:.17g},{:.17g},{:.17g}\n", s, dB[s][0].get<double>(),
                        dB[s][1].get<double>(), dB[s][2].get<double>());
  write("readings.csv", text);
  ASSERT_EQ(ciliaval("sense two.toml readings.csv --json found.json"), 0) << err_;
  const auto sample = nlohmann::json::parse(read_text(folder_.path() / "found.json"))["samples"][0];
  EXPECT_NEAR(sample["magnitude"].get<double>(), 3e-3, 1e-9);
  // The same side by side, by name.
  std::string named = read_text(folder_.path() / "two.toml");
  const std::size_t from = named.find("[sensor]");
  named = named.substr(0, from) +
          "[[sensor]]\nname = \"left\"\nposition = [\"1 mm\", \"0 mm\", \"-1.5 mm\"]\n"
          "[[sensor]]\nname = \"right\"\nposition = [\"0 mm\", \"-2 mm\", \"-1.5 mm\"]\n" +
          named.substr(named.find("[models]"));
  write("named.toml", named);
  std::string wide =
      "right_dBx [T],right_dBy [T],right_dBz [T],left_dBx [T],left_dBy [T],left_dBz [T]\n";
  for (const std::size_t s : {1u, 0u})
    wide += fmt::format("{}{:.17g},{:.17g},{:.17g}", s == 1 ? "" : ",", dB[s][0].get<double>(),
                        dB[s][1].get<double>(), dB[s][2].get<double>());
  write("wide.csv", wide + "\n");
  ASSERT_EQ(ciliaval("sense named.toml wide.csv --json found.json"), 0) << err_;
  EXPECT_NEAR(
      nlohmann::json::parse(read_text(folder_.path() / "found.json"))["samples"][0]["magnitude"]
          .get<double>(),
      3e-3, 1e-9);
  write("readings.csv", text.substr(0, text.rfind("a,")));
  EXPECT_EQ(ciliaval("sense two.toml readings.csv"), 2);
  EXPECT_THAT(err_, HasSubstr("no row of sample 'a', sensor 0"));
}

}  // namespace
}  // namespace ciliaval

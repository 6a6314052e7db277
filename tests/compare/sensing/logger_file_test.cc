// SPDX-License-Identifier: LGPL-2.1-or-later
// Files as loggers, spreadsheets and serial monitors write them: each is read with the right
// numbers, or refused for a stated reason.
#include "compare/sensing/logger/file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "compare/sensing/sensing.h"
#include "problem/error.h"
#include "tests/support/synthetic.h"

namespace ciliaval::compare::sensing {
namespace {

using input::external::ReadingOptions;
using testing::HasSubstr;

/// Options as the command line gives them.
struct Given {
  std::string unloaded = {};
  std::string unit = {};
  std::string map = {};
  std::string scale = {};

  ReadingOptions options() const {
    return {{map, "--map"}, {unit, "--unit"}, {scale, "--scale"}, {unloaded, "--unloaded"}};
  }
};

const std::vector<std::string> one_sensor{"0"};
const std::vector<std::string> two_sensors{"0", "1"};

// The oracle of all files: the readings (67.6, −97.5, 2204.9) µT unloaded and (83.3, −98.7, 2203.6)
// µT loaded; of a second sensor (10, 20, 30) µT and (11, 22, 33) µT.
const Eigen::Vector3d first_change(15.7e-6, -1.2e-6, -1.3e-6);
const Eigen::Vector3d second_change(1e-6, 2e-6, 3e-6);
/// 30 times the largest error measured, 3e-19 T, of numbers of 2e-3 T.
constexpr double rounding = 1e-17;

struct LoggerCase {
  std::string file;
  Given given;
  std::size_t sensors = 1;
  std::size_t rows = 1;  ///< of the loaded sample
  std::string refused;   ///< what the message says; empty: it is read
  std::string remark;    ///< part of what is said about the file
};

void PrintTo(const LoggerCase& c, std::ostream* out) {
  *out << c.file << ' ' << c.given.unloaded << ' ' << c.given.unit;
}

class LoggerFiles : public testing::TestWithParam<LoggerCase> {};

TEST_P(LoggerFiles, AreReadWithTheRightNumbersOrRefusedForAStatedReason) {
  const LoggerCase& c = GetParam();
  const std::filesystem::path file =
      std::filesystem::path(CILIAVAL_SOURCE_DIR) / "tests/compare/sensing/loggers" / c.file;
  const auto& names = c.sensors == 1 ? one_sensor : two_sensors;
  if (!c.refused.empty()) {
    try {
      read_sensor_readings(file, {}, names, c.given.options());
      ADD_FAILURE() << "it is read";
    } catch (const InputError& fault) {
      EXPECT_THAT(fault.what(), HasSubstr(c.refused));
      EXPECT_THAT(fault.what(), HasSubstr(c.file + ":"));
    }
    return;
  }
  const SensorReadings read = read_sensor_readings(file, {}, names, c.given.options());
  ASSERT_EQ(read.samples.size(), 1U);
  const Sample& sample = read.samples.front();
  EXPECT_EQ(sample.rows, c.rows);
  EXPECT_TRUE(read.measured_offset);
  ASSERT_EQ(sample.change.size(), static_cast<Eigen::Index>(3 * c.sensors));
  EXPECT_LT((sample.change.head<3>() - first_change).cwiseAbs().maxCoeff(), rounding);
  if (c.sensors == 2) {
    EXPECT_LT((sample.change.tail<3>() - second_change).cwiseAbs().maxCoeff(), rounding);
  }
  EXPECT_THAT(read.remark, HasSubstr(c.remark));
}

const std::string first_second = "0 s..1 s";
const std::string channels = "bx=Ch 1,by=Ch 2,bz=Ch 3";
INSTANTIATE_TEST_SUITE_P(
    Sixteen, LoggerFiles,
    testing::Values(
        LoggerCase{"house_format.csv", {}, 1, 1, "", "1 unloaded"},
        LoggerCase{"spreadsheet_decimal_comma.csv", {first_second}, 1, 1, "", "2 unloaded"},
        LoggerCase{"tabs.tsv", {first_second}, 1, 1, "", "'Bx_uT', 'By_uT', 'Bz_uT'"},
        LoggerCase{"milligauss.csv", {first_second}, 1, 1, "", "'X (mG)'"},
        LoggerCase{"lower_case_no_unit.csv", {"rows 1..1", "uT"}, 1, 1, "", "'bx' in uT"},
        LoggerCase{"gauss.csv", {"rows 1..1"}, 1, 1, "", "'B_x [G]'"},
        LoggerCase{"row_of_units.csv", {first_second}, 1, 1, "", "'Bx' in mT"},
        LoggerCase{"serial_monitor.csv", {"0 s..1 s"}, 1, 1, "", "2 lines above the header"},
        LoggerCase{"lsb.csv", {"rows 1..1", "", "", "0.1 uT"}, 1, 1, "", "not read: 'Index'"},
        LoggerCase{"wide_numbers.csv", {first_second, "uT"}, 2, 1, "", "'Bz1' in uT"},
        LoggerCase{"wide_prefix.csv", {first_second}, 2, 1, "", "'s2_Bz [uT]'"},
        LoggerCase{"iso_time.csv", {first_second}, 1, 1, "", "2 unloaded"},
        LoggerCase{"phone_app.csv",
                   {"0..1 s"},
                   1,
                   1,
                   "",
                   "columns not read: 'Absolute field (µT)', 'Temperature (°C)'"},
        LoggerCase{"repeated_rows.csv", {}, 1, 3, "", "5 rows"},
        LoggerCase{"other_names.csv", {first_second, "µT", channels}, 1, 1, "", "'Ch 3' in µT"},
        LoggerCase{"no_header.csv", {}, 1, 1, "there is no header above the numbers", ""}));

INSTANTIATE_TEST_SUITE_P(
    WithoutTheirOptions, LoggerFiles,
    testing::Values(
        LoggerCase{"lower_case_no_unit.csv", {}, 1, 1, ":1:1: no unit of 'bx', 'by', 'bz'", ""},
        LoggerCase{"lower_case_no_unit.csv", {}, 1, 1, "--unit uT", ""},
        LoggerCase{"gauss.csv", {}, 1, 1, "there is no reading of the unloaded cilium", ""},
        LoggerCase{"gauss.csv", {first_second}, 1, 1, "there is no column 'time'", ""},
        LoggerCase{"lower_case_no_unit.csv",
                   {first_second, "uT"},
                   1,
                   1,
                   "the column 't' has no unit: write \"t [s]\"",
                   ""},
        LoggerCase{"lsb.csv", {"rows 1..1"}, 1, 1, "--scale \"0.15 uT\"", ""},
        LoggerCase{"other_names.csv", {}, 1, 1, ":1:1: no columns Bx, By, Bz; say which", ""},
        LoggerCase{"wide_numbers.csv", {first_second, "uT"}, 1, 1, "does not have", ""},
        LoggerCase{"house_format.csv", {}, 2, 1, "the case has 2 sensors", ""},
        LoggerCase{"iso_time.csv", {"5 s..9 s"}, 1, 1, "the times 0 s..2.5 s", ""},
        LoggerCase{"iso_time.csv", {"0 s..9 s"}, 1, 1, "no reading but of the unloaded", ""},
        LoggerCase{"gauss.csv", {"rows 1..1", "mT"}, 1, 1, "'B_x [G]' has two units", ""},
        LoggerCase{"house_format.csv", {"rows 1..1"}, 1, 1, "leave --unloaded out", ""}));

/// A small file, read for one sensor unless said otherwise.
class LoggerText : public testing::Test {
 protected:
  logger::File read(const std::string& text, const Given& given = {},
                    const std::vector<std::string>& sensors = one_sensor) {
    faults_ = {};
    const ReadingOptions options = given.options();
    return logger::read_file(text, sensors, options, faults_);
  }
  std::string message(const std::string& text, const Given& given = {},
                      const std::vector<std::string>& sensors = one_sensor) {
    read(text, given, sensors);
    return faults_.report("log.csv");
  }
  /// The file's rows, which have no fault.
  std::vector<logger::Row> rows(const std::string& text, const Given& given = {},
                                const std::vector<std::string>& sensors = one_sensor) {
    logger::File file = read(text, given, sensors);
    EXPECT_TRUE(faults_.empty()) << faults_.report("log.csv");
    return std::move(file.rows);
  }
  input::Faults faults_;
};

const std::string header = "time [s],Bx [uT],By [uT],Bz [uT]\n";

TEST_F(LoggerText, PlantedFaultsAreRefusedWithTheirPlace) {
  EXPECT_THAT(message(header + "0,1,2,3\n1,1,NaN,3\n"),
              HasSubstr("log.csv:3:5: 'NaN' is not a finite number"));
  EXPECT_THAT(message(header + "0,1,2,inf\n"), HasSubstr("log.csv:2:7: 'inf' is not a finite"));
  EXPECT_THAT(message(header + "0,1,,3\n"), HasSubstr("log.csv:2:5: the cell is empty"));
  EXPECT_THAT(message(header + "0,1,2,3\n1,1,2"),
              HasSubstr("log.csv:3:5: the row has 3 cells and the header 4: the last row is cut "
                        "off"));
  EXPECT_THAT(message(header + "0,1,2,3\n1;1;2;3\n"),
              HasSubstr("separated by commas, this row by semicolons?"));
  EXPECT_THAT(message(header + "0,1,5,2,5,3,5\n"), HasSubstr("are there commas in the numbers?"));
  EXPECT_THAT(message("Bx [uT];By [uT];Bz [uT]\n1,5;2;3\n1.5;2;3\n"),
              HasSubstr("log.csv:3:1: '1.5' has a decimal point, line 2 the other"));
  EXPECT_THAT(message("Bx [uT];By [uT];Bz [uT]\n1.234,5;2;3\n"),
              HasSubstr("log.csv:2:1: '1.234,5'"));
  EXPECT_THAT(message("Bx [uT],By [uT],Bz [uT]\n\"1,234\",2,3\n"),
              HasSubstr("nothing between thousands"));
  EXPECT_THAT(message("Bx [uT],By [uT],Bz [uT],Bx [mT]\n1,2,3,4\n"),
              HasSubstr("log.csv:1:25: there is a second column 'Bx'"));
  EXPECT_THAT(message(header + "0,1,2,3\n" + header + "0,1,2,3\n"),
              HasSubstr("log.csv:3:1: the header is repeated"));
  EXPECT_THAT(message("Bx [mT],By [mT],Bz [mT]\nuT,uT,uT\n1,2,3\n"),
              HasSubstr("log.csv:2:1: the column 'Bx [mT]' has two units: 'mT' by the header, 'uT' "
                        "by the row of units"));
  EXPECT_THAT(message("Bx [V],By [V],Bz [V]\n1,2,3\n"),
              HasSubstr("log.csv:1:1: the column 'Bx': 'V' is not a unit of a flux density"));
  EXPECT_THAT(message(header + "0,1,2,3\n2,1,2,3\n1,1,2,3\n"),
              HasSubstr("log.csv:4:1: the time goes back at '1'"));
  EXPECT_THAT(message(header + "0,1,2,3\nlater,1,2,3\n"),
              HasSubstr("log.csv:3:1: 'later' is no time as in the rows above"));
  EXPECT_THAT(message(header), HasSubstr("there are no rows below the header"));
  EXPECT_THAT(message(""), HasSubstr("the file is empty"));
  EXPECT_THAT(message("\xFF\xFE"
                      "B"),
              HasSubstr("UTF-16"));
  EXPECT_THAT(message("Bx [T],By [T],Bz [T]\n1,2,300\n"),
              HasSubstr("log.csv:2:1: a field of 300 T"));
  EXPECT_THAT(message("Bx By Bz\n1 2 3\n"),
              HasSubstr("columns are separated by commas, semicolons or tabs"));
  EXPECT_THAT(message("Bx [uT],By [uT],dBz [uT]\n1,2,3\n"), HasSubstr("must be either Bx, By, Bz"));
  EXPECT_THAT(message("Bx [uT],By [uT],U [V]\n1,2,3\n"), HasSubstr("there is no column Bz"));
}

TEST_F(LoggerText, NumbersAboveAHeaderAreNotDropped) {
  EXPECT_THAT(message("1,2,3\n4,5,6\nBx [uT],By [uT],Bz [uT]\n1,2,3\n"),
              HasSubstr("log.csv:1:1: there is no header above the numbers '1,2,3'"));
}

TEST_F(LoggerText, OptionsWithFaultsAreRefusedByName) {
  const std::string good = "Bx,By,Bz\n1,2,3\n";
  const auto refused = [&](const Given& given, const std::string& what) {
    try {
      read(good, given);
      EXPECT_THAT(faults_.report("log.csv"), HasSubstr(what));
    } catch (const InputError& fault) {
      EXPECT_THAT(fault.what(), HasSubstr(what));
    }
  };
  refused({"", "mm"}, "--unit: 'mm' is not a unit of a flux density");
  refused({"", "LSB", "", "5 mm"}, "--scale: ");
  refused({"", "LSB", "", "1 uT, 2 uT"}, "--scale: '1 uT, 2 uT' has 2 parts");
  refused({"", "uT", "", "5 uT"}, "no column is in LSB: leave --scale out");
  refused({"", "uT", "bx"}, "--map: 'bx' is no entry NAME=COLUMN");
  refused({"", "uT", "bq=Bx"}, "--map: 'bq=Bx' is no entry");
  refused({"", "uT", "bx=Bx,by=By,bz=Bzz"},
          "no column 'Bzz', which --map names; did you mean 'Bz'?");
  refused({"", "uT", "bx=Bx,by=Bx,bz=Bz"}, "--map names the column 'Bx' twice");
}

TEST(UnloadedPart, OptionsWithFaultsAreRefusedByName) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "log.csv";
  std::ofstream(file) << header << "0,1,2,3\n1,2,3,4\n";
  for (const char* option : {"first", "rows 0..1", "rows 2..1", "1 s..0 s", "0 mm..1 mm", "0..1",
                             "rows 1..x", "nan s..1 s"})
    try {
      read_sensor_readings(file, {}, one_sensor, Given{option}.options());
      ADD_FAILURE() << option;
    } catch (const InputError& fault) {
      EXPECT_THAT(fault.what(), HasSubstr("--unloaded: ")) << option;
      EXPECT_THAT(fault.what(), HasSubstr("rows 1..20")) << option;
    }
}

// Oracle: the same rows in plain UTF-8.
TEST_F(LoggerText, EncodingsAndLineEndsDoNotMatter) {
  for (const std::string text :
       {"\xEF\xBB\xBF"
        "Bx [\xC2\xB5T],By [\xCE\xBCT],Bz [uT]\r\n1,-2,3e0\r\n",
        "Bx [\xB5T],By [\xB5T],Bz [\xB5T]\n1,-2,3\n",
        "Bx (\xB5T);By (\xB5T);Bz (\xB5T);\n+1;-2,0;3;\n", "Bx, uT\tBy, uT\tBz, uT\n1\t-2\t3"}) {
    const auto read = rows(text);
    ASSERT_EQ(read.size(), 1U) << text;
    EXPECT_LT((read[0].B - Vector3(1e-6, -2e-6, 3e-6)).norm(), 1e-20) << text;
  }
}

TEST_F(LoggerText, HeadersOfManyKindsAreKnown) {
  for (const std::string names :
       {"X,Y,Z", "x,y,z", "Bx,By,Bz", "bx,by,bz", "B_x,B_y,B_z", "Mag X,Mag Y,Mag Z",
        "magX,magY,magZ", "X axis,Y axis,Z axis", "mx,my,mz",
        "Magnetic Field X,Magnetic Field Y,Magnetic Field Z", "BX_uT,BY_uT,BZ_uT",
        "Bx / uT,By / uT,Bz / uT", "x uT,y uT,z uT", "ax,Bx,By,Bz,x,y,z"}) {
    const std::string cells = names.starts_with("ax") ? "9,1,2,3,7,8,9" : "1,2,3";
    const auto read = rows(names + "\n" + cells + "\n", {"", "uT"});
    ASSERT_EQ(read.size(), 1U) << names;
    EXPECT_LT((read[0].B - Vector3(1e-6, 2e-6, 3e-6)).norm(), 1e-20) << names;
  }
  // As numpy.savetxt() and the program's own files have them.
  EXPECT_EQ(rows("# log of today\n# t,Bx,By,Bz\n0,1,2,3\n", {"", "uT"}).size(), 1U);
  EXPECT_NEAR(rows("# units: Bx mT, By mT, Bz mT\nBx,By,Bz\n1,2,3\n")[0].B.z(), 3e-3, 1e-18);
  EXPECT_NEAR(rows("Bx,By,Bz\n# units: Bx mT, By mT, Bz mT\n1,2,3\n")[0].B.z(), 3e-3, 1e-18);
}

TEST_F(LoggerText, UnitsOfManySpellingsAreKnown) {
  const auto z = [&](const std::string& unit, const std::string& scale = "") {
    return rows("Bx,By,Bz\n1,2,3\n", {"", unit, "", scale})[0].B.z();
  };
  for (const auto& [unit, factor] : std::vector<std::pair<std::string, double>>{{"T", 1},
                                                                                {"mT", 1e-3},
                                                                                {"uT", 1e-6},
                                                                                {"µT", 1e-6},
                                                                                {"nT", 1e-9},
                                                                                {"G", 1e-4},
                                                                                {"mG", 1e-7},
                                                                                {"Gauss", 1e-4},
                                                                                {"Tesla", 1},
                                                                                {"ut", 1e-6}})
    EXPECT_NEAR(z(unit), 3 * factor, 1e-15 * factor) << unit;
  EXPECT_NEAR(z("LSB", "0.15 uT"), 0.45e-6, 1e-21);
  EXPECT_NEAR(z("counts", "0.15 uT/LSB"), 0.45e-6, 1e-21);
  EXPECT_NEAR(z("LSB", "6842 LSB/G"), 3e-4 / 6842, 1e-21);
  EXPECT_NEAR(z("raw", "0.15 uT, 0.15 uT, 0.25 uT"), 0.75e-6, 1e-21);
}

TEST_F(LoggerText, TimesOfManyFormsAreSeconds) {
  const auto second = [&](const std::string& name, const std::string& from, const std::string& to) {
    const auto read =
        rows(name + ";Bx [uT];By [uT];Bz [uT]\n" + from + ";1;2;3\n" + to + ";1;2;3\n");
    return read.size() == 2 ? read[1].time : -1;
  };
  EXPECT_NEAR(second("Time (s)", "3", "4,5"), 4.5, 1e-12);
  EXPECT_NEAR(second("t_ms", "3", "1500"), 1.5, 1e-12);
  EXPECT_NEAR(second("micros", "3", "1500000"), 1.5, 1e-12);
  EXPECT_EQ(second("Timestamp [s]", "1764065918", "1764065919.5"), 1.5);
  EXPECT_EQ(second("Timestamp [s]", "1764065918", "1764065920,2"), 2.2);
  EXPECT_EQ(second("t [day]", "45979.5", "45979.75"), 21600);
  EXPECT_NEAR(second("time", "2026-11-25T10:18:38+01:00", "2026-11-25T09:18:39.25Z"), 1.25, 0);
  EXPECT_NEAR(second("time", "2024-02-28 23:59:59", "2024-02-29 00:00:00,5"), 1.5, 1e-6);
  EXPECT_NEAR(second("Time", "10:18:38.5", "10:19:00"), 21.5, 1e-9);
  EXPECT_NEAR(second("date", "2024-02-28", "2024-03-01"), 2 * 86400, 1e-6);
  // One that is not known is not read, and is said.
  const logger::File odd = read("time,Bx [uT],By [uT],Bz [uT]\n3 pm,1,2,3\n4 pm,1,2,3\n");
  EXPECT_TRUE(std::isnan(odd.rows.at(1).time));
  EXPECT_THAT(odd.timeless, HasSubstr("'3 pm' in the column 'time' is no time"));
  EXPECT_THAT(odd.remark, HasSubstr("columns not read: 'time'"));
  EXPECT_FALSE(read("time,Bx [uT],By [uT],Bz [uT]\n2026-02-30,1,2,3\n").has_time);
}

TEST_F(LoggerText, SeveralSensorsStandSideBySideOrBelowEachOther) {
  const std::vector<std::string> named{"left", "right"};
  for (const std::string names :
       {"left_Bx,left_By,left_Bz,right_Bx,right_By,right_Bz",
        "Bx left,By left,Bz left,Bx right,By "
        "right,Bz right",
        "Bx0,By0,Bz0,Bx1,By1,Bz1", "B1x,B1y,B1z,B2x,B2y,B2z",
        "Sensor 1: X,Sensor 1: Y,Sensor 1: Z,Sensor 2: X,Sensor 2: Y,Sensor 2: Z"}) {
    const auto read = rows(names + "\n1,2,3,4,5,6\n", {"", "uT"}, named);
    ASSERT_EQ(read.size(), 2U) << names;
    EXPECT_EQ(read[1].sensor, 1U);
    EXPECT_LT((read[1].B - Vector3(4e-6, 5e-6, 6e-6)).norm(), 1e-20) << names;
  }
  const auto below = rows("time [s],sensor,x,y,z\n0,right,1,2,3\n0,0,4,5,6\n", {"", "uT"}, named);
  EXPECT_EQ(below[0].sensor, 1U);
  EXPECT_EQ(below[1].sensor, 0U);
  EXPECT_THAT(message("sensor,x,y,z\nmiddle,1,2,3\n", {"", "uT"}, named),
              HasSubstr("log.csv:2:1: the sensor 'middle' is none of the case's, left, right"));
  EXPECT_THAT(message("Bx0,By0,Bz0,Bx1,By1\n1,2,3,4,5\n", {"", "uT"}, named),
              HasSubstr("there is no column Bz of the sensor right"));
}

TEST_F(LoggerText, MapsChooseAmongColumns) {
  const std::string two = "t,X,Y,Z,Hall 1 [mT],Hall 2,Hall 3 [mT]\n0,7,8,9,1,2,3\n";
  const auto read = rows(two, {"", "", "bx=hall 1, by=Hall 2 [mT], bz=Hall 3 [mT], time=t [ms]"});
  EXPECT_LT((read.at(0).B - Vector3(1e-3, 2e-3, 3e-3)).norm(), 1e-17);
  EXPECT_EQ(read[0].time, 0);
  const auto turned = rows("X,Y,Z\n1,2,3\n", {"", "uT", "bx=Y,by=Z,bz=X"});
  EXPECT_LT((turned.at(0).B - Vector3(2e-6, 3e-6, 1e-6)).norm(), 1e-20);
}

// Rows of one time are one sample where each sensor has its own rows.
TEST(LoggedReadings, RowsOfOneTimeAreOneSample) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "log.csv";
  std::ofstream(file) << "time [s],sensor,Bx [uT],By [uT],Bz [uT]\n0,0,0,0,0\n0,1,1,1,1\n"
                         "2,0,5,0,0\n2,1,1,1,6\n4,1,0,0,1\n4,0,0,0,0\n";
  const SensorReadings read =
      read_sensor_readings(file, {}, two_sensors, Given{"0 s..1 s"}.options());
  ASSERT_EQ(read.samples.size(), 2U);
  EXPECT_NEAR(read.samples[0].change[0], 5e-6, 1e-20);
  EXPECT_NEAR(read.samples[0].change[5], 5e-6, 1e-20);
  EXPECT_NEAR(read.samples[1].change[3], -1e-6, 1e-20);
  EXPECT_EQ(read.samples[1].time, 4.0);
}

/// A time as loggers and the programs behind them write it, `hundredths` of a second after an epoch
/// in whole seconds since 1970.
struct TimeForm {
  std::string name;
  std::string header;
  std::function<std::string(std::int64_t epoch, int hundredths)> text;
  /// Whether the file has the time as it was, not as a double held it.
  bool is_exact = true;
};

/// "2025-11-18T16:27:14" with the fraction and the offset from UTC.
std::string iso(std::int64_t epoch, char between, const std::string& fraction, int offset_minutes) {
  const std::time_t local = static_cast<std::time_t>(epoch + 60 * offset_minutes);
  std::tm parts{};
  gmtime_r(&local, &parts);
  return fmt::format("{:04}-{:02}-{:02}{}{:02}:{:02}:{:02}{}{}{:02}:{:02}", parts.tm_year + 1900,
                     parts.tm_mon + 1, parts.tm_mday, between, parts.tm_hour, parts.tm_min,
                     parts.tm_sec, fraction, offset_minutes < 0 ? '-' : '+',
                     std::abs(offset_minutes) / 60, std::abs(offset_minutes) % 60);
}

double in_seconds(std::int64_t epoch, int hundredths) {
  return static_cast<double>(epoch) + hundredths / 100.;
}

const TimeForm time_forms[]{
    {"Seconds", "time [s]",
     [](std::int64_t epoch, int h) { return fmt::format("{}.{:02}", epoch + h / 100, h % 100); }},
    {"Milliseconds", "time [ms]",
     [](std::int64_t epoch, int h) { return fmt::format("{}", 1000 * epoch + 10 * h); }},
    {"MillisecondsWithFraction", "time [ms]",
     [](std::int64_t epoch, int h) { return fmt::format("{}.000", 1000 * epoch + 10 * h); }},
    {"Microseconds", "time [us]",
     [](std::int64_t epoch, int h) { return fmt::format("{}", 1'000'000 * epoch + 10'000 * h); }},
    {"Nanoseconds", "time [ns]",
     [](std::int64_t epoch, int h) {
       return fmt::format("{}", 1'000'000'000 * epoch + 10'000'000 * h);
     }},
    {"SecondsOfADouble", "time [s]",
     [](std::int64_t epoch, int h) { return fmt::format("{:.9f}", in_seconds(epoch, h)); }, false},
    {"SecondsOfNumpy", "time [s]",
     [](std::int64_t epoch, int h) { return fmt::format("{:.18e}", in_seconds(epoch, h)); }, false},
    {"NanosecondsOfNumpy", "time [ns]",
     [](std::int64_t epoch, int h) {
       return fmt::format("{:.18e}", static_cast<double>(1'000'000'000 * epoch + 10'000'000 * h));
     },
     false},
    {"IsoWithZone", "time",
     [](std::int64_t epoch, int h) {
       return iso(epoch + h / 100, 'T', fmt::format(".{:02}0", h % 100), 0);
     }},
    {"IsoOfPython", "time",  // str(datetime) has no fraction where it is zero
     [](std::int64_t epoch, int h) {
       return iso(epoch + h / 100, ' ',
                  h % 100 == 0 ? std::string() : fmt::format(".{:02}0000", h % 100), 0);
     }},
    {"IsoOfNanoseconds", "time",
     [](std::int64_t epoch, int h) {
       return iso(epoch + h / 100, 'T', fmt::format(".{:02}0000000", h % 100), 330);
     }},
    {"IsoWestOfGreenwich", "time",
     [](std::int64_t epoch, int h) {
       return iso(epoch + h / 100, 'T', fmt::format(".{:02}", h % 100), -150);
     }},
    {"IsoOfADouble", "time",  // as pandas makes it of seconds since 1970
     [](std::int64_t epoch, int h) {
       const std::string text = fmt::format("{:.9f}", in_seconds(epoch, h));
       const auto point = text.find('.');
       return iso(std::stoll(text.substr(0, point)), ' ', text.substr(point), 0);
     },
     false}};

class TimesSince1970 : public testing::TestWithParam<TimeForm> {};

// Twenty rows of the straight cilium, 50 ms apart, and a window whose end is the last of them.
// Oracle: the rows' numbers. The times of the loaded rows are the doubles nearest to what the file
// has.
TEST_P(TimesSince1970, ARowAtTheBoundaryOfAWindowBelongsToIt) {
  const TimeForm& form = GetParam();
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "log.csv";
  for (const std::int64_t epoch :
       {std::int64_t{100'000'001}, std::int64_t{999'999'999}, std::int64_t{1'763'483'234},
        std::int64_t{2'147'483'647}, std::int64_t{3'848'765'234}, std::int64_t{4'102'444'799}}) {
    std::ofstream out(file);
    out << form.header << ",Bx [uT],By [uT],Bz [uT]\n";
    for (int i = 0; i < 30; ++i)
      out << form.text(epoch, 5 * i) << (i < 20 ? ",0,0,0\n" : ",9,0,0\n");
    out.close();
    const auto read = [&](const std::string& window) {
      return read_sensor_readings(file, {}, one_sensor, Given{window}.options());
    };
    const SensorReadings all = read("0 s..0.95 s");
    EXPECT_THAT(all.remark, HasSubstr("; 20 unloaded")) << epoch;
    ASSERT_EQ(all.samples.size(), 10U) << epoch;
    for (int i = 0; i < 10; ++i) {
      const double time = all.samples[static_cast<std::size_t>(i)].time.value_or(-1);
      if (form.is_exact)
        EXPECT_EQ(time, (100 + 5 * i) / 100.) << epoch;
      else
        EXPECT_NEAR(time, (100 + 5 * i) / 100., 0.5e-6) << epoch;
    }
    EXPECT_THAT(read("0.05 s..0.95 s").remark, HasSubstr("; 19 unloaded")) << epoch;
    EXPECT_THAT(read("50 ms..949 ms").remark, HasSubstr("; 18 unloaded")) << epoch;
  }
}

INSTANTIATE_TEST_SUITE_P(Forms, TimesSince1970, testing::ValuesIn(time_forms),
                         [](const auto& form) { return form.param.name; });

// Oracle: by hand. Rows 1, 2, 3 of x differ from their mean by −1, 0, 1 µT.
TEST(LoggedReadings, RepeatedRowsAreAveragedWithTheirScatter) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "log.csv";
  std::ofstream(file) << "sample,Bx [uT],By [uT],Bz [uT]\nunloaded,0,0,0\nunloaded,0,0,0\n"
                         "a,1,0,0\na,2,0,0\nb,7,0,0\na,3,0,0\n";
  const SensorReadings read = read_sensor_readings(file, {}, one_sensor, {});
  ASSERT_EQ(read.samples.size(), 2U);
  EXPECT_EQ(read.samples[0].name, "a");
  EXPECT_NEAR(read.samples[0].change[0], 2e-6, 1e-20);
  EXPECT_NEAR(read.error(read.samples[0]).variance, 1. / 3 + 1. / 2, 1e-15);
  EXPECT_NEAR(read.error(read.samples[1]).variance, 1 + 1. / 2, 1e-15);
  EXPECT_EQ(read.scatter.freedom, 9U);
  EXPECT_NEAR(read.scatter.deviation(), std::sqrt(2. / 9) * 1e-6, 1e-20);
  EXPECT_FALSE(scatter_remark(read.scatter, 1e-6));
  EXPECT_THAT(scatter_remark(read.scatter, 0.1e-6).value_or(""), HasSubstr("differ by 0.471 uT"));
}

TEST_F(LoggerText, AMillionRowsTakeSeconds) {
  std::string text = header;
  text.reserve(40'000'000);
  constexpr int count = 1'000'000;
  for (int i = 0; i < count; ++i) text += fmt::format("{},67.{},-97.5,2204.9\n", i, i % 10);
  const auto start = std::chrono::steady_clock::now();
  const auto read = rows(text);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(read.size(), static_cast<std::size_t>(count));
  EXPECT_LT(taken.count(), 10);  // 0.4 s measured
  RecordProperty("seconds", std::to_string(taken.count()));
  EXPECT_THAT(message(text + "1000001,1,2,3\n"), HasSubstr("more than 1000000 rows"));
}

}  // namespace
}  // namespace ciliaval::compare::sensing

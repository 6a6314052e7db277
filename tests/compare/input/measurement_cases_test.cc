// SPDX-License-Identifier: LGPL-2.1-or-later
// Case files with [[measurement]]: what they say, what is refused and where, and that they are
// written back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <initializer_list>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compare/input/case.h"
#include "compare/models/registry.h"
#include "problem/error.h"
#include "tests/support/planted_fault.h"

namespace ciliaval::compare {
namespace {

using input::measurement::Measurand;
using input::measurement::Measurement;
using testing::HasSubstr;
using testing::StartsWith;
using Kind = Measurand::Kind;

/// The good case and a table, which begins in line 36.
std::string with(std::string_view measurement) {
  return std::string(good_case).append(measurement);
}

constexpr std::string_view tip = R"toml([[measurement]]
quantity = "tip.deflection"
point = ["1 mm", "-0.5 mm"]
step = 2
value = "3.5 mm"
uncertainty = "0.1 mm"
source = "photograph"
fitted = true
)toml";

TEST(MeasurementCase, StatesAValueOfTheTip) {
  const input::Case c = read(with(tip));
  ASSERT_EQ(c.measured.measurements.size(), 1U);
  const Measurement& m = c.measured.measurements[0];
  EXPECT_EQ(m.measurand.kind, Kind::deflection);
  EXPECT_EQ(m.measurand.point[0], 1e-3);
  EXPECT_EQ(m.measurand.point[1], -0.5e-3);
  EXPECT_EQ(m.step, 2U);
  EXPECT_EQ(m.value, 3.5e-3);
  EXPECT_EQ(m.uncertainty, 1e-4);
  EXPECT_EQ(m.source, "photograph");
  EXPECT_TRUE(m.fitted);
}

TEST(MeasurementCase, MayBeAnyCoordinateAngleOrField) {
  const auto of = [](std::string_view quantity, std::string_view value,
                     std::string_view uncertainty) {
    std::string text(good_case);
    text = replaced(text, "[sensor]\n", "[[sensor]]\nname = \"a.b\"\n");
    const auto c = read(text.append("[[measurement]]\nquantity = \"")
                            .append(quantity)
                            .append("\"\nstep = 0\nvalue = \"")
                            .append(value)
                            .append("\"\nuncertainty = \"")
                            .append(uncertainty)
                            .append("\"\nsource = \"s\"\n"));
    return c.measured.measurements.at(0);
  };
  EXPECT_EQ(of("tip.z", "19 mm", "1 mm").measurand.axis, 2U);
  const Measurement angle = of("tip.theta", "90 deg", "2 %");
  EXPECT_EQ(angle.measurand.kind, Kind::angle);
  EXPECT_DOUBLE_EQ(angle.uncertainty, 0.01 * std::numbers::pi);
  EXPECT_FALSE(angle.fitted);
  const Measurement field = of("dB.a.b.y", "-20 uT", "5 %");
  EXPECT_EQ(field.measurand.kind, Kind::dB);
  EXPECT_EQ(field.measurand.axis, 1U);
  EXPECT_EQ(field.measurand.sensor, 0U);
  EXPECT_DOUBLE_EQ(field.uncertainty, 1e-6);
  EXPECT_EQ(of("B.a.b.z", "1 mT", "1 uT").measurand.kind, Kind::B);
}

TEST(MeasurementCase, IsWrittenBack) {
  const std::string text =
      with(tip) +
      "[[input_uncertainty]]\nnumber = \"cilium.diameter\"\nuncertainty = \"1 %\"\nsource = "
      "\"caliper\"\n[[input_uncertainty]]\nnumber = \"cilium.segment.base.poisson_ratio\"\n"
      "uncertainty = 0.005\n";
  const std::string written = input::to_toml(read(text), models::known());
  const input::Case again = read(written);
  EXPECT_EQ(input::to_toml(again, models::known()), written);
  EXPECT_EQ(again.measured.measurements[0].measurand,
            read(text).measured.measurements[0].measurand);
  EXPECT_EQ(again.measured.measurements[0].value, 3.5e-3);
  ASSERT_EQ(again.measured.inputs.size(), 2U);
  EXPECT_EQ(again.measured.inputs[0].uncertainty.front(), "1 %");
  EXPECT_EQ(again.measured.inputs[0].source, "caliper");
  EXPECT_TRUE(again.measured.inputs[1].is_plain);
}

class BadMeasurementCase : public testing::TestWithParam<PlantedFault> {};

TEST_P(BadMeasurementCase, IsRefusedWithOneLocatedMessage) {
  expect_refused(with(tip), GetParam());
}

const PlantedFault bad_measurements[]{
    {"UnknownQuantity", "\"tip.deflection\"", "\"tip.deflexion\"", "37:12",
     "'quantity' cannot be 'tip.deflexion' (valid: tip.x, tip.y, tip.z, tip.deflection, tip.theta, "
     "B.0.x"},
    {"UnknownComponent", "\"tip.deflection\"", "\"tip\"", "37:12", "'quantity' cannot be 'tip'"},
    {"UnknownSensor", "\"tip.deflection\"\npoint = [\"1 mm\", \"-0.5 mm\"]", "\"dB.1.x\"", "37:12",
     "did you mean 'dB.0.x'?"},
    {"QuantityIsNoText", "\"tip.deflection\"", "3", "37:12", "'quantity' must be a text"},
    {"NoQuantity", "quantity = \"tip.deflection\"\n", "", "36:1",
     "[[measurement]] needs "
     "'quantity'"},
    {"ValueWithoutUnit", "\"3.5 mm\"", "3.5", "40:9", "has no unit"},
    {"ValueOfAnotherKind", "\"3.5 mm\"", "\"3.5 mT\"", "40:9", "'value'"},
    {"UncertaintyWithoutUnit", "\"0.1 mm\"", "0.1", "41:15", "has no unit"},
    {"NegativeUncertainty", "\"0.1 mm\"", "\"-0.1 mm\"", "41:15", "'uncertainty' is -0.0001 m"},
    {"NoUncertainty", "uncertainty = \"0.1 mm\"\n", "", "36:1",
     "[[measurement]] needs 'uncertainty'"},
    {"ZeroUncertainty", "\"0.1 mm\"", "\"0 mm\"", "41:15", "nothing is measured without one"},
    {"NegativePercentage", "\"0.1 mm\"", "\"-2 %\"", "41:15", "'uncertainty' is -2 %"},
    {"PartOfZero", "value = \"3.5 mm\"\nuncertainty = \"0.1 mm\"",
     "value = \"0 mm\"\nuncertainty = \"2 %\"", "41:15", "a part of zero is zero"},
    {"StepOutOfRange", "step = 2", "step = 3", "39:8", "'step' is 3, but must be from 0 to 2"},
    {"NegativeStep", "step = 2", "step = -1", "39:8", "'step' is -1"},
    {"NoStep", "step = 2\n", "", "36:1", "[[measurement]] needs 'step'"},
    {"NoSource", "source = \"photograph\"\n", "", "36:1", "[[measurement]] needs 'source'"},
    {"FittedIsNoFlag", "fitted = true", "fitted = \"yes\"", "43:10", "must be true or false"},
    {"PointOutside", "\"1 mm\"", "\"1.5 mm\"", "38:9", "outside the end section"},
    {"PointHasThree", "\"-0.5 mm\"]", "\"-0.5 mm\", \"0 mm\"]", "38:9",
     "'point' must be a list of two numbers"},
    {"PointWithoutUnit", "\"-0.5 mm\"]", "0]", "38:18", "has no unit"},
    {"NeitherValueNorFile", "step = 2\nvalue = \"3.5 mm\"\n", "", "36:1",
     "needs either 'value' or 'file'"},
    {"ValueAndFile", "value =", "file = \"a.csv\"\nvalue =", "36:1",
     "needs either 'value' or 'file'"},
    {"ScaleOfAValue", "value =", "scale = \"1 mm\"\nvalue =", "40:9", "'scale' goes with 'file'"},
    {"StepOfAFile", "value = \"3.5 mm\"", "file = \"a.csv\"", "39:8", "'step' goes with 'value'"},
    {"UnknownKey", "fitted", "fited", "43:1", "did you mean 'fitted'?"},
    {"NoTable", "[[measurement]]", "[measurement]", "36:1",
     "expected 0 to 2000 tables [[measurement]], found a table"},
};

INSTANTIATE_TEST_SUITE_P(All, BadMeasurementCase, testing::ValuesIn(bad_measurements), name_of);

TEST(MeasurementCase, HasItsPointInTheRectangle) {
  std::string text = replaced(
      with(tip), "diameter = \"3 mm\"",
      "section = {shape = \"rectangle\", width = \"4 mm\", height = \"2 mm\", orientation = \"90 "
      "deg\"}");
  text = replaced(text, "azimuth = \"30 deg\"", "azimuth = \"90 deg\"");
  EXPECT_EQ(faults_of(text), "");  // (1, -0.5) mm: turned, the sides reach to 1 mm and 2 mm
  EXPECT_EQ(faults_of(replaced(text, "\"-0.5 mm\"", "\"-2 mm\"")), "");
  const std::string beside = faults_of(replaced(text, "\"1 mm\"", "\"1.1 mm\""));
  EXPECT_THAT(beside, StartsWith("bad.toml:38:9: 'point' lies outside the end section"));
}

TEST(BadMeasurement, OfAnAngleHasNoPoint) {
  std::string text = replaced(with(tip), "\"tip.deflection\"", "\"tip.theta\"");
  text = replaced(replaced(text, "3.5 mm", "3 deg"), "0.1 mm\"\nsource", "1 deg\"\nsource");
  EXPECT_THAT(faults_of(text), StartsWith("bad.toml:38:9: 'point' goes with tip.x"));
  EXPECT_EQ(lines(faults_of(text)).size(), 1U);
}

TEST(BadMeasurement, OfAFieldNeedsAFieldModel) {
  const std::string text = replaced(
      replaced(with(tip), "\"tip.deflection\"\npoint = [\"1 mm\", \"-0.5 mm\"]", "\"dB.0.x\""),
      "fields = [\"dipole\", \"line\", \"volume\", \"mesh\"]", "");
  EXPECT_THAT(faults_of(text), StartsWith("bad.toml:37:12: 'dB.0.x' needs a field model"));
}

TEST(InputUncertainty, NeedsNoMeasurement) {
  const std::string text =
      with("[[input_uncertainty]]\nnumber = \"cilium.diameter\"\nuncertainty = \"1 %\"\n");
  EXPECT_EQ(faults_of(text), "");
}

TEST(BadInputUncertainty, LacksAKey) {
  EXPECT_THAT(faults_of(with(tip) + "[[input_uncertainty]]\nuncertainty = \"1 %\"\n"),
              StartsWith("bad.toml:44:1: [[input_uncertainty]] needs 'number'"));
  EXPECT_THAT(faults_of(with(tip) + "[[input_uncertainty]]\nnumber = \"cilium.diameter\"\n"),
              StartsWith("bad.toml:44:1: [[input_uncertainty]] needs 'uncertainty'"));
}

class MeasuredFiles : public testing::Test {
 protected:
  /// The keys of a table that reads `a.csv`, between two that state a value.
  std::string text(const std::string& csv, const std::string& keys) const {
    folder_.write("a.csv", csv);
    return with(tip) + "[[measurement]]\nquantity = \"tip.x\"\nsource = \"b\"\n" + keys +
           with(tip).substr(good_case.size());
  }
  input::Case read(const std::string& csv, const std::string& keys) const {
    return input::read_case(text(csv, keys), (folder_.path() / "case.toml").string(),
                            models::known());
  }
  std::string faults(const std::string& csv,
                     const std::string& keys = "file = \"a.csv\"\nuncertainty = \"1 mm\"\n") const {
    return faults_beside(folder_, text(csv, keys));
  }
  test::TemporaryFolder folder_;
};

TEST_F(MeasuredFiles, GiveAValueForEachStepInTheirPlace) {
  const input::Case c =
      read("value [mm],other\n1,x\n2,y\n4,z\n", "file = \"a.csv\"\nuncertainty = \"0.1 mm\"\n");
  ASSERT_EQ(c.measured.measurements.size(), 5U);  // between the two tables with a value
  for (std::size_t i = 0; i < 3; ++i) {
    const Measurement& m = c.measured.measurements[i + 1];
    EXPECT_EQ(m.measurand.name, "tip.x");
    EXPECT_EQ(m.step, i);
    EXPECT_DOUBLE_EQ(m.value, (i == 2 ? 4e-3 : i == 1 ? 2e-3 : 1e-3));
    EXPECT_EQ(m.uncertainty, 1e-4);
    EXPECT_EQ(m.source, "b");
  }
  EXPECT_EQ(c.measured.files.size(), 1U);
  const std::string written = input::to_toml(c, models::known());
  EXPECT_EQ(
      input::to_toml(input::read_case(written, "again.toml", models::known()), models::known()),
      written);
}

TEST_F(MeasuredFiles, MayHaveAScaleUncertaintiesAndSteps) {
  const input::Case c = read("# by eye\nstep,w,uncertainty\n2,0.5,0.01\n0,-0.1,0.02\n",
                             "file = \"a.csv\"\ncolumn = \"w\"\nscale = \"20 mm\"\n");
  ASSERT_EQ(c.measured.measurements.size(), 4U);
  EXPECT_EQ(c.measured.measurements[1].step, 2U);
  EXPECT_DOUBLE_EQ(c.measured.measurements[1].value, 10e-3);
  EXPECT_DOUBLE_EQ(c.measured.measurements[1].uncertainty, 0.2e-3);
  EXPECT_EQ(c.measured.measurements[2].step, 0U);
  EXPECT_DOUBLE_EQ(c.measured.measurements[2].value, -2e-3);
}

constexpr const char* with_uncertainty = "file = \"a.csv\"\nuncertainty = \"0.1 mm\"\n";

// Oracle: by hand; the forces of the case are 1, 2 and 4 mN. However the loads are written, each
// value is that of its step.
TEST_F(MeasuredFiles, AreMatchedToTheStepsByTheirLoads) {
  for (const auto& [csv, more] : std::initializer_list<std::pair<std::string, std::string>>{
           {"force [mN],value [mm]\n4,3\n1,1\n2,2\n", ""},
           {"value [mm],F (uN)\n2,2000\n3,4e3\n1,1000.0\n", ""},
           {"value [mm],x_mN\n3,4\n1,1\n2,2\n", ""},
           {"value [mm],pull / N\n3,0.004\n1,0.001\n2,0.002\n", ""},
           {"# units: value mm, x gf\nvalue,x\n3,0.407886486\n1,0.1019716213\n2,0.2039432426\n",
            ""},
           {"\xEF\xBB\xBFvalue [mm],x [mN],note,height [mm]\n3,4,a,16\n1,1,b,16\n2,2,c,16\n", ""},
           {"value [mm],x\n3,4\n1,1\n2,2\n", "load = \"x [mN]\"\n"},
           {"value [mm],x [mN],y [mN]\n3,4,1\n1,1,4\n2,2,2\n", "load = \"x\"\n"},
           {"value [mm],x [mN],y [mN]\n3,4,7\n1,1,8\n2,2,9\n", ""},
           {"F [mN];value [mm]\r\n4,0;3,0\r\n1,0;1,0\r\n2;2\r\n", ""},
           {"F [mN]\tvalue [mm]\n4\t3\n1\t1\n2\t2\n", ""},
           {"F [mN],value [mm]\n4,\"3,0\"\n1,1\n2,\"2,0\"\n", ""},
           {"% Nodes,3\n% F (mN),value (mm)\n4,3\n1,1\n2,2\n", ""},
           {",F [mN],value [mm]\n0,4,3\n1,1,1\n2,2,2\n", ""}}) {
    const input::Case c = read(csv, with_uncertainty + more);
    ASSERT_EQ(c.measured.measurements.size(), 5U) << csv;
    for (std::size_t i = 0; i < 3; ++i) {
      const Measurement& m = c.measured.measurements[i + 1];
      EXPECT_DOUBLE_EQ(m.value, 1e-3 * static_cast<double>(m.step + 1)) << csv;
    }
    ASSERT_EQ(c.measured.remarks.size(), 1U);
    EXPECT_THAT(c.measured.remarks[0],
                StartsWith("a.csv: 3 rows of tip.x from 'value', steps by '"));
    EXPECT_THAT(c.measured.remarks[0], HasSubstr("(force)"));
  }
  EXPECT_THAT(read("value [mm],x [mN],t [s],\"why\"\n3,4,0,a\n1,1,1,b\n2,2,2,c\n", with_uncertainty)
                  .measured.remarks.at(0),
              HasSubstr("columns not read: 't [s]', 'why'"));
}

// No file is taken for one in the steps' order that may have its loads in it.
TEST_F(MeasuredFiles, AreNotPairedByTheirOrderInSilence) {
  const auto refused = [&](const std::string& csv, const std::string& more = "") {
    return faults(csv, with_uncertainty + more);
  };
  EXPECT_THAT(
      refused("x [mN],value [mm]\n4,3\n1,1\n3,2\n"),
      StartsWith("a.csv:4:1: 3 mN in the column 'x [mN]' is the load of no step; force of the "
                 "steps: 1 mN, 2 mN, 4 mN"));
  EXPECT_THAT(refused("x [mN],value [mm]\n4,3\n1,1\n"),
              StartsWith("a.csv:3:1: there is no row of step 1, force 2 mN"));
  EXPECT_THAT(refused("x [mN],value [mm]\n4,3\n1,1\n2,2\n4,5\n"),
              StartsWith("a.csv:5:1: there is a second row of the load 4 mN"));
  EXPECT_THAT(refused("x [mN],y [mN],value [mm]\n4,1,3\n1,2,1\n2,4,2\n"),
              StartsWith("a.csv:1:8: both 'x [mN]' (force) and 'y [mN]' (force) have the loads"));
  EXPECT_THAT(refused("x,value [mm]\n1,1\n2,2\n4,3\n"),
              StartsWith("a.csv:1:1: the column 'x' has numbers without a unit, which may be the "
                         "loads: name it with its unit, such as \"x [mN]\", here or by load = \"x "
                         "[mN]\" in the case"));
  EXPECT_THAT(refused(",value [mm]\n1,1\n2,2\n4,3\n"),
              StartsWith("a.csv:1:1: the column without a name has numbers without a unit"));
  EXPECT_THAT(refused("\"1\",\"0,01\"\n\"2\",\"5,4\"\n\"4\",\"9,6\"\n"),
              StartsWith("a.csv:1:1: there is no header above the numbers"));
  EXPECT_THAT(refused("1,0.01\n2,5.4\n4,9.6\n"),
              StartsWith("a.csv:1:1: there is no header above the numbers '1,0.01'"));
  EXPECT_THAT(refused("x [mN],value [mm]\n4,9,6\n1,1\n2,2\n"),
              StartsWith("a.csv:2:5: the row has 3 cells and the header 2: are there commas"));
  EXPECT_EQ(faults(",value [mm]\n0,1\n1,2\n2,3\n"), "no fault");  // pandas counts rows so
  EXPECT_THAT(refused("value [mm]\n1;3\n2;1\n4;2\n"),
              StartsWith("a.csv:1:1: the row"));  // the first may be the loads
  EXPECT_THAT(
      refused("x [mN],value [mm]\n4,1\n1,1\n2,2\n", "load = \"y\"\n"),
      StartsWith("a.csv:1:1: there is no column 'y', which 'load' names (others: 'x [mN]')"));
  EXPECT_THAT(
      refused("x [s],value [mm]\n4,1\n1,1\n2,2\n", "load = \"x\"\n"),
      StartsWith("a.csv:1:1: the column 'x [s]' in s is of no number of the load: force (N)"));
  EXPECT_THAT(refused("x [mN],value [mm]\n4,1\n1,1\n2,2\n", "load = \"x [N]\"\n"),
              StartsWith("a.csv:1:1: the column 'x [mN]' has the unit mN, and N by 'load'"));
  EXPECT_THAT(refused("step,value [mm]\n0,1\n1,1\n2,2\n", "load = \"in order\"\n"),
              StartsWith("a.csv:1:1: the column 'step' contradicts the key 'load'"));
}

TEST_F(MeasuredFiles, MayStandInTheOrderOfTheStepsWhereThatIsSaid) {
  for (const std::string csv :
       {"x,value [mm]\n7,1\n7,2\n9,3\n", "x [mN],value [mm]\n4,1\n1,2\n2,3\n",
        ",value [mm]\n7,1\n7,2\n9,3\n"}) {
    const input::Case c = read(csv, std::string(with_uncertainty) + "load = \"in order\"\n");
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(c.measured.measurements[i + 1].step, i);
      EXPECT_DOUBLE_EQ(c.measured.measurements[i + 1].value, 1e-3 * static_cast<double>(i + 1));
    }
    EXPECT_THAT(c.measured.remarks.at(0), HasSubstr("rows in the order of the load steps"));
  }
}

// A path that comes back has a load twice: rows in its order, or a column `step`.
TEST_F(MeasuredFiles, OfAPathThatComesBackStandInItsOrder) {
  const auto steps = [&](const std::string& csv) {
    folder_.write("a.csv", csv);
    std::string text =
        replaced(with(tip), "[\"1 mN\", \"2 mN\", \"4 mN\"]", "[\"1 mN\", \"2 mN\", \"1 mN\"]");
    text += "[[measurement]]\nquantity = \"tip.x\"\nsource = \"b\"\n";
    std::vector<std::size_t> result;
    for (const Measurement& m :
         input::read_case(text + with_uncertainty, (folder_.path() / "case.toml").string(),
                          models::known())
             .measured.measurements)
      result.push_back(m.step);
    return result;
  };
  EXPECT_THAT(steps("x [mN],value [mm]\n1,1\n2,2\n1,3\n"), testing::ElementsAre(2, 0, 1, 2));
  EXPECT_THROW(steps("x [mN],value [mm]\n1,1\n1,2\n2,3\n"), InputError);
}

// A field is matched by a component or by its amount; a flow by the velocity that the case states.
TEST_F(MeasuredFiles, KnowTheNumbersOfAFieldAndOfAFlow) {
  const auto steps = [&](const std::string& load, const std::string& csv) {
    folder_.write("a.csv", csv);
    std::string text(good_case);
    text = text.substr(0, text.find("[load]")) + load +
           "[models]\nmechanics = [\"elastica\"]\n[[measurement]]\nquantity = \"tip.x\"\nsource = "
           "\"b\"\n" +
           with_uncertainty;
    std::vector<std::size_t> result;
    for (const Measurement& m :
         input::read_case(text, (folder_.path() / "case.toml").string(), models::known())
             .measured.measurements)
      result.push_back(m.step);
    return result;
  };
  const std::string field =
      "[environment]\nuniform_field = [[\"0 T\", \"0 T\", \"0 T\"], [\"-3 mT\", \"0 T\", \"4 "
      "mT\"], "
      "[\"-6 mT\", \"0 T\", \"8 mT\"]]\n";
  for (const char* loads : {"5,1\n0,0\n10,2\n", "-3,1\n0,0\n-6,2\n", "4,1\n0,0\n8,2\n"})
    EXPECT_THAT(steps(field, std::string("B [mT],value [mm]\n") + loads),
                testing::ElementsAre(1, 0, 2))
        << loads;
  EXPECT_THAT(steps(field, "B [G],value [mm]\n50,1\n0,0\n100,2\n"), testing::ElementsAre(1, 0, 2));
  EXPECT_THAT(steps("[load]\ntype = \"flow\"\nvelocity = [\"0.1 m/s\", \"0.3 m/s\"]\n",
                    "v [cm/s],value [mm]\n30,2\n10,1\n"),
              testing::ElementsAre(1, 0));
}

TEST_F(MeasuredFiles, AreRefusedWithTheirPlace) {
  EXPECT_THAT(faults("", "file = \"b.csv\"\nuncertainty = \"1 mm\"\n"),
              StartsWith("b.csv:1:1: there is no such file"));
  EXPECT_THAT(faults("value [mm]\n1\n2\n"),
              StartsWith("a.csv:3:1: the file has 2 rows and the case 3 load steps"));
  EXPECT_THAT(faults("w [mm]\n1\n2\n3\n"), StartsWith("a.csv:1:1: there is no column 'value'"));
  EXPECT_THAT(faults("value\n1\n2\n3\n"),
              StartsWith("a.csv:1:1: the column 'value' needs the unit"));
  EXPECT_THAT(faults("value [mT]\n1\n2\n3\n"), StartsWith("a.csv:1:1: the column 'value'"));
  EXPECT_THAT(faults("value [mm]\n1\nx\n3\n"), StartsWith("a.csv:3:1: 'x' is not a number"));
  EXPECT_THAT(faults("value [mm],step\n1,0\n2,3\n"),
              StartsWith("a.csv:3:1: the step 3 is none of the case's load steps, 0 to 2"));
  EXPECT_THAT(faults("value [mm],step\n1,0\n2,0\n"),
              StartsWith("a.csv:3:1: there is a second row of step 0"));
  EXPECT_THAT(faults("value [mm],step\n1,0.5\n"), StartsWith("a.csv:2:1: the step 0.5"));
  EXPECT_THAT(faults("value [mm]\n1\n2\n3\n", "file = \"a.csv\"\n"),
              StartsWith("a.csv:1:1: the values have no uncertainty"));
  EXPECT_THAT(faults("value [mm],uncertainty [mm]\n1,1\n2,1\n3,1\n"),
              StartsWith("a.csv:1:12: the column 'uncertainty' contradicts"));
  EXPECT_THAT(faults("value [mm],uncertainty [mm]\n1,1\n2,-1\n3,1\n", "file = \"a.csv\"\n"),
              StartsWith("a.csv:3:1: the uncertainty is -0.001 m, but must be more than zero"));
  EXPECT_THAT(faults("value [mm]\n0\n2\n3\n", "file = \"a.csv\"\nuncertainty = \"2 %\"\n"),
              StartsWith("a.csv:2:1: the uncertainty is 0 m"));
  EXPECT_THAT(faults("value [mm]\n1\n2\n3\n",
                     "file = \"a.csv\"\nscale = \"20 mm\"\nuncertainty = \"1 mm\"\n"),
              StartsWith("a.csv:1:1: the column 'value' has no unit"));
}

}  // namespace
}  // namespace ciliaval::compare

// SPDX-License-Identifier: LGPL-2.1-or-later
// Each fault is put into a case file without one; the place that the message must name is counted
// by hand in case_texts.h.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/support/planted_fault.h"

namespace ciliaval::compare {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class BadCaseFile : public testing::TestWithParam<PlantedFault> {};

TEST_P(BadCaseFile, IsRefusedWithOneLocatedMessage) {
  expect_refused(good_case, GetParam());
}

constexpr std::string_view slip = "taken for a slip in the sign or the unit";

const PlantedFault syntax[]{
    {"UnquotedQuantity", "\"3 mm\"", "3 mm", "6:14", "expected a comment or whitespace, saw 'm'",
     "write it in quotes"},
    {"OpenTable", "[cilium]", "[cilium", "5:8", "Error while parsing table header"},
    {"OpenText", "\"good\"", "\"good", "2:13", "Error while parsing string"},
    {"MissingValue", "\"16 mm\"", "", "24:10", "Error while parsing key-value pair"},
    {"RepeatedKey", "azimuth", "height", "25:10", "cannot redefine existing string 'height'"},
    {"DecimalComma", "poisson_ratio = 0.49", "poisson_ratio = 0,49", "12:18",
     "saw ','; a decimal number has a point, as 0.49"},
    {"RepeatedTable", "[sensor]", "[load]", "27:1", "cannot redefine existing table 'load'"},
    {"NotUtf8", "A case", "A c\xffse", "3:12", "invalid utf-8 sequence"},
    {"ControlCharacter", "A case", std::string_view("A \0ase", 6), "3:12", "control characters"},
    {"IntegerTooLarge", "refinement = 1", "refinement = 99999999999999999999", "35:34",
     "not representable in 64 bits", "; the whole number is outside the range of 64 bits"},
    {"FloatTooLarge", "= 0.49", "= 1e400", "12:22", "could not be interpreted as a value",
     "; the number is outside the range of double precision"},
    {"UnquotedQuantityInAList", "\"4 mN\"", "-4e0 mN", "23:31", "saw 'm'", "write it in quotes"},
    {"UnquotedQuantityWithoutABlank", "\"75 kA/m\"", "7_5kA/m", "19:20", "Error while parsing",
     "write it in quotes"},
    {"DeepKey", "refinement",
     "a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a", "35:1",
     "a dotted key of more than 32 parts"},
    {"DeepKeyBehindAComment", "title = \"A case without a fault\"",
     "x = 1 # don't\n  é.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a = 1",
     "4:3", "a dotted key of more than 32 parts"},
    {"DeepKeyBehindAText", "\"A case without a fault\"",
     "\"\"\"it's\n\\\"\"\"\"\"\nx = "
     "{a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a "
     "= 1}",
     "5:6", "a dotted key of more than 32 parts"},
};

TEST(BadCaseSyntax, NoAdviceIsGivenWhereNoneIsKnown) {
  for (const char* value : {"5 = 6", "2020-13-01", "[1 2]", "05", "\"a, 3 mm", "1 # 3 mm\n3 mm"}) {
    const std::string faults = faults_of(replaced(good_case, "0.49", value));
    EXPECT_THAT(faults, StartsWith("bad.toml:1"));
    EXPECT_THAT(faults, testing::Not(HasSubstr("; "))) << value;
  }
}

const PlantedFault keys[]{
    {"UnknownKeyInSegment", "length =", "lenght =", "10:1",
     "unknown key 'lenght' in [[cilium.segment]] (valid: name, length, young_modulus, "
     "poisson_ratio, magnetization, density)",
     "; did you mean 'length'?"},
    {"StartOfAKey", "poisson_ratio", "poisson", "12:1",
     "unknown key 'poisson' in [[cilium.segment]]", "did you mean 'poisson_ratio'?"},
    {"StartOfAnOption", "refinement = 1", "kernel = \"0.5 mm\"", "35:1", "unknown key 'kernel'",
     "did you mean 'kernel_width'?"},
    {"UnknownKeyInCase", "title", "titel", "3:1", "unknown key 'titel' in [case]",
     "did you mean 'title'?"},
    {"UnknownKeyInLoad", "azimuth", "azimut", "25:1",
     "unknown key 'azimut' in [load] of type 'contact'", "did you mean 'azimuth'?"},
    {"KeyOfAnotherLoadType", "azimuth = \"30 deg\"", "velocity = \"1 m/s\"", "25:1",
     "unknown key 'velocity' in [load] of type 'contact' (valid: type, force, height, azimuth, "
     "slip_off, touch)"},
    {"UnknownKeyInModels", "[models.solid]", "[models.sold]", "34:9",
     "unknown key 'sold' in [models]", "did you mean 'solid'?"},
    {"UnknownOption", "refinement", "refinment", "35:1",
     "unknown key 'refinment' in [models.solid]", "did you mean 'refinement'?"},
    {"UnknownKeyWithoutANeighbour", "refinement", "colour", "35:1",
     "unknown key 'colour' in [models.solid] (valid: material, mooney_ratio"},
    {"CaseOfAKeyMatters", "title", "Title", "3:1", "unknown key 'Title'", "did you mean 'title'?"},
    {"MissingDiameter", "diameter = \"3 mm\"", "", "5:1", "[cilium] needs 'diameter'"},
    {"MissingLength", "length = \"3 mm\"", "", "8:1", "[[cilium.segment]] needs 'length'"},
    {"MissingModulus", "young_modulus = \"3 MPa\"", "", "14:1",
     "[[cilium.segment]] needs 'young_modulus'"},
    {"MissingType", "type = \"contact\"", "", "21:1", "[load] needs 'type'"},
    {"MissingForce", "force = [\"1 mN\", \"2 mN\", \"4 mN\"]", "", "21:1",
     "[load] of type 'contact' needs 'force'"},
    {"MissingHeight", "height = \"16 mm\"", "", "21:1", "needs 'height'"},
    {"SegmentIsOneTable", "[[cilium.segment]]\nname = \"base\"", "[cilium.base]\nname = \"base\"",
     "8:9", "unknown key 'base' in [cilium] (valid: section, diameter, segment)"},
    {"SensorWithoutAName", "[sensor]", "[[sensor]]", "27:1", "[[sensor]] needs 'name'"},
    {"SensorNamedByANumber", "[sensor]", "[[sensor]]\nname = \"1\"", "28:8",
     "the sensor name '1' must be letters"},
    {"SensorNameTwice", "[sensor]",
     "[[sensor]]\nname = \"a\"\nposition = [\"0 m\", \"0 m\", \"1 m\"]\n[[sensor]]\nname = \"A\"",
     "31:8", "the sensor name 'A' is already taken"},
    {"NamedSensorsWithTwoPlaces", "[sensor]\nposition = [\"-0.1 mm\",",
     "[[sensor]]\nname = \"a\"\nposition = [[\"0 m\", \"0 m\", \"1 m\"],", "29:13",
     "expected a length"},
    {"UnknownKeyOfReadings", "[sensor]", "[readings]\nunits = \"mT\"\n[sensor]", "28:1",
     "unknown key 'units' in [readings]"},
    {"UnitOfReadingsIsANumber", "[sensor]", "[readings]\nunit = 1\n[sensor]", "28:8", "'unit'"},
    {"TableIsAText", "[sensor]\nposition = [\"-0.1 mm\", \"0.2 mm\", \"-1.55 mm\"]",
     "[models.line]\n", "32:10", "'fields' need a place: add [sensor] with 'position'"},
};

// Oracle: the lines and columns of the faults as counted in case_texts.h.
TEST(BadLoad, OfAnUnknownTypeHasItsOtherFaultsReported) {
  const std::string broken =
      replaced(replaced(replaced(good_case, "\"2 mN\"", "\"2 mm\""), "height = \"16 mm\"",
                        "height = [\"16\", \"-1 mm\"]"),
               "azimuth", "azimut");
  for (const std::string& type : {std::string("type = \"contct\""), std::string("type = 3"),
                                  std::string("type = \"prob\""), std::string("typ = \"dead\"")}) {
    const auto faults = lines(faults_of(replaced(broken, "type = \"contact\"", type)));
    ASSERT_EQ(faults.size(), 6U) << type;
    EXPECT_THAT(faults[0], StartsWith("bad.toml:22:")) << type;
    EXPECT_THAT(faults[1], StartsWith("bad.toml:23:18: 'force': 'mm' is not a unit of a force"));
    EXPECT_THAT(faults[2], StartsWith("bad.toml:24:10: 'height' lists 2 values"));
    EXPECT_THAT(faults[3], StartsWith("bad.toml:24:11: 'height': '16' has no unit"));
    EXPECT_THAT(faults[4], StartsWith("bad.toml:24:17: 'height' is -0.001 m"));
    EXPECT_THAT(faults[5], StartsWith("bad.toml:25:1: unknown key 'azimut' in [load]"));
  }
}

const PlantedFault values[]{
    {"NumberWithoutUnit", "diameter = \"3 mm\"", "diameter = 3", "6:12",
     "'diameter': the number 3 has no unit: write a length, such as \"3 mm\""},
    {"TextWithoutUnit", "diameter = \"3 mm\"", "diameter = \"3\"", "6:12", "'3' has no unit"},
    {"ForceWithALengthsUnit", "\"2 mN\"", "\"2 mm\"", "23:18",
     "'force': 'mm' is not a unit of a force: write a force, such as \"1 mN\""},
    {"MagnetizationInTesla", "\"75 kA/m\"", "\"0.09 T\"", "19:17",
     "'T' is not a unit of a magnetization"},
    {"UnknownUnit", "\"16 mm\"", "\"16 milimeter\"", "24:10", "unknown unit 'milimeter'"},
    {"OffsetUnit", "\"16 mm\"", "\"16 mm @ 3\"", "24:10", "is not a product of units"},
    {"ReciprocalUnit", "\"16 mm\"", "\"16 mm-1\"", "24:10", "'mm-1' is not a unit of a length"},
    {"AngleWithoutUnit", "\"30 deg\"", "\"30\"", "25:11",
     "'30' has no unit: write an angle, such as \"30 deg\""},
    {"AngleInRadiansByMistake", "\"30 deg\"", "\"30 rad\"", "25:11",
     "'azimuth' is 30 rad ('30 rad'), but must be from -720 deg to 720 deg: more than two turns"},
    {"ThreeTurns", "\"30 deg\"", "\"999 deg\"", "25:11",
     "('999 deg'), but must be from -720 deg to 720 deg: more than two turns is taken for a slip"},
    {"NotANumber", "\"16 mm\"", "\"nan mm\"", "24:10", "does not start with a finite number"},
    {"NotANumberInToml", "= 0.49", "= nan", "12:17", "'poisson_ratio': the number must be finite"},
    {"InfiniteInToml", "= 0.49", "= -inf", "12:17", "the number must be finite"},
    {"HugeLength", "length = \"17 mm\"", "length = \"1e308 m\"", "16:10",
     "'length' is 1e+308 m ('1e308 m'), but must be from 1e-09 m to 100 m", slip},
    {"HugeModulus", "\"3 MPa\"", "\"1e308 Pa\"", "17:17", "'young_modulus' is 1e+308 Pa", slip},
    {"HugeMagnetization", "\"75 kA/m\"", "\"-1e308 A/m\"", "19:17", "the strongest magnets"},
    {"HugeForce", "\"4 mN\"", "\"1e308 N\"", "23:26", "'force' is 1e+308 N"},
    {"HugePosition", "\"0.2 mm\"", "\"1e308 m\"", "28:24", "'position' is 1e+308 m"},
    {"NegativeLength", "length = \"3 mm\"", "length = \"-3 mm\"", "10:10", "'length' is -0.003 m",
     slip},
    {"ZeroDiameter", "diameter = \"3 mm\"", "diameter = \"0 mm\"", "6:12", "'diameter' is 0 m",
     slip},
    {"NegativeModulus", "\"0.1 MPa\"", "\"-0.1 MPa\"", "11:17", "'young_modulus' is -100000 Pa"},
    {"ZeroModulus", "\"0.1 MPa\"", "\"0 MPa\"", "11:17", "'young_modulus' is 0 Pa"},
    {"NegativeForce", "\"1 mN\"", "\"-1 mN\"", "23:10", "add 180 deg to the azimuth"},
    {"IncompressibleExactly", "= 0.49", "= 0.5", "12:17",
     "'poisson_ratio' is 0.5, but must be between -1 and 0.5, both excluded"},
    {"PoissonBelow", "= 0.49", "= -1", "12:17", "between -1 and 0.5, both excluded"},
    {"PoissonAsText", "= 0.49", "= \"0.49\"", "12:17", "write a plain number without quotes"},
    {"QuantityIsATable", "diameter = \"3 mm\"", "diameter = {x = 1}", "6:12", "found a table"},
    {"QuantityIsADate", "\"16 mm\"", "2000-01-01", "24:10", "found a date or time"},
    {"QuantityIsTrue", "\"16 mm\"", "true", "24:10", "such as \"3 mm\", found true"},
    {"TitleIsANumber", "\"A case without a fault\"", "3", "3:9", "must be a text in quotes"},
    {"TitleHasTwoLines", "A case", "A\\ncase", "3:9", "line breaks"},
    {"EmptyName", "\"good\"", "\"\"", "2:8", "must be a plain file name"},
    {"NameClimbs", "\"good\"", "\"../good\"", "2:8", "must be a plain file name"},
    {"NameIsAPath", "\"good\"", "\"a/b\"", "2:8", "must be a plain file name"},
    {"NameIsAnOption", "\"good\"", "\"-good\"", "2:8", "not starting with '.' or '-'"},
    {"NameIsTheParent", "\"good\"", "\"..\"", "2:8", "must be a plain file name"},
    {"NameHasABlank", "\"good\"", "\"go od\"", "2:8", "must be a plain file name"},
    {"NameHasABackslash", "\"good\"", "'a\\b'", "2:8", "must be a plain file name"},
    {"NameHasAnEscape", "\"good\"", "\"\\u001b[2J\"", "2:8", "'\\x1B[2J' must be a plain"},
    {"SegmentWithoutAName", "\"base\"", "\" \"", "9:8", "'name' must not be empty"},
    {"SegmentNameTwice", "\"magnet\"", "\"base\"", "15:8", "name 'base' is already taken"},
    {"FractionalRefinement", "refinement = 1", "refinement = 1.5", "35:14",
     "'refinement' must be a whole number, found the number 1.5"},
    {"NegativeRefinement", "refinement = 1", "refinement = -1", "35:14",
     "'refinement' is -1, but must be from 0 to 3"},
    {"HugeRefinement", "refinement = 1", "refinement = 9000000000000000000", "35:14",
     "'refinement' is 9e+18"},
    {"ToleranceZero", "refinement = 1", "newton_tolerance = 0", "35:20",
     "'newton_tolerance' is 0, but must be"},
    {"ToleranceWithUnit", "refinement = 1", "newton_tolerance = \"1e-9 N\"", "35:20",
     "'newton_tolerance': write a plain number"},
    {"ToleranceIsNoPercentage", "refinement = 1", "tolerance = 1e-9", "35:13",
     "'tolerance': the number 1e-09 has no unit"},
    {"NegativeTolerance", "refinement = 1", "tolerance = \"-1 %\"", "35:13", "'tolerance' is -1 %"},
    {"ToleranceAndRefinement", "refinement = 1", "refinement = 1\ntolerance = \"0.1 %\"", "35:14",
     "'refinement' goes with no tolerance only"},
    {"ToleranceOfNothing", "refinement = 1", "tolerance_of = \"field\"", "35:16",
     "'tolerance_of' says of what the 'tolerance' is a part: give that too"},
    {"KernelWithoutUnit", "refinement = 1", "kernel_width = 0.5", "35:16",
     "'kernel_width': the number 0.5 has no unit"},
    {"FlagIsANumber", "[models.solid]\nrefinement = 1", "[models.beam]\nshear_rigid = 1", "35:15",
     "'shear_rigid' must be true or false, found the number 1"},
    {"JointsOfTheHeightForm", "[models.solid]\nrefinement = 1",
     "[models.elastica]\nform = \"height\"\njoints = \"corrected\"", "36:10",
     "the elastica's form 'height' (Eq. 1-4) takes no corrected joints"},
    {"UnknownChoice", "[models.solid]\nrefinement = 1", "[models.volume]\nslices = \"wegde\"",
     "35:10", "'slices' cannot be 'wegde' (valid: wedge, stacked)", "did you mean 'wedge'?"},
    {"UnknownPushForward", "[models.solid]\nrefinement = 1", "[models.mesh]\npush_forward = \"U\"",
     "35:16", "'push_forward' cannot be 'U' (valid: F, R)"},
};

const PlantedFault lists[]{
    {"EmptyMechanics",
     "[\"elastica\", \"beam\", \"solid\"]\nfields = [\"dipole\", \"line\", "
     "\"volume\", \"mesh\"]",
     "[]", "31:13", "'mechanics' is empty: name at least one of elastica, beam, calculix, solid"},
    {"MechanicsIsAText", "[\"elastica\", \"beam\", \"solid\"]", "\"beam\"", "31:13",
     "'mechanics' must be a list, such as [\"elastica\"], found the text 'beam'"},
    {"UnknownMechanics", "\"elastica\"", "\"elastika\"", "31:14",
     "'mechanics' cannot be 'elastika' (valid: elastica, beam, calculix, solid)",
     "did you mean 'elastica'?"},
    {"UnknownField", "\"volume\"", "\"volumen\"", "32:29",
     "'fields' cannot be 'volumen' (valid: dipole, line, volume, mesh, potential)",
     "did you mean 'volume'?"},
    {"MechanicsTwice", "\"beam\"", "\"elastica\"", "31:26", "'mechanics' lists 'elastica' twice"},
    {"FieldTwice", "\"line\"", "\"dipole\"", "32:21", "'fields' lists 'dipole' twice"},
    {"NumberAmongIds", "\"beam\"", "1", "31:26", "'mechanics' must be a text in quotes"},
    {"EmptyLoadPath", "[\"1 mN\", \"2 mN\", \"4 mN\"]", "[]", "23:9",
     "'force' lists 0 values: a load path has 1 to 1000 steps"},
    {"NestedLoadPath", "\"2 mN\"", "[\"2 mN\"]", "23:18", "such as \"1 mN\", found a list"},
    {"ListsOfDifferentLength", "\"16 mm\"", "[\"16 mm\", \"15 mm\"]", "24:10",
     "'height' lists 2 values, but 'force' lists 3: all lists of a load path have the same length"},
    {"EmptyPosition", "[\"-0.1 mm\", \"0.2 mm\", \"-1.55 mm\"]", "[]", "28:12",
     "'position' must be a point"},
    {"TwoCoordinates", "[\"-0.1 mm\", \"0.2 mm\", \"-1.55 mm\"]", "[\"-0.1 mm\", \"0.2 mm\"]",
     "28:12", "a point has three coordinates", "found 2"},
    {"FourCoordinates", "\"-1.55 mm\"]", "\"-1.55 mm\", \"1 mm\"]", "28:12", "found 4"},
    {"CoordinateNotFinite", "\"0.2 mm\"", "\"inf mm\"", "28:24",
     "does not start with a finite number"},
    {"PositionIsAText", "[\"-0.1 mm\", \"0.2 mm\", \"-1.55 mm\"]", "\"0 mm\"", "28:12",
     "'position' must be a point", "found the text '0 mm'"},
};

const PlantedFault contradictions[]{
    {"HeightAboveTheTip", "\"16 mm\"", "\"21 mm\"", "24:10",
     "the contact height 0.021 m must lie between the base and the tip of the cilium, which is "
     "0.02 m high"},
    {"HeightAtTheTip", "\"16 mm\"", "\"20 mm\"", "24:10", "must lie between the base and the tip"},
    {"OneHeightOfThePathAbove", "\"16 mm\"", "[\"16 mm\", \"21 mm\", \"15 mm\"]", "24:20",
     "the contact height 0.021 m"},
    {"KernelAboveTheTip", "\"16 mm\"", "\"19.6 mm\"", "24:10",
     "the solid's contact kernel, 0.0005 m below and above the contact height 0.0196 m",
     "set a smaller 'kernel_width'"},
    {"KernelBelowTheBase", "\"16 mm\"", "\"0.4 mm\"", "24:10", "must lie between the base and"},
    {"WideKernel", "refinement = 1", "kernel_width = \"5 mm\"", "24:10", "0.005 m below and above"},
    {"SectionBeyondTheTip",
     "type = \"contact\"\nforce = [\"1 mN\", \"2 mN\", \"4 mN\"]\nheight = "
     "\"16 mm\"",
     "type = \"section\"\nforce = \"1 mN\"\narclength = \"20.1 mm\"", "24:13",
     "the loaded section at arc length 0.0201 m lies beyond the tip at 0.02 m"},
    {"HeightFormWithASection",
     "type = \"contact\"\nforce = [\"1 mN\", \"2 mN\", \"4 mN\"]\nheight = \"16 mm\"\nazimuth = "
     "\"30 deg\"\n",
     "type = \"section\"\nforce = \"1 mN\"\narclength = \"20 mm\"\n[models.elastica]\nform = "
     "\"height\"\n",
     "26:8",
     "the elastica's form 'height' (Eq. 1-4) takes the load types 'contact', 'flow' and 'probe', "
     "not 'section'"},
    {"HeightFormWithADeadLoad",
     "type = \"contact\"\nforce = [\"1 mN\", \"2 mN\", \"4 mN\"]\nheight = \"16 mm\"\nazimuth = "
     "\"30 deg\"\n",
     "type = \"dead\"\nforce_per_length = \"0.1 N/m\"\n[models.elastica]\nform = \"height\"\n",
     "25:8", "not 'dead'"},
    {"VelocityAndForce",
     "type = \"contact\"\nforce = [\"1 mN\", \"2 mN\", \"4 mN\"]\nheight = \"16 mm\"",
     "type = \"flow\"\nforce_per_height = \"0.1 N/m\"\nvelocity = \"0.5 m/s\"", "24:12",
     "'velocity' contradicts 'force_per_height'"},
    {"DensityWithForce",
     "type = \"contact\"\nforce = [\"1 mN\", \"2 mN\", \"4 mN\"]\nheight = \"16 mm\"",
     "type = \"flow\"\nforce_per_height = \"0.1 N/m\"\ndensity = \"1 g/cm^3\"", "24:11",
     "'density' goes with 'velocity'"},
    {"DragCoefficientWithForce",
     "type = \"contact\"\nforce = [\"1 mN\", \"2 mN\", \"4 mN\"]\nheight = \"16 mm\"",
     "type = \"flow\"\nforce_per_height = \"0.1 N/m\"\ndrag_coefficient = 1", "24:20",
     "'drag_coefficient' goes with 'velocity'"},
    {"ViscosityWithADragCoefficient",
     "type = \"contact\"\nforce = [\"1 mN\", \"2 mN\", \"4 mN\"]\nheight = \"16 mm\"",
     "type = \"flow\"\nvelocity = \"0.1 m/s\"\nviscosity = \"1 mPa s\"", "24:13",
     "'viscosity' goes with 'drag_coefficient = \"cylinder\"' only"},
    {"DragOfASphere",
     "type = \"contact\"\nforce = [\"1 mN\", \"2 mN\", \"4 mN\"]\nheight = \"16 mm\"",
     "type = \"flow\"\nvelocity = \"0.1 m/s\"\ndrag_coefficient = \"sphere\"", "24:20",
     "'drag_coefficient' must be a number or \"cylinder\", found"},
    {"DragBeyondTheCorrelation",
     "type = \"contact\"\nforce = [\"1 mN\", \"2 mN\", \"4 mN\"]\nheight = \"16 mm\"",
     "type = \"flow\"\nvelocity = \"500 m/s\"\ndrag_coefficient = \"cylinder\"", "23:12",
     "known for Reynolds numbers of 1e-4 to 2e5, not for 1.49"},
    {"FlowOfNothing",
     "type = \"contact\"\nforce = [\"1 mN\", \"2 mN\", \"4 mN\"]\nheight = \"16 mm\"",
     "type = \"flow\"", "21:1", "needs 'force_per_height' or 'velocity'"},
    {"NegativeVelocity",
     "type = \"contact\"\nforce = [\"1 mN\", \"2 mN\", \"4 mN\"]\nheight = \"16 mm\"",
     "type = \"flow\"\nvelocity = \"-0.5 m/s\"", "23:12", "add 180 deg to the azimuth"},
    {"FieldsWithoutAMagnet", "magnetization = \"75 kA/m\"", "", "32:10",
     "no [[cilium.segment]] has a 'magnetization'"},
    {"FieldsOfNoMagnetization", "\"75 kA/m\"", "\"0 A/m\"", "32:10", "'fields' need a magnet"},
    {"CalculixUnderAContactLoad", "\"beam\", \"solid\"", "\"beam\", \"calculix\", \"solid\"",
     "31:34",
     "calculix takes the load types 'section', 'dead', not 'contact': leave out 'calculix', or "
     "state the load as one of those"},
    {"CalculixWithoutAProgram", "[models.solid]\nrefinement = 1",
     "[models.calculix]\nprogram = \"\"", "35:11", "'program' must name a program"},
    {"MeshWithoutSolid", ", \"solid\"]", "]", "32:39", "add one of calculix, solid to 'mechanics'"},
    {"TooLongTogether", "length = \"3 mm\"", "length = \"100 m\"", "8:1",
     "the segments are 100.017 m long together"},
    {"TooSlender", "diameter = \"3 mm\"", "diameter = \"3 nm\"", "6:12",
     "the cilium is 6.66667e+06 diameters long"},
};

/// The load of good_case, lines 22 to 24, which each row replaces by a probe's.
constexpr std::string_view contact_load =
    "type = \"contact\"\nforce = [\"1 mN\", \"2 mN\", \"4 mN\"]\nheight = \"16 mm\"";

const PlantedFault probe[]{
    {"MissingDisplacement", contact_load, "type = \"probe\"\nheight = \"16 mm\"", "21:1",
     "[load] of type 'probe' needs 'displacement'"},
    {"MissingHeight", contact_load, "type = \"probe\"\ndisplacement = \"1 mm\"", "21:1",
     "[load] of type 'probe' needs 'height'"},
    {"Negative", contact_load,
     "type = \"probe\"\ndisplacement = [\"1 mm\", \"-2 mm\"]\nheight = \"16 mm\"", "23:25",
     "'displacement' is -0.002 m", "add 180 deg to the azimuth"},
    {"UnitOfAForce", contact_load, "type = \"probe\"\ndisplacement = \"1 mN\"\nheight = \"16 mm\"",
     "23:16", "'displacement': 'mN' is not a unit of a length: write a length"},
    {"NoUnit", contact_load, "type = \"probe\"\ndisplacement = 1e-3\nheight = \"16 mm\"", "23:16",
     "'displacement': the number 0.001 has no unit"},
    {"Force", contact_load,
     "type = \"probe\"\ndisplacement = \"1 mm\"\nheight = \"16 mm\"\nforce = \"1 mN\"", "25:9",
     "'force' is a result of the load type 'probe', whose 'displacement' is given",
     "leave it out or use the type 'contact'"},
    {"HeightAboveTheTip", contact_load,
     "type = \"probe\"\ndisplacement = \"1 mm\"\nheight = \"21 mm\"", "24:10",
     "the contact height 0.021 m must lie between the base and the tip of the cilium"},
    {"NotANumberInTheList", contact_load,
     "type = \"probe\"\ndisplacement = [\"1 mm\", \"nan mm\"]\nheight = \"16 mm\"", "23:25",
     "does not start with a finite number"},
    {"InfiniteNumberInTheList", contact_load,
     "type = \"probe\"\ndisplacement = [inf, \"1 mm\"]\nheight = \"16 mm\"", "23:17",
     "'displacement'"},
    {"DisplacementOfAContact", "azimuth = \"30 deg\"", "displacement = \"1 mm\"", "25:1",
     "unknown key 'displacement' in [load] of type 'contact' (valid: type, force, height, "
     "azimuth, slip_off, touch)"},
    {"UnknownKey", contact_load,
     "type = \"probe\"\ndisplacement = \"1 mm\"\nheight = \"16 mm\"\nspeed = \"1 m/s\"", "25:1",
     "unknown key 'speed' in [load] of type 'probe' (valid: type, displacement, height, azimuth, "
     "slip_off, touch)"},
    {"KernelAboveTheTip", contact_load,
     "type = \"probe\"\ndisplacement = \"1 mm\"\nheight = \"19.6 mm\"", "24:10",
     "the solid's contact kernel"},
};

// Oracle: the rows counted by hand. Three mechanics models are 3 pairs with 5 rows a step; with
// dipole, line and volume on each and mesh on the solid there are 10 field runs, 45 pairs with 6
// components: at 3 steps and over the path 4 (10 + 270) = 1120 rows for each sensor, and 3·3·5
// = 45.
TEST(BadCaseSize, MoreResultsThanAMachineHoldsAreRefused) {
  constexpr std::string_view point = "[\"-0.1 mm\", \"0.2 mm\", \"-1.55 mm\"]";
  const auto with_sensors = [&](int count) {
    return replaced(good_case, point, repeated(point, count));
  };
  EXPECT_EQ(faults_of(with_sensors(178)), "");  // 199405 rows
  EXPECT_THAT(faults_of(with_sensors(179)),
              StartsWith("bad.toml:28:12: 179 sensor points, 3 steps and 10 pairs of mechanics and "
                         "field model with 45 comparisons among them make 200525 rows of results, "
                         "more than 200000: list fewer points, steps or models"));
}

// The solid asks for its kernel below the tip anyway; rods ask for it where they let go by the rim.
TEST(BadCaseFile, ARimNeedsTheContactsEdgeBelowTheTip) {
  const auto with = [](const std::string& slip_off) {
    return faults_of(replaced(
        replaced(replaced(good_case, "\"16 mm\"", "\"19.6 mm\"\nslip_off = \"" + slip_off + "\""),
                 ", \"solid\"", ""),
        ", \"mesh\"", ""));
  };
  EXPECT_EQ(with("axis"), "");
  EXPECT_THAT(with("rim"),
              StartsWith("bad.toml:24:10: with slip_off = 'rim' the contact's upper edge, 0.0005 m "
                         "above the height 0.0196 m, must lie below the tip at 0.02 m"));
  EXPECT_THAT(with("rin"),
              HasSubstr("'slip_off' cannot be 'rin' (valid: axis, rim); did you mean 'rim'?"));
}

struct TouchFault {
  const char* touch;
  const char* message;
};

TEST(BadCaseFile, OfATouch) {
  const std::string of_rods =
      replaced(replaced(std::string(good_case), ", \"solid\"", ""), ", \"mesh\"", "");
  const auto with = [](const std::string& text, const std::string& touch) {
    return faults_of(replaced(text, "height = \"16 mm\"", "height = \"16 mm\"\n" + touch));
  };
  const std::string of_elastica = replaced(of_rods, "\"elastica\", \"beam\"", "\"elastica\"");
  EXPECT_EQ(with(of_elastica, "touch = {law = \"coulomb\", friction = 0.3, at = \"mantle\"}"), "");
  for (const auto& [touch, message] : std::vector<TouchFault>{
           {"touch = 3", "25:9: expected the table [load.touch], found the number 3"},
           {"touch = {law = \"coulom\"}", "did you mean 'coulomb'?"},
           {"touch = {law = \"coulomb\", friction = -0.1}", "'friction' is -0.1"},
           {"touch = {law = \"coulomb\", friction = 5.1}", "'friction' is 5.1"},
           {"touch = {friction = 0.3}", "'friction' goes with 'law = \"coulomb\"' only"},
           {"touch = {at = \"mantel\"}", "did you mean 'mantle'?"},
           {"touch = {radius = \"16 mm\"}", "the pin reaches the floor"},
           {"touch = {radius = \"1 mN\"}", "'mN' is not a unit of a length"},
           {"touch = {at = \"mantle\"}\nslip_off = \"rim\"",
            "slip_off = 'rim' is of a horizontal force"},
           {"touch = {mu = 0.3}", "unknown key 'mu'"}}) {
    SCOPED_TRACE(touch);
    EXPECT_THAT(with(of_elastica, touch), HasSubstr(message));
  }
  EXPECT_EQ(with(of_rods, "touch = {at = \"mantle\"}"), "");
  const std::string pin = "touch = {law = \"coulomb\", friction = 0.3, at = \"mantle\", radius = ";
  EXPECT_EQ(with(std::string(good_case), pin + "\"1 mm\"}"), "");
  EXPECT_THAT(with(std::string(good_case), pin + "\"0 mm\"}"),
              HasSubstr("the solid takes a pin with a 'radius' that slides on it"));
  EXPECT_THAT(with(of_elastica + "\n[models.elastica]\njoints = \"corrected\"\n",
                   "touch = {at = \"mantle\"}"),
              HasSubstr("the elastica takes a touch in its form 'arclength' with joints = 'none'"));
  EXPECT_THAT(faults_of(replaced(of_elastica, contact_load,
                                 "type = \"flow\"\nforce_per_height = "
                                 "\"0.1 N/m\"\ntouch = {radius = \"1 mm\"}")),
              HasSubstr("unknown key 'touch' in [load] of type 'flow'"));
}

TEST(BadCaseSize, OneFieldModelIsBoundedToo) {
  // One run of one field model has no comparison: 400 steps make 401 rows for each sensor.
  const auto text = [](int sensors) {
    return "[case]\nname = \"c\"\n[cilium]\ndiameter = \"3 mm\"\n[[cilium.segment]]\nname = \"a\"\n"
           "length = \"9 mm\"\nyoung_modulus = \"1 MPa\"\npoisson_ratio = 0\n"
           "magnetization = \"1 kA/m\"\n[load]\ntype = \"dead\"\nforce_per_length = " +
           repeated("\"0 N/m\"", 400) +
           "\n[sensor]\nposition = " + repeated("[\"0 m\", \"0 m\", \"1 m\"]", sensors) +
           "\n[models]\nmechanics = [\"beam\"]\nfields = [\"line\"]\n";
  };
  EXPECT_EQ(faults_of(text(498)), "");  // 199698 rows
  EXPECT_THAT(faults_of(text(499)), HasSubstr("make 200099 rows of results, more than 200000"));
}

TEST(BadCaseSize, ALoadPathHasAThousandStepsAtMost) {
  const auto with_steps = [](int count) {
    return replaced(
        replaced(good_case, "[\"1 mN\", \"2 mN\", \"4 mN\"]", repeated("\"1 mN\"", count)),
        "fields = [\"dipole\", \"line\", \"volume\", \"mesh\"]", "");
  };
  EXPECT_EQ(faults_of(with_steps(1000)), "");
  EXPECT_THAT(
      faults_of(with_steps(1001)),
      StartsWith("bad.toml:23:9: 'force' lists 1001 values: a load path has 1 to 1000 steps"));
}

const PlantedFault later[]{
    {"UnknownLoad", "\"contact\"", "\"contract\"", "22:8", "'type' cannot be 'contract'",
     "did you mean 'contact'?"},
    {"PotentialOptions", "[models.solid]\nrefinement = 1",
     "[models.potential]\nrelative_permeability = 0", "35:25",
     "'relative_permeability' is 0, but must be between 0"},
    {"PotentialPlates", "[models.solid]\nrefinement = 1", "[models.potential]\nplate = \"iron\"",
     "35:9", "expected 0 to 100 tables [[models.potential.plate]]"},
    {"PotentialPlateCorners", "[models.solid]\nrefinement = 1",
     "[[models.potential.plate]]\nlower = [\"0 mm\", \"0 mm\", \"0 mm\"]\nupper = [\"1 mm\", "
     "\"-1 mm\", \"1 mm\"]\nrelative_permeability = 2",
     "34:1", "a plate's 'upper' corner must lie above its 'lower' one"},
    {"UnknownMaterial", "refinement = 1", "material = \"neo-hook\"", "35:12",
     "'material' cannot be 'neo-hook'", "did you mean 'neo-hooke'?"},
    {"InitialGuess", "refinement = 1", "initial_guess = \"beem\"", "35:17",
     "'initial_guess' cannot be 'beem'", "did you mean 'beam'?"},
    {"Symmetry", "refinement = 1", "symmetry = \"half\"", "35:12",
     "'symmetry' must be true or false"},
    {"RatioOfAnotherMaterial", "refinement = 1", "mooney_ratio = 0.1", "35:16",
     "'mooney_ratio' goes with material = \"mooney-rivlin\" only"},
    {"RatiosOfAnotherMaterial", "refinement = 1",
     "material = \"mooney-rivlin\"\nyeoh_ratios = [0, 0]", "36:15",
     "'yeoh_ratios' goes with material = \"yeoh\" only"},
    {"NegativeMooneyRatio", "refinement = 1", "material = \"mooney-rivlin\"\nmooney_ratio = -0.1",
     "36:16", "with a negative C01 the solid is unstable"},
    {"OneYeohRatio", "refinement = 1", "material = \"yeoh\"\nyeoh_ratios = [0]", "36:15",
     "'yeoh_ratios' must be a list of two numbers, such as [-0.1, 0.01], found a list of 1"},
    {"YeohRatioAlone", "refinement = 1", "material = \"yeoh\"\nyeoh_ratios = 0.1", "36:15",
     "'yeoh_ratios' must be a list of two numbers, such as [-0.1, 0.01], found the number"},
    {"YeohRatioWithAUnit", "refinement = 1", "material = \"yeoh\"\nyeoh_ratios = [0.1, \"1 Pa\"]",
     "36:21", "'yeoh_ratios'"},
    {"SofteningYeoh", "refinement = 1", "material = \"yeoh\"\nyeoh_ratios = [-0.1, 0.005]", "36:15",
     "is unstable: from some shear on its shear stress falls; C30/C10 must be above "
     "3/5 (C20/C10)² = 0.006"},
    {"NegativeYeoh", "refinement = 1", "material = \"yeoh\"\nyeoh_ratios = [0.1, -0.1]", "36:15",
     "C30/C10 must not be negative"},
};

INSTANTIATE_TEST_SUITE_P(Syntax, BadCaseFile, testing::ValuesIn(syntax), name_of);
INSTANTIATE_TEST_SUITE_P(Keys, BadCaseFile, testing::ValuesIn(keys), name_of);
INSTANTIATE_TEST_SUITE_P(Values, BadCaseFile, testing::ValuesIn(values), name_of);
INSTANTIATE_TEST_SUITE_P(Lists, BadCaseFile, testing::ValuesIn(lists), name_of);
INSTANTIATE_TEST_SUITE_P(Contradictions, BadCaseFile, testing::ValuesIn(contradictions), name_of);
INSTANTIATE_TEST_SUITE_P(Probe, BadCaseFile, testing::ValuesIn(probe), name_of);
INSTANTIATE_TEST_SUITE_P(Later, BadCaseFile, testing::ValuesIn(later), name_of);

}  // namespace
}  // namespace ciliaval::compare

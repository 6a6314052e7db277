// SPDX-License-Identifier: LGPL-2.1-or-later
// Uncertain inputs: which numbers they are, how they are shifted, and what is refused where.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "compare/validation/input_number.h"
#include "tests/support/case_texts.h"

namespace ciliaval::compare::validation {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// Its last line is line 50; the tables of the test begin in line 51.
std::string with_inputs(std::string_view inputs, std::string_view text = good_case) {
  const std::string measured = R"toml([[measurement]]
quantity = "tip.x"
step = 0
value = "1 mm"
uncertainty = "0.1 mm"
source = "a photograph"
)toml";
  std::string all = std::string(text) + measured;
  const auto count = std::count(all.begin(), all.end(), '\n');
  for (auto line = count; line < 50; ++line) all += '\n';
  return all + std::string(inputs);
}

std::string row(std::string_view number, std::string_view uncertainty) {
  return std::string("[[input_uncertainty]]\nnumber = \"")
      .append(number)
      .append("\"\nuncertainty = ")
      .append(uncertainty)
      .append("\n");
}

std::string input_faults(const std::string& text) {
  const input::Case c = read(text);
  try {
    read_inputs(c);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(Inputs, AreAbsoluteOrAPartOfTheNumber) {
  const input::Case c = read(with_inputs(row("cilium.segment.base.young_modulus", "\"5 kPa\"") +
                                         row("cilium.segment.magnet.magnetization", "\"2 %\"") +
                                         row("cilium.segment.base.poisson_ratio", "0.005") +
                                         row("sensor.position.x", "\"0.2 mm\"")));
  const std::vector<Input> inputs = read_inputs(c);
  ASSERT_EQ(inputs.size(), 4U);
  EXPECT_EQ(inputs[0].uncertainty, 5000);
  EXPECT_FALSE(inputs[0].is_relative);
  EXPECT_EQ(inputs[1].uncertainty, 0.02);
  EXPECT_TRUE(inputs[1].is_relative);
  EXPECT_EQ(inputs[2].uncertainty, 0.005);
  EXPECT_DOUBLE_EQ(shifted(c, inputs[0], -2).cilium.segments[0].young_modulus, 0.09e6);
  EXPECT_DOUBLE_EQ(shifted(c, inputs[1], 0.5).cilium.segments[1].magnetization, 75e3 * 1.01);
  EXPECT_DOUBLE_EQ(shifted(c, inputs[2], 1).cilium.segments[0].poisson_ratio, 0.495);
  EXPECT_DOUBLE_EQ(shifted(c, inputs[3], 1).sensors[0].x(), 0.1e-3);
}

std::string range(std::string_view number, std::string_view ends) {
  return fmt::format("[[input_uncertainty]]\nnumber = \"{}\"\nrange = {}\n", number, ends);
}

TEST(Inputs, MayBeRangesOfEvenLikelihood) {
  const input::Case c =
      read(with_inputs(range("cilium.segment.base.young_modulus", "[\"0.08 MPa\", \"0.14 MPa\"]") +
                       range("cilium.segment.base.poisson_ratio", "[\"0.4\", 0.495]") +
                       range("load.height", "[\"15.5 mm\", \"16.5 mm\"]")));
  const std::vector<Input> inputs = read_inputs(c);
  ASSERT_EQ(inputs.size(), 3U);
  EXPECT_DOUBLE_EQ(inputs[0].uncertainty, 0.06e6 / std::sqrt(12));
  const auto at = [&](std::size_t i, double t) {
    return shifted(c, inputs[i], t * inputs[i].step);
  };
  EXPECT_DOUBLE_EQ(at(0, -1).cilium.segments[0].young_modulus, 0.08e6);
  EXPECT_DOUBLE_EQ(at(0, 1).cilium.segments[0].young_modulus, 0.14e6);
  EXPECT_DOUBLE_EQ(at(1, -1).cilium.segments[0].poisson_ratio, 0.4);
  EXPECT_DOUBLE_EQ(at(1, 1).cilium.segments[0].poisson_ratio, 0.495);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_DOUBLE_EQ(contact_height(at(2, 1).load_path[i]).value(), 16.5e-3);
}

TEST(BadInputs, OfARange) {
  const auto faults = [](std::string_view ends,
                         std::string_view number = "cilium.segment.base.young_modulus") {
    try {
      return input_faults(with_inputs(range(number, ends)));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_THAT(faults("[\"0.12 MPa\", \"0.08 MPa\"]"), HasSubstr("the ends of a range must rise"));
  EXPECT_THAT(faults("[\"0.12 MPa\", \"0.2 MPa\"]"),
              HasSubstr("'cilium.segment.base.young_modulus' lies outside the range"));
  EXPECT_THAT(faults("[\"0.08 mm\", \"0.2 MPa\"]"), HasSubstr("'mm' is not a unit of a pressure"));
  EXPECT_THAT(faults("[0.1, \"x\"]", "cilium.segment.base.poisson_ratio"),
              HasSubstr("'x' is no plain number"));
  EXPECT_THAT(faults("[0.1, 0.7]", "cilium.segment.base.poisson_ratio"),
              HasSubstr("'0.7' is no value of 'cilium.segment.base.poisson_ratio'"));
  EXPECT_THAT(faults("\"0.1 MPa\""), HasSubstr("'range' is the two ends of a range"));
  EXPECT_THAT(faults("[0.4, 0.495]\nuncertainty = 0.01", "cilium.segment.base.poisson_ratio"),
              HasSubstr("leave out one of the two"));
}

TEST(Inputs, ShiftEachStepOfALoadFromItsOwnValue) {
  const input::Case part = read(with_inputs(row("load.force", "\"10 %\"")));
  const input::Case scaled = shifted(part, read_inputs(part).front(), 1);
  const input::Case whole = read(with_inputs(row("load.force", "\"0.1 mN\"")));
  const input::Case moved = shifted(whole, read_inputs(whole).front(), 1);
  for (std::size_t i = 0; i < 3; ++i) {
    const double force = magnitude(part.load_path[i]);
    EXPECT_DOUBLE_EQ(magnitude(scaled.load_path[i]), 1.1 * force);
    EXPECT_DOUBLE_EQ(magnitude(moved.load_path[i]), force + 1e-4);
    EXPECT_EQ(contact_height(scaled.load_path[i]), 16e-3);
  }
}

TEST(Inputs, ShiftAPathOfFieldsAndItsStepWithoutAField) {
  std::string text = replaced(
      good_case,
      good_case.substr(good_case.find("[load]"),
                       good_case.find("[sensor]") - good_case.find("[load]")),
      "[environment]\nuniform_field = [[\"0 mT\", \"0 mT\", \"0 mT\"], [\"2 mT\", \"0 mT\", \"1 "
      "mT\"]]\n");
  text = replaced(text, "\"elastica\", \"beam\", \"solid\"", "\"elastica\"");
  text = replaced(text, ", \"mesh\"", "");
  const input::Case c = read(with_inputs(row("environment.uniform_field.x", "\"5 %\""), text));
  const input::Case scaled = shifted(c, read_inputs(c).front(), 1);
  EXPECT_EQ(scaled.load_path[0].environment().uniform_field, Vector3::Zero());
  EXPECT_LT((scaled.load_path[1].environment().uniform_field - Vector3(2.1e-3, 0, 1e-3)).norm(),
            1e-18);
  const input::Case o = read(with_inputs(row("environment.uniform_field.x", "\"50 uT\""), text));
  const input::Case moved = shifted(o, read_inputs(o).front(), -1);
  EXPECT_DOUBLE_EQ(moved.load_path[0].environment().uniform_field.x(), -50e-6);
  EXPECT_DOUBLE_EQ(moved.load_path[1].environment().uniform_field.x(), 1.95e-3);
}

TEST(Inputs, ShiftAFlowByItsVelocity) {
  const std::string text = replaced(replaced(good_case, "type = \"contact\"", "type = \"flow\""),
                                    "force = [\"1 mN\", \"2 mN\", \"4 mN\"]\nheight = \"16 mm\"",
                                    "velocity = [\"0.5 m/s\", \"1 m/s\"]");
  const input::Case c = read(with_inputs(row("load.velocity", "\"10 %\""), text));
  const input::Case moved = shifted(c, read_inputs(c).front(), 1);
  for (std::size_t i = 0; i < 2; ++i)  // q ~ v²
    EXPECT_NEAR(magnitude(moved.load_path[i]) / magnitude(c.load_path[i]), 1.21, 1e-12);
}

TEST(Inputs, KeepASectionAtTheSegmentsEnd) {
  const std::string text =
      replaced(replaced(good_case, "type = \"contact\"", "type = \"section\""),
               "height = \"16 mm\"", "arclength = [\"20 mm\", \"3 mm\", \"10 mm\"]");
  const input::Case c = read(with_inputs(row("cilium.segment.base.length", "\"0.2 mm\""), text));
  for (const double t : {-1.0, 1.0}) {
    const input::Case moved = shifted(c, read_inputs(c).front(), t);
    EXPECT_DOUBLE_EQ(loaded_arclength(moved.load_path[0]).value(), 20e-3 + t * 0.2e-3);
    EXPECT_DOUBLE_EQ(loaded_arclength(moved.load_path[1]).value(), 3e-3 + t * 0.2e-3);
    EXPECT_DOUBLE_EQ(loaded_arclength(moved.load_path[2]).value(), 10e-3);
  }
}

TEST(Inputs, AreShiftedWithinTheirRange) {
  const input::Case c = read(with_inputs(row("cilium.segment.base.poisson_ratio", "0.2")));
  const Input input = read_inputs(c).front();
  EXPECT_LT(input.step, 0.1);
  EXPECT_LT(shifted(c, input, input.step).cilium.segments[0].poisson_ratio, 0.5);
}

TEST(BadInputs, AreRefusedWithTheirPlace) {
  const auto faults = [](std::string_view number, std::string_view uncertainty) {
    return input_faults(with_inputs(row(number, uncertainty)));
  };
  const std::string of_number = "bad.toml:52:10: [[input_uncertainty]] number: ";
  const std::string of_value = "bad.toml:53:15: [[input_uncertainty]] uncertainty: ";
  const std::string unknown = faults("cilium.segment.bose.young_modulus", "\"1 %\"");
  EXPECT_THAT(unknown, StartsWith(of_number + "the case has no number "
                                              "'cilium.segment.bose.young_modulus'"));
  EXPECT_THAT(unknown, HasSubstr("did you mean 'cilium.segment.base.young_modulus'?"));
  EXPECT_THAT(faults("models.solid.kernel_width", "\"1 %\""),
              StartsWith(of_number + "'models.solid.kernel_width' is an option of a model"));
  EXPECT_THAT(faults("cilium.diameter", "0.1"),
              StartsWith(of_value + "'cilium.diameter' is a length: write the uncertainty with its "
                                    "unit, as in \"3 mm\", or a part of it, \"2 %\""));
  EXPECT_THAT(faults("cilium.diameter", "\"0.1 mT\""), StartsWith(of_value));
  EXPECT_THAT(faults("cilium.diameter", "\"0.1\""), HasSubstr("no unit"));
  EXPECT_THAT(faults("cilium.segment.base.poisson_ratio", "\"0.1\""),
              StartsWith(of_value + "'cilium.segment.base.poisson_ratio' is a plain number: write "
                                    "a number without quotes"));
  EXPECT_THAT(faults("cilium.diameter", "\"-1 %\""),
              StartsWith(of_value + "the standard uncertainty must be more than zero"));
  EXPECT_THAT(faults("cilium.diameter", "\"0 mm\""), HasSubstr("more than zero"));
  EXPECT_THAT(faults("cilium.segment.base.magnetization", "\"1 %\""),
              StartsWith(of_value + "a part of zero is zero"));
  const std::string twice = input_faults(
      with_inputs(row("cilium.diameter", "\"1 %\"") + row("cilium.aspect_ratio", "\"1 %\"")));
  EXPECT_THAT(twice, StartsWith("bad.toml:55:10: [[input_uncertainty]] number: "
                                "'cilium.aspect_ratio' is set by 'cilium.diameter' already"));
}

TEST(BadInputs, AtTheEndOfARangeCannotBeShifted) {
  const std::string text = replaced(good_case, "\"1 mN\", ", "\"0 mN\", ");
  EXPECT_THAT(input_faults(with_inputs(row("load.force", "\"0.1 mN\""), text)),
              HasSubstr("'load.force' stands at the end of its range"));
  EXPECT_EQ(input_faults(with_inputs(row("load.force", "\"1 %\""), text)), "");
}

}  // namespace
}  // namespace ciliaval::compare::validation

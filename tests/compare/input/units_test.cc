// SPDX-License-Identifier: LGPL-2.1-or-later
// Oracle: the definitions of the units (SI brochure; international pound-force and inch), written
// out as decimal literals, which the compiler rounds correctly.
#include "compare/input/units.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <random>
#include <string_view>

#include "problem/error.h"

namespace ciliaval::compare {
namespace {

TEST(Units, MultiplesOfTheSiUnitAreReadToTheLastBit) {
  EXPECT_EQ(input::parse_quantity("3 mm", quantity::length), 0.003);
  EXPECT_EQ(input::parse_quantity("17 mm", quantity::length), 0.017);
  EXPECT_EQ(input::parse_quantity("-1.55 mm", quantity::length), -0.00155);
  EXPECT_EQ(input::parse_quantity("5 um", quantity::length), 5e-6);
  EXPECT_EQ(input::parse_quantity("0.7 nm", quantity::length), 0.7e-9);
  EXPECT_EQ(input::parse_quantity("2 cm", quantity::length), 0.02);
  EXPECT_EQ(input::parse_quantity("0.1 MPa", quantity::pressure), 1e5);
  EXPECT_EQ(input::parse_quantity("75 kA/m", quantity::magnetization), 75000.0);
  EXPECT_EQ(input::parse_quantity("1 mN", quantity::force), 1e-3);
  EXPECT_EQ(input::parse_quantity("0.375 N/m", quantity::force_per_length), 0.375);
  EXPECT_EQ(input::parse_quantity("10 cm/s", quantity::velocity), 0.1);
  EXPECT_EQ(input::parse_quantity("1000 kg/m^3", quantity::density), 1000.0);
  EXPECT_EQ(input::parse_quantity("1.5 rad", quantity::angle), 1.5);
}

TEST(Units, EveryWholeNumberOfMillimetresIsTheNearestDouble) {
  for (int n = 1; n <= 2000; ++n)
    EXPECT_EQ(input::parse_quantity(std::to_string(n) + " mm", quantity::length),
              std::stod(std::to_string(n) + "e-3"));
}

TEST(Units, DegIsADegree) {
  // One rounding of pi/180 and one of the product: 2 units in the last place.
  EXPECT_NEAR(input::parse_quantity("30 deg", quantity::angle), std::numbers::pi / 6, 2.3e-16);
  EXPECT_EQ(input::parse_quantity("30 deg", quantity::angle),
            input::parse_quantity("30 degree", quantity::angle));
  EXPECT_EQ(input::parse_quantity("30deg", quantity::angle),
            input::parse_quantity("30 deg", quantity::angle));
  EXPECT_EQ(input::parse_quantity("30 °", quantity::angle),
            input::parse_quantity("30 deg", quantity::angle));
}

TEST(Units, OtherWritingsOfTheSameUnitAreRead) {
  EXPECT_EQ(input::parse_quantity("  3mm ", quantity::length), 0.003);
  EXPECT_EQ(input::parse_quantity("+3 mm", quantity::length), 0.003);
  EXPECT_EQ(input::parse_quantity("3e0 mm", quantity::length), 0.003);
  EXPECT_EQ(input::parse_quantity("3. mm", quantity::length), 0.003);
  EXPECT_EQ(input::parse_quantity(".3 cm", quantity::length), 0.003);
  EXPECT_EQ(input::parse_quantity("5 µm", quantity::length), 5e-6);
  EXPECT_EQ(input::parse_quantity("1000 kg m-3", quantity::density), 1000.0);
  EXPECT_EQ(input::parse_quantity("1000 kg/m3", quantity::density), 1000.0);
  EXPECT_EQ(input::parse_quantity("1000 kg.m^-3", quantity::density), 1000.0);
  EXPECT_EQ(input::parse_quantity("1 g/cm^3", quantity::density), 1000.0);
  EXPECT_EQ(input::parse_quantity("2 kg m s-2", quantity::force), 2.0);
  EXPECT_EQ(input::parse_quantity("0.1 N/mm^2", quantity::pressure), 1e5);
  EXPECT_EQ(input::parse_quantity("0.1 N/(mm mm)", quantity::pressure), 1e5);
  EXPECT_EQ(input::parse_quantity("0.1 N/mm**2", quantity::pressure), 1e5);
  EXPECT_EQ(input::parse_quantity("0.1 N/mm²", quantity::pressure), 1e5);
}

TEST(Units, UnitsOutsideTheSiKeepTheirDefinition) {
  // 1 inch = 25.4 mm; 1 lbf = 0.45359237 kg × 9.80665 m/s². UDUNITS has them to 1e-13 or better.
  EXPECT_NEAR(input::parse_quantity("1 inch", quantity::length), 0.0254, 1e-17);
  EXPECT_NEAR(input::parse_quantity("1 lbf", quantity::force), 0.45359237 * 9.80665, 1e-12);
  EXPECT_NEAR(input::parse_quantity("1 psi", quantity::pressure),
              0.45359237 * 9.80665 / (0.0254 * 0.0254), 1e-8);
  // 1 Oe = 1000/(4π) A/m; UDUNITS rounds it to seven digits.
  EXPECT_NEAR(input::parse_quantity("1 Oe", quantity::magnetization), 1000 / (4 * std::numbers::pi),
              1e-5);
}

TEST(Units, UnderscoresBelongToNames) {
  // 1 kgf = 9.80665 N (CGPM 1901), 1 at = 1 kgf/cm², 1 mmHg = 133.322 Pa.
  EXPECT_NEAR(input::parse_quantity("1 gram_force", quantity::force), 9.80665e-3, 1e-16);
  EXPECT_NEAR(input::parse_quantity("1 kilogram_force", quantity::force), 9.80665, 1e-13);
  EXPECT_NEAR(input::parse_quantity("1 technical_atmosphere", quantity::pressure), 98066.5, 1e-9);
  EXPECT_NEAR(input::parse_quantity("1 international_inch", quantity::length), 0.0254, 1e-17);
  EXPECT_NEAR(input::parse_quantity("180 arc_degree", quantity::angle), std::numbers::pi, 1e-15);
  EXPECT_NEAR(input::parse_quantity("1 mm_Hg", quantity::pressure), 133.322, 1e-3);
}

TEST(Units, TypesettersBlanksMinusAndSuperscriptsAreRead) {
  EXPECT_EQ(input::parse_quantity("3\u00A0mm", quantity::length), 0.003);
  EXPECT_EQ(input::parse_quantity("3\u202Fmm", quantity::length), 0.003);
  EXPECT_EQ(input::parse_quantity("\u00A03\u2009mm\u00A0", quantity::length), 0.003);
  EXPECT_EQ(input::parse_quantity("\u22123 mm", quantity::length), -0.003);
  EXPECT_EQ(input::parse_quantity("2 kg m s⁻²", quantity::force), 2.0);
  EXPECT_EQ(input::parse_quantity("2 kg·m·s\u22122", quantity::force), 2.0);
  EXPECT_EQ(input::parse_quantity("2 kg\u202Fm⁻³", quantity::density), 2.0);
  EXPECT_EQ(input::parse_quantity("2e6 N (m⁻¹)²", quantity::pressure), 2e6);
  EXPECT_EQ(input::parse_quantity("2 m⁺¹", quantity::length), 2.0);
}

/// A text, what it is, and its value by the definitions of the units.
struct GoodText {
  std::string_view text;
  Quantity quantity;
  double value;
};

// 1 G = 1e-4 T; 1 emu = 1 erg/G = 1e-3 A m²; 1 Oe = 1000/(4π) A/m, which UDUNITS rounds to seven
// digits; 1 gf = 9.80665e-3 N; 1 dyn = 1e-5 N; 1 lbf = 4.4482216152605 N.
TEST(Units, OfTheLaboratoryAreKnownEverywhere) {
  constexpr double oersted = 1000 / (4 * std::numbers::pi);
  constexpr double psi = 4.4482216152605 / (0.0254 * 0.0254);
  for (const auto& [text, quantity, value] :
       std::initializer_list<GoodText>{{"1 G", quantity::flux_density, 1e-4},
                                       {"1 Gs", quantity::flux_density, 1e-4},
                                       {"1 gauss", quantity::flux_density, 1e-4},
                                       {"1 Gauss", quantity::flux_density, 1e-4},
                                       {"1 mG", quantity::flux_density, 1e-7},
                                       {"1 mGs", quantity::flux_density, 1e-7},
                                       {"1 mGauss", quantity::flux_density, 1e-7},
                                       {"1 uG", quantity::flux_density, 1e-10},
                                       {"1 µG", quantity::flux_density, 1e-10},
                                       {"1 kG", quantity::flux_density, 0.1},
                                       {"1 mt", quantity::flux_density, 1e-3},
                                       {"1 ut", quantity::flux_density, 1e-6},
                                       {"1 µt", quantity::flux_density, 1e-6},
                                       {"1 MicroTesla", quantity::flux_density, 1e-6},
                                       {"1 gamma", quantity::flux_density, 1e-9},
                                       {"1 Wb/m2", quantity::flux_density, 1},
                                       {"1 V s/m2", quantity::flux_density, 1},
                                       {"1 emu/cm^3", quantity::magnetization, 1e3},
                                       {"1 emu/cm3", quantity::magnetization, 1e3},
                                       {"1 emu/cm³", quantity::magnetization, 1e3},
                                       {"1 emu/cc", quantity::magnetization, 1e3},
                                       {"1 memu/cc", quantity::magnetization, 1},
                                       {"1 Oe", quantity::magnetization, oersted},
                                       {"1 kOe", quantity::magnetization, 1e3 * oersted},
                                       {"1 A/mm", quantity::magnetization, 1e3},
                                       {"1 A/cm", quantity::magnetization, 1e2},
                                       {"1 kA·m⁻¹", quantity::magnetization, 1e3},
                                       {"1 kA m-1", quantity::magnetization, 1e3},
                                       {"1 kA / m", quantity::magnetization, 1e3},
                                       {"1 gf", quantity::force, 9.80665e-3},
                                       {"1 mgf", quantity::force, 9.80665e-6},
                                       {"1 kgf", quantity::force, 9.80665},
                                       {"1 gram_force", quantity::force, 9.80665e-3},
                                       {"1 pond", quantity::force, 9.80665e-3},
                                       {"1 ozf", quantity::force, 4.4482216152605 / 16},
                                       {"1 dyn", quantity::force, 1e-5},
                                       {"1 dyne", quantity::force, 1e-5},
                                       {"1 kg m/s2", quantity::force, 1},
                                       {"1 psi", quantity::pressure, psi},
                                       {"1 ksi", quantity::pressure, 1e3 * psi},
                                       {"1 kgf/cm2", quantity::pressure, 98066.5},
                                       {"1 at", quantity::pressure, 98066.5},
                                       {"1 atm", quantity::pressure, 101325},
                                       {"1 bar", quantity::pressure, 1e5},
                                       {"1 dyn/cm2", quantity::pressure, 0.1},
                                       {"1 N/mm2", quantity::pressure, 1e6},
                                       {"1 in", quantity::length, 0.0254},
                                       {"1 mil", quantity::length, 25.4e-6},
                                       {"1 micron", quantity::length, 1e-6},
                                       {"1 millimetres", quantity::length, 1e-3},
                                       {"1 msec", quantity::time, 1e-3},
                                       {"1 usec", quantity::time, 1e-6},
                                       {"1 sec", quantity::time, 1}}) {
    EXPECT_NEAR(input::parse_quantity(text, quantity), value, 3e-7 * value) << text;
  }
}

struct BadText {
  std::string_view text;
  Quantity expected;
  std::string_view message;
};

void PrintTo(const BadText& bad, std::ostream* out) {
  *out << input::in_quotes(bad.text) << " as " << bad.expected.name;
}

class BadQuantity : public testing::TestWithParam<BadText> {};

TEST_P(BadQuantity, IsRefusedWithTheReason) {
  const BadText& bad = GetParam();
  try {
    const double value = input::parse_quantity(bad.text, bad.expected);
    FAIL() << '"' << bad.text << "\" was read as " << value;
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(bad.message)) << bad.text;
  }
}

constexpr std::string_view no_number = "does not start with a finite number";
constexpr std::string_view thousands = "has a mark between its thousands";
constexpr std::string_view no_product = "is not a product of units with small exponents";

INSTANTIATE_TEST_SUITE_P(
    Table, BadQuantity,
    testing::Values(
        BadText{"", quantity::length, "the text is empty: write a length, such as \"3 mm\""},
        BadText{"   ", quantity::length, "the text is empty"},
        BadText{"mm", quantity::length, no_number}, BadText{"nan mm", quantity::length, no_number},
        BadText{"inf mm", quantity::length, no_number},
        BadText{"-inf mm", quantity::length, no_number},
        BadText{"+-3 mm", quantity::length, no_number},
        BadText{"--3 mm", quantity::length, no_number},
        BadText{". mm", quantity::length, no_number},
        BadText{"three mm", quantity::length, no_number},
        BadText{"1e400 mm", quantity::length, "outside the range of double precision"},
        BadText{"1e-400 mm", quantity::length, "outside the range of double precision"},
        BadText{"1.7e308 km", quantity::length, "is not finite in m"},
        BadText{"3", quantity::length, "has no unit"},
        BadText{"0", quantity::force, "has no unit: write a force, such as \"1 mN\""},
        BadText{"30", quantity::angle, "has no unit: write an angle, such as \"30 deg\""},
        BadText{"0,5 mm", quantity::length, "has a comma: write the decimal point"},
        BadText{"0x10 mm", quantity::length, "unknown unit 'x10 mm'"},
        BadText{"1_000 mm", quantity::length, thousands},
        BadText{"1 000 mm", quantity::length, thousands},
        BadText{"75\u202F000 A/m", quantity::magnetization, thousands},
        BadText{"75'000 A/m", quantity::magnetization, thousands},
        BadText{"75,000 A/m", quantity::magnetization, "nothing between thousands"},
        BadText{"3 mm 2", quantity::length, no_product},
        BadText{"3 mm.2", quantity::length, no_product},
        BadText{"3 1", quantity::angle, no_product},
        BadText{"3 m @ 3", quantity::length, no_product},
        BadText{"3 m since 1", quantity::length, no_product},
        BadText{"3 m from 2", quantity::length, no_product},
        BadText{"3 m^400", quantity::length, no_product},
        BadText{"3 s since 2000-01-01", quantity::length, no_product},
        BadText{"3 degC", quantity::length, "'degC' is not a unit of a length"},
        BadText{"3 lg(re mW)", quantity::length, no_product},
        BadText{"3 mmm", quantity::length, "unknown unit 'mmm'"},
        BadText{"3 m/", quantity::length, no_product},
        BadText{"3 (m", quantity::length, no_product},
        BadText{"3 mm; rm", quantity::length, no_product},
        BadText{"3 N", quantity::length, "'N' is not a unit of a length: write a length, such as"},
        BadText{"3 mm", quantity::force, "'mm' is not a unit of a force: write a force, such as"},
        // UDUNITS converts a unit into its reciprocal and takes a radian for a plain number.
        BadText{"5 m-1", quantity::length, "'m-1' is not a unit of a length"},
        BadText{"5 /m", quantity::length, no_product},
        BadText{"5 m rad", quantity::length, "'m rad' is not a unit of a length"},
        BadText{"5 rad rad", quantity::angle, "'rad rad' is not a unit of an angle"},
        BadText{"3 milimeter", quantity::length, "did you mean 'millimeter'?"},
        BadText{"3 Centimetrs", quantity::length, "did you mean 'centimetre'?"},
        BadText{"3 MM", quantity::length,
                "unknown unit 'MM': write a length, such as \"3 mm\"; did "
                "you mean 'mm'?"},
        BadText{"3 mn", quantity::force, "did you mean 'mN'?"},
        BadText{"3 Deg", quantity::angle, "did you mean 'deg'?"},
        BadText{"3 mpA", quantity::pressure, "did you mean 'MPa'?"},
        BadText{"3 KA/m", quantity::magnetization, "did you mean 'kA/m'?"},
        BadText{"1_00 mm", quantity::length, no_product},
        BadText{"10⁻³ m", quantity::length, no_product},
        BadText{"3 m^²", quantity::length, no_product},
        BadText{"3 m⁻", quantity::length, no_product},
        BadText{"\u2212\u22123 m", quantity::length, no_number},
        // M = B_r/μ0: 0.1 T / (4π·1e-7 N/A²) = 79577.5 A/m; 1 G = 1e-4 T.
        BadText{"0.1 T", quantity::magnetization,
                "magnetization is B_r/mu_0: 0.1 T is 79.58 kA/m: write that"},
        BadText{"-1000 gauss", quantity::magnetization, "-0.1 T is -79.58 kA/m"},
        BadText{"942 G", quantity::magnetization, "0.0942 T is 74.96 kA/m: write that"},
        BadText{"94.2 mT", quantity::magnetization, "0.0942 T is 74.96 kA/m: write that"},
        BadText{"12 emu/g", quantity::magnetization,
                "times the magnet's density, 12 A m2/kg times kg/m^3"},
        // The reverse: 75 kA/m · μ0 = 94.248 mT; 50 Oe = 3978.9 A/m, 5 mT.
        BadText{"75 kA/m", quantity::flux_density, "75 kA/m is 94.25 mT: write that"},
        BadText{"75 emu/cc", quantity::flux_density, "75 kA/m is 94.25 mT: write that"},
        BadText{"50 Oe", quantity::flux_density, "3.979 kA/m is 5 mT: write that"},
        // 0.2 g · 9.80665 m/s² = 1.96133 mN.
        BadText{"0.2 g", quantity::force, "the weight of 0.2 g is 1.961 mN: write that"},
        BadText{"10 Gs", quantity::time, "'Gs' is not a unit of a time"},
        BadText{"50 Shore A", quantity::pressure, "is a hardness, which fixes no modulus"},
        BadText{"Shore 00-30", quantity::pressure, "is a hardness, which fixes no modulus"},
        BadText{"0.63\"", quantity::length, "did you mean 'inch'?"},
        BadText{"16 degC", quantity::length, "'degC' is not a unit of a length"},
        BadText{"0.1 MPA", quantity::pressure, "did you mean 'MPa'?"},
        BadText{"2 Mn", quantity::force, "did you mean 'mN'?"},
        BadText{"2 mN\u00B7m", quantity::force, "is not a unit of a force"},
        BadText{"2 %", quantity::force, "'%' is not a unit of a force"},
        BadText{"5 %", quantity::angle, "'%' is not a unit of an angle"},
        BadText{"0.1 T", quantity::magnetization, "'T' is not a unit of a magnetization"},
        BadText{"1 N m", quantity::force, "'N m' is not a unit of a force"},
        BadText{std::string_view("3 m\0m", 5), quantity::length, "has a control character"},
        BadText{"3 m\n", quantity::length, "has a control character"},
        BadText{"3 mmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmm",
                quantity::length, "is too long to be one"}));

TEST(Units, NothingIsWrittenToTheErrorStreamByUdunits) {
  testing::internal::CaptureStderr();
  EXPECT_THROW(input::parse_quantity("3 nonsense", quantity::length), InputError);
  EXPECT_THROW(input::parse_quantity("3 degC", quantity::length), InputError);
  EXPECT_THROW(input::parse_quantity("3 ((", quantity::length), InputError);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Units, NoUnitIsProposedWhereNoneIsNear) {
  for (const char* text : {"3 mmm", "3 nonsense", "3 N", "3 x"}) {
    try {
      input::parse_quantity(text, quantity::length);
      FAIL() << text;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr("did you mean"))) << text;
    }
  }
}

TEST(Units, WhatIsWrittenReadsBackAsTheSameDouble) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(-12, 12);
  for (const Quantity& q :
       {quantity::length, quantity::pressure, quantity::magnetization, quantity::force,
        quantity::force_per_length, quantity::velocity, quantity::density, quantity::angle}) {
    for (int i = 0; i < 200; ++i) {
      const double value = std::pow(10, exponent(random)) * (i % 2 == 0 ? 1 : -1);
      EXPECT_EQ(input::parse_quantity(input::format_quantity(value, q), q), value) << q.name;
    }
    EXPECT_EQ(input::parse_quantity(input::format_quantity(0.0, q), q), 0.0) << q.name;
  }
  EXPECT_EQ(input::format_quantity(0.003, quantity::length), "0.003 m");
  EXPECT_EQ(input::format_quantity(0.49, quantity::number), "0.49");
  EXPECT_EQ(input::format_number(1.0 / 3), "0.3333333333333333");
}

TEST(Units, MessagesCannotControlATerminal) {
  EXPECT_EQ(input::in_quotes("a\x1b[2J\n"), "'a\\x1B[2J\\x0A'");
  EXPECT_EQ(input::in_quotes(std::string(100, 'x')), "'" + std::string(60, 'x') + "...'");
}

}  // namespace
}  // namespace ciliaval::compare

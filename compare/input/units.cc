// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/units.h"

#include <fmt/format.h>
#include <udunits2.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include "problem/error.h"
#include "problem/field_model.h"
#include "problem/support/words.h"

namespace ciliaval::compare::input {
namespace {

constexpr std::string_view blanks = " \t";
constexpr std::size_t longest_unit = 64;      ///< bytes; UDUNITS' parser is not asked to read more
constexpr std::size_t longest_exponent = 2;   ///< digits
constexpr double standard_gravity = 9.80665;  ///< m/s², of the gram-force (CGPM 1901)

struct FreeUnit {
  void operator()(ut_unit* unit) const { ut_free(unit); }
};
using Unit = std::unique_ptr<ut_unit, FreeUnit>;

/// Symbols that UDUNITS does not know, or reads otherwise ("Gs": a gigasecond). They take its
/// prefixes, so that "mG" is a milligauss. emu: the magnetic moment of the CGS, erg/G.
struct Symbol {
  const char* name;
  const char* definition;
};
constexpr Symbol added_symbols[]{{"G", "gauss"},       {"Gs", "gauss"}, {"emu", "1e-3 A m2"},
                                 {"cc", "cm3"},        {"dyn", "dyne"}, {"gf", "gram_force"},
                                 {"deg", "arc_degree"}};

ut_system* unit_system() {
  static ut_system* const system = [] {
    ut_set_error_message_handler(ut_ignore);       // UDUNITS would write to stderr
    ut_system* const read = ut_read_xml(nullptr);  // lives as long as the program
    if (read != nullptr)
      for (const Symbol& symbol : added_symbols)
        ut_map_symbol_to_unit(symbol.name, UT_UTF8,
                              Unit(ut_parse(read, symbol.definition, UT_UTF8)).get());
    return read;
  }();
  if (system == nullptr)
    throw FileError(
        "the units' database of UDUNITS-2 cannot be read; is it installed, and does the "
        "environment variable UDUNITS2_XML_PATH, if set, name it?");
  return system;
}

/// A letter of a unit's name; '_', '%' and bytes of UTF-8 sequences (µ, Ω, °, ²) count as such.
bool is_unit_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '%' ||
         static_cast<unsigned char>(c) >= 0x80;
}

/// A character beyond ASCII and what is read in its place.
struct Spelling {
  std::string_view written;
  std::string_view read;
};
constexpr Spelling spellings[]{{"\u00A0", " "}, {"\u2009", " "}, {"\u202F", " "}, {"\u2212", "-"}};
constexpr Spelling superscripts[]{{"⁺", "+"}, {"⁻", "-"}, {"⁰", "0"}, {"¹", "1"},
                                  {"²", "2"}, {"³", "3"}, {"⁴", "4"}, {"⁵", "5"},
                                  {"⁶", "6"}, {"⁷", "7"}, {"⁸", "8"}, {"⁹", "9"}};

/// The spelling that the text starts with, or null.
const Spelling* at_start(std::string_view text, std::span<const Spelling> all) {
  for (const Spelling& spelling : all)
    if (text.starts_with(spelling.written)) return &spelling;
  return nullptr;
}

/// The text with the blanks of typesetters and the minus sign as those of ASCII, and exponents in
/// superscript as ^-2.
std::string in_ascii(std::string_view text) {
  std::string result;
  for (bool raised = false; !text.empty();) {
    const Spelling* const superscript = at_start(text, superscripts);
    const Spelling* const other = at_start(text, spellings);
    if (superscript != nullptr && !raised) result += '^';
    raised = superscript != nullptr;
    const Spelling* const spelling = superscript != nullptr ? superscript : other;
    result += spelling != nullptr ? spelling->read : text.substr(0, 1);
    text.remove_prefix(spelling != nullptr ? spelling->written.size() : 1);
  }
  return result;
}

/// True if the text contains a word in lower case, in any case.
bool holds_word(std::string_view text, std::string_view word) {
  return std::ranges::search(text, word, [](char a, char b) {
           return std::tolower(static_cast<unsigned char>(a)) == b;
         }).begin() != text.end();
}

std::string wanted(const Quantity& expected) {
  return fmt::format("write {} {}, such as \"{}\"", expected.article, expected.name,
                     expected.example);
}

/// Reads a unit from left to right.
struct UnitReader {
  std::string_view rest;

  char next() const { return rest.empty() ? '\0' : rest.front(); }
  bool take(char c) {
    if (next() != c) return false;
    rest.remove_prefix(1);
    return true;
  }
  std::size_t take_all(bool (*kind)(char)) {
    std::size_t count = 0;
    for (; !rest.empty() && kind(rest.front()); rest.remove_prefix(1)) ++count;
    return count;
  }
  std::string_view take_name() {
    const std::string_view before = rest;
    if (next() == '_') return {};  // the rest of a number such as 1_000
    return before.substr(0, take_all(is_unit_letter));
  }
  /// Nothing, "2", "-2", "^2", "^-2" or "**-2". Returns whether that is so.
  bool take_exponent() {
    const bool raised = take('^') || (rest.starts_with("**") && take('*') && take('*'));
    const bool is_signed = take('-') || take('+');
    const std::size_t digits = take_all(is_digit);
    return digits <= longest_exponent && (digits > 0 || (!raised && !is_signed));
  }
  /// Blanks, '.', '*' or '/', blanks. Returns whether there was any.
  bool take_separator() {
    const std::size_t before = rest.size();
    const auto blank = [](char c) { return blanks.find(c) != std::string_view::npos; };
    take_all(blank);
    if (next() == '.' || next() == '*' || next() == '/') rest.remove_prefix(1);
    take_all(blank);
    return rest.size() != before;
  }
};

/// Words that make an offset of what follows.
bool is_offset_word(std::string_view name) {
  return name == "since" || name == "after" || name == "from" || name == "ref";
}

/// True if the unit is a product or quotient of names with small exponents, as "kg m s^-2" or
/// "N/(mm s)". Other units that UDUNITS reads (factors as in "3 mm 2", offsets as in "m @ 3",
/// logarithms) are mistakes of the file, and on some of them its parser leaks memory.
bool is_product_of_names(std::string_view unit) {
  UnitReader reader{unit};
  int open = 0;
  while (true) {
    while (reader.take('(')) ++open;
    const std::string_view name = reader.take_name();
    if (name.empty() || is_offset_word(name) || !reader.take_exponent()) return false;
    while (open > 0 && reader.take(')')) {
      --open;
      if (!reader.take_exponent()) return false;
    }
    if (reader.rest.empty()) return open == 0;
    if (!reader.take_separator()) return false;
  }
}

/// Units that a person may mean to write, for advice.
std::span<const std::string_view> usual_units(const Quantity& expected) {
  using Names = std::vector<std::string_view>;
  static const std::vector<std::pair<std::string_view, Names>> all{
      {"m",
       {"m", "mm", "cm", "um", "nm", "km", "meter", "millimeter", "centimeter", "micrometer",
        "nanometer", "metre", "millimetre", "centimetre", "micrometre", "nanometre", "inch"}},
      {"Pa",
       {"Pa", "MPa", "kPa", "GPa", "pascal", "kilopascal", "megapascal", "gigapascal", "N/m^2",
        "N/mm^2", "bar", "psi"}},
      {"A/m", {"A/m", "kA/m", "MA/m", "A/mm", "emu/cc", "Oe", "kOe", "oersted"}},
      {"T", {"T", "mT", "uT", "nT", "G", "mG", "kG", "tesla", "millitesla", "microtesla", "gauss"}},
      {"N", {"N", "mN", "uN", "kN", "newton", "millinewton", "micronewton", "lbf", "kgf"}},
      {"N/m", {"N/m", "mN/m", "uN/m", "kN/m", "N/mm", "mN/mm"}},
      {"N m", {"N m", "N.m", "mN m", "uN m", "nN m", "N mm", "mN mm", "uN mm"}},
      {"m/s", {"m/s", "mm/s", "cm/s", "km/h"}},
      {"kg/m^3", {"kg/m^3", "kg/m3", "g/cm^3", "g/cm3"}},
      {"rad", {"deg", "degree", "degrees", "rad", "radian", "turn"}}};
  for (const auto& [unit, names] : all)
    if (unit == expected.unit) return names;
  return {};
}

/// "; did you mean 'mN'?" for a unit that differs from a usual one by its case or, if it is a
/// longer word, by a few letters; otherwise empty.
std::string did_you_mean_unit(std::string_view unit, const Quantity& expected) {
  constexpr std::size_t longest_symbol = 3;
  for (const std::string_view usual : usual_units(expected))
    if (support::equal_but_case(unit, usual)) return fmt::format("; did you mean '{}'?", usual);
  return unit.size() > longest_symbol ? support::did_you_mean(unit, usual_units(expected)) : "";
}

/// The factor from one unit to another; none if they do not have the same dimension, or one has an
/// offset. ut_get_converter() would also turn 1/m into m, and takes radians for plain numbers: so
/// the quotient of the two units must be the factor itself.
std::optional<double> factor_between(const ut_unit* from, std::string_view to) {
  const Unit target(ut_parse(unit_system(), std::string(to).c_str(), UT_UTF8));
  const Unit quotient(ut_divide(from, target.get()));
  const Unit one(ut_get_dimensionless_unit_one(unit_system()));
  const std::unique_ptr<cv_converter, decltype(&cv_free)> converter(
      ut_get_converter(quotient.get(), one.get()), &cv_free);
  if (!converter) return std::nullopt;
  const double factor = cv_convert_double(converter.get(), 1);
  const Unit scaled(ut_scale(factor, one.get()));
  if (!scaled || ut_compare(scaled.get(), quotient.get()) != 0) return std::nullopt;
  return factor;
}

/// The value that a person means who states another quantity than the expected one; empty if that
/// is not known.
std::string converted(double value, const ut_unit* given, const Quantity& expected) {
  const auto in = [&](std::string_view unit) -> std::optional<double> {
    const auto factor = factor_between(given, unit);
    return factor ? std::optional(value * *factor) : std::nullopt;
  };
  if (expected.unit == quantity::magnetization.unit) {
    if (const auto remanence = in("T"))
      return fmt::format("magnetization is B_r/mu_0: {:.4g} T is {:.4g} kA/m: write that",
                         *remanence, *remanence / vacuum_permeability / 1000);
    if (const auto per_mass = in("A m2/kg"))
      return fmt::format(
          "it is a magnetization per mass: times the magnet's density, {:.4g} A m2/kg times "
          "kg/m^3, it is in A/m",
          *per_mass);
  }
  if (expected.unit == quantity::flux_density.unit)
    if (const auto strength = in("A/m"))
      return fmt::format("B is mu_0 M or mu_0 H: {:.4g} kA/m is {:.4g} mT: write that",
                         *strength / 1000, *strength * vacuum_permeability * 1000);
  if (expected.unit == quantity::force.unit)
    if (const auto mass = in("kg"))
      return fmt::format("a mass is no force: the weight of {:.4g} g is {:.4g} mN: write that",
                         *mass * 1000, *mass * standard_gravity * 1000);
  return {};
}

/// The unit as UDUNITS reads it. Where a flux density is due, "mt", "ut" and "nt" are no tonnes.
std::string symbol_of(std::string_view unit, const Quantity& expected) {
  std::string symbol(unit);
  if (expected.unit == quantity::flux_density.unit)
    for (const std::string_view lower : {"mt", "ut", "nt", "\u00B5t", "\u03BCt"})
      if (unit == lower) symbol.back() = 'T';
  return symbol;
}

/// The factor from the unit of a value to the SI unit of `expected`.
double factor_to_si(double value, std::string_view unit, const Quantity& expected) {
  const Unit given(ut_parse(unit_system(), symbol_of(unit, expected).c_str(), UT_UTF8));
  if (!given)
    throw InputError(fmt::format("unknown unit {}: {}{}", in_quotes(unit), wanted(expected),
                                 did_you_mean_unit(unit, expected)));
  if (const auto factor = factor_between(given.get(), expected.unit)) return *factor;
  const std::string meant = converted(value, given.get(), expected);
  throw InputError(
      fmt::format("{} is not a unit of {} {}: {}", in_quotes(unit), expected.article, expected.name,
                  meant.empty() ? wanted(expected) + did_you_mean_unit(unit, expected) : meant));
}

/// True if three digits go on behind a number where a person parts the thousands: "75 000",
/// "75'000", "75_000".
bool goes_on_by_thousands(std::string_view rest) {
  const std::size_t mark = std::min(rest.find_first_not_of(" \t'_"), rest.size());
  UnitReader reader{rest.substr(mark)};
  return mark > 0 && reader.take_all(is_digit) == 3;
}

/// The number at the start of the text, which is cut off from it.
double take_number(std::string_view& text, const Quantity& expected) {
  const std::string_view whole = text;
  if (text.starts_with('+')) text.remove_prefix(1);
  const std::size_t sign = text.starts_with('-') && text.size() == whole.size() ? 1 : 0;
  const char first = text.size() > sign ? text[sign] : ' ';
  double value = 0;
  // from_chars() reads "nan" and "inf" too.
  if (!is_digit(first) && first != '.')
    throw InputError(fmt::format("{} does not start with a finite number: {}", in_quotes(whole),
                                 wanted(expected)));
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range)
    throw InputError(
        fmt::format("the number of {} is outside the range of double precision", in_quotes(whole)));
  if (error != std::errc())
    throw InputError(fmt::format("{} does not start with a finite number: {}", in_quotes(whole),
                                 wanted(expected)));
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

}  // namespace

double parse_quantity(std::string_view text, const Quantity& expected) {
  const std::string plain = in_ascii(text);
  std::string_view rest = support::trimmed(plain);
  if (rest.empty()) throw InputError(fmt::format("the text is empty: {}", wanted(expected)));
  if (expected.unit == quantity::pressure.unit && holds_word(rest, "shore"))
    throw InputError(fmt::format(
        "{} is a hardness, which fixes no modulus: measure Young's modulus, or take it from the "
        "data sheet, and {}",
        in_quotes(text), wanted(expected)));
  const double value = take_number(rest, expected);
  if (rest.starts_with(','))
    throw InputError(
        fmt::format("{} has a comma: write the decimal point, such as \"0.5 mm\", and nothing "
                    "between thousands",
                    in_quotes(text)));
  if (goes_on_by_thousands(rest))
    throw InputError(
        fmt::format("{} has a mark between its thousands: write the digits alone, such "
                    "as \"75000 A/m\"",
                    in_quotes(text)));
  const std::string_view unit = support::trimmed(rest);
  if (unit.empty())
    throw InputError(fmt::format("{} has no unit: {}", in_quotes(text), wanted(expected)));
  for (const char c : unit)
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0)
      throw InputError(fmt::format("{} has a control character in its unit", in_quotes(text)));
  if (unit.size() > longest_unit)
    throw InputError(fmt::format("the unit of {} is too long to be one", in_quotes(text)));
  if (!is_product_of_names(unit))
    throw InputError(fmt::format(
        "the unit {} is not a product of units with small exponents, such as \"kg m "
        "s^-2\": write the number first, then the unit alone, such as \"{}\"{}",
        in_quotes(unit), expected.example, unit == "\"" ? "; did you mean 'inch'?" : ""));

  const double factor = factor_to_si(value, unit, expected);
  // Factors such as 1000 and 1/1000 come from UDUNITS with a rounding error.
  constexpr double rounding = 1e-14;
  const double divisor = std::round(1 / factor);
  const double multiple = std::round(factor);
  double result = value * factor;
  if (factor < 1 && std::abs(factor * divisor - 1) < rounding) result = value / divisor;
  if (factor > 1 && std::abs(multiple / factor - 1) < rounding) result = value * multiple;
  if (!std::isfinite(result))
    throw InputError(fmt::format("{} is not finite in {}", in_quotes(text), expected.unit));
  return result;
}

std::string format_number(double value) {
  return fmt::format("{}", value);
}

std::string format_quantity(double value, const Quantity& quantity) {
  if (quantity.unit.empty()) return format_number(value);
  return fmt::format("{} {}", format_number(value), quantity.unit);
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 60;
  // Cut between characters only: bytes 10xxxxxx continue one.
  std::size_t end = std::min(text.size(), longest);
  while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) ++end;
  return "'" + support::printable(text.substr(0, end), "") + (end < text.size() ? "...'" : "'");
}

}  // namespace ciliaval::compare::input

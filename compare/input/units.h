// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <string_view>

#include "problem/parameter.h"
#include "problem/types.h"

namespace ciliaval::compare::input {

/// The value in SI units of a text such as "3 mm", "1.5e-3 N" or "30 deg".
///
/// Number and unit are parsed apart: the number strictly (decimal point, finite), the unit by
/// UDUNITS-2 with these added: G and Gs (gauss), emu, cc, dyn, gf, deg, all with prefixes; of a
/// flux density "mt", "ut" and "nt" too. The blanks U+00A0, U+2009 and U+202F, the minus sign
/// U+2212 and superscripts as in "s⁻²" are read as their ASCII forms. Case files, options, headers
/// of readings and the Python package read their units here. Where the unit is 1/n of the SI unit
/// the number is divided by the whole number n, so that "17 mm" is exactly the double 0.017. The
/// text must have the dimension of `expected`, which must not be a plain number.
///
/// Throws InputError that names the fault and an example, for a slip such as "milimeter" or "mn"
/// the unit that was meant, and where another quantity fixes the expected one (B_r a magnetization,
/// a mass its weight) the value: no number, marks between thousands, no unit, a unit that is not a
/// product of names with exponents ("mm 2", "m @ 3", "lg(re mW)"), an unknown unit, an offset one
/// ("degC"), another dimension (also the reciprocal, which UDUNITS would convert), not finite.
/// Throws FileError if UDUNITS' database of units cannot be read. Not thread-safe, as UDUNITS is
/// not.
double parse_quantity(std::string_view text, const Quantity& expected);

/// The shortest decimal that reads back as the same double: at most 17 significant digits.
std::string format_number(double value);

/// The value with its SI unit, in full precision: parse_quantity() of it gives the same double. A
/// plain number has no unit.
std::string format_quantity(double value, const Quantity& quantity);

bool is_digit(char c);

/// The text between single quotes for a message: control characters escaped, the rest of a long
/// text cut off.
std::string in_quotes(std::string_view text);

}  // namespace ciliaval::compare::input

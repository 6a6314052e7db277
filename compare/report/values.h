// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "problem/load.h"

namespace ciliaval::compare::report {

using Json = nlohmann::ordered_json;

/// A unit that people read, and its size in SI units.
struct ShownUnit {
  std::string name;
  double size = 1;
};

/// The unit for a quantity that a file has in an SI unit: "T" as µT, "N" as mN, "T/N" as µT/mN.
ShownUnit shown_unit(const std::string& si);

/// What stands for a value that is undefined or not known.
inline constexpr const char* unknown = "–";

/// A number in a unit with so many significant digits.
std::string number(double value, double unit = 1, int digits = 5);
/// The same; `unknown` for null. Throws what nlohmann::json does if it is neither.
std::string number(const Json& value, double unit = 1, int digits = 5);
/// A number for a drawing: NaN for null.
double coordinate(const Json& value, double unit = 1);

/// The text at a key, or "" if it is missing or null.
std::string text_at(const Json& json, const char* key);

/// The value at a key, or null.
const Json& at_or_null(const Json& json, const char* key);

/// The load that summary.json states. Throws FileError if it is none.
Load load_of(const Json& json);

/// A list of all names in words: "a, b and c".
std::string in_words(const std::vector<std::string>& names);

}  // namespace ciliaval::compare::report

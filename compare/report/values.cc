// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/report/values.h"

#include <fmt/core.h>

#include <array>
#include <limits>

#include "problem/error.h"

namespace ciliaval::compare::report {

ShownUnit shown_unit(const std::string& si) {
  static const std::array<std::pair<const char*, ShownUnit>, 8> units{
      {{"T", {"µT", 1e-6}},
       {"N", {"mN", 1e-3}},
       {"m", {"mm", 1e-3}},
       {"rad", {"deg", 0.017453292519943295}},
       {"T/N", {"µT/mN", 1e-3}},
       {"T/(N/m)", {"µT/(N/m)", 1e-6}},
       {"T/m", {"µT/mm", 1e-3}},
       {"Pa", {"MPa", 1e6}}}};
  for (const auto& [name, unit] : units)
    if (si == name) return unit;
  return {si, 1};
}

std::string number(double value, double unit, int digits) {
  return fmt::format("{:.{}g}", value / unit + 0.0, digits);
}

std::string number(const Json& value, double unit, int digits) {
  return value.is_null() ? unknown : number(value.get<double>(), unit, digits);
}

double coordinate(const Json& value, double unit) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>() / unit;
}

const Json& at_or_null(const Json& json, const char* key) {
  static const Json null;
  const auto it = json.find(key);
  return it == json.end() ? null : *it;
}

std::string text_at(const Json& json, const char* key) {
  const Json& value = at_or_null(json, key);
  return value.is_null() ? std::string() : value.get<std::string>();
}

Load load_of(const Json& json) {
  const std::string name = json.at("type").get<std::string>();
  const LoadType* type = find_load_type(name);
  if (type == nullptr) throw FileError("there is no load `" + name + "`");
  std::vector<double> values;
  for (const LoadParameter& parameter : type->parameters)
    values.push_back(json.at(std::string(parameter.key.name)).get<double>());
  return Load(*type, values);
}

std::string in_words(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

}  // namespace ciliaval::compare::report

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compare/input/case.h"
#include "compare/models/registry.h"
#include "problem/error.h"

namespace ciliaval::compare {

/// A case file without a fault. The places that bad_cases_test.cc expects are its lines, from 1.
inline constexpr std::string_view good_case = R"toml([case]
name = "good"
title = "A case without a fault"

[cilium]
diameter = "3 mm"

[[cilium.segment]]
name = "base"
length = "3 mm"
young_modulus = "0.1 MPa"
poisson_ratio = 0.49

[[cilium.segment]]
name = "magnet"
length = "17 mm"
young_modulus = "3 MPa"
poisson_ratio = 0.49
magnetization = "75 kA/m"

[load]
type = "contact"
force = ["1 mN", "2 mN", "4 mN"]
height = "16 mm"
azimuth = "30 deg"

[sensor]
position = ["-0.1 mm", "0.2 mm", "-1.55 mm"]

[models]
mechanics = ["elastica", "beam", "solid"]
fields = ["dipole", "line", "volume", "mesh"]

[models.solid]
refinement = 1
)toml";

/// The text with the first occurrence of a part replaced; empty if the part does not occur.
inline std::string replaced(std::string_view text, std::string_view part, std::string_view by) {
  const std::size_t at = text.find(part);
  if (at == std::string_view::npos) return {};
  return std::string(text.substr(0, at)).append(by).append(text.substr(at + part.size()));
}

/// A list of the same text.
inline std::string repeated(std::string_view part, int count) {
  std::string list = "[";
  for (int i = 0; i < count; ++i) list.append(part).append(", ");
  return list + "]";
}

/// The good case's cilium, swept by the elastica over plateaus of 1 mm; `rest` has the keys of
/// [load] but type and interference, and further tables.
inline std::string plateau_sweep(std::string_view rest) {
  return std::string(good_case.substr(0, good_case.find("[load]")))
      .append(R"toml([models]
mechanics = ["elastica"]
fields = ["volume"]
[surface]
profile = "trapezoid"
height = "1 mm"
top = "12 mm"
bottom = "12 mm"
flank = "1 mm"
radius = "0.5 mm"
friction = 0.3
[load]
type = "sweep"
interference = "1 mm"
)toml")
      .append(rest);
}

inline std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> result(1);
  for (const char c : text) {
    if (c == '\n')
      result.emplace_back();
    else
      result.back() += c;
  }
  return result;
}

/// Every option of every model, with the model's id.
inline std::vector<std::pair<std::string, input::Option>> all_options() {
  std::vector<std::pair<std::string, input::Option>> result;
  models::known().for_each([&](const auto& entry) {
    for (const input::Option& option : entry.options) result.emplace_back(entry.id, option);
  });
  return result;
}

inline input::Case read(std::string_view text) {
  return input::read_case(text, "bad.toml", models::known());
}

/// Message on a bad case file; empty if it is read. Any other exception is let through.
inline std::string faults_of(std::string_view text) {
  try {
    read(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace ciliaval::compare

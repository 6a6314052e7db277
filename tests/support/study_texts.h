// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/synthetic.h"

namespace ciliaval::test {

/// Writes `one.toml`, the paper's cilium under 1 mN, into the folder.
inline void write_study_case(const std::filesystem::path& folder,
                             const std::string& force = "\"1 mN\"",
                             const std::string& models = "mechanics = [\"elastica\"]\n") {
  std::ofstream(folder / "one.toml") << case_text({.name = "one", .force = force}, models);
}

/// A study of `one.toml`: `header` are further lines of [study].
inline std::string study_text(const std::string& header, const std::string& rest) {
  return "[study]\nname = \"varied\"\ncase = \"one.toml\"\n" + header + "\n" + rest;
}

inline const std::string modulus_range = R"([[parameter]]
path = "cilium.segment.base.young_modulus"
name = "E1"
from = "0.1 MPa"
to = "1 MPa"
count = 5
spacing = "logarithmic"
)";

inline std::filesystem::path write_study(const std::filesystem::path& folder,
                                         const std::string& text) {
  std::filesystem::path file = folder / "varied.study.toml";
  std::ofstream(file) << text;
  return file;
}

}  // namespace ciliaval::test

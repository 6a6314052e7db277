// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace ciliaval::compare::input::external {

/// How a file of readings is to be read where it does not say so itself (docs/guide/sensing.md):
/// the options of `ciliaval sense`, or the table [readings] of a case.
struct ReadingOptions {
  struct Text {
    std::string text;   ///< empty: not given
    std::string where;  ///< for messages, "--unit" or "mine.toml:12:1: unit"
    bool given() const { return !text.empty(); }
  };
  Text map;       ///< "bx=Mag X, by=Mag Y, bz=Mag Z"
  Text unit;      ///< of columns without one: "uT", "LSB"
  Text scale;     ///< of an LSB: "0.15 uT", "6842 LSB/G", or three for x, y, z
  Text unloaded;  ///< "0 s..1 s", "rows 1..20" or "model"
};

/// The keys of [readings].
inline constexpr std::array<std::pair<std::string_view, ReadingOptions::Text ReadingOptions::*>, 4>
    reading_keys{{{"map", &ReadingOptions::map},
                  {"unit", &ReadingOptions::unit},
                  {"scale", &ReadingOptions::scale},
                  {"unloaded", &ReadingOptions::unloaded}}};

}  // namespace ciliaval::compare::input::external

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "problem/description/field.h"

namespace ciliaval::compare::input::external {

/// Options for reading a file of readings where it does not say so itself (docs/guide/sensing.md):
/// those of `ciliaval sense`, or the table [readings] of a case.
struct ReadingOptions {
  struct Text {
    std::string text;   ///< empty: not given
    std::string where;  ///< for messages, "--unit" or "mine.toml:12:1: unit"
    bool given() const { return !text.empty(); }
  };
  Text map;          ///< "bx=Mag X, by=Mag Y, bz=Mag Z"
  Text unit;         ///< of columns without one: "uT", "LSB"
  Text scale;        ///< of an LSB: "0.15 uT", "6842 LSB/G", or three for x, y, z
  Text unloaded;     ///< "0 s..1 s", "rows 1..20" or "model"
  Text average;      ///< "10 ms"
  Text temperature;  ///< "-0.1 %/K"
};

/// A key of [readings].
struct ReadingKey : description::Key {
  ReadingOptions::Text ReadingOptions::*option;
};
inline const std::array<ReadingKey, 6>& reading_keys() {
  constexpr std::size_t longest = 1000;  // a map of many sensors
  using description::text_key;
  static const std::array<ReadingKey, 6> keys{
      {{text_key("map",
                 "Of `ciliaval sense`, as its option `--map`: the columns of a file of readings "
                 "(docs/guide/sensing.md).",
                 "none", R"("bx=Ch 1, by=Ch 2, bz=Ch 3")", longest),
        &ReadingOptions::map},
       {text_key("unit", "As `--unit`: T, mT, uT, nT, G, mG or LSB, of columns that state none.",
                 "none", R"("mG")", longest),
        &ReadingOptions::unit},
       {text_key("scale",
                 "As `--scale`: the flux density of an LSB, `\"6842 LSB/G\"`, or three for x, y, "
                 "z.",
                 "none", R"("0.15 uT")", longest),
        &ReadingOptions::scale},
       {text_key("unloaded",
                 "As `--unloaded`: the readings of the straight cilium by time, `\"rows 1..20\"`, "
                 "or `\"model\"`.",
                 "none", R"("0 s..1 s")", longest),
        &ReadingOptions::unloaded},
       {text_key("average", "As `--average`: readings within so long are averaged.", "none",
                 R"("10 ms")", longest),
        &ReadingOptions::average},
       {text_key("temperature",
                 "As `--temperature`: by how much the reading of the same field grows with the "
                 "column `temperature`, against the unloaded rows.",
                 "none", R"("-0.1 %/K")", longest),
        &ReadingOptions::temperature}}};
  return keys;
}

}  // namespace ciliaval::compare::input::external

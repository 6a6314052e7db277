// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compare/input/model_entry.h"
#include "problem/parameter.h"

/// Keys and values that a case file may have, for people and editors: the table of keys in
/// docs/guide/cases.md, the JSON schema, and a file to start from.
namespace ciliaval::compare::input::schema {

struct Key {
  enum class Kind {
    text,
    file,
    files,
    choice,
    choices,  ///< a list of them
    flag,
    whole_number,
    quantity,    ///< a number with its unit, or a plain one
    quantities,  ///< or a list of them
    point,       ///< three of them
    points,      ///< or a list of such
    pair,        ///< two of them
    any          ///< a quantity of what another key says, or a percentage
  };
  std::string table;  ///< "cilium.segment"
  std::string name;
  Kind kind = Kind::text;
  std::string example{};  ///< of a text, as a file states it
  std::vector<std::string_view> choices{};
  std::string_view word{};  ///< in place of a number
  Quantity quantity = quantity::number;
  Range range{};           ///< empty: not stated
  std::string fallback{};  ///< as a file states it, or in words; empty: the key is required
  std::string doc{};
  /// The values of the table's choice with which the key goes; empty: all.
  std::vector<std::string_view> with{};
};

/// Every key, table by table.
std::vector<Key> all_keys(const Models& models);

}  // namespace ciliaval::compare::input::schema

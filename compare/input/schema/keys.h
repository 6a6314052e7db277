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

/// A key of a table, with what of it depends on other keys.
struct Key : description::Key {
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
    any,         ///< a quantity of what another key says, or a percentage
    any_pair     ///< two of them
  };
  std::string table;  ///< "cilium.segment"
  Kind kind = Kind::text;
  std::string text;  ///< the whole `doc`; a `fallback` has each key that is not required
  /// The values of the table's choice with which the key goes; empty: all.
  std::vector<std::string_view> with{};
};

/// Every key, table by table.
std::vector<Key> all_keys(const Models& models);

}  // namespace ciliaval::compare::input::schema

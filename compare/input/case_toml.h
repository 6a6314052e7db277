// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <toml++/toml.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compare/input/units.h"
#include "problem/parameter.h"

namespace ciliaval::compare::input {

/// A place in a file, from 1.
struct Place {
  std::size_t line = 1;
  std::size_t column = 1;
};
Place place(const toml::node& node);
Place place(const toml::key& key);

/// The faults found in a file, each with its place.
class Faults {
 public:
  void add(Place where, std::string what) { faults_.push_back({where, std::move(what)}); }
  std::size_t size() const { return faults_.size(); }
  bool empty() const { return faults_.empty(); }
  /// Text of the fault that was added first.
  const std::string& first() const { return faults_.front().what; }
  /// `file:line:column: what`, a line each, in the order of the file; of very many the first.
  std::string report(std::string_view file) const;

 private:
  struct Fault {
    Place where;
    std::string what;
  };
  std::vector<Fault> faults_;
};

/// "from 1e-09 m to 100 m" or "between -1 and 0.5, both excluded"; angles in deg.
std::string describe(const Range& range, const Quantity& quantity);

/// A table of a file that remembers which keys it was asked for, so that the others can be refused.
class Section {
 public:
  /// `name` as a person writes it, "[load]"; `path` dotted, "load". A null table has no keys.
  Section(const toml::table* table, std::string name, std::string path, Place where,
          Faults& faults);

  bool exists() const { return table_ != nullptr; }
  const toml::table* table() const { return table_; }
  const std::string& name() const { return name_; }
  const std::string& path() const { return path_; }
  Place where() const { return where_; }
  Faults& faults() const { return *faults_; }

  /// The key's value, or null. The key is a valid one from now on.
  const toml::node* find(std::string_view key);
  /// The same; a missing key is a fault at the table's place, which finish() adds; `needed` says
  /// what there should be, if not the key alone: "'magnetization' or 'remanence'".
  const toml::node* require(std::string_view key, std::string_view needed = {});
  /// The sub-table of this name; a value that is no table is a fault.
  Section section(std::string_view key);
  /// Reads the value of a key, if it is there and no fault.
  void read(std::string_view key, const Range& range, unsigned int& value);
  /// Calls f with each table of a list [[…]], and finishes it. A value that is no list of at least
  /// `fewest` and at most `most` tables is a fault.
  void tables(std::string_view key, std::size_t fewest, std::size_t most,
              const std::function<void(Section&)>& f);
  /// Adds a fault for each key that was not asked for (unknown) and for each
  /// that is missing, unless an unknown one looks like it.
  void finish() const;

 private:
  const toml::table* table_;
  std::string name_;
  std::string path_;
  Place where_;
  Faults* faults_;
  std::vector<std::string> valid_;
  struct Missing {
    std::string key;
    std::string needed;
  };
  std::vector<Missing> missing_;
};

/// The text of a node, or a fault.
std::optional<std::string> read_text(const toml::node& node, std::string_view name, Faults& faults);

/// A text that is one of the choices, or a fault.
std::optional<std::string> read_choice(const toml::node& node, std::string_view name,
                                       std::span<const std::string_view> choices, Faults& faults);

/// The texts of a list, each one of the choices and none twice.
std::vector<std::string> read_choices(const toml::node& node, std::string_view name,
                                      std::span<const std::string_view> choices, Faults& faults);

/// A quantity (text with a unit) or a plain number, as `quantity` says, in its range; or a fault.
std::optional<double> read_value(const toml::node& node, std::string_view name,
                                 const Quantity& quantity, const Range& range, Faults& faults);

/// A whole number in its range, or a fault.
std::optional<unsigned int> read_whole_number(const toml::node& node, std::string_view name,
                                              const Range& range, Faults& faults);

bool has_control_character(std::string_view text);

/// The text in quotes, escaped where TOML wants it.
std::string toml_text(const std::string& text);

/// Description of the node for messages: "a table", "the number 3".
std::string describe(const toml::node& node);

}  // namespace ciliaval::compare::input

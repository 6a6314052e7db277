// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "problem/parameter.h"
#include "problem/types.h"

/// Keys of a plain struct that a file may state, each described once. Case files are read and
/// written by the descriptions; the JSON schema, the tables of the guide, the numbers of studies
/// and Python's attributes follow from them.
namespace ciliaval::description {

/// The value of a key, whatever the member's type is.
using Value = std::variant<bool, unsigned int, double, std::string, std::array<double, 2>, Vector3,
                           std::array<double, 4>>;

/// A key of a table of a case file.
struct Key {
  enum class File {
    none,
    mesh,     ///< read in place of the model's own mesh, beside the case file
    program,  ///< with a slash beside the case file, else in PATH
    folder,   ///< written to, beside the case file; empty: nothing is kept
    data      ///< read, beside the case file
  };
  /// A file that leaves the key out means this.
  enum class Absence {
    its_initial_value,  ///< which is written back
    nothing,            ///< the member's initial value stands for it, and is not written back
    fault               ///< the key is required
  };
  std::string_view name;
  Quantity quantity = quantity::number;     ///< of a number or each of several
  Range range{};                            ///< likewise
  std::vector<std::string_view> choices{};  ///< of a text
  std::string_view doc;                     ///< one sentence
  Value initial;                            ///< the member's, which says what kind of value it is
  Absence absence = Absence::its_initial_value;
  std::string fallback{};       ///< the initial value as a person would state it; empty: its TOML
  std::string_view example{};   ///< of a text or a quantity of any kind, as a file states it
  bool is_of_any_kind = false;  ///< a quantity of what another key says, or a percentage
  std::size_t longest = 0;      ///< bytes of a text for people, of one line and not empty; 0: any
  /// May stand in place of a number, which is then `stands_for_word`, beyond its range.
  std::string_view word{};
  bool may_be_axial = false;   ///< of a vector: one number is its third component
  bool is_along_path = false;  ///< one value, or a list of them, one for each load step
  /// The key that this one takes the place of, if a file states it; it is not written back.
  std::string_view in_place_of{};
  File file = File::none;
  std::string goes_with{};  ///< what makes it belong, as a file would state it

  static constexpr double stands_for_word = 0;

  bool is_word(double value) const { return !word.empty() && value == stands_for_word; }
  /// A single number, whole or not.
  bool is_number() const { return std::holds_alternative<double>(initial) || is_whole_number(); }
  bool is_whole_number() const { return std::holds_alternative<unsigned int>(initial); }
};

/// A key of a struct.
template <class Owner>
struct Field : Key {
  std::function<Value(const Owner&)> get{};
  std::function<void(Owner&, const Value&)> set{};
  /// True where the key means anything beside the other ones; empty: it always does. A file that
  /// states it where it does not is refused, and it is not written back.
  std::function<bool(const Owner&)> condition{};

  bool belongs(const Owner& owner) const { return !condition || condition(owner); }
  /// The value of a key that is a number.
  double number(const Owner& owner) const {
    const Value value = get(owner);
    return is_whole_number() ? std::get<unsigned int>(value) : std::get<double>(value);
  }
  void set_number(Owner& owner, double value) const {
    set(owner,
        is_whole_number() ? Value(static_cast<unsigned int>(std::lround(value))) : Value(value));
  }
};

template <class Owner>
using Fields = std::vector<Field<Owner>>;

/// The keys of a struct that a case can state.
template <class T>
const Fields<T>& fields();

/// A line of text for people that is no member; without a fallback a file must state it.
inline Key text_key(std::string_view name, std::string_view doc, std::string_view fallback = "",
                    std::string_view example = "", std::size_t longest = 300) {
  Key key;
  key.name = name;
  key.doc = doc;
  key.initial = std::string();
  key.fallback = fallback;
  key.absence = fallback.empty() ? Key::Absence::fault : Key::Absence::nothing;
  key.example = example;
  key.longest = longest;
  return key;
}

/// A quantity of what another key says, or a percentage.
inline Key any_quantity_key(std::string_view name, std::string_view doc, std::string_view fallback,
                            std::string_view example) {
  Key key = text_key(name, doc, fallback, example);
  key.is_of_any_kind = true;
  return key;
}

/// A key whose value is a member: a number, a flag, a text, two numbers or a vector.
template <class Owner, class T>
Field<Owner> field(T Owner::*member, std::string_view name, const Quantity& quantity,
                   const Range& range, std::string_view doc) {
  Field<Owner> result;
  result.name = name;
  result.quantity = quantity;
  result.range = range;
  result.doc = doc;
  result.initial = Owner{}.*member;
  result.get = [=](const Owner& owner) { return Value(owner.*member); };
  result.set = [=](Owner& owner, const Value& value) { owner.*member = std::get<T>(value); };
  return result;
}

/// A key whose number need not be known: -1, beyond its range, stands for none.
template <class Owner>
Field<Owner> field(std::optional<double> Owner::*member, std::string_view name,
                   const Quantity& quantity, const Range& range, std::string_view doc) {
  Field<Owner> result;
  result.name = name;
  result.quantity = quantity;
  result.range = range;
  result.doc = doc;
  result.initial = -1.0;
  result.absence = Key::Absence::nothing;
  result.fallback = "not known";
  result.get = [=](const Owner& owner) { return Value((owner.*member).value_or(-1)); };
  result.set = [=](Owner& owner, const Value& value) { owner.*member = std::get<double>(value); };
  return result;
}

/// A key that is a plain number or several.
template <class Owner, class T>
Field<Owner> field(T Owner::*member, std::string_view name, const Range& range,
                   std::string_view doc) {
  return field(member, name, quantity::number, range, doc);
}

/// A key that is a flag or a text.
template <class Owner, class T>
Field<Owner> field(T Owner::*member, std::string_view name, std::string_view doc) {
  return field(member, name, quantity::number, Range{}, doc);
}

/// The values of an enumeration by their names.
template <class T>
using Choices = std::vector<std::pair<std::string_view, T>>;

template <class Owner, class T>
Field<Owner> choice(T Owner::*member, std::string_view name,
                    const std::type_identity_t<Choices<T>>& values, std::string_view doc) {
  Field<Owner> result;
  result.name = name;
  result.doc = doc;
  for (const auto& [text, value] : values) result.choices.push_back(text);
  result.get = [=](const Owner& owner) {
    const auto at = std::ranges::find(values, owner.*member, &Choices<T>::value_type::second);
    return Value(std::string(at->first));
  };
  result.set = [=](Owner& owner, const Value& value) {
    const auto& text = std::get<std::string>(value);
    owner.*member = std::ranges::find(values, text, &Choices<T>::value_type::first)->second;
  };
  result.initial = result.get(Owner{});
  return result;
}

/// The name of a file; empty: none.
template <class Owner>
Field<Owner> file(std::filesystem::path Owner::*member, std::string_view name, Key::File kind,
                  std::string_view doc) {
  Field<Owner> result;
  result.name = name;
  result.doc = doc;
  result.initial = (Owner{}.*member).string();
  result.get = [=](const Owner& owner) { return Value((owner.*member).string()); };
  result.set = [=](Owner& owner, const Value& value) {
    owner.*member = std::get<std::string>(value);
  };
  result.file = kind;
  return result;
}

/// The key, which a file must state.
template <class Owner>
Field<Owner> required(Field<Owner> field) {
  field.absence = Key::Absence::fault;
  return field;
}

/// The initial value stands for what is not stated: "not known".
template <class Owner>
Field<Owner> optional(Field<Owner> field, std::string_view words) {
  field.absence = Key::Absence::nothing;
  field.fallback = words;
  return field;
}

/// The key, of which a file may list a value for each load step.
template <class Owner>
Field<Owner> along_path(Field<Owner> field) {
  field.is_along_path = true;
  return field;
}

/// Another way to state what the key of this name says.
template <class Owner>
Field<Owner> in_place_of(std::string_view name, Field<Owner> field) {
  field.in_place_of = name;
  field.absence = Key::Absence::nothing;
  return field;
}

/// The key, whose initial value has these words in documentation: "0 deg".
template <class Owner>
Field<Owner> falls_back_to(Field<Owner> field, std::string_view words) {
  field.fallback = words;
  return field;
}

/// The key, which goes with one value of another one only; `other` is that as a file states it.
template <class Owner, class T>
Field<Owner> only_with(T Owner::*member, std::type_identity_t<T> value, std::string_view other,
                       Field<Owner> field) {
  field.condition = [=, other_condition = field.condition](const Owner& owner) {
    return owner.*member == value && (!other_condition || other_condition(owner));
  };
  field.goes_with = other;
  return field;
}

/// A field of a part, as one of the whole; `part` gives a reference to the part.
template <class Whole, class Part, class Function>
Field<Whole> of_part(const Field<Part>& field, const Function& part) {
  Field<Whole> result;
  static_cast<Key&>(result) = static_cast<const Key&>(field);
  result.get = [=, get = field.get](const Whole& whole) { return get(part(whole)); };
  result.set = [=, set = field.set](Whole& whole, const Value& value) { set(part(whole), value); };
  if (field.condition)
    result.condition = [=, condition = field.condition](const Whole& whole) {
      return condition(part(whole));
    };
  return result;
}

}  // namespace ciliaval::description

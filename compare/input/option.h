// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <algorithm>
#include <any>
#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <typeindex>
#include <utility>
#include <variant>
#include <vector>

#include "problem/parameter.h"

namespace ciliaval::compare::input {

/// The options of all models, each model's a struct of its own type. A struct that nobody has set
/// has the defaults of its own header.
class ModelOptions {
 public:
  template <class Options>
  Options& of() {
    std::any& value = values_[typeid(Options)];
    if (!value.has_value()) value = Options{};
    return *std::any_cast<Options>(&value);
  }
  template <class Options>
  const Options& of() const {
    static const Options defaults{};
    const auto found = values_.find(typeid(Options));
    return found == values_.end() ? defaults : *std::any_cast<Options>(&found->second);
  }

 private:
  std::map<std::type_index, std::any> values_;
};

using OptionValue = std::variant<bool, unsigned int, double, std::string, std::array<double, 2>>;

/// A setting of one model, [models.<model>] name = …: the one declaration from which it is read,
/// written back, documented and varied by studies. Its default is that of the model's options.
struct Option {
  enum class File {
    none,
    mesh,     ///< read in place of the model's own mesh, beside the case file
    program,  ///< with a slash beside the case file, else in PATH
    folder    ///< written to, beside the case file; empty: nothing is kept
  };
  std::string_view name;
  Quantity quantity = quantity::number;     ///< of a double
  Range range{};                            ///< of a number or of each number of a pair
  std::vector<std::string_view> choices{};  ///< of a text
  std::string_view doc;                     ///< one sentence
  std::function<OptionValue(const ModelOptions&)> get{};
  std::function<void(ModelOptions&, const OptionValue&)> set{};
  File file = File::none;
  /// Whether the option means anything with the other options; empty: it always does. A file that
  /// states it where it does not is refused, and it is not written back.
  std::function<bool(const ModelOptions&)> belongs{};
  std::string_view goes_with{};  ///< what makes it belong, as the file would state it

  /// The value of an option that is a number.
  std::optional<double> number(const ModelOptions& options) const;
  void set_number(ModelOptions& options, double value) const;
  bool is_whole_number() const;
};

/// An option that is a double, a whole number, a flag or two doubles.
template <class Options, class T>
Option option(T Options::*member, std::string_view name, const Quantity& quantity,
              const Range& range, std::string_view doc) {
  return {.name = name,
          .quantity = quantity,
          .range = range,
          .doc = doc,
          .get = [=](const ModelOptions& o) { return OptionValue(o.of<Options>().*member); },
          .set = [=](ModelOptions& o,
                     const OptionValue& v) { o.of<Options>().*member = std::get<T>(v); }};
}

/// The same without a unit.
template <class Options, class T>
Option option(T Options::*member, std::string_view name, const Range& range, std::string_view doc) {
  return option(member, name, quantity::number, range, doc);
}

template <class Options>
Option flag(bool Options::*member, std::string_view name, std::string_view doc) {
  return option(member, name, Range{}, doc);
}

/// An option that is an enumeration, by the names of its values.
template <class T>
using Choices = std::vector<std::pair<std::string_view, T>>;

template <class Options, class T>
Option choice(T Options::*member, std::string_view name,
              const std::type_identity_t<Choices<T>>& values, std::string_view doc) {
  Option result{.name = name, .doc = doc};
  for (const auto& [text, value] : values) result.choices.push_back(text);
  result.get = [=](const ModelOptions& o) {
    const auto at =
        std::ranges::find(values, o.of<Options>().*member, &Choices<T>::value_type::second);
    return OptionValue(std::string(at->first));
  };
  result.set = [=](ModelOptions& o, const OptionValue& v) {
    const auto at =
        std::ranges::find(values, std::get<std::string>(v), &Choices<T>::value_type::first);
    o.of<Options>().*member = at->second;
  };
  return result;
}

/// An option that is the name of a file; empty: none.
template <class Options>
Option file(std::filesystem::path Options::*member, std::string_view name, Option::File kind,
            std::string_view doc) {
  return {
      .name = name,
      .doc = doc,
      .get = [=](const ModelOptions& o) { return OptionValue((o.of<Options>().*member).string()); },
      .set = [=](ModelOptions& o,
                 const OptionValue& v) { o.of<Options>().*member = std::get<std::string>(v); },
      .file = kind};
}

/// The option, which goes with one value of another one only; `other` is that as a file states it.
template <class Options, class T>
Option only_with(T Options::*member, std::type_identity_t<T> value, std::string_view other,
                 Option option) {
  option.belongs = [=](const ModelOptions& o) { return o.of<Options>().*member == value; };
  option.goes_with = other;
  return option;
}

/// Whether a case with these options may state the option.
bool belongs(const Option& option, const ModelOptions& options);

/// An option's value as the file would state it: `"0.0005 m"`, `1`, `false`, `"wedge"`.
std::string to_toml(const Option& option, const OptionValue& value);

}  // namespace ciliaval::compare::input

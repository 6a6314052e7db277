// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <any>
#include <filesystem>
#include <map>
#include <string_view>
#include <type_traits>
#include <typeindex>

#include "problem/description/field.h"
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

using description::Choices;

/// A setting of one model, [models.<model>] name = …
using Option = description::Field<ModelOptions>;

/// Option of the struct of one model.
template <class Options>
Option option(const description::Field<Options>& field) {
  return description::of_part<ModelOptions>(
      field, [](auto& all) -> auto& { return all.template of<Options>(); });
}

/// As description::field(), choice() and file().
template <class Options, class T>
Option option(T Options::*member, std::string_view name, const Quantity& quantity,
              const Range& range, std::string_view doc) {
  return option(description::field(member, name, quantity, range, doc));
}
template <class Options, class T>
Option option(T Options::*member, std::string_view name, const Range& range, std::string_view doc) {
  return option(description::field(member, name, range, doc));
}
template <class Options>
Option flag(bool Options::*member, std::string_view name, std::string_view doc) {
  return option(description::field(member, name, doc));
}
template <class Options, class T>
Option choice(T Options::*member, std::string_view name,
              const std::type_identity_t<description::Choices<T>>& values, std::string_view doc) {
  return option(description::choice(member, name, values, doc));
}
template <class Options>
Option file(std::filesystem::path Options::*member, std::string_view name,
            description::Key::File kind, std::string_view doc) {
  return option(description::file(member, name, kind, doc));
}

/// The option, which goes with one value of another one only; `other` is that as a file states it.
template <class Options, class T>
Option only_with(T Options::*member, std::type_identity_t<T> value, std::string_view other,
                 Option option) {
  option.condition = [=](const ModelOptions& o) { return o.of<Options>().*member == value; };
  option.goes_with = other;
  return option;
}

}  // namespace ciliaval::compare::input

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <pybind11/pybind11.h>

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "compare/input/option.h"
#include "problem/description/cilium.h"
#include "problem/error.h"
#include "problem/mechanics_model.h"
#include "problem/parameter.h"
#include "problem/types.h"

namespace ciliaval::python::core {

template <std::size_t n>
struct TypeName {
  char text[n]{};
  constexpr TypeName(const char (&name)[n]) {  // NOLINT: a text is a name
    for (std::size_t i = 0; i < n; ++i) text[i] = name[i];
  }
};
/// An argument of any type, which the signature calls `name`. The functions below convert it:
/// pybind11's own conversions would refuse it with a TypeError that lists C++ types.
template <TypeName name>
class Argument : public pybind11::object {
 public:
  PYBIND11_OBJECT(Argument, object, is_anything)
 private:
  static bool is_anything(PyObject* /*value*/) { return true; }
};
using Number = Argument<"float">;
using Text = Argument<"str">;
using Array = Argument<"ArrayLike">;

/// numpy.ndarray of doubles, of this shape, from values in C order. NumPy is called through Python
/// and takes the values by the buffer protocol: one build serves its versions 1 and 2.
pybind11::object array(std::vector<double> values, std::vector<pybind11::ssize_t> shape);
pybind11::object array(const Vector3& vector);
/// (n, 3).
pybind11::object array(const std::vector<Vector3>& vectors);

/// The value as a message shows it: the start of its repr().
std::string shown(pybind11::handle value);

/// A real number of any kind: Python's, NumPy's, an array without dimensions, a Fraction, a
/// Decimal. None if the value is another thing: a truth value, a text, a complex number, a list.
std::optional<double> as_number(pybind11::handle value);
/// A number in SI units, or a text with a unit as case files have it ("1 mN"). Throws InputError
/// that names the argument.
double number(pybind11::handle value, std::string_view name, const Quantity& quantity);

/// A text. Throws InputError that names the argument.
std::string text(pybind11::handle value, std::string_view name);
/// The name of a file, a text or a path. Throws as above.
std::string file_name(pybind11::handle value, std::string_view name);
/// A function, or None. Throws as above.
pybind11::object function(const pybind11::object& value, std::string_view name);

/// Points in m from anything that numpy.asarray takes: (3,), (n, 3), or an empty list. Throws
/// InputError.
std::vector<Vector3> points(const pybind11::object& values);
/// A vector from anything that numpy.asarray takes; its components are numbers as above. Throws
/// InputError that names the argument.
Vector3 vector(const pybind11::object& value, std::string_view name, const Quantity& quantity);
/// The value of a key in its range, which the argument has its name of; of a vector that may be
/// axial, a number is its third component. Throws as above.
description::Value value_of(pybind11::handle value, const description::Key& key);
pybind11::object to_python(const description::Key& key, const description::Value& value);

/// Sets the member that the key describes.
template <class T>
void set_field(T& owner, std::string_view name, pybind11::handle value) {
  const auto& fields = description::fields<T>();
  const auto field = std::ranges::find(fields, name, &description::Field<T>::name);
  if (field == fields.end()) throw std::logic_error("no field " + std::string(name));
  field->set(owner, value_of(value, *field));
}

/// An attribute for each key of the struct.
template <class T>
void define_attributes(pybind11::class_<T>& of) {
  for (const description::Field<T>& field : description::fields<T>())
    of.def_property(
        std::string(field.name).c_str(),
        [&field](const T& owner) { return to_python(field, field.get(owner)); },
        [&field](T& owner, const pybind11::object& value) {
          field.set(owner, value_of(value, field));
        },
        std::string(field.doc).c_str());
}
/// The same that cannot be set: what the keys say together has been checked.
template <class T>
void define_constants(pybind11::class_<T>& of) {
  for (const description::Field<T>& field : description::fields<T>())
    of.def_property_readonly(
        std::string(field.name).c_str(),
        [&field](const T& owner) { return to_python(field, field.get(owner)); },
        std::string(field.doc).c_str());
}

/// The name of a bound class.
template <class T>
std::string class_name() {
  return pybind11::type::of<T>().attr("__name__").template cast<std::string>();
}

/// An object of a bound class. Throws InputError that names the argument.
template <class T>
const T& one(pybind11::handle value, std::string_view name) {
  if (!pybind11::isinstance<T>(value))
    throw InputError("`" + std::string(name) + "` is a " + class_name<T>() + ", not " +
                     shown(value));
  return value.cast<const T&>();
}

/// The items of anything that can be iterated over, each converted by `item(value, name)`, where
/// the name is "loads[3]". Throws InputError, also those of `item`.
template <class T, class Item>
std::vector<T> list_by(pybind11::handle value, std::string_view name, std::string_view items,
                       const Item& item) {
  const bool is_list = pybind11::isinstance<pybind11::iterable>(value) &&
                       !PyUnicode_Check(value.ptr()) && !PyBytes_Check(value.ptr());
  if (!is_list)
    throw InputError("`" + std::string(name) + "` is a list of " + std::string(items) + ", not " +
                     shown(value));
  std::vector<T> result;
  for (const pybind11::handle each : pybind11::iter(value))
    result.push_back(item(each, std::string(name) + "[" + std::to_string(result.size()) + "]"));
  return result;
}

/// A list of objects of a bound class. Throws as above.
template <class T>
std::vector<T> list_of(pybind11::handle value, std::string_view name) {
  return list_by<T>(value, name, class_name<T>(), one<T>);
}

/// Sets the options that are named, as a case file would state them in SI units. Throws InputError
/// that names what the model has.
void set_options(const std::string& model, const std::vector<compare::input::Option>& options,
                 const pybind11::dict& named, compare::input::ModelOptions& values);

/// Calls a Python function with each line of progress and lets Python handle signals, whose
/// handlers may raise; None: nothing but that. An exception ends the solution (calls.h).
Progress progress(const pybind11::object& callback);

void bind_array(pybind11::module_& module);
void bind_magnets(pybind11::module_& module);
void bind_problem(pybind11::module_& module);
void bind_models(pybind11::module_& module);
void bind_case(pybind11::module_& module);
void bind_study(pybind11::module_& module);

}  // namespace ciliaval::python::core

template <ciliaval::python::core::TypeName shown>
struct pybind11::detail::handle_type_name<ciliaval::python::core::Argument<shown>> {
  static constexpr auto name = const_name(shown.text);
};

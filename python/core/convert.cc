// SPDX-License-Identifier: LGPL-2.1-or-later
#include "python/core/convert.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <variant>

#include "compare/input/described.h"
#include "compare/input/units.h"
#include "python/core/calls.h"

namespace ciliaval::python::core {
namespace py = pybind11;
using compare::input::ModelOptions;
using compare::input::Option;
using description::Key;
namespace {

/// Values and shape from which NumPy makes an array.
struct Buffer {
  std::vector<double> values;
  std::vector<py::ssize_t> shape;
};

/// A whole number that is not negative, of any kind.
std::optional<unsigned int> as_count(py::handle value) {
  const std::optional<double> number = as_number(value);
  const double limit = std::numeric_limits<unsigned int>::max();
  if (!number || !(*number >= 0 && *number <= limit) || std::floor(*number) != *number)
    return std::nullopt;
  return static_cast<unsigned int>(*number);
}

/// Python's or NumPy's truth value.
std::optional<bool> as_flag(py::handle value) {
  const bool is_numpy_s = std::string_view(Py_TYPE(value.ptr())->tp_name).starts_with("numpy.bool");
  if (!PyBool_Check(value.ptr()) && !is_numpy_s) return std::nullopt;
  return PyObject_IsTrue(value.ptr()) == 1;
}

/// A number, or a text with a unit as case files have it. Throws InputError if the text is none.
std::optional<double> as_quantity(py::handle value, const Quantity& quantity) {
  if (PyUnicode_Check(value.ptr()) && !quantity.unit.empty())
    return compare::input::parse_quantity(value.cast<std::string>(), quantity);
  return as_number(value);
}

/// The value of an option of the type of its present one; none if it is of another type.
std::optional<description::Value> as_option(const Key& option, const description::Value& present,
                                            py::handle value) {
  return std::visit(
      [&](const auto& old) -> std::optional<description::Value> {
        using T = std::decay_t<decltype(old)>;
        if constexpr (std::is_same_v<T, bool>) {
          return as_flag(value);
        } else if constexpr (std::is_same_v<T, unsigned int>) {
          return as_count(value);
        } else if constexpr (std::is_same_v<T, double>) {
          return as_quantity(value, option.quantity);
        } else if constexpr (std::is_same_v<T, std::string>) {
          return option.file == Key::File::none ? text(value, option.name)
                                                : file_name(value, option.name);
        } else if constexpr (std::is_same_v<T, Vector3>) {
          return vector(py::reinterpret_borrow<py::object>(value), option.name, option.quantity);
        } else {
          const auto pair = list_by<double>(value, option.name, "two numbers",
                                            [&](py::handle each, const std::string& name) {
                                              return number(each, name, option.quantity);
                                            });
          if (pair.size() != 2) return std::nullopt;
          return T{pair[0], pair[1]};
        }
      },
      present);
}

description::Value converted(const Key& option, const description::Value& present,
                             py::handle value) {
  std::string fault = "is not what it takes";
  try {
    if (const auto found = as_option(option, present, value)) return *found;
  } catch (const InputError& error) {
    fault = fmt::format("is not what it takes ({})", error.what());
  }
  throw InputError(fmt::format("option `{}`: {} {}; a case file would state it as {}", option.name,
                               shown(value), fault, compare::input::to_toml(option, present)));
}

/// `kind`: "option ", or nothing.
void require_in_range(const Key& key, const description::Value& value, std::string_view kind) {
  const auto require = [&](double number) {
    if (key.range.lower != key.range.upper && !key.range.contains(number))
      throw InputError(fmt::format("{}`{}` is {:g}{}{}, but must be {}{}{}", kind, key.name, number,
                                   key.quantity.unit.empty() ? "" : " ", key.quantity.unit,
                                   compare::input::describe(key.range, key.quantity),
                                   key.range.reason.empty() ? "" : ": ", key.range.reason));
  };
  if (const auto* number = std::get_if<double>(&value)) require(*number);
  if (const auto* number = std::get_if<unsigned int>(&value)) require(*number);
  if (const auto* pair = std::get_if<std::array<double, 2>>(&value))
    std::ranges::for_each(*pair, require);
  if (const auto* vector = std::get_if<Vector3>(&value)) std::ranges::for_each(*vector, require);
  const auto* text = std::get_if<std::string>(&value);
  if (text != nullptr && !key.choices.empty() &&
      std::ranges::find(key.choices, *text) == key.choices.end())
    throw InputError(fmt::format("{}`{}`: \"{}\" is none of {}", kind, key.name, *text,
                                 fmt::join(key.choices, ", ")));
}

}  // namespace

py::object array(std::vector<double> values, std::vector<py::ssize_t> shape) {
  return py::module_::import("numpy").attr("asarray")(
      py::cast(Buffer{std::move(values), std::move(shape)}));
}

py::object array(const Vector3& vector) {
  return array({vector.x(), vector.y(), vector.z()}, {3});
}

py::object array(const std::vector<Vector3>& vectors) {
  std::vector<double> values;
  values.reserve(3 * vectors.size());
  for (const Vector3& vector : vectors)
    values.insert(values.end(), {vector.x(), vector.y(), vector.z()});
  return array(std::move(values), {static_cast<py::ssize_t>(vectors.size()), 3});
}

std::string shown(py::handle value) {
  constexpr std::size_t longest = 60;
  const std::string type = Py_TYPE(value.ptr())->tp_name;
  std::string text;
  try {
    text = py::repr(value).cast<std::string>();
  } catch (const py::error_already_set&) {
    return "an object of type " + type;
  }
  if (text.size() > longest) text = text.substr(0, text.find_last_of(" ,[", longest)) + " …";
  return value.is_none() ? text : fmt::format("{} ({})", text, type);
}

std::optional<double> as_number(py::handle value) {
  py::object plain = py::reinterpret_borrow<py::object>(value);
  if (PyFloat_CheckExact(plain.ptr())) return PyFloat_AS_DOUBLE(plain.ptr());
  try {
    if (py::hasattr(plain, "dtype") && py::hasattr(plain, "item")) {  // NumPy's and the like
      const std::string kind = py::str(py::getattr(plain.attr("dtype"), "kind", py::str("f")));
      const bool is_real = kind == "f" || kind == "i" || kind == "u" || kind == "O";
      if (!is_real || py::getattr(plain, "ndim", py::int_(0)).cast<int>() != 0) return std::nullopt;
      plain = plain.attr("item")();
    }
  } catch (const py::error_already_set&) {
    return std::nullopt;
  }
  PyObject* const object = plain.ptr();
  const PyNumberMethods* const methods = Py_TYPE(object)->tp_as_number;
  if (PyBool_Check(object) || PyComplex_Check(object) || methods == nullptr ||
      (methods->nb_float == nullptr && methods->nb_index == nullptr))
    return std::nullopt;
  const double number = PyFloat_AsDouble(object);
  if (PyErr_Occurred() == nullptr) return number;
  PyErr_Clear();  // a quantity with a unit of another library, a whole number of 400 digits
  return std::nullopt;
}

double number(py::handle value, std::string_view name, const Quantity& quantity) {
  std::optional<double> found;
  try {
    found = as_quantity(value, quantity);
  } catch (const InputError& error) {
    throw InputError(fmt::format("`{}`: {}", name, error.what()));
  }
  if (found) return *found;
  const std::string kinds = quantity.unit.empty()
                                ? ""
                                : fmt::format(", a number in {} or a text such as \"{}\"",
                                              quantity.unit, quantity.example);
  throw InputError(fmt::format("`{}` is {} {}{}, not {}", name, quantity.article, quantity.name,
                               kinds, shown(value)));
}

std::string text(py::handle value, std::string_view name) {
  if (!PyUnicode_Check(value.ptr()))
    throw InputError(fmt::format("`{}` is a text, not {}", name, shown(value)));
  return value.cast<std::string>();
}

std::string file_name(py::handle value, std::string_view name) {
  const auto path = py::reinterpret_steal<py::object>(PyOS_FSPath(value.ptr()));
  if (!path) PyErr_Clear();
  if (!path || !PyUnicode_Check(path.ptr()))
    throw InputError(fmt::format("`{}` is the name of a file, not {}", name, shown(value)));
  // The bytes of the name, which need be no UTF-8: Python has the others as lone surrogates.
  const auto bytes = py::reinterpret_steal<py::bytes>(PyUnicode_EncodeFSDefault(path.ptr()));
  if (!bytes) throw py::error_already_set();
  return static_cast<std::string>(bytes);
}

py::object function(const py::object& value, std::string_view name) {
  if (!value.is_none() && PyCallable_Check(value.ptr()) == 0)
    throw InputError(fmt::format("`{}` is a function or None, not {}", name, shown(value)));
  return value;
}

namespace {

/// Numbers in C order and their shape.
struct Numbers {
  std::vector<double> values;
  std::vector<py::ssize_t> shape;
};

/// From anything that numpy.asarray takes. An array of floats or whole numbers is taken as it is;
/// of all else each item is a number by itself.
Numbers numbers(const py::object& values, std::string_view name, const Quantity& quantity,
                const std::string& expected) {
  const py::module_ numpy = py::module_::import("numpy");
  py::object found;
  bool is_numeric = false;
  try {
    if (py::hasattr(values, "__array__")) {
      found = numpy.attr("asarray")(values);
      const std::string kind = py::str(found.attr("dtype").attr("kind"));
      is_numeric = kind == "f" || kind == "i" || kind == "u";
    }
    found = is_numeric ? numpy.attr("ascontiguousarray")(found, py::arg("dtype") = "float64")
                       : numpy.attr("asarray")(values, py::arg("dtype") = "object");
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_Exception)) throw;
    throw InputError(fmt::format("{}, not {}", expected, shown(values)));
  }
  Numbers result{{}, found.attr("shape").cast<std::vector<py::ssize_t>>()};
  if (is_numeric) {
    const py::buffer_info info = found.cast<py::buffer>().request();
    const auto* data = static_cast<const double*>(info.ptr);
    result.values.assign(data, data + info.size);
    if (found.attr("ndim").cast<int>() == 0) result.shape.clear();
    return result;
  }
  if (!result.shape.empty())
    for (const py::handle item : found.attr("ravel")())
      result.values.push_back(number(item, name, quantity));
  return result;
}

}  // namespace

std::vector<Vector3> points(const py::object& values) {
  const std::string expected = "`points` are an array of shape (3,) or (n, 3), in m";
  const Numbers all = numbers(values, "points", quantity::length, expected);
  const bool is_one = all.shape.size() == 1 && (all.shape[0] == 3 || all.shape[0] == 0);
  if (!is_one && !(all.shape.size() == 2 && all.shape[1] == 3))
    throw InputError(fmt::format("{}, not of shape ({})", expected, fmt::join(all.shape, ", ")));
  std::vector<Vector3> result;
  result.reserve(all.values.size() / 3);
  for (std::size_t i = 0; i + 2 < all.values.size(); i += 3)
    result.emplace_back(all.values[i], all.values[i + 1], all.values[i + 2]);
  return result;
}

Vector3 vector(const py::object& value, std::string_view name, const Quantity& quantity) {
  const std::string expected = fmt::format("`{}` is a vector [x, y, z]", name);
  const Numbers all = numbers(value, name, quantity, expected);
  if (all.shape != std::vector<py::ssize_t>{3})
    throw InputError(fmt::format("{}, not {}", expected, shown(value)));
  return {all.values[0], all.values[1], all.values[2]};
}

description::Value value_of(py::handle value, const Key& key) {
  const description::Value found = std::visit(
      [&](const auto& kind) -> description::Value {
        using T = std::decay_t<decltype(kind)>;
        if constexpr (std::is_same_v<T, std::string>) {
          return text(value, key.name);
        } else if constexpr (std::is_same_v<T, double>) {
          return number(value, key.name, key.quantity);
        } else if constexpr (std::is_same_v<T, Vector3>) {
          const bool is_axial =
              key.may_be_axial && (PyUnicode_Check(value.ptr()) || as_number(value));
          if (is_axial) return Vector3(0, 0, number(value, key.name, key.quantity));
          return vector(py::reinterpret_borrow<py::object>(value), key.name, key.quantity);
        } else {
          return converted(key, key.initial, value);
        }
      },
      key.initial);
  // A value that stands for one that is not stated may lie beyond.
  if (key.absence != Key::Absence::nothing || found != key.initial)
    require_in_range(key, found, "");
  return found;
}

py::object to_python(const Key& key, const description::Value& value) {
  return std::visit(
      [&](const auto& v) -> py::object {
        if constexpr (std::is_same_v<std::decay_t<decltype(v)>, Vector3>) {
          if (!key.may_be_axial) return array(v);
          if (v.template head<2>().isZero(0)) return py::float_(v.z());
          return py::make_tuple(v.x(), v.y(), v.z());
        } else {
          return py::cast(v);
        }
      },
      value);
}

void set_options(const std::string& model, const std::vector<Option>& options,
                 const py::dict& named, ModelOptions& values) {
  for (const auto& [key, value] : named) {
    const auto name = key.cast<std::string>();
    const auto option = std::ranges::find(options, name, &Option::name);
    if (option == options.end()) {
      std::vector<std::string_view> known(options.size());
      std::ranges::transform(options, known.begin(), &Option::name);
      throw InputError(
          fmt::format("model `{}` has no option `{}`; it has: {}", model, name,
                      known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", "))));
    }
    const description::Value wanted = converted(*option, option->get(values), value);
    require_in_range(*option, wanted, "option ");
    option->set(values, wanted);
  }
}

Progress progress(const py::object& callback) {
  const py::object called = function(callback, "progress");
  return [called](const ProgressReport& report) {
    support::check_interruption();
    const py::gil_scoped_acquire held;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (!called.is_none()) called(report.text);
    } catch (py::error_already_set& error) {
      throw RaisedInPython{error};
    }
  };
}

void bind_array(py::module_& module) {
  py::class_<Buffer>(module, "_Buffer", py::buffer_protocol()).def_buffer([](Buffer& buffer) {
    std::vector<py::ssize_t> strides(buffer.shape.size());
    py::ssize_t stride = sizeof(double);
    for (std::size_t i = buffer.shape.size(); i-- > 0; stride *= buffer.shape[i])
      strides[i] = stride;
    return py::buffer_info(buffer.values.data(), sizeof(double),
                           py::format_descriptor<double>::format(),
                           static_cast<py::ssize_t>(buffer.shape.size()), buffer.shape, strides);
  });
}

}  // namespace ciliaval::python::core

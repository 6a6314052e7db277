// SPDX-License-Identifier: LGPL-2.1-or-later
#include "python/core/convert.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>
#include <utility>
#include <variant>

#include "problem/error.h"

namespace ciliaval::python::core {
namespace py = pybind11;
using compare::input::ModelOptions;
using compare::input::Option;
using compare::input::OptionValue;
namespace {

/// What NumPy takes the values from.
struct Buffer {
  std::vector<double> values;
  std::vector<py::ssize_t> shape;
};

/// The value of an option of the type of its present one.
OptionValue converted(const Option& option, const OptionValue& present, py::handle value) {
  return std::visit(
      [&](const auto& old) -> OptionValue {
        using T = std::decay_t<decltype(old)>;
        try {
          if constexpr (std::is_same_v<T, std::array<double, 2>>) {
            const auto pair = value.cast<py::sequence>();
            return T{pair[0].cast<double>(), pair[1].cast<double>()};
          } else {
            return value.cast<T>();
          }
        } catch (const py::cast_error&) {
          throw InputError(
              fmt::format("option `{}`: {} is not what it takes; a case file would "
                          "state it as {}",
                          option.name, std::string(py::repr(value)), to_toml(option, present)));
        }
      },
      present);
}

void require_in_range(const Option& option, const OptionValue& value) {
  const auto require = [&](double number) {
    if (option.range.lower != option.range.upper && !option.range.contains(number))
      throw InputError(fmt::format("option `{}`: {} is not between {} and {}{}{}", option.name,
                                   number, option.range.lower, option.range.upper,
                                   option.range.reason.empty() ? "" : ": ", option.range.reason));
  };
  if (const auto* number = std::get_if<double>(&value)) require(*number);
  if (const auto* number = std::get_if<unsigned int>(&value)) require(*number);
  if (const auto* pair = std::get_if<std::array<double, 2>>(&value))
    std::ranges::for_each(*pair, require);
  const auto* text = std::get_if<std::string>(&value);
  if (text != nullptr && !option.choices.empty() &&
      std::ranges::find(option.choices, *text) == option.choices.end())
    throw InputError(fmt::format("option `{}`: \"{}\" is none of {}", option.name, *text,
                                 fmt::join(option.choices, ", ")));
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

namespace {

std::vector<Vector3> rows_of_three(const py::object& values, std::string_view expected) {
  const py::object numbers =
      py::module_::import("numpy").attr("ascontiguousarray")(values, py::arg("dtype") = "float64");
  const py::buffer_info info = numbers.cast<py::buffer>().request();
  const bool is_one = info.ndim == 1 && info.shape[0] == 3;
  if (!is_one && !(info.ndim == 2 && info.shape[1] == 3)) throw InputError(std::string(expected));
  const auto* data = static_cast<const double*>(info.ptr);
  std::vector<Vector3> result;
  for (py::ssize_t i = 0; i < info.size; i += 3)
    result.emplace_back(data[i], data[i + 1], data[i + 2]);
  return result;
}

}  // namespace

std::vector<Vector3> points(const py::object& values) {
  return rows_of_three(values, "points are an array of shape (3,) or (n, 3), in m");
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
    const OptionValue wanted = converted(*option, option->get(values), value);
    require_in_range(*option, wanted);
    option->set(values, wanted);
  }
}

Progress progress(const py::object& callback) {
  return [callback](const ProgressReport& report) {
    const py::gil_scoped_acquire held;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!callback.is_none()) callback(report.text);
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

Vector3 vector(const py::object& value, const char* name) {
  const std::string expected = fmt::format("`{}` is a vector [x, y, z]", name);
  const std::vector<Vector3> found = rows_of_three(value, expected);
  if (found.size() != 1)
    throw InputError(fmt::format("{}, not {} of them", expected, found.size()));
  return found.front();
}

}  // namespace ciliaval::python::core

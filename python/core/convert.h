// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <pybind11/pybind11.h>

#include <initializer_list>
#include <string>
#include <vector>

#include "compare/input/option.h"
#include "problem/mechanics_model.h"
#include "problem/types.h"

namespace ciliaval::python::core {

/// numpy.ndarray of doubles, of this shape, from values in C order. NumPy is called through Python
/// and takes the values by the buffer protocol: one build serves its versions 1 and 2.
pybind11::object array(std::vector<double> values, std::vector<pybind11::ssize_t> shape);
pybind11::object array(const Vector3& vector);
/// (n, 3).
pybind11::object array(const std::vector<Vector3>& vectors);

/// Points from anything that numpy.asarray takes: (3,) or (n, 3). Throws InputError.
std::vector<Vector3> points(const pybind11::object& values);
/// A vector from anything that numpy.asarray takes. Throws InputError with the name.
Vector3 vector(const pybind11::object& value, const char* name);

/// Sets the options that are named, as a case file would state them in SI units. Throws InputError
/// that names what the model has.
void set_options(const std::string& model, const std::vector<compare::input::Option>& options,
                 const pybind11::dict& named, compare::input::ModelOptions& values);

/// Calls a Python function with each line of progress; empty: nothing but to look whether the user
/// has interrupted, which ends the solution with KeyboardInterrupt.
Progress progress(const pybind11::object& callback);

void bind_array(pybind11::module_& module);
void bind_magnets(pybind11::module_& module);
void bind_problem(pybind11::module_& module);
void bind_models(pybind11::module_& module);
void bind_case(pybind11::module_& module);
void bind_study(pybind11::module_& module);

}  // namespace ciliaval::python::core

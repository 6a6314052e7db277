// SPDX-License-Identifier: LGPL-2.1-or-later
// The compiled part of the Python package: docs/guide/python.md.
#include <pybind11/pybind11.h>

#include <exception>

#include "compare/output/provenance.h"
#include "problem/error.h"
#include "python/core/calls.h"
#include "python/core/convert.h"

namespace py = pybind11;

PYBIND11_MODULE(_core, module) {
  using namespace ciliaval;
  // pybind11 hands it over by value.
  py::register_exception_translator([](std::exception_ptr pointer) {  // NOLINT
    const auto raise = [](const char* name, const Error& error) {
      PyErr_SetString(py::module_::import("ciliaval.errors").attr(name).ptr(), error.what());
    };
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const InputError& error) {
      raise("InputError", error);
    } catch (const SolverError& error) {
      raise("SolverError", error);
    } catch (const FileError& error) {
      raise("FileError", error);
    } catch (const Error& error) {
      raise("Error", error);
    }
  });
  module.attr("__version__") = compare::output::provenance("").version;
  python::core::bind_calls(module);
  python::core::bind_array(module);
  python::core::bind_problem(module);
  python::core::bind_models(module);
  python::core::bind_case(module);
  python::core::bind_study(module);
}

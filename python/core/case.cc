// SPDX-License-Identifier: LGPL-2.1-or-later
#include <pybind11/stl.h>

#include <filesystem>
#include <string>

#include "compare/input/case.h"
#include "compare/models/errors.h"
#include "compare/models/registry.h"
#include "compare/models/run.h"
#include "compare/output/provenance.h"
#include "compare/output/results.h"
#include "compare/validation/report.h"
#include "compare/validation/validation.h"
#include "python/core/convert.h"

namespace ciliaval::python::core {
namespace py = pybind11;
using namespace compare;

namespace {

std::string summary(const input::Case& problem, const py::object& callback) {
  const Progress shown = progress(callback);
  const py::gil_scoped_release released;
  const models::CaseResult result =
      models::run(problem, models::mechanics_models(), models::field_models(), shown);
  const auto measured =
      validation::validate(result, models::mechanics_models(), models::field_models(), shown);
  return output::summary_json(result, models::compare_models(result),
                              output::provenance("ciliaval.Case.run()"),
                              measured ? validation::json(*measured) : "");
}

}  // namespace

void bind_case(py::module_& module) {
  py::class_<input::Case>(module, "CaseFile")
      .def(py::init([](const std::string& file) {
             input::Case problem = input::read_case(std::filesystem::path(file), models::known());
             validation::read_inputs(problem);  // throws if a number is not the case's
             return problem;
           }),
           py::arg("file"))
      .def_readonly("name", &input::Case::name)
      .def_readonly("title", &input::Case::title)
      .def_readonly("cilium", &input::Case::cilium)
      .def_readonly("loads", &input::Case::load_path)
      .def_property_readonly("sensors",
                             [](const input::Case& problem) { return array(problem.sensors); })
      .def_property_readonly("sensor_names",
                             [](const input::Case& problem) { return sensor_names(problem); })
      .def_readwrite("mechanics", &input::Case::mechanics)
      .def_readwrite("fields", &input::Case::fields)
      .def("toml", [](const input::Case& problem) { return to_toml(problem, models::known()); })
      .def("summary", &summary, py::arg("progress"));
}

}  // namespace ciliaval::python::core

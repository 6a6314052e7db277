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
#include "python/core/calls.h"
#include "python/core/convert.h"
#include "python/core/pickle.h"

namespace ciliaval::python::core {
namespace py = pybind11;
using namespace compare;

namespace {

std::string summary(const input::Case& problem, const py::object& callback) {
  const Progress shown = progress(callback);
  const Call call;
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
      .def(py::init([](const Text& file) {
             input::Case problem =
                 input::read_case(std::filesystem::path(file_name(file, "file")), models::known());
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
      .def_property(
          "mechanics", [](const input::Case& problem) { return problem.mechanics; },
          [](input::Case& problem, const py::object& ids) {
            problem.mechanics = list_by<std::string>(ids, "mechanics", "models", text);
          })
      .def_property(
          "fields", [](const input::Case& problem) { return problem.fields; },
          [](input::Case& problem, const py::object& ids) {
            problem.fields = list_by<std::string>(ids, "fields", "models", text);
          })
      .def("toml", [](const input::Case& problem) { return to_toml(problem, models::known()); })
      .def(py::pickle(
          [](const input::Case& problem) {
            return py::make_tuple(build(), to_toml(problem, models::known()));
          },
          [](const py::tuple& state) {
            require_own_build(state[0].cast<std::string>());
            return input::read_case(state[1].cast<std::string>(), "a pickle", models::known());
          }))
      .def("summary", &summary, py::arg("progress"));
}

}  // namespace ciliaval::python::core

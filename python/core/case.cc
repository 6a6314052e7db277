// SPDX-License-Identifier: LGPL-2.1-or-later
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/input/case.h"
#include "compare/input/case_sections.h"
#include "compare/input/units.h"
#include "compare/models/errors.h"
#include "compare/models/model_part.h"
#include "compare/models/registry.h"
#include "compare/models/run.h"
#include "compare/output/output_file.h"
#include "compare/output/provenance.h"
#include "compare/output/results.h"
#include "compare/output/text_table.h"
#include "compare/study/case_number.h"
#include "compare/validation/input_number.h"
#include "compare/validation/input_part.h"
#include "compare/validation/report.h"
#include "compare/validation/validation.h"
#include "problem/error.h"
#include "problem/load.h"
#include "problem/support/words.h"
#include "python/core/calls.h"
#include "python/core/convert.h"
#include "python/core/pickle.h"

namespace ciliaval::python::core {
namespace py = pybind11;
using namespace compare;

namespace {

/// Results of a case, with the texts of the files that `ciliaval run` would write.
class CaseRun {
 public:
  CaseRun(const input::Case& problem, const Progress& shown)
      : result_(models::run(problem, models::mechanics_models(), models::field_models(), shown)),
        comparisons_(models::compare_models(result_)) {
    models::add_model_parts(result_, models::mechanics_models(), models::field_models(), shown);
    validation::add_input_parts(result_, models::mechanics_models(), models::field_models(), shown);
    const auto measured =
        validation::validate(result_, models::mechanics_models(), models::field_models(), shown);
    files_ = output::result_files(result_, comparisons_, output::provenance("ciliaval.Case.run()"),
                                  measured ? validation::json(*measured) : "");
    files_.push_back({"case.toml", [this] { return to_toml(result_.problem, models::known()); }});
  }
  CaseRun(const CaseRun&) = delete;  // the files refer to the members
  CaseRun& operator=(const CaseRun&) = delete;
  ~CaseRun() = default;

  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const output::ResultFile& file : files_) all.push_back(file.name);
    return all;
  }
  std::string text(const std::string& name) const {
    const auto file = std::ranges::find(files_, name, &output::ResultFile::name);
    if (file == files_.end()) throw FileError("there is no " + name + " among the results");
    return file->text();
  }

 private:
  models::CaseResult result_;
  std::vector<models::Comparison> comparisons_;
  std::vector<output::ResultFile> files_;
};

std::unique_ptr<CaseRun> run(const input::Case& problem, const py::object& callback) {
  const Progress shown = progress(callback);
  const Call call;
  const py::gil_scoped_release released;
  return std::make_unique<CaseRun>(problem, shown);
}

input::Case checked(input::Case problem) {
  validation::read_inputs(problem);  // throws if a number is not the case's
  return problem;
}

/// The case of these objects: what a file that states them would be.
input::Case of_objects(const py::object& cilium, const py::object& loads, const Array& sensors,
                       const py::object& mechanics, const py::object& fields, const Text& name,
                       const Text& title) {
  input::Case problem;
  problem.name = text(name, "name");
  problem.title = text(title, "title");
  problem.cilium = one<Cilium>(cilium, "cilium");
  problem.load_path = list_of<Load>(loads, "load");
  if (problem.load_path.empty()) throw InputError("a case has one load or more");
  if (problem.load_path.front().is<SweepLoad>())
    throw InputError("the surface of a sweep is stated in a case file: Case.from_text()");
  problem.sensors = points(sensors);
  problem.mechanics = list_by<std::string>(mechanics, "mechanics", "models", text);
  problem.fields = list_by<std::string>(fields, "fields", "models", text);
  return checked(
      input::read_case(to_toml(problem, models::known()), "the objects", models::known()));
}

/// Options of [readings]: of each key the text and its place in the file.
py::dict reading_options(const input::Case& problem) {
  py::dict options;
  for (const input::external::ReadingKey& key : input::external::reading_keys())
    if (const auto& option = problem.readings.*key.option; option.given())
      options[py::str(std::string(key.name))] = py::make_tuple(option.text, option.where);
  return options;
}

/// A text such as "0.4 uT" in the SI unit that is expected.
double parsed(const Text& value, const Text& unit) {
  const std::string expected = text(unit, "unit");
  for (const Quantity& of :
       {quantity::length, quantity::force, quantity::force_per_length, quantity::angle,
        quantity::time, quantity::flux_density, quantity::pressure, quantity::magnetization})
    if (of.unit == expected) return input::parse_quantity(text(value, "text"), of);
  throw InputError("there is no quantity in `" + expected + "`");
}

/// The case with other numbers, by the paths that studies have for them.
input::Case changed(const input::Case& problem, const py::dict& values) {
  const std::vector<study::CaseNumber> numbers = study::case_numbers(problem);
  std::vector<study::Setting> settings;
  for (const auto& [key, value] : values) {
    const std::string path = text(key, "path");
    const auto number = std::ranges::find(numbers, path, &study::CaseNumber::path);
    if (number == numbers.end()) {
      std::vector<std::string_view> paths;
      paths.reserve(numbers.size());
      for (const study::CaseNumber& known : numbers) paths.emplace_back(known.path);
      throw InputError(fmt::format("the case has no number `{}`{} Its numbers: {}", path,
                                   support::did_you_mean(path, paths), fmt::join(paths, ", ")));
    }
    const description::Value set = value_of(value, *number);
    const auto* whole = std::get_if<unsigned int>(&set);
    settings.push_back({*number, whole != nullptr ? *whole : std::get<double>(set)});
  }
  // Read again, for the rules that go over several keys.
  return checked(input::read_case(to_toml(study::with_settings(problem, settings), models::known()),
                                  "the changed case", models::known()));
}

}  // namespace

void bind_case(py::module_& module) {
  py::class_<input::Case>(module, "CaseFile")
      .def(py::init([](const Text& file) {
             return checked(
                 input::read_case(std::filesystem::path(file_name(file, "file")), models::known()));
           }),
           py::arg("file"))
      .def_static(
          "from_text",
          [](const Text& toml, const Text& name) {
            return checked(
                input::read_case(text(toml, "toml"), text(name, "name"), models::known()));
          },
          py::arg("toml"), py::arg("name"))
      .def_static("of_objects", &of_objects, py::arg("cilium"), py::arg("loads"),
                  py::arg("sensors"), py::arg("mechanics"), py::arg("fields"), py::arg("name"),
                  py::arg("title"))
      .def("changed", &changed, py::arg("values"))
      .def(
          "input_shifts",
          [](const input::Case& problem) {
            py::list shifts;
            for (const validation::Input& input : validation::read_inputs(problem))
              shifts.append(py::make_tuple(validation::shifted(problem, input, -input.step),
                                           validation::shifted(problem, input, input.step),
                                           2 * input.step));
            return shifts;
          },
          "Of each [[input_uncertainty]] the case with the number lower and higher, and how many\n"
          "standard uncertainties lie between. InputError.")
      .def(
          "corrected",
          [](input::Case problem, const Text& model) {
            const auto& entry = models::entry_of(models::mechanics_models(), text(model, "model"));
            std::string fault = models::correct(entry, problem);
            return py::make_tuple(std::move(problem), std::move(fault));
          },
          py::arg("model"))
      .def("numbers",
           [](const input::Case& problem) {
             py::dict numbers;
             for (const study::CaseNumber& number : study::case_numbers(problem)) {
               const description::Value value = number.get(problem);
               if (const auto* real = std::get_if<double>(&value))
                 numbers[py::str(number.path)] =
                     py::make_tuple(*real, std::string(number.quantity.unit));
             }
             return numbers;
           })
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
      .def_property_readonly("files",
                             [](const input::Case& problem) {
                               std::vector<std::string> files;
                               for (const auto& file : input::named_files(models::known(), problem))
                                 files.push_back(file.string());
                               return files;
                             })
      .def_property_readonly("readings", &reading_options)
      .def_property_readonly("chips",
                             [](const input::Case& problem) {
                               py::list chips;
                               for (const input::Chip& chip : problem.chips)
                                 chips.append(py::make_tuple(chip.axes, array(chip.rotation),
                                                             chip.gain, chip.components));
                               return chips;
                             })
      .def(
          "stated",
          [](const input::Case& problem, const Text& key) {
            return input::stated_values(problem, text(key, "key"));
          },
          py::arg("key"))
      .def(
          "user_meshes",
          [](const input::Case& problem, const Text& model) {
            const auto& entry = models::entry_of(models::mechanics_models(), text(model, "model"));
            std::vector<std::string> keys;
            for (const auto& [key, mesh] : input::user_meshes({{entry}, {}}, problem.options))
              keys.emplace_back(key);
            return keys;
          },
          py::arg("model"))
      .def("toml", [](const input::Case& problem) { return to_toml(problem, models::known()); })
      .def(py::pickle(
          [](const input::Case& problem) {
            return py::make_tuple(build(), to_toml(problem, models::known()));
          },
          [](const py::tuple& state) {
            require_own_build(state[0].cast<std::string>());
            return input::read_case(state[1].cast<std::string>(), "a pickle", models::known());
          }))
      .def("run", &run, py::arg("progress"));
  py::class_<CaseRun>(module, "CaseRun")
      .def("names", &CaseRun::names)
      .def(
          "text", [](const CaseRun& run, const Text& name) { return run.text(text(name, "name")); },
          py::arg("name"));
  module.def(
      "text_table",
      [](const output::TextRows& rows, const std::string& alignment, std::size_t width) {
        output::set_line_width(width);
        return output::text_table(rows, alignment);
      },
      py::arg("rows"), py::arg("alignment"), py::arg("width"));
  using File = std::optional<std::filesystem::path>;
  module.def(
      "check_outputs",
      [](const std::array<std::optional<std::string>, 3>& outputs,
         const std::vector<std::string>& inputs) {
        const auto file = [&](std::size_t i) { return outputs[i] ? File(*outputs[i]) : File(); };
        output::check_outputs({file(0), file(1), file(2)}, {inputs.begin(), inputs.end()});
      },
      py::arg("outputs"), py::arg("inputs"));
  module.def(
      "write_file",
      [](const std::string& file, const std::string& text) { output::write_file(file, text); },
      py::arg("file"), py::arg("text"));
  module.def("quantity", &parsed, py::arg("text"), py::arg("unit"));
  module.def(
      "provenance",
      [](const Text& command) {
        return output::to_json(output::provenance(text(command, "command"))).dump();
      },
      py::arg("command"));
}

}  // namespace ciliaval::python::core

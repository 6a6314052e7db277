// SPDX-License-Identifier: LGPL-2.1-or-later
// A study's file and its store: ciliaval/design, and in parts, for several machines,
// ciliaval/cluster.py.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/stl.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "compare/models/registry.h"
#include "compare/output/output_file.h"
#include "compare/output/provenance.h"
#include "compare/output/results.h"
#include "compare/output/store/store.h"
#include "compare/output/text_table.h"
#include "compare/study/evaluate.h"
#include "compare/study/reader/study_reader.h"
#include "compare/study/study.h"
#include "compare/study/sweep.h"
#include "problem/error.h"
#include "problem/support/fingerprint.h"
#include "problem/support/interruption.h"
#include "python/core/calls.h"
#include "python/core/convert.h"

namespace ciliaval::python::core {
namespace py = pybind11;
using namespace compare;
namespace {

namespace fs = std::filesystem;

/// A task as Python has it: the number of the point and the mechanics model.
using PointModel = std::pair<std::size_t, std::string>;

std::vector<PointModel> to_python(const std::vector<study::Task>& tasks) {
  std::vector<PointModel> pairs;
  pairs.reserve(tasks.size());
  for (const study::Task& task : tasks) pairs.emplace_back(task.point, task.mechanics);
  return pairs;
}

/// Bytes that are no UTF-8 become U+FFFD: a message may name any file.
py::str to_text(std::string_view bytes) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeUTF8(bytes.data(), static_cast<py::ssize_t>(bytes.size()), "replace"));
}

/// As ciliaval/design/summary.py has it: status, message, values, uncertainties.
py::tuple to_python(const study::PairResult& result) {
  return py::make_tuple(output::to_string(result.status), to_text(result.message), result.values,
                        result.uncertainty, result.range_uncertainty, result.model_uncertainty,
                        result.range_model_uncertainty);
}

/// An output as people and files know it.
struct OutputColumn {
  std::string id;
  std::string symbol;
  std::string unit;
  std::string shown_unit;
  double shown_size;
};

OutputColumn column(study::Output output, const study::Study& of) {
  const std::string unit(quantity_of(output, of.load()).unit);
  const output::ShownUnit shown = output::shown_unit(unit);
  return {std::string(id(output)), std::string(symbol(output)), unit, shown.name, shown.size};
}

std::vector<OutputColumn> columns(const study::Study& of) {
  std::vector<OutputColumn> all;
  for (const study::Output output : of.outputs) all.push_back(column(output, of));
  return all;
}

const study::Optimisation& optimisation(const study::Study& of) {
  if (!of.optimisation) throw InputError("the study has no [optimise]");
  return *of.optimisation;
}

/// Output, whether it is at least the value, value.
using LimitColumn = std::tuple<OutputColumn, bool, double>;

std::vector<LimitColumn> limits(const study::Study& of) {
  std::vector<LimitColumn> all;
  for (const study::Limit& limit : optimisation(of).limits)
    all.emplace_back(column(limit.output, of), limit.is_lower, limit.value);
  return all;
}

/// The study's first pair with these outputs alone.
study::Study searched(study::Study of, const std::vector<std::string>& outputs) {
  of.pairs.resize(1);
  of.has_model_uncertainty = false;
  of.outputs.clear();
  for (const std::string& name : outputs)
    for (const study::Output output : study::all_outputs())
      if (id(output) == name) of.outputs.push_back(output);
  if (of.outputs.size() != outputs.size()) throw InputError("no such outputs");
  return of;
}

/// A study file that has been read.
struct StudyFile {
  fs::path file;
  study::Study study;

  explicit StudyFile(const Text& name)
      : file(file_name(name, "file")), study(study::reader::read_study(file)) {}

  void require_point(std::size_t point) const {
    if (point >= study.all_points())
      throw InputError("the study has no point " + std::to_string(point));
  }

  /// Fingerprint of the study and of the program.
  support::Fingerprint fingerprint() const {
    support::Fingerprint all = study::fingerprint(study);
    all.emplace_back("program", output::version_line());
    return all;
  }

  std::vector<std::string> solve(const std::vector<PointModel>& tasks) const {
    std::vector<std::string> solutions(tasks.size());
    const auto solve_one = [&](std::size_t i) {
      const auto& [point, mechanics] = tasks[i];
      require_point(point);
      solutions[i] = to_bytes(evaluate(study, study.case_at(point), mechanics,
                                       models::mechanics_models(), models::field_models()));
    };
    const Call call;
    const py::gil_scoped_release released;
    if (tasks.size() == 1)
      solve_one(0);  // a model that uses the cores itself stays in this thread
    else
      tbb::parallel_for(std::size_t{0}, tasks.size(), solve_one);
    return solutions;
  }
};

/// The store in the folder of a study's results, which no other process has at the same time;
/// without a folder what is solved is kept in memory alone.
class StudyStore {
 public:
  using Designs = std::vector<std::vector<double>>;

  StudyStore(const StudyFile& file, const std::optional<std::string>& results, bool fresh)
      : study_(file.study) {
    if (!results) {
      solutions_.emplace();
      return;
    }
    const fs::path folder = fs::path(*results) / study_.name;
    study::make_folder(folder);
    store_.emplace(folder / study::store_name, std::vector{study::store_owner}, fresh);
    output::remove_unfinished(folder);
    solutions_.emplace(*store_, study_, output::version_line());
  }

  std::size_t size() const { return solutions_ ? solutions_->size() : 0; }

  std::pair<std::vector<PointModel>, std::vector<PointModel>> missing() const {
    const study::Tasks tasks =
        missing_tasks(study_, opened(), models::mechanics_models(), models::field_models());
    return {to_python(tasks.side_by_side), to_python(tasks.one_by_one)};
  }

  void keep(std::size_t point, const std::string& mechanics, const std::string& solution) {
    opened().add(study::Task{point, mechanics}.name(), study::from_bytes(solution));
  }

  py::list run(const py::object& callback) {
    const auto solved = [&] {
      const Progress said = progress(callback);
      const Call call;
      const py::gil_scoped_release released;
      return run_study(study_, opened(), models::mechanics_models(), models::field_models(), said);
    }();
    py::list points;
    for (const auto& pairs : solved.points) points.append(listed(pairs));
    return points;
  }

  py::list evaluate(const Designs& designs, const std::string& mechanics,
                    const std::optional<std::vector<std::string>>& outputs,
                    const py::object& callback) {
    for (const auto& values : designs)
      if (values.size() != optimisation(study_).parameters.size())
        throw InputError("a design has a value for each parameter");
    study::Solutions& solutions = opened();
    const study::Study asked = outputs ? searched(study_, *outputs) : study_;
    std::vector<std::string> names;
    std::vector<std::size_t> missing;
    std::set<std::string_view> seen;
    names.reserve(designs.size());
    for (std::size_t i = 0; i < designs.size(); ++i) {
      names.push_back(fmt::format("{} of {} at {}", outputs ? "search" : "design", mechanics,
                                  fmt::join(designs[i], " ")));
      if (solutions.find(names[i]) == nullptr && seen.insert(names[i]).second) missing.push_back(i);
    }
    const auto solve = [&](std::size_t i, const Progress& said) {
      solutions.add(names[i],
                    study::evaluate(asked, study_.design(designs[i]), mechanics,
                                    models::mechanics_models(), models::field_models(), said));
    };
    {
      const Progress said = progress(callback);
      const Call call;
      const py::gil_scoped_release released;
      if (missing.size() > 1 &&
          runs_in_threads(asked, mechanics, models::mechanics_models(), models::field_models()))
        // A grain of one: the solutions take different times.
        tbb::parallel_for(std::size_t{0}, missing.size(), [&](std::size_t i) {
          support::check_interruption();
          solve(missing[i], {});
        });
      else
        for (const std::size_t i : missing) solve(i, said);
    }
    py::list all;
    for (const std::string& name : names) all.append(listed(*solutions.find(name)));
    return all;
  }

  void close() {
    solutions_.reset();
    store_.reset();
  }

 private:
  study::Solutions& opened() {
    if (!solutions_) throw FileError("the store of the study is closed");
    return *solutions_;
  }
  const study::Solutions& opened() const { return const_cast<StudyStore*>(this)->opened(); }

  static py::list listed(const std::vector<study::PairResult>& results) {
    py::list all;
    for (const study::PairResult& result : results) all.append(to_python(result));
    return all;
  }

  study::Study study_;
  std::optional<output::store::Store> store_;
  std::optional<study::Solutions> solutions_;
};

void bind_parts(py::module_& module) {
  py::class_<OutputColumn>(module, "StudyOutput")
      .def_readonly("id", &OutputColumn::id)
      .def_readonly("symbol", &OutputColumn::symbol)
      .def_readonly("unit", &OutputColumn::unit)
      .def_readonly("shown_unit", &OutputColumn::shown_unit)
      .def_readonly("shown_size", &OutputColumn::shown_size);
  using study::Parameter;
  py::class_<Parameter>(module, "StudyParameter")
      .def_property_readonly("path", [](const Parameter& of) { return of.number.path; })
      .def_property_readonly("unit", [](const Parameter& of) { return of.number.quantity.unit; })
      .def_readonly("name", &Parameter::name)
      .def_readonly("shown_unit", &Parameter::unit)
      .def_readonly("shown_size", &Parameter::unit_size)
      .def_readonly("values", &Parameter::values)
      .def_readonly("logarithmic", &Parameter::is_logarithmic);
  using study::Tolerance;
  py::class_<Tolerance>(module, "StudyTolerance")
      .def_property_readonly("path", [](const Tolerance& of) { return of.number.path; })
      .def_property_readonly("unit", [](const Tolerance& of) { return of.number.quantity.unit; })
      .def_readonly("nominal", &Tolerance::nominal)
      .def_readonly("deviation", &Tolerance::deviation)
      .def_readonly("shown_unit", &Tolerance::unit)
      .def_readonly("shown_size", &Tolerance::unit_size);
}

}  // namespace

void bind_study(py::module_& module) {
  bind_parts(module);
  module.attr("tolerance_step") = study::tolerance_step;
  const auto property = [](auto get) {
    return [get](const StudyFile& of) { return get(of.study); };
  };
  using study::Study;
  py::class_<StudyFile>(module, "StudyFile")
      .def(py::init<const Text&>(), py::arg("file"))
      .def_property_readonly("name", property([](const Study& of) { return of.name; }))
      .def_property_readonly("title", property([](const Study& of) { return of.title; }))
      .def_property_readonly("case", property([](const Study& of) { return of.base.name; }))
      .def_property_readonly("optimises",
                             property([](const Study& of) { return of.optimisation.has_value(); }))
      .def_property_readonly("zipped", property([](const Study& of) { return of.is_zipped; }),
                             "Whether the parameters' values go together.")
      .def_property_readonly("pairs", property([](const Study& of) {
                               std::vector<std::string> names;
                               for (const study::ModelPair& pair : of.pairs)
                                 names.push_back(pair.name());
                               return names;
                             }))
      .def_property_readonly("mechanics", property([](const Study& of) { return of.mechanics(); }),
                             "The mechanics models of the pairs, each once.")
      .def_property_readonly("outputs", property(columns))
      .def_property_readonly("parameters", property([](const Study& of) { return of.parameters; }))
      .def_property_readonly("tolerances", property([](const Study& of) { return of.tolerances; }))
      .def_property_readonly("point_count",
                             property([](const Study& of) { return of.point_count(); }),
                             "Points of the sweep; those of the tolerances are behind them.")
      .def_property_readonly("all_points",
                             property([](const Study& of) { return of.all_points(); }))
      .def_property_readonly(
          "goal", property([](const Study& of) { return column(optimisation(of).goal, of); }))
      .def_property_readonly("limits", property(limits),
                             "Each an output, whether it is at least or at most, and the value.")
      .def_property_readonly("searched",
                             property([](const Study& of) { return optimisation(of).parameters; }),
                             "The parameters of [optimise]; their values are the two bounds.")
      .def_property_readonly("start",
                             property([](const Study& of) { return optimisation(of).start; }))
      .def_property_readonly("global_evaluations", property([](const Study& of) {
                               return optimisation(of).global_evaluations;
                             }))
      .def_property_readonly("starts",
                             property([](const Study& of) { return optimisation(of).starts; }))
      .def_property_readonly(
          "range", property([](const Study& of) { return column(study::Output::range, of); }))
      .def_property_readonly(
          "slips", property([](const Study& of) { return contact_height(of.load()).has_value(); }),
          "Whether its load may slip off: a contact or a probe.")
      .def(
          "load",
          [](const StudyFile& of, const std::vector<double>& values) {
            if (values.size() != optimisation(of.study).parameters.size())
              throw InputError("a design has a value for each parameter");
            return magnitude(of.study.design(values).load_path.front());
          },
          py::arg("values"), "The magnitude of the load of a design.")
      .def(
          "values_at",
          [](const StudyFile& of, std::size_t point) {
            of.require_point(point);
            return point < of.study.point_count() ? of.study.values_at(point)
                                                  : std::vector<double>();
          },
          py::arg("point"), "The parameters' values at a point; none behind the sweep.")
      .def(
          "describe",
          [](const StudyFile& of, std::size_t point) {
            of.require_point(point);
            return of.study.describe(point);
          },
          py::arg("point"), "\"E1 = 0.1 MPa, d = 3 mm\"")
      .def_property_readonly(
          "files",
          [](const StudyFile& of) {
            std::vector<std::string> names;
            for (const fs::path& name : study::reader::files_of_study(of.file))
              names.push_back(name.string());
            return names;
          },
          "All files that it is read from.")
      .def_property_readonly("fingerprint", &StudyFile::fingerprint,
                             "Everything that its results depend on: pairs of name and value.")
      .def("solve", &StudyFile::solve, py::arg("tasks"),
           "The solutions of tasks (point, mechanics model), as the store keeps them. Several are\n"
           "solved at once.");
  py::class_<StudyStore>(module, "StudyStore")
      .def(py::init<const StudyFile&, const std::optional<std::string>&, bool>(), py::arg("study"),
           py::arg("folder"), py::arg("fresh") = false)
      .def_property_readonly("size", &StudyStore::size, "Solutions that it has.")
      .def("missing", &StudyStore::missing,
           "The tasks that are not solved yet: of rods, and of models that take all cores.")
      .def("keep", &StudyStore::keep, py::arg("point"), py::arg("mechanics"), py::arg("solution"),
           "Keeps a solution from now on, whatever happens to this process.")
      .def(
          "run", &StudyStore::run, py::arg("progress") = py::none(),
          "Solves all points that are missing. Of each point and pair (status, message, values of\n"
          "the outputs, uncertainty of dB, uncertainty of the range).")
      .def(
          "evaluate", &StudyStore::evaluate, py::arg("designs"), py::arg("mechanics"),
          py::arg("outputs") = py::none(), py::arg("progress") = py::none(),
          "Designs of [optimise] by a mechanics model: of each design and each of its pairs the\n"
          "same. With outputs, by the study's first pair these alone. Several designs of rods are\n"
          "solved at once. What is there is not solved again.")
      .def("close", &StudyStore::close, "Lets another process have it.");
}

}  // namespace ciliaval::python::core

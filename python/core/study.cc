// SPDX-License-Identifier: LGPL-2.1-or-later
// A study in parts, for several machines: ciliaval/cluster.py.
#include <pybind11/stl.h>
#include <tbb/parallel_for.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compare/models/registry.h"
#include "compare/output/provenance.h"
#include "compare/output/store/store.h"
#include "compare/study/evaluate.h"
#include "compare/study/folder.h"
#include "compare/study/reader/study_reader.h"
#include "compare/study/study.h"
#include "compare/study/sweep.h"
#include "problem/error.h"
#include "problem/support/fingerprint.h"
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
  for (const study::Task& task : tasks) pairs.emplace_back(task.point, task.mechanics);
  return pairs;
}

/// A study file that has been read.
struct StudyFile {
  fs::path file;
  study::Study study;

  explicit StudyFile(const Text& name)
      : file(file_name(name, "file")), study(study::reader::read_study(file)) {}

  /// Of the program too.
  support::Fingerprint fingerprint() const {
    support::Fingerprint all = study::fingerprint(study);
    all.emplace_back("program", output::version_line());
    return all;
  }

  std::vector<std::string> solve(const std::vector<PointModel>& tasks) const {
    std::vector<std::string> solutions(tasks.size());
    const auto solve_one = [&](std::size_t i) {
      const auto& [point, mechanics] = tasks[i];
      if (point >= study.all_points())
        throw InputError("the study has no point " + std::to_string(point));
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

/// The store in the folder of a study's results, which no other process has at the same time.
class StudyStore {
 public:
  StudyStore(const StudyFile& file, const std::string& results) : study_(file.study) {
    const fs::path folder = fs::path(results) / study_.name;
    study::make_folder(folder);
    store_.emplace(folder / study::store_name, std::vector{study::store_owner});
    solutions_.emplace(*store_, study_, output::version_line());
  }

  std::pair<std::vector<PointModel>, std::vector<PointModel>> missing() const {
    const study::Tasks tasks =
        missing_tasks(study_, *solutions_, models::mechanics_models(), models::field_models());
    return {to_python(tasks.side_by_side), to_python(tasks.one_by_one)};
  }

  void keep(std::size_t point, const std::string& mechanics, const std::string& solution) {
    if (!solutions_) throw FileError("the store of the study is closed");
    solutions_->add(study::Task{point, mechanics}.name(), study::from_bytes(solution));
  }

  void close() {
    solutions_.reset();
    store_.reset();
  }

 private:
  study::Study study_;
  std::optional<output::store::Store> store_;
  std::optional<study::Solutions> solutions_;
};

}  // namespace

void bind_study(py::module_& module) {
  py::class_<StudyFile>(module, "StudyFile")
      .def(py::init<const Text&>(), py::arg("file"))
      .def_property_readonly("name", [](const StudyFile& of) { return of.study.name; })
      .def_property_readonly("optimises",
                             [](const StudyFile& of) { return of.study.optimisation.has_value(); })
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
      .def(py::init<const StudyFile&, const std::string&>(), py::arg("study"), py::arg("folder"))
      .def("missing", &StudyStore::missing,
           "The tasks that are not solved yet: of rods, and of models that take all cores.")
      .def("keep", &StudyStore::keep, py::arg("point"), py::arg("mechanics"), py::arg("solution"),
           "Keeps a solution from now on, whatever happens to this process.")
      .def("close", &StudyStore::close, "Lets another process have it.");
}

}  // namespace ciliaval::python::core

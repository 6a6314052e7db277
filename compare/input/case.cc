// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/case.h"

#include "compare/input/case_sections.h"
#include "compare/input/case_syntax.h"
#include "compare/input/external/external_files.h"
#include "problem/error.h"

namespace ciliaval::compare::input {
namespace {

/// A file name that the case states is that of a file beside the case file, unless absolute.
void put_beside(std::string_view case_file, std::filesystem::path& file) {
  if (!file.empty())
    file = std::filesystem::absolute(std::filesystem::path(case_file).parent_path() / file)
               .lexically_normal();
}

/// Reads the files of all external models. Throws InputError with all their faults.
void read_files(std::vector<external::ExternalModel>& external, const Case& c) {
  std::string faults;
  for (external::ExternalModel& model : external) {
    try {
      external::read_external_files(model, c.cilium, c.load_path, c.sensors.size());
    } catch (const InputError& error) {
      faults += (faults.empty() ? "" : "\n") + std::string(error.what());
    }
  }
  if (!faults.empty()) throw InputError(faults);
}

}  // namespace

Case read_case(std::string_view text, std::string_view file) {
  const toml::table table = parse_toml(text, file);
  Faults faults;
  Section root(&table, "the case file", "", {}, faults);
  Case c;
  read_header(root, c);
  const bool cilium = read_cilium(root, c);
  const bool load = read_load(root, c);
  read_sensor(root, c);
  const bool models = read_models(root, c);
  put_beside(file, c.options.solid.mesh);
  put_beside(file, c.options.calculix.keep);
  if (c.options.calculix.program.has_parent_path()) put_beside(file, c.options.calculix.program);
  for (external::ExternalModel& model : c.external) {
    for (std::filesystem::path& centreline : model.centreline_files) put_beside(file, centreline);
    put_beside(file, model.readings_file);
    put_beside(file, model.background_file);
  }
  root.finish();
  if (cilium) snap_to_interfaces(c.cilium, c.load_path);
  check_together(table, c, {cilium, load, models}, faults);
  if (!faults.empty()) throw InputError(faults.report(file));

  // What the models themselves demand; a case that comes so far has it.
  require_valid(c.cilium);
  for (const Load& step : c.load_path) require_valid(step, c.cilium);
  read_files(c.external, c);
  return c;
}

Case read_case(const std::filesystem::path& file) {
  return read_case(read_toml_file(file, "case"), file.string());
}

}  // namespace ciliaval::compare::input

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/case.h"

#include <fmt/core.h>

#include "compare/input/case_sections.h"
#include "compare/input/case_syntax.h"
#include "problem/error.h"

namespace ciliaval::compare::input {
namespace {

/// A file name that the case states is that of a file beside the case file, unless absolute.
void put_beside(std::string_view case_file, std::filesystem::path& file) {
  if (!file.empty())
    file = std::filesystem::absolute(std::filesystem::path(case_file).parent_path() / file)
               .lexically_normal();
}

}  // namespace

void change_files(const Models& models, ModelOptions& options,
                  const std::function<void(Option::File, std::filesystem::path&)>& change) {
  models.for_each([&](const auto& entry) {
    for (const Option& option : entry.options) {
      if (option.file == Option::File::none) continue;
      std::filesystem::path file = std::get<std::string>(option.get(options));
      if (file.empty()) continue;
      change(option.file, file);
      option.set(options, file.string());
    }
  });
}

std::map<std::string, std::filesystem::path> user_meshes(const Models& models,
                                                         const ModelOptions& options) {
  std::map<std::string, std::filesystem::path> result;
  models.for_each([&](const auto& entry) {
    for (const Option& option : entry.options)
      if (option.file == Option::File::mesh)
        if (const auto file = std::get<std::string>(option.get(options)); !file.empty())
          result[fmt::format("models.{}.{}", entry.id, option.name)] = file;
  });
  return result;
}

std::string sensor_name(const Case& c, std::size_t sensor) {
  return sensor < c.sensor_names.size() ? c.sensor_names[sensor] : std::to_string(sensor);
}

std::vector<std::string> sensor_names(const Case& c) {
  std::vector<std::string> names;
  for (std::size_t s = 0; s < c.sensors.size(); ++s) names.push_back(sensor_name(c, s));
  return names;
}

Case read_case(std::string_view text, std::string_view file, const Models& known) {
  const toml::table table = parse_toml(text, file);
  Faults faults;
  Section root(&table, "the case file", "", {}, faults);
  Case c;
  const auto is_right = [&](const auto& read) {
    const std::size_t before = faults.size();
    read();
    return faults.size() == before;
  };
  read_header(root, c);
  const bool cilium = is_right([&] { read_cilium(root, c); });
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  const bool load = is_right([&] { read_load(root, folder, c); });
  const bool sensors = is_right([&] { read_sensor(root, c); });
  read_readings(root, file, c.readings);
  c.signal = sweep::read_signal(root);
  const bool models = is_right([&] { read_models(root, known, c); });
  const std::vector<measurement::MeasuredFile> measured =
      measurement::read_measurements(root, file, cilium && load && sensors, c);
  change_files(known, c.options, [&](Option::File kind, std::filesystem::path& name) {
    if (kind != Option::File::program || name.has_parent_path()) put_beside(file, name);
  });
  for (external::ExternalModel& model : c.external) {
    for (std::filesystem::path& centreline : model.centreline_files) put_beside(file, centreline);
    put_beside(file, model.readings_file);
    put_beside(file, model.background_file);
  }
  root.finish();
  if (cilium) snap_to_interfaces(c.cilium, c.load_path);
  check_together(table, c, known, {cilium, load, models}, faults);
  if (!faults.empty()) throw InputError(faults.report(file));

  // The models' own demands; a case that comes so far meets them.
  require_valid(c.cilium);
  for (const Load& step : c.load_path) require_valid(step, c.cilium);
  external::read_external_files(c.external, c.cilium, c.load_path, sensor_names(c));
  measurement::read_measured_files(measured, c);
  return c;
}

Case read_case(const std::filesystem::path& file, const Models& known) {
  return read_case(read_toml_file(file, "case"), file.string(), known);
}

}  // namespace ciliaval::compare::input

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/case.h"

#include <fmt/core.h>

#include "compare/input/case_sections.h"
#include "compare/input/case_syntax.h"
#include "problem/error.h"

namespace ciliaval::compare::input {
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

void change_files(const Models& models, Case& c,
                  const std::function<void(Option::File, std::filesystem::path&)>& change) {
  change_files(models, c.options, change);
  const auto change_data = [&](std::filesystem::path& file) {
    if (!file.empty()) change(Option::File::data, file);
  };
  for (external::ExternalModel& model : c.external) {
    for (std::filesystem::path& centreline : model.centreline_files) change_data(centreline);
    change_data(model.readings_file);
    change_data(model.background_file);
  }
  if (c.surface) change_data(c.surface->file);
}

std::vector<std::filesystem::path> named_files(const Models& models, const Case& c) {
  std::vector<std::filesystem::path> files;
  Case stated = c;
  change_files(models, stated, [&](Option::File kind, std::filesystem::path& file) {
    if (kind == Option::File::mesh || kind == Option::File::data) files.push_back(file);
  });
  files.insert(files.end(), c.measured.files.begin(), c.measured.files.end());
  return files;
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
  // They lie beside the case file, unless absolute.
  change_files(known, c, [&](Option::File kind, std::filesystem::path& name) {
    if (kind != Option::File::program || name.has_parent_path())
      name = std::filesystem::absolute(folder / name).lexically_normal();
  });
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

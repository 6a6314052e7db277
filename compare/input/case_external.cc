// SPDX-License-Identifier: LGPL-2.1-or-later
// The tables [[models.external]] of a case file.
#include <fmt/format.h>

#include <algorithm>

#include "compare/input/case_sections.h"
#include "compare/input/described.h"

namespace ciliaval::description {

template <>
const Fields<compare::input::external::ExternalModel>&
fields<compare::input::external::ExternalModel>() {
  using Model = compare::input::external::ExternalModel;
  static const Fields<Model> all = [] {
    Field<Model> background =
        optional(file(&Model::background_file, "background", Key::File::data,
                      "CSV file with the ambient field at each azimuth, to be taken off the "
                      "readings."),
                 "none");
    background.condition = [](const Model& model) { return !model.readings_file.empty(); };
    background.goes_with = "'readings'";
    const auto uncertainty = [](auto member, std::string_view name, const Quantity& quantity,
                                std::string_view doc) {
      return field(member, name, quantity, {0, 100, false, unit_slip}, doc);
    };
    return Fields<Model>{
        optional(file(&Model::readings_file, "readings", Key::File::data,
                      "CSV file with the readings of every load step and sensor."),
                 "none"),
        background,
        uncertainty(&Model::tip_uncertainty, "tip_uncertainty", quantity::length,
                    "Uncertainty of the tip's position in each centreline."),
        uncertainty(&Model::field_uncertainty, "field_uncertainty", quantity::flux_density,
                    "Uncertainty of each component of each reading.")};
  }();
  return all;
}

}  // namespace ciliaval::description

namespace ciliaval::compare::input {
namespace {

constexpr std::size_t most_external = 20;

std::optional<std::filesystem::path> read_file_name(const toml::node& node, std::string_view name,
                                                    Faults& faults) {
  const std::optional<std::string> text = read_text(node, name, faults);
  if (!text) return std::nullopt;
  if (!text->empty() && std::all_of(text->begin(), text->end(), [](char c) {
        return static_cast<unsigned char>(c) >= 0x20 && c != 0x7F;
      }))
    return *text;
  faults.add(place(node), fmt::format("'{}' must name a file", name));
  return std::nullopt;
}

std::vector<std::filesystem::path> read_file_names(const toml::node& node, std::string_view name,
                                                   Faults& faults) {
  std::vector<std::filesystem::path> result;
  const toml::array* list = node.as_array();
  if (list == nullptr || list->empty()) {
    faults.add(place(node),
               fmt::format("'{}' must be a list of files, one for each load step", name));
    return result;
  }
  for (const toml::node& element : *list)
    if (auto file = read_file_name(element, name, faults)) result.push_back(std::move(*file));
  return result;
}

void read_name(const toml::node& node, const Models& known,
               const std::vector<external::ExternalModel>& others, external::ExternalModel& model,
               Faults& faults) {
  model.name = read_text(node, keys().external_name.name, faults).value_or("");
  bool is_taken = std::any_of(others.begin(), others.end(), [&](const external::ExternalModel& m) {
    return m.name == model.name;
  });
  known.for_each([&](const auto& entry) { is_taken = is_taken || entry.id == model.name; });
  if (!is_plain_file_name(model.name))
    faults.add(place(node), fmt::format("the name {} must be a plain file name: letters, digits, "
                                        "'.', '_' and '-', not starting with '.' or '-'",
                                        in_quotes(model.name)));
  else if (is_taken)
    faults.add(place(node),
               fmt::format("the name {} is already that of a model", in_quotes(model.name)));
}

external::ExternalModel read_model(Section& table, const Models& known,
                                   const std::vector<external::ExternalModel>& others) {
  Faults& faults = table.faults();
  external::ExternalModel model;
  if (const toml::node* node = table.require(keys().external_name.name))
    read_name(*node, known, others, model, faults);
  if (const toml::node* node = table.find(keys().centrelines.name))
    model.centreline_files = read_file_names(*node, keys().centrelines.name, faults);
  const std::size_t before = faults.size();
  read(table, description::fields<external::ExternalModel>(), model);
  if (model.readings_file.empty() && table.find(keys().centrelines.name) == nullptr &&
      faults.size() == before)
    faults.add(table.where(), fmt::format("{} needs 'centrelines' or 'readings'", table.name()));
  return model;
}

}  // namespace

void read_readings(Section& root, std::string_view file, external::ReadingOptions& readings) {
  Section table = root.section("readings");
  for (const external::ReadingKey& key : external::reading_keys())
    if (const toml::node* node = table.find(key.name)) {
      const auto value = read_line(*node, key.name, key.longest, table.faults());
      readings.*key.option = {value.value_or(""),
                              fmt::format("{}:{}:{}: [readings] {}", file, place(*node).line,
                                          place(*node).column, key.name)};
    }
  table.finish();
}

void read_external(Section& models, const Models& known,
                   std::vector<external::ExternalModel>& external) {
  models.tables("external", 0, most_external,
                [&](Section& table) { external.push_back(read_model(table, known, external)); });
}

void check_external(const Case& c, const Report& report) {
  for (std::size_t i = 0; i < c.external.size(); ++i) {
    const external::ExternalModel& model = c.external[i];
    const std::string path = fmt::format("{}[{}].", external::table_name, i);
    if (!model.centreline_files.empty() && model.centreline_files.size() != c.load_path.size())
      report(path + std::string(keys().centrelines.name),
             fmt::format("there are {} files of centrelines and {} load "
                         "steps: one file for each",
                         model.centreline_files.size(), c.load_path.size()));
    if (!model.readings_file.empty() && c.sensors.empty())
      report(path + "readings", "readings need a place: add [sensor] with 'position'");
  }
}

}  // namespace ciliaval::compare::input

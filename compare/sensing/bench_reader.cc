// SPDX-License-Identifier: LGPL-2.1-or-later
// A bench file read and checked.
#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>

#include "compare/input/case_sections.h"
#include "compare/input/case_syntax.h"
#include "compare/models/registry.h"
#include "compare/sensing/bench.h"
#include "compare/sensing/response.h"
#include "problem/error.h"

namespace ciliaval::compare::sensing {
namespace {

constexpr std::size_t longest_title = 200;  ///< bytes
constexpr Range azimuth_count{1, 3600, false, "a stage stops at so many azimuths"};
constexpr Range draw_count{1, 100'000, false, "a simulation must end"};
constexpr Range seed_range{0, 4294967295.0, false, "a seed is a whole number of 32 bits"};
constexpr Range field_range{0, 1, false, unit_slip};
constexpr Range ambient_range{-1, 1, false, unit_slip};
constexpr Range position_range{0, 1, false, unit_slip};
constexpr Range angle_range{0, 1.6, false, "a stage is not that far off"};

/// A pair of models; one that there is not is a fault at its place.
void read_pair(input::Section& table, std::string_view name, models::ModelPair& pair) {
  const toml::node* node = table.find(name);
  if (node == nullptr) return;
  const std::optional<std::string> text = input::read_text(*node, name, table.faults());
  if (!text) return;
  try {
    pair = parse_pair(*text);
  } catch (const InputError& error) {
    table.faults().add(input::place(*node), error.what());
  }
}

void read_ambient(input::Section& table, Vector3& ambient) {
  const toml::node* node = table.find("ambient");
  if (node == nullptr) return;
  const toml::array* list = node->as_array();
  if (list == nullptr || list->size() != 3) {
    table.faults().add(input::place(*node),
                       "'ambient' has three components, such as [\"20 uT\", \"0 uT\", \"-43 uT\"]");
    return;
  }
  for (std::size_t i = 0; i < 3; ++i)
    if (const auto value = input::read_value((*list)[i], "ambient", quantity::flux_density,
                                             ambient_range, table.faults()))
      ambient[static_cast<Eigen::Index>(i)] = *value;
}

/// The case that the bench names, beside the bench's file.
void read_problem(input::Section& table, const std::filesystem::path& file, input::Case& problem) {
  const toml::node* node = table.require("case");
  if (node == nullptr) return;
  const std::optional<std::string> name = input::read_text(*node, "case", table.faults());
  if (!name) return;
  try {
    problem = input::read_case(file.parent_path() / *name, models::known());
    if (problem.sensors.empty()) throw InputError("the case has no sensor");
    if (problem.load_path.front().is<SweepLoad>())
      throw InputError("it is a sweep, and a bench has loads with a magnitude");
    require_load_to_sense(problem);
    for (const Load& load : problem.load_path)
      if (!(magnitude(load) > 0)) throw InputError("the case has a load that is zero");
  } catch (const InputError& error) {
    table.faults().add(input::place(*node),
                       fmt::format("the case cannot be used: {}", error.what()));
  }
}

}  // namespace

Bench read_bench(const std::filesystem::path& file) {
  const toml::table root = input::parse_toml(input::read_toml_file(file, "bench"), file.string());
  input::Faults faults;
  input::Section top(&root, "the bench", "", {}, faults);
  Bench bench;
  input::Section table = input::require_section(top, "bench");
  if (const toml::node* node = table.find("title"))
    bench.title = input::read_line(*node, "title", longest_title, faults).value_or("");
  read_problem(table, file, bench.problem);
  read_pair(table, "models", bench.models);
  bench.truth = bench.models;
  read_pair(table, "truth", bench.truth);
  table.read("azimuths", azimuth_count, bench.azimuths);
  table.read("draws", draw_count, bench.draws);
  table.read("seed", seed_range, bench.seed);
  table.finish();
  input::Section errors = input::require_section(top, "errors");
  errors.read("noise", quantity::flux_density, field_range, bench.noise);
  errors.read("quantum", quantity::flux_density, field_range, bench.quantum);
  errors.read("sensor_position", quantity::length, position_range, bench.sensor_position);
  errors.read("stage_azimuth", quantity::angle, angle_range, bench.stage_azimuth);
  read_ambient(errors, bench.ambient);
  errors.finish();
  top.finish();
  if (!faults.empty()) throw InputError(faults.report(file.string()));
  return bench;
}

}  // namespace ciliaval::compare::sensing

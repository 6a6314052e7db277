// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/study/study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <sstream>

#include "compare/input/units.h"
#include "fem/checkpoint_file.h"

namespace ciliaval::compare::study {
namespace {

constexpr std::array<Output, 10> outputs{
    Output::B_x,  Output::B_y,     Output::B_z,         Output::dB_x,  Output::dB_y,
    Output::dB_z, Output::dB_norm, Output::sensitivity, Output::range, Output::resolution};

/// Checksum of a file that the case names; the results depend on its content.
std::uint32_t checksum_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  return fem::checksum(bytes);
}

std::string numbers(const std::vector<double>& values) {
  std::vector<std::string> texts;
  texts.reserve(values.size());
  for (const double v : values) texts.push_back(input::format_number(v));
  return fmt::format("{}", fmt::join(texts, " "));
}

/// Where the differences are taken, in steps.
constexpr std::array<int, 4> steps{-2, -1, 1, 2};

/// What is moved at a point behind the sweep; nothing at the first one.
std::optional<Setting> moved_number(const Study& study, std::size_t point) {
  const std::size_t index = point - study.point_count();
  if (index == 0) return std::nullopt;
  const Tolerance& tolerance = study.tolerances[(index - 1) / steps.size()];
  const int step = steps[(index - 1) % steps.size()];
  return Setting{tolerance.number, tolerance.nominal + step * tolerance_step * tolerance.deviation};
}

}  // namespace

std::string_view id(Output output) {
  switch (output) {
    case Output::B_x:
      return "B_x";
    case Output::B_y:
      return "B_y";
    case Output::B_z:
      return "B_z";
    case Output::dB_x:
      return "dB_x";
    case Output::dB_y:
      return "dB_y";
    case Output::dB_z:
      return "dB_z";
    case Output::dB_norm:
      return "dB_norm";
    case Output::sensitivity:
      return "sensitivity";
    case Output::range:
      return "range";
    case Output::resolution:
      break;
  }
  return "resolution";
}

std::span<const Output> all_outputs() {
  return outputs;
}

std::size_t Study::point_count() const {
  std::size_t count = parameters.empty() ? 0 : 1;
  for (const Parameter& p : parameters)
    count = is_zipped ? p.values.size() : count * p.values.size();
  return count;
}

std::size_t Study::all_points() const {
  return point_count() + (tolerances.empty() ? 0 : 1 + steps.size() * tolerances.size());
}

std::vector<double> Study::values_at(std::size_t point) const {
  std::vector<double> values(parameters.size());
  for (std::size_t i = parameters.size(); i-- > 0;) {
    const std::vector<double>& all = parameters[i].values;
    values[i] = all[is_zipped ? point : point % all.size()];
    point = is_zipped ? point : point / all.size();
  }
  return values;
}

input::Case Study::case_at(std::size_t point) const {
  if (point >= point_count()) {
    const input::Case nominal = with_settings(base, fixed);
    const auto moved = moved_number(*this, point);
    return moved ? with_settings(nominal, {*moved}) : nominal;
  }
  std::vector<Setting> settings = fixed;
  const std::vector<double> values = values_at(point);
  for (std::size_t i = 0; i < parameters.size(); ++i)
    settings.push_back({parameters[i].number, values[i]});
  return with_settings(base, settings);
}

input::Case Study::design(const std::vector<double>& values) const {
  std::vector<Setting> settings = fixed;
  for (std::size_t i = 0; i < values.size(); ++i)
    settings.push_back({optimisation->parameters[i].number, values[i]});
  return with_settings(base, settings);
}

std::string Study::describe(std::size_t point) const {
  if (point >= point_count()) {
    const auto moved = moved_number(*this, point);
    return moved ? fmt::format("{} = {}", moved->number.path,
                               input::format_quantity(moved->value, moved->number.quantity))
                 : "nominal";
  }
  const std::vector<double> values = values_at(point);
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    texts.push_back(
        fmt::format("{} = {}", parameters[i].name, format_value(parameters[i], values[i])));
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::vector<std::string> Study::mechanics() const {
  std::vector<std::string> ids;
  for (const models::ModelPair& pair : pairs)
    if (std::find(ids.begin(), ids.end(), pair.mechanics) == ids.end())
      ids.push_back(pair.mechanics);
  return ids;
}

bool Study::asks_for(Output output) const {
  return std::find(outputs.begin(), outputs.end(), output) != outputs.end();
}

std::string format_value(const Parameter& parameter, double value) {
  const std::string text = fmt::format("{:.6g}", value / parameter.unit_size);
  return parameter.unit.empty() ? text : fmt::format("{} {}", text, parameter.unit);
}

std::vector<std::string> resolved(const Study& study) {
  std::vector<std::string> lines;
  input::Case base = study.base;
  base.name = study.name;
  base.title = study.name;
  std::istringstream text(input::to_toml(base));
  for (std::string line; std::getline(text, line);)
    if (!line.empty()) lines.push_back(line);
  const std::filesystem::path& mesh = base.options.solid.mesh;
  if (!mesh.empty()) lines.push_back(fmt::format("mesh file: checksum {:08x}", checksum_of(mesh)));
  for (const Setting& s : study.fixed)
    lines.push_back(fmt::format("fixed: {} = {}", s.number.path, input::format_number(s.value)));
  for (const Parameter& p : study.parameters)
    lines.push_back(fmt::format("parameter: {} = {}", p.number.path, numbers(p.values)));
  for (const Tolerance& t : study.tolerances)
    lines.push_back(
        fmt::format("tolerance: {} = {}", t.number.path, input::format_number(t.deviation)));
  lines.emplace_back(study.is_zipped ? "combine: zip" : "combine: product");
  for (const models::ModelPair& pair : study.pairs)
    lines.push_back(fmt::format("pair: {}", pair.name()));
  for (const Output output : study.outputs) lines.push_back(fmt::format("output: {}", id(output)));
  if (study.optimisation) {
    const Optimisation& o = *study.optimisation;
    lines.push_back(fmt::format("optimise: {}, {} global evaluations, {} starts", id(o.goal),
                                o.global_evaluations, o.starts));
    for (const Limit& limit : o.limits)
      lines.push_back(fmt::format("limit: {} {} {}", id(limit.output),
                                  limit.is_lower ? ">=" : "<=", input::format_number(limit.value)));
    for (std::size_t i = 0; i < o.parameters.size(); ++i)
      lines.push_back(fmt::format("searched: {} = {}, {}, from {}", o.parameters[i].number.path,
                                  numbers(o.parameters[i].values),
                                  o.parameters[i].is_logarithmic ? "logarithmic" : "linear",
                                  input::format_number(o.start[i])));
  }
  if (study.noise) lines.push_back(fmt::format("noise: {}", input::format_number(*study.noise)));
  if (study.rotation)
    lines.push_back(fmt::format("rotation: {}", input::format_number(*study.rotation)));
  return lines;
}

}  // namespace ciliaval::compare::study

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/study/summary/report.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "compare/input/units.h"
#include "compare/output/csv_writer.h"
#include "compare/output/results.h"
#include "compare/output/text_table.h"
#include "problem/support/evenly.h"

namespace ciliaval::compare::study::summary {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_rows = 25;

/// As many points as fit a screen.
std::vector<std::size_t> shown_points(const Study& study) {
  if (study.is_zipped) return support::evenly(study.point_count(), most_rows);
  std::vector<std::size_t> counts;
  for (const Parameter& p : study.parameters) counts.push_back(p.values.size());
  return output::thinned_grid(counts, most_rows);
}

std::string point_table(const StudyResult& result, std::size_t pair) {
  const Study& study = result.study;
  output::TextRows rows(1);
  for (const Parameter& p : study.parameters) rows[0].push_back(heading(p));
  for (const Output output : study.outputs) rows[0].push_back(heading(output, study));
  for (const std::size_t point : shown_points(study)) {
    std::vector<std::string>& row = rows.emplace_back();
    const std::vector<double> values = study.values_at(point);
    for (std::size_t i = 0; i < values.size(); ++i)
      row.push_back(fmt::format("{:.5g}", values[i] / study.parameters[i].unit_size));
    for (std::size_t o = 0; o < study.outputs.size(); ++o)
      row.push_back(cell(study, result.points[point][pair], o));
  }
  return output::text_table(rows);
}

/// How many points of each pair slipped off, were pulled in or failed, and why the first one did.
std::string exceptions(const StudyResult& result) {
  const Study& study = result.study;
  std::string text;
  for (std::size_t pair = 0; pair < study.pairs.size(); ++pair)
    for (const Status status : {Status::slipped_off, Status::pulled_in, Status::failed}) {
      std::size_t count = 0;
      std::size_t first = 0;
      for (std::size_t point = 0; point < study.point_count(); ++point)
        if (result.points[point][pair].status == status && count++ == 0) first = point;
      if (count > 0)
        text +=
            fmt::format("{}: {} at {} of {} points, first at {}: {}\n", study.pairs[pair].name(),
                        output::to_string(status), count, study.point_count(),
                        study.describe(first), result.points[first][pair].message);
    }
  return text.empty() ? text : "\n" + text;
}

}  // namespace

std::string heading(const Parameter& p) {
  return p.unit.empty() ? p.name : fmt::format("{}({})", p.name, p.unit);
}

std::string heading(Output output, const Study& study) {
  return fmt::format("{}({})", symbol(output), unit_of(output, study).name);
}

std::string cell(const Study& study, const PairResult& result, std::size_t output) {
  if (!result.values[output] && result.status != Status::converged)
    return std::string(output::to_string(result.status));
  const double unit = unit_of(study.outputs[output], study).size;
  return output::number_cell(result.values[output], unit, "{:.5g}");
}

std::string text(const StudyResult& result) {
  const Study& study = result.study;
  std::string text = fmt::format("Study \"{}\": {}\n", study.name, study.title);
  const std::size_t count = study.point_count();
  if (count == 0) return text;
  if (const std::size_t shown = shown_points(study).size(); shown < count)
    text += fmt::format("{} points, {} of them below, {} left out; all are in study.csv\n", count,
                        shown, count - shown);
  for (std::size_t pair = 0; pair < study.pairs.size(); ++pair)
    text += fmt::format("\n{}\n{}", study.pairs[pair].name(), point_table(result, pair));
  return text + exceptions(result);
}

void add_csv_header(output::CsvWriter& csv, const Study& study,
                    const std::vector<Parameter>& parameters, std::string_view first) {
  std::vector<std::string> units;
  for (const Parameter& p : parameters)
    if (!p.number.quantity.unit.empty())
      units.push_back(fmt::format("{} {}", p.number.path, p.number.quantity.unit));
  for (const Output output : study.outputs)
    units.push_back(fmt::format("{} {}", id(output), quantity_of(output, study.load()).unit));
  csv.comment(fmt::format("units: {}", fmt::join(units, ", ")));
  csv.add(first);
  for (const Parameter& p : parameters) csv.add(p.number.path);
  csv.add("pair");
  csv.add("status");
  for (const Output output : study.outputs) csv.add(id(output));
  csv.row("message");
}

void add_csv_row(output::CsvWriter& csv, std::string_view first, const std::vector<double>& values,
                 const models::ModelPair& pair, const PairResult& result) {
  csv.add(first);
  for (const double value : values) csv.add(value);
  csv.add(pair.name());
  csv.add(output::to_string(result.status));
  for (const auto& value : result.values) csv.add(value);
  csv.row(result.message);
}

Json number_json(const std::optional<double>& value) {
  return value ? Json(*value + 0.0) : Json(nullptr);
}

Json parameter_json(const Parameter& p, const Json& values) {
  Json json{{"path", p.number.path}, {"name", p.name}, {"unit", p.number.quantity.unit}};
  json.update(values);
  json["shown_unit"] = p.unit;
  json["shown_unit_size"] = p.unit_size;
  json["logarithmic"] = p.is_logarithmic;
  return json;
}

Json pair_json(const Study& study, const PairResult& result) {
  Json json{{"status", output::to_string(result.status)}, {"message", result.message}};
  for (std::size_t o = 0; o < study.outputs.size(); ++o)
    json[std::string(id(study.outputs[o]))] = number_json(result.values[o]);
  json["dB_uncertainty"] = number_json(result.uncertainty);
  if (result.range_uncertainty) json["range_uncertainty"] = number_json(result.range_uncertainty);
  return json;
}

std::string csv(const StudyResult& result) {
  const Study& study = result.study;
  output::CsvWriter csv;
  add_csv_header(csv, study, study.parameters, "point");
  for (std::size_t point = 0; point < study.point_count(); ++point)
    for (std::size_t pair = 0; pair < study.pairs.size(); ++pair)
      add_csv_row(csv, std::to_string(point), study.values_at(point), study.pairs[pair],
                  result.points[point][pair]);
  return csv.text();
}

Json json(const StudyResult& result, const output::Provenance& provenance) {
  const Study& study = result.study;
  Json json{{"schema", 1},
            {"study", study.name},
            {"title", study.title},
            {"case", study.base.name},
            {"provenance",
             {{"version", provenance.version},
              {"git", provenance.git},
              {"libraries", provenance.libraries}}},
            {"resolved", Json::array()},
            {"parameters", Json::array()},
            {"outputs", Json::array()},
            {"pairs", Json::array()},
            {"points", Json::array()}};
  for (const auto& [name, value] : fingerprint(study))
    json["resolved"].push_back(fmt::format("{} = {}", name, value));
  for (const Parameter& p : study.parameters)
    json["parameters"].push_back(parameter_json(p, {{"values", p.values}}));
  for (const Output output : study.outputs)
    json["outputs"].push_back(
        {{"id", id(output)}, {"unit", quantity_of(output, study.load()).unit}});
  for (const models::ModelPair& pair : study.pairs) json["pairs"].push_back(pair.name());
  for (std::size_t point = 0; point < study.point_count(); ++point) {
    Json entry{{"point", point}, {"parameters", Json::object()}, {"pairs", Json::object()}};
    const std::vector<double> values = study.values_at(point);
    for (std::size_t i = 0; i < values.size(); ++i)
      entry["parameters"][study.parameters[i].number.path] = values[i];
    for (std::size_t pair = 0; pair < study.pairs.size(); ++pair)
      entry["pairs"][study.pairs[pair].name()] = pair_json(study, result.points[point][pair]);
    json["points"].push_back(std::move(entry));
  }
  return json;
}

}  // namespace ciliaval::compare::study::summary

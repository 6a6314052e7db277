// SPDX-License-Identifier: LGPL-2.1-or-later
// The ledger of claims, test benches and readings.
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "compare/report/curves.h"
#include "compare/report/sections.h"

namespace ciliaval::compare::report {
namespace {

constexpr double degree = 0.017453292519943295;

std::string range_text(const Json& finding) {
  const std::string low = number(finding.at("low"), 1, 4);
  const std::string high = number(finding.at("high"), 1, 4);
  std::string text = low == high ? low : low + " to " + high;
  if (!finding.at("uncertainty").is_null() && finding["uncertainty"].get<double>() > 0)
    text += " ± " + number(finding["uncertainty"], 1, 1);
  return text + " " + finding.at("unit").get<std::string>();
}

std::vector<Cell> error_cells(const Json& errors, bool flow) {
  std::vector<Cell> cells{number(errors.at("magnitude_rms"), 0.01, 3)};
  if (flow) cells.emplace_back(number(errors.at("speed_rms"), 1, 3));
  cells.emplace_back(number(errors.at("azimuth_rms"), degree, 3));
  cells.emplace_back(number(errors.at("azimuth_largest"), degree, 3));
  cells.emplace_back(number(errors.at("below_ten_degrees"), 0.01, 4));
  return cells;
}

Drawing bench_drawing(const Json& bench, const ShownUnit& unit) {
  const Json& points = at_or_null(bench, "first_draw");
  if (points.is_null()) return {};
  Curves drawing;
  drawing.title = "loads found on the bench";
  drawing.x_label = "load along x, " + unit.name;
  drawing.y_label = "load along y, " + unit.name;
  drawing.equal_axes = true;
  drawing.curves = {{"true load", "#666666", 0, 6, {}},
                    {"found by " + bench.at("models").get<std::string>(), "#4477aa", 0, 7, {}}};
  for (const Json& point : points) {
    std::size_t curve = 0;
    for (const char* key : {"truth", "found"})
      drawing.curves[curve++].points.emplace_back(coordinate(point.at(key).at(0), unit.size),
                                                  coordinate(point.at(key).at(1), unit.size));
  }
  return {drawing.title,
          "The readings of the first sensor drawn, with all errors: circles are the true loads, "
          "dots what was found.",
          script(drawing),
          {480, 520}};
}

}  // namespace

std::string claims_content(const Json& json) {
  std::vector<std::pair<std::string, std::size_t>> counts{
      {"reproduced", 0}, {"not reproduced", 0}, {"depends on the model", 0}, {"not checkable", 0}};
  Table table{"The paper's statements and what the models find",
              {"place", "statement", "verdict", "model or measure", "value", "holds"},
              {}};
  for (const Json& claim : json.at("claims")) {
    const std::string verdict = claim.at("verdict").get<std::string>();
    for (auto& [name, count] : counts) count += name == verdict ? 1 : 0;
    const std::string note = text_at(claim, "note");
    const std::string statement = claim.at("statement").get<std::string>();
    std::vector<Cell> row{
        {claim.at("place").get<std::string>(), "text"},
        {note.empty() ? statement : fmt::format("{}. ({})", statement, note), "text"},
        {verdict, verdict == "reproduced" ? "word" : "word strong"}};
    for (Cell& cell : row) cell.rows = std::max<std::size_t>(claim.at("findings").size(), 1);
    for (const Json& f : claim["findings"]) {
      const Json& holds = f.at("holds");
      const std::string answer = holds.is_null() ? "undecided" : holds.get<bool>() ? "yes" : "no";
      row.insert(
          row.end(),
          {{f.at("models").get<std::string>(), "text plain"}, range_text(f), {answer, "word"}});
      table.rows.push_back(std::exchange(row, {}));
    }
    if (claim["findings"].empty()) {
      row.insert(row.end(), {{unknown, "text plain"}, unknown, {unknown, "word"}});
      table.rows.push_back(std::move(row));
    }
  }
  std::vector<std::string> parts;
  parts.reserve(counts.size());
  for (const auto& [verdict, count] : counts) parts.push_back(fmt::format("{} {}", verdict, count));
  return paragraph(fmt::format("{} claims: {}.", json["claims"].size(), in_words(parts))) +
         html(table);
}

std::string bench_content(const Json& bench, Figures& figures) {
  const ShownUnit unit = shown_unit(bench.value("unit", "N"));
  bool flow = false;
  for (const Json& row : bench.at("sources"))
    flow = flow || row.at("inversion").at("speed_rms").get<double>() > 0;
  std::vector<std::string> head{"load, %"};
  if (flow) head.emplace_back("speed, m/s");
  head.insert(head.end(), {"direction, deg", "largest", "within 10 deg, %"});
  const auto table = [&](const char* caption, const char* name) {
    Table result{caption, {name}, {}};
    result.head.insert(result.head.end(), head.begin(), head.end());
    return result;
  };
  Table inversion =
      table("Full inversion: root mean squares with each error alone, then all", "error");
  Table fit = table("Linear fit of ΔB, as in the paper", "error");
  Table loads = table("Full inversion with all errors, by load", "load");
  const auto add = [&](Table& to, std::string name, const Json& errors) {
    std::vector<Cell> row{std::move(name)};
    for (Cell& cell : error_cells(errors, flow)) row.push_back(std::move(cell));
    to.rows.push_back(std::move(row));
  };
  for (const Json& row : bench["sources"]) {
    const std::string source = row.at("source").get<std::string>();
    add(inversion, source, row["inversion"]);
    add(fit, source, row.at("linear_fit"));
  }
  for (const Json& row : bench.at("by_magnitude"))
    add(loads, fmt::format("{} {}", number(row.at("magnitude"), unit.size, 4), unit.name), row);
  const Json& errors = bench.at("errors");
  return paragraph(fmt::format(
             "Simulated readings of the case {}: read by {}, inverted by {}; {} azimuths, {} "
             "sensors drawn. Standard deviations: noise {} µT, digits of {} µT, sensor position {} "
             "mm, stage {} deg.",
             bench.at("case").get<std::string>(), bench.at("truth").get<std::string>(),
             bench.at("models").get<std::string>(), number(bench.at("azimuths"), 1, 9),
             number(bench.at("draws"), 1, 9), number(errors.at("noise"), 1e-6, 3),
             number(errors.at("quantum"), 1e-6, 3), number(errors.at("sensor_position"), 1e-3, 3),
             number(errors.at("stage_azimuth"), degree, 3))) +
         figures.row({bench_drawing(bench, unit)}) + html(inversion) + html(loads) + html(fit);
}

std::string readings_content(const Json& sensing) {
  const ShownUnit unit = shown_unit(sensing.at("unit").get<std::string>());
  Table table{
      fmt::format("Loads found by {} from the readings", sensing.at("models").get<std::string>()),
      {"sample", "status", "load, " + unit.name, "± (95 %)", "direction, deg", "± (95 %)"},
      {}};
  for (const Json& s : sensing.at("samples"))
    table.rows.push_back({s.at("sample").get<std::string>(),
                          {s.at("status").get<std::string>(), "word"},
                          number(s.at("magnitude"), unit.size),
                          number(s.at("magnitude_interval"), unit.size, 2),
                          number(s.at("azimuth"), degree),
                          number(s.at("azimuth_interval"), degree, 2)});
  return html(table);
}

}  // namespace ciliaval::compare::report

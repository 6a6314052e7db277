// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/validation/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "compare/output/json_file.h"
#include "compare/output/text_table.h"

namespace ciliaval::compare::validation {
namespace {

using Json = nlohmann::ordered_json;
using output::or_null;
using output::ShownUnit;

// ------------------------------------------------------------------------------------------- text

constexpr const char* legend =
    "D measured, S simulated, E = S - D. u_num: numerical uncertainty as the model\n"
    "    states it, taken for a standard one; u_in: what the uncertainties of the\n"
    "    inputs make of S; u_D: that of D; u_val^2 = u_num^2 + u_in^2 + u_D^2 (ASME\n"
    "    V&V 20). Where |E| > 2 u_val the model's error is seen, between\n"
    "    |E| - 2 u_val and |E| + 2 u_val; else it is not seen, but below the latter.\n"
    "    f: parameters were fitted to this value.\n"
    "(1) E^T V^-1 E, V = diag(u_num^2 + u_D^2) + C C^T: an input's error is the same\n"
    "    at all values. In brackets what it is without any error of the model.\n";

std::string title(const Series& series) {
  const auto& measurand = series.measurand();
  std::string result = measurand.name;
  if (measurand.point != std::array<double, 2>{})
    result += fmt::format(" of the point ({:g}, {:g}) mm of the end", 1e3 * measurand.point[0],
                          1e3 * measurand.point[1]);
  std::string sources;
  std::vector<std::string> seen;
  for (const Point& point : series.points)
    if (std::ranges::find(seen, point.measured.source) == seen.end())
      seen.push_back(point.measured.source);
  for (const std::string& source : seen)
    sources += "  " + output::wrapped("from " + source, "    ");
  return fmt::format("\nMeasured: {}, {} value{}\n{}", result, series.points.size(),
                     series.points.size() == 1 ? "" : "s", sources);
}

/// Digits behind the point that show a hundredth of the largest value.
int digits_for(const Series& series, double unit) {
  double largest = 0;
  for (const Point& point : series.points)
    largest = std::max(largest, std::abs(point.measured.value));
  if (!(largest > 0)) return 4;
  return std::clamp(4 - static_cast<int>(std::floor(std::log10(largest / unit))), 1, 9);
}

std::string verdict_cell(const Point& point, const ShownUnit& unit) {
  if (!point.assessment) return std::string(to_string(point.verdict()));
  const auto [least, bound] =
      std::pair(point.assessment->least / unit.size, point.assessment->bound / unit.size);
  return point.verdict() == Verdict::bounded ? fmt::format("{:.2g} to {:.3g}", least, bound)
                                             : fmt::format("not seen, < {:.3g}", bound);
}

/// Each note once, with its steps.
std::string notes_of(const Series& series) {
  std::vector<std::pair<std::string, std::string>> steps_of;
  for (const Point& point : series.points) {
    if (point.note.empty()) continue;
    const std::string step = std::to_string(point.measured.step + 1);
    const auto known =
        std::ranges::find(steps_of, point.note, [](const auto& entry) { return entry.first; });
    if (known == steps_of.end())
      steps_of.emplace_back(point.note, "step " + step);
    else
      known->second += ", " + step;
  }
  std::string text;
  for (const auto& [note, steps] : steps_of)
    text += "  " + output::wrapped(fmt::format("{}: {}", steps, note), "    ");
  return text;
}

std::string series_text(const Series& series) {
  const ShownUnit unit = output::shown_unit(series.measurand().quantity().unit);
  const std::string plain = fmt::format("{{:.{}f}}", digits_for(series, unit.size));
  const auto cell = [&](std::optional<double> value, std::string_view format) {
    return output::number_cell(value, unit.size, format);
  };
  output::TextRows rows{{"step", fmt::format("D ({})", unit.name), "S", "E", "u_num", "u_in", "u_D",
                         "2 u_val", "model error"}};
  for (const Point& point : series.points) {
    const auto& a = point.assessment;
    rows.push_back({fmt::format("{}{}", point.measured.step + 1, point.measured.fitted ? "f" : ""),
                    cell(point.measured.value, plain), cell(point.simulated, plain),
                    cell(a ? std::optional(a->error) : std::nullopt, plain),
                    cell(point.u_num, "{:.2g}"), cell(point.u_input, "{:.2g}"),
                    cell(point.measured.uncertainty, "{:.2g}"),
                    cell(a ? std::optional(2 * a->u_val) : std::nullopt, "{:.2g}"),
                    verdict_cell(point, unit)});
  }
  std::string text = "\n" + series.model;
  if (series.has_sensitivities_of_another())
    text += fmt::format(" (u_in by {})", series.sensitivities_by);
  text += fmt::format("\n{}{}", output::text_table(rows, ">>>>>>>><"), notes_of(series));
  const std::size_t n = series.assessed;
  if (series.rms_error)
    text += fmt::format("  r.m.s. of E {:.3g} {}; chi^2 (1) {} over {} value{} ({} +- {:.1f})\n",
                        *series.rms_error / unit.size, unit.name,
                        series.chi_squared ? fmt::format("{:.3g}", *series.chi_squared) : "-", n,
                        n == 1 ? "" : "s", n, std::sqrt(2.0 * static_cast<double>(n)));
  text += fmt::format("  model error seen at {}, not seen at {}", series.count(Verdict::bounded),
                      series.count(Verdict::not_resolved));
  if (const std::size_t unknown = series.count(Verdict::not_known))
    text += fmt::format(", not known at {}", unknown);
  if (n > 0) {
    std::vector<std::string> seen;
    for (const double factor : factors_of_u_D)
      if (factor != 1)
        seen.push_back(fmt::format("{} ({:g} u_D)", series.seen_with(factor), factor));
    text += fmt::format("\n  seen with another u_D: {}", fmt::join(seen, ", "));
    if (series.has_sensitivities_of_another())
      text += fmt::format("\n  seen with twice the u_in of {}: {}", series.sensitivities_by,
                          series.seen_with(1, 2));
  }
  return text + '\n';
}

std::string domain_text(const std::vector<Extent>& domain) {
  std::string text = "Against measurements (ASME V&V 20). It holds in this domain alone:\n";
  for (const Extent& extent : domain) {
    const ShownUnit unit =
        extent.unit == "T" ? ShownUnit{"mT", 1e-3} : output::shown_unit(extent.unit);
    const std::string range =
        extent.from == extent.to
            ? fmt::format("{:.4g}", extent.from / unit.size)
            : fmt::format("{:.4g} to {:.4g}", extent.from / unit.size, extent.to / unit.size);
    text += fmt::format("  {:<14} {}{}{}: {}\n", extent.name, range, unit.name.empty() ? "" : " ",
                        unit.name, extent.meaning);
  }
  return text;
}

std::string inputs_text(const std::vector<Input>& inputs) {
  std::string text;
  for (const Input& input : inputs) {
    const std::string_view unit = input.number.quantity.unit;
    const auto in_unit = [&](double value) {
      return fmt::format("{:.3g}{}{}", value, unit.empty() ? "" : " ", unit);
    };
    const double u = input.uncertainty;
    std::string known = "+- " + (input.is_relative ? fmt::format("{:.3g} %", 100 * u) : in_unit(u));
    if (input.middle)
      known = fmt::format("from {} to {}", in_unit(*input.middle - input.step * u),
                          in_unit(*input.middle + input.step * u));
    text += "  " + output::wrapped(
                       fmt::format("{} {}{}", input.number.path, known,
                                   input.source.empty() ? "" : fmt::format(" ({})", input.source)),
                       "    ");
  }
  return text.empty() ? text : "Inputs and their standard uncertainties:\n" + text;
}

// ------------------------------------------------------------------------------------------- JSON

Json point_json(const Point& point) {
  const auto& a = point.assessment;
  Json json{{"step", point.measured.step},
            {"measured", point.measured.value},
            {"u_D", point.measured.uncertainty},
            {"simulated", or_null(point.simulated)},
            {"error", a ? Json(a->error) : Json(nullptr)},
            {"u_num", or_null(point.u_num)},
            {"u_input", or_null(point.u_input)},
            {"u_val", a ? Json(a->u_val) : Json(nullptr)},
            {"least", a ? Json(a->least) : Json(nullptr)},
            {"bound", a ? Json(a->bound) : Json(nullptr)},
            {"verdict", to_string(point.verdict())},
            {"fitted", point.measured.fitted},
            {"source", point.measured.source},
            {"contributions", Json::array()}};
  for (const std::optional<double>& c : point.contributions)
    json["contributions"].push_back(or_null(c));
  if (!point.note.empty()) json["note"] = point.note;
  return json;
}

Json series_json(const Series& series) {
  const auto& measurand = series.measurand();
  Json json{{"model", series.model},
            {"sensitivities_by", or_null(series.sensitivities_by)},
            {"quantity", measurand.name},
            {"point", {measurand.point[0], measurand.point[1]}},
            {"unit", measurand.quantity().unit},
            {"assessed", series.assessed},
            {"bounded", series.count(Verdict::bounded)},
            {"not_resolved", series.count(Verdict::not_resolved)},
            {"bounded_with_u_D", Json::array()},
            {"bounded_with_twice_u_input", series.seen_with(1, 2)},
            {"fitted", series.fitted()},
            {"chi_squared", or_null(series.chi_squared)},
            {"rms_error", or_null(series.rms_error)},
            {"points", Json::array()}};
  for (const double factor : factors_of_u_D)
    json["bounded_with_u_D"].push_back({{"factor", factor}, {"bounded", series.seen_with(factor)}});
  for (const Point& point : series.points) json["points"].push_back(point_json(point));
  return json;
}

}  // namespace

std::string text(const Validation& validation, output::Footnotes which) {
  std::string text = domain_text(validation.domain) + inputs_text(validation.inputs);
  for (const std::string& remark : validation.remarks)
    text += output::wrapped("Remark: " + remark, "    ");
  const Series* last = nullptr;
  for (const Series& series : validation.series) {
    if (last == nullptr || !(last->measurand() == series.measurand())) text += title(series);
    text += series_text(series);
    last = &series;
  }
  return text + '\n' + output::footnotes(which, legend);
}

std::string json(const Validation& validation) {
  Json json{{"inputs", Json::array()}, {"domain", Json::object()}};
  for (const Input& input : validation.inputs)
    json["inputs"].push_back({{"number", input.number.path},
                              {"uncertainty", input.uncertainty},
                              {"relative", input.is_relative},
                              {"unit", input.is_relative ? "" : input.number.quantity.unit},
                              {"source", input.source}});
  for (const Extent& extent : validation.domain)
    json["domain"][extent.name] = {{"from", extent.from},
                                   {"to", extent.to},
                                   {"unit", extent.unit},
                                   {"meaning", extent.meaning}};
  json["remarks"] = validation.remarks;
  json["series"] = Json::array();
  for (const Series& series : validation.series) json["series"].push_back(series_json(series));
  return output::to_text(json);
}

}  // namespace ciliaval::compare::validation

// SPDX-License-Identifier: LGPL-2.1-or-later
#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "compare/output/csv_writer.h"
#include "compare/output/results.h"
#include "compare/output/text_table.h"
#include "compare/study/summary/report.h"

namespace ciliaval::compare::study::summary {
namespace {

using Json = nlohmann::ordered_json;

std::string pair_table(const StudyResult& result, std::size_t pair) {
  const Study& study = result.study;
  output::TextRows rows{{"", "value", "sigma"}};
  std::vector<std::string> nominal{"nominal", "", ""};
  std::vector<std::string> total{"all together", "", ""};
  for (const Tolerance& t : study.tolerances)
    rows.push_back({t.number.path, fmt::format("{:.6g} {}", t.nominal / t.unit_size, t.unit),
                    fmt::format("{:.4g} {}", t.deviation / t.unit_size, t.unit)});
  for (std::size_t o = 0; o < study.outputs.size(); ++o) {
    const Propagation p = propagate(result, pair, o);
    const auto cell = [&](const std::optional<double>& value) {
      return output::number_cell(value, unit_of(study.outputs[o], study).size, "{:.4g}");
    };
    rows[0].push_back(heading(study.outputs[o], study));
    nominal.push_back(cell(p.nominal));
    for (std::size_t i = 0; i < p.shares.size(); ++i)
      rows[i + 1].push_back(cell(p.shares[i].spread));
    total.push_back(cell(p.deviation));
  }
  rows.insert(rows.begin() + 1, std::move(nominal));
  rows.push_back(std::move(total));
  return output::text_table(rows);
}

}  // namespace

Propagation propagate(const StudyResult& result, std::size_t pair, std::size_t output) {
  const Study& study = result.study;
  const std::size_t first = study.point_count();
  const auto value = [&](std::size_t point) { return result.points[point][pair].values[output]; };
  Propagation p{value(first), {}, 0.0};
  for (std::size_t i = 0; i < study.tolerances.size(); ++i) {
    const double sigma = study.tolerances[i].deviation;
    const double h = tolerance_step * sigma;
    const std::size_t at = first + 1 + 4 * i;  // −2, −1, 1, 2 steps
    Propagation::Share& share = p.shares.emplace_back();
    if (value(at) && value(at + 1) && value(at + 2) && value(at + 3)) {
      const double fine = (*value(at + 2) - *value(at + 1)) / (2 * h);
      const double coarse = (*value(at + 3) - *value(at)) / (4 * h);
      share.slope = (4 * fine - coarse) / 3;
      share.error = std::abs(*share.slope - fine);
      share.spread = std::abs(*share.slope) * sigma;
    }
    p.deviation = p.deviation && share.spread
                      ? std::optional<double>(std::hypot(*p.deviation, *share.spread))
                      : std::nullopt;
  }
  return p;
}

std::string tolerance_text(const StudyResult& result) {
  const Study& study = result.study;
  if (study.tolerances.empty()) return {};
  std::string text =
      "\nTolerances: what one standard deviation (sigma) of each number does, to first order; all "
      "together if they are independent\n";
  for (std::size_t pair = 0; pair < study.pairs.size(); ++pair) {
    text += fmt::format("\n{}\n", study.pairs[pair].name());
    const PairResult& nominal = result.points[study.point_count()][pair];
    text += nominal.status == Status::converged
                ? pair_table(result, pair)
                : fmt::format("  {}: {}\n", output::to_string(nominal.status), nominal.message);
  }
  return text;
}

std::string tolerance_csv(const StudyResult& result) {
  const Study& study = result.study;
  output::CsvWriter csv;
  csv.comment(
      "units: SI, of the number (deviation), of the output (spread), of the output over the number "
      "(slope, error)");
  csv.row("pair", "output", "output_unit", "number", "number_unit", "nominal", "deviation", "slope",
          "error", "spread");
  for (std::size_t pair = 0; pair < study.pairs.size(); ++pair)
    for (std::size_t o = 0; o < study.outputs.size(); ++o) {
      const Propagation p = propagate(result, pair, o);
      const std::string name = study.pairs[pair].name();
      const std::string_view output = id(study.outputs[o]);
      const std::string_view unit = quantity_of(study.outputs[o], study.load()).unit;
      for (std::size_t i = 0; i < p.shares.size(); ++i) {
        const Tolerance& t = study.tolerances[i];
        const Propagation::Share& share = p.shares[i];
        csv.row(name, output, unit, t.number.path, t.number.quantity.unit, t.nominal, t.deviation,
                share.slope, share.slope ? std::optional(share.error) : std::nullopt, share.spread);
      }
      csv.row(name, output, unit, "all", "", "", "", "", "", p.deviation);
    }
  return csv.text();
}

Json tolerance_json(const StudyResult& result) {
  const Study& study = result.study;
  Json json{{"numbers", Json::array()}, {"pairs", Json::object()}};
  for (const Tolerance& t : study.tolerances)
    json["numbers"].push_back({{"path", t.number.path},
                               {"unit", t.number.quantity.unit},
                               {"nominal", t.nominal},
                               {"deviation", t.deviation}});
  for (std::size_t pair = 0; pair < study.pairs.size(); ++pair) {
    Json& of_pair = json["pairs"][study.pairs[pair].name()];
    of_pair["status"] = output::to_string(result.points[study.point_count()][pair].status);
    for (std::size_t o = 0; o < study.outputs.size(); ++o) {
      const Propagation p = propagate(result, pair, o);
      Json& entry = of_pair[std::string(id(study.outputs[o]))];
      entry = {{"nominal", number_json(p.nominal)},
               {"deviation", number_json(p.deviation)},
               {"slopes", Json::array()},
               {"errors", Json::array()}};
      for (const Propagation::Share& share : p.shares) {
        entry["slopes"].push_back(number_json(share.slope));
        entry["errors"].push_back(share.slope ? Json(share.error) : Json(nullptr));
      }
    }
  }
  return json;
}

}  // namespace ciliaval::compare::study::summary

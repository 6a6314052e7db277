// SPDX-License-Identifier: LGPL-2.1-or-later
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compare/output/text_table.h"
#include "compare/report/curves.h"
#include "compare/report/sections.h"

namespace ciliaval::compare::report {
namespace {

/// Of more combinations of the other parameters some are drawn, of more points some are listed.
constexpr std::size_t most_families = 6;
constexpr std::size_t most_rows = 100;

struct Parameter {
  std::string path;
  std::string name;
  ShownUnit unit;
  bool logarithmic = false;

  std::string label() const { return unit.name.empty() ? name : name + ", " + unit.name; }
  std::string shown(double value) const {
    return number(value, unit.size, 4) + (unit.name.empty() ? "" : " " + unit.name);
  }
};

std::vector<Parameter> parameters_of(const Json& study) {
  std::vector<Parameter> result;
  for (const Json& p : study.at("parameters")) {
    ShownUnit unit = shown_unit(p.at("unit").get<std::string>());
    if (p.contains("shown_unit"))
      unit = {p["shown_unit"].get<std::string>(), p.at("shown_unit_size").get<double>()};
    result.push_back({p.at("path").get<std::string>(), p.at("name").get<std::string>(),
                      std::move(unit), p.value("logarithmic", false)});
  }
  return result;
}

std::string symbol(const std::string& output) {
  if (output == "dB_norm") return "|ΔB|";
  if (output == "sensitivity") return "sensitivity d|ΔB|/dF";
  if (output == "range") return "range: largest load";
  if (output == "resolution") return "resolution: smallest change of the load";
  return output.starts_with("dB_") ? "ΔB" + output.substr(2) : output;
}

/// Whether the parameters' values go together.
bool is_zipped(const Json& study) {
  return study.at("points").size() == study.at("parameters").at(0).at("values").size();
}

/// The points that differ in the first parameter alone, each set with the others' values in words.
struct Family {
  std::string name;
  std::vector<const Json*> points;
};

std::vector<Family> families_of(const Json& study, const std::vector<Parameter>& parameters) {
  std::vector<Family> all;
  std::map<std::string, std::size_t> known;
  const std::size_t other = is_zipped(study) ? parameters.size() : 1;
  for (const Json& point : study.at("points")) {
    std::string name;
    for (std::size_t i = other; i < parameters.size(); ++i)
      name += fmt::format(
          "{}{} = {}", name.empty() ? "" : ", ", parameters[i].name,
          parameters[i].shown(point.at("parameters").at(parameters[i].path).get<double>()));
    const auto [it, is_new] = known.emplace(name, all.size());
    if (is_new) all.push_back({name, {}});
    all[it->second].points.push_back(&point);
  }
  std::vector<Family> result;
  for (const std::size_t i : output::evenly(all.size(), most_families)) result.push_back(all[i]);
  return result;
}

/// "elastica/line 83.2 µT at L2/L0 = 0.87, d = 3 mm; …": of each pair the point at which the output
/// has the largest magnitude.
std::string largest_text(const Json& study, const std::vector<Parameter>& parameters,
                         const std::string& output, const ShownUnit& unit) {
  std::string text;
  for (const Json& pair : study.at("pairs")) {
    const Json* best = nullptr;
    double largest = 0;
    for (const Json& point : study.at("points")) {
      const Json& value = point.at("pairs").at(pair.get<std::string>()).at(output);
      if (value.is_null() ||
          (best != nullptr && std::abs(value.get<double>()) <= std::abs(largest)))
        continue;
      largest = value.get<double>();
      best = &point;
    }
    if (best == nullptr) continue;
    text += fmt::format("{}{} {} {} at ", text.empty() ? "" : "; ", pair.get<std::string>(),
                        number(largest, unit.size, 4), unit.name);
    for (const Parameter& p : parameters)
      text += fmt::format("{}{} = {}", &p == parameters.data() ? "" : ", ", p.name,
                          p.shown(best->at("parameters").at(p.path).get<double>()));
  }
  return text;
}

Drawing drawing_of(const Json& study, const std::vector<Parameter>& parameters,
                   const std::vector<Family>& families, const Json& output) {
  const Parameter& x = parameters.front();
  const std::string id = output.at("id").get<std::string>();
  const ShownUnit unit = shown_unit(output.at("unit").get<std::string>());
  const bool unit_in_legend = families.size() > 1;
  Curves drawing;
  drawing.title = symbol(id);
  drawing.x_label = x.label();
  drawing.y_label = fmt::format("{}, {}", symbol(id), unit.name);
  drawing.logarithmic_x = x.logarithmic;
  std::size_t pair_number = 0;
  for (const Json& pair : study.at("pairs")) {
    const std::string colour(plot::colours[pair_number % plot::colours.size()]);
    for (std::size_t f = 0; f < families.size(); ++f) {
      const std::string name = pair.get<std::string>();
      Curve curve{unit_in_legend ? name + ", " + families[f].name : name,
                  colour,
                  static_cast<int>(unit_in_legend ? f : pair_number) + 1,
                  0,
                  {}};
      if (families[f].points.size() < 30) curve.mark = 7;
      for (const Json* point : families[f].points)
        curve.points.emplace_back(coordinate(point->at("parameters").at(x.path), x.unit.size),
                                  coordinate(point->at("pairs").at(name).at(id), unit.size));
      drawing.curves.push_back(std::move(curve));
    }
    ++pair_number;
  }
  return {fmt::format("{} over {}", symbol(id), x.name),
          fmt::format("Largest magnitude of the points: {}.",
                      largest_text(study, parameters, id, unit)),
          script(drawing), panel_size(drawing)};
}

/// How many points of each pair slipped off or failed, and why the first did.
std::vector<std::string> exceptions(const Json& study) {
  std::vector<std::string> result;
  for (const Json& pair : study.at("pairs"))
    for (const char* status : {"slipped_off", "failed"}) {
      std::size_t count = 0;
      std::string message;
      for (const Json& point : study.at("points")) {
        const Json& of_pair = point.at("pairs").at(pair.get<std::string>());
        if (of_pair.at("status").get<std::string>() != status) continue;
        if (count++ == 0) message = text_at(of_pair, "message");
      }
      if (count > 0)
        result.push_back(fmt::format("{}: {} at {} of {} points{}{}", pair.get<std::string>(),
                                     status, count, study["points"].size(),
                                     message.empty() ? "" : ", the first: ", message));
    }
  return result;
}

/// Of many points some.
std::vector<std::size_t> shown_points(const Json& study) {
  const std::size_t count = study.at("points").size();
  if (is_zipped(study)) return output::evenly(count, most_rows);
  std::vector<std::size_t> counts;
  for (const Json& p : study.at("parameters")) counts.push_back(p.at("values").size());
  return output::thinned_grid(counts, most_rows);
}

Table point_table(const Json& study, const std::vector<Parameter>& parameters,
                  const std::string& pair) {
  Table table{pair, {"point"}, {}};
  for (const Parameter& p : parameters) table.head.push_back(p.label());
  for (const Json& output : study.at("outputs"))
    table.head.push_back(fmt::format("{}, {}", output.at("id").get<std::string>(),
                                     shown_unit(output.at("unit").get<std::string>()).name));
  const Json& points = study.at("points");
  for (const std::size_t i : shown_points(study)) {
    const Json& of_pair = points[i].at("pairs").at(pair);
    std::vector<Cell> row{std::to_string(i)};
    for (const Parameter& p : parameters)
      row.emplace_back(number(points[i].at("parameters").at(p.path), p.unit.size));
    const std::string status = of_pair.at("status").get<std::string>();
    for (const Json& output : study["outputs"]) {
      const Json& value = of_pair.at(output["id"].get<std::string>());
      row.emplace_back(value.is_null() && status != "converged"
                           ? status
                           : number(value, shown_unit(output["unit"].get<std::string>()).size));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Standard deviations of the outputs, by pair.
std::string tolerances(const Json& study) {
  const Json& tolerances = at_or_null(study, "tolerances");
  if (tolerances.is_null()) return {};
  std::string text;
  for (const auto& [pair, of_pair] : tolerances.at("pairs").items()) {
    Table table{pair + ": what one standard deviation of each number does", {"number"}, {}};
    for (const Json& n : tolerances.at("numbers"))
      table.rows.push_back(
          {fmt::format("{} ± {} {}", n.at("path").get<std::string>(), number(n.at("deviation")),
                       n.at("unit").get<std::string>())});
    table.rows.push_back({"all together"});
    for (const Json& output : study.at("outputs")) {
      const ShownUnit unit = shown_unit(output.at("unit").get<std::string>());
      const std::string id = output.at("id").get<std::string>();
      table.head.push_back(fmt::format("{}, {}", id, unit.name));
      const Json& entry = of_pair.at(id);
      for (std::size_t i = 0; i + 1 < table.rows.size(); ++i) {
        const Json& slope = entry.at("slopes").at(i);
        table.rows[i].emplace_back(
            slope.is_null() ? unknown
                            : number(std::abs(slope.get<double>()) *
                                         tolerances["numbers"].at(i).at("deviation").get<double>(),
                                     unit.size, 4));
      }
      table.rows.back().emplace_back(number(entry.at("deviation"), unit.size, 4));
    }
    text += html(table);
  }
  return heading(3, "Tolerances") + text;
}

/// "range >= 2 mN: reached; 1 % less would give 0.47 % more"
std::vector<std::string> constraints_text(const Json& optimum, const Json& best) {
  std::vector<std::string> items;
  for (std::size_t j = 0; j < optimum.at("constraints").size(); ++j) {
    const Json& constraint = optimum["constraints"][j];
    const Json& state = best.at("constraints").at(j);
    const bool is_lower = constraint.contains("at_least");
    const Json& value = constraint.at(is_lower ? "at_least" : "at_most");
    const ShownUnit unit = shown_unit(constraint.at("unit").get<std::string>());
    const std::string limit = constraint.at("times_the_load").get<bool>()
                                  ? number(value) + " times the load"
                                  : number(value, unit.size) + " " + unit.name;
    const std::string gain =
        state.at("reached").get<bool>()
            ? fmt::format("reached; 1 % {} would give {} % more", is_lower ? "less" : "more",
                          number(state.at("elasticity"), 1, 3))
            : "kept, not reached";
    items.push_back(fmt::format("{} {} {}: {}", symbol(constraint.at("output").get<std::string>()),
                                is_lower ? "≥" : "≤", limit, gain));
  }
  return items;
}

/// The designs' parameters; those at a bound with what it would give to move it.
Table design_table(const Json& optimum) {
  Table table{"The designs", {"parameter", "from", "to"}, {}};
  const std::vector<Parameter> parameters = parameters_of(optimum);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& p = parameters[i];
    const Json& bounds = optimum.at("parameters").at(i);
    table.rows.push_back(
        {p.label(), number(bounds.at("from"), p.unit.size), number(bounds.at("to"), p.unit.size)});
  }
  for (const Json& design : optimum.at("designs")) {
    table.head.push_back(design.at("name").get<std::string>());
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      const Parameter& p = parameters[i];
      std::string cell = number(design.at("parameters").at(p.path), p.unit.size);
      const Json& at_bound = at_or_null(design, "at_bound");
      if (!at_bound.is_null() && at_bound.contains(p.path))
        cell += fmt::format(" (bound: 1 % beyond would give {} % more)",
                            number(at_bound[p.path].at("elasticity"), 1, 3));
      table.rows[i].emplace_back(std::move(cell));
    }
  }
  return table;
}

/// What each pair makes of the designs.
Table confirmation_table(const Json& study, const Json& optimum) {
  Table table{"The designs by all pairs", {"design", "pair"}, {}};
  for (const Json& output : study.at("outputs"))
    table.head.push_back(fmt::format("{}, {}", symbol(output.at("id").get<std::string>()),
                                     shown_unit(output.at("unit").get<std::string>()).name));
  table.head.emplace_back("numerical uncertainty of ΔB, µT");
  for (const Json& design : optimum.at("designs"))
    for (const auto& [pair, result] : design.at("pairs").items()) {
      std::vector<Cell> row{design.at("name").get<std::string>(), pair};
      for (const Json& output : study.at("outputs"))
        row.emplace_back(number(result.at(output.at("id").get<std::string>()),
                                shown_unit(output.at("unit").get<std::string>()).size));
      row.emplace_back(number(result.at("dB_uncertainty"), 1e-6, 1));
      table.rows.push_back(std::move(row));
    }
  return table;
}

/// The best design, what holds it, and what each pair makes of it.
std::string optimum_content(const Json& study) {
  const Json& optimum = at_or_null(study, "optimum");
  if (optimum.is_null()) return {};
  std::string text =
      heading(3, "Optimum") +
      paragraph(fmt::format("The largest {} by {}: {} designs evaluated, {} local searches.",
                            symbol(optimum.at("maximise").get<std::string>()),
                            optimum.at("pair").get<std::string>(),
                            optimum.at("evaluations").get<std::size_t>(),
                            optimum.at("local_searches").get<std::size_t>()));
  if (optimum.at("found").get<bool>())
    text += list(constraints_text(optimum, optimum.at("designs").at(1)));
  else
    text += paragraph("No design was found that keeps the limits.");
  return text + html(design_table(optimum)) + html(confirmation_table(study, optimum));
}

}  // namespace

std::string study_content(const Json& study, Figures& figures) {
  const std::vector<Parameter> parameters = parameters_of(study);
  const auto pairs = study.at("pairs").get<std::vector<std::string>>();
  std::vector<std::string> names;
  names.reserve(parameters.size());
  for (const Parameter& p : parameters) names.push_back(p.name);
  const std::string points = study.contains("optimum")
                                 ? "An optimum"
                                 : fmt::format("{} points", study.at("points").size());
  std::string text = paragraph(
      fmt::format("{} of the case {}{}; pairs {}.", points, study.at("case").get<std::string>(),
                  names.empty() ? "" : ", varied in " + in_words(names), in_words(pairs)));
  text += list(exceptions(study));
  if (!parameters.empty() && !study["points"].empty()) {
    const std::vector<Family> families = families_of(study, parameters);
    std::vector<Drawing> drawings;
    drawings.reserve(study.at("outputs").size());
    for (const Json& output : study.at("outputs"))
      drawings.push_back(drawing_of(study, parameters, families, output));
    text += figures.row(drawings);
    std::string tables;
    for (const std::string& pair : pairs) tables += html(point_table(study, parameters, pair));
    const std::size_t count = study["points"].size();
    if (const std::size_t shown = shown_points(study).size(); shown < count)
      tables = paragraph(fmt::format("{} of the {} points, {} are left out; all are in study.csv.",
                                     shown, count, count - shown)) +
               tables;
    text += details("The points' numbers", tables);
  }
  text += tolerances(study) + optimum_content(study);
  std::string lines;
  for (const Json& line : study.at("resolved")) lines += line.get<std::string>() + "\n";
  return text + details("Everything the results depend on, SI units",
                        verbatim("The study, resolved", lines));
}

}  // namespace ciliaval::compare::report

// SPDX-License-Identifier: LGPL-2.1-or-later
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "compare/input/csv.h"
#include "compare/output/sweep.h"
#include "compare/output/table.h"
#include "compare/output/text_table.h"
#include "compare/report/curves.h"
#include "compare/report/sections.h"
#include "problem/error.h"

namespace ciliaval::compare::report {
namespace {

namespace fs = std::filesystem;

constexpr double degree = std::numbers::pi / 180;
constexpr std::array<const char*, 3> axes{"x", "y", "z"};
/// Of more load steps the shapes of some are drawn, evenly chosen.
constexpr std::size_t most_shapes = 5;

std::string colour(std::size_t i) {
  return std::string(plot::colours[i % plot::colours.size()]);
}

/// The models of all steps in the order of the file.
std::vector<std::string> models_of(const Json& summary, const char* kind) {
  std::vector<std::string> names;
  for (const Json& step : summary.at("steps"))
    for (const auto& [name, unused] : step.at(kind).items())
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  return names;
}

/// The load of a step for people, with the flow's velocity if the case stated one.
std::string load_text(const Json& load) {
  const std::string text = output::describe(load_of(load));
  return load.contains("velocity") ? fmt::format("{} m/s: {}", number(load["velocity"]), text)
                                   : text;
}

/// The horizontal axis of everything that is drawn over the load.
struct LoadAxis {
  std::string label;
  std::vector<double> values;  ///< of each step
};

bool is_sweep(const Json& steps) {
  return !steps.empty() && load_of(steps.front().at("load")).is<SweepLoad>();
}

/// The way of a sweep's surface, there and back.
LoadAxis way_axis(const Json& steps) {
  LoadPath path;
  for (const Json& step : steps) path.push_back(load_of(step.at("load")));
  LoadAxis axis{"way of the surface, mm", output::ways(path)};
  for (double& value : axis.values) value *= 1e3;
  return axis;
}

/// Between two samples of a sweep that a model jumps.
std::vector<std::pair<double, double>> jumps(const Json& steps, const LoadAxis& axis) {
  std::vector<std::pair<double, double>> ranges;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const auto& models = steps[i].at("mechanics").items();
    if (std::any_of(models.begin(), models.end(),
                    [](const auto& model) { return model.value().contains("jump"); }))
      ranges.emplace_back(axis.values[i - 1], axis.values[i]);
  }
  return ranges;
}

LoadAxis load_axis(const Json& steps) {
  if (is_sweep(steps)) return way_axis(steps);
  LoadAxis axis;
  ShownUnit unit;
  for (const Json& step : steps) {
    const Json& load = step.at("load");
    const Load of_step = load_of(load);
    const bool speed = load.contains("velocity");
    unit = speed ? ShownUnit{"m/s", 1} : shown_unit(std::string(magnitude_unit(of_step)));
    axis.label = speed ? "flow speed, m/s" : fmt::format("{} load, {}", type(of_step), unit.name);
    axis.values.push_back((speed ? load["velocity"].get<double>() : magnitude(of_step)) /
                          unit.size);
  }
  if (std::is_sorted(axis.values.begin(), axis.values.end(), std::less_equal<>())) return axis;
  for (std::size_t i = 0; i < axis.values.size(); ++i) axis.values[i] = static_cast<double>(i + 1);
  return {"load step", std::move(axis.values)};
}

/// (deflection along the load, height) of a centreline, mm.
std::vector<std::pair<double, double>> shape_of(const fs::path& file, double phi) {
  constexpr std::array columns{
      input::CsvColumn{"x", input::CsvColumn::Kind::quantity, quantity::length},
      input::CsvColumn{"y", input::CsvColumn::Kind::quantity, quantity::length},
      input::CsvColumn{"z", input::CsvColumn::Kind::quantity, quantity::length}};
  constexpr std::array<std::string_view, 3> ignored{"S", "theta", "kappa"};
  input::Faults faults;
  const input::CsvTable table =
      input::read_csv(input::read_csv_file(file), columns, ignored, faults);
  if (!faults.empty()) throw InputError(faults.report(file.string()));
  std::vector<std::pair<double, double>> points;
  for (std::size_t i = 0; i < table.numbers[0].size(); ++i)
    points.emplace_back(
        1e3 * (table.numbers[0][i] * std::cos(phi) + table.numbers[1][i] * std::sin(phi)),
        1e3 * table.numbers[2][i]);
  return points;
}

/// The steps whose shapes are drawn, the last among them.
std::vector<std::size_t> drawn_steps(std::size_t count) {
  std::vector<std::size_t> steps;
  const std::size_t shown = std::min(count, most_shapes);
  for (std::size_t i = 1; i <= shown; ++i) steps.push_back(i * count / shown - 1);
  return steps;
}

/// All shapes and the straight cilium with a margin, not narrower than 0.7 of its height.
std::array<double, 4> window_of(const std::vector<Curve>& curves) {
  double left = 0;
  double right = 0;
  double low = 0;
  double length = 0;
  for (const Curve& curve : curves) {
    double arc = 0;
    for (std::size_t i = 0; i < curve.points.size(); ++i) {
      const auto& [x, z] = curve.points[i];
      left = std::min(left, x);
      right = std::max(right, x);
      low = std::min(low, z);
      if (i > 0) arc += std::hypot(x - curve.points[i - 1].first, z - curve.points[i - 1].second);
    }
    length = std::max(length, arc);
  }
  const double margin = 0.1 * length;
  right = std::max(right + margin, left - margin + 0.7 * length);
  return {left - margin, right, low < 0 ? low - margin : 0, 1.1 * length};
}

Drawing shapes(const Json& summary, const fs::path& folder) {
  const Json& steps = summary.at("steps");
  const LoadAxis axis = load_axis(steps);
  Curves drawing;
  drawing.title = summary.at("case").get<std::string>() + ": deformed centrelines";
  drawing.x_label = "deflection along the load, mm";
  drawing.y_label = "height, mm";
  drawing.equal_axes = true;
  const std::vector<std::string> models = models_of(summary, "mechanics");
  const std::vector<std::size_t> drawn = drawn_steps(steps.size());
  std::set<std::size_t> labelled;  // a number at one model's tip is enough
  for (std::size_t m = 0; m < models.size(); ++m) {
    std::string name_in_legend = models[m];
    for (const std::size_t step : drawn) {
      const Json& of_model = at_or_null(steps[step].at("mechanics"), models[m].c_str());
      if (of_model.is_null() || at_or_null(of_model, "centreline").is_null()) continue;
      const fs::path name = of_model["centreline"].get<std::string>();
      if (name != name.filename()) throw FileError("it names a file in another folder");
      // The most detailed model, which is the others' reference, has the unbroken line.
      Curve curve{std::exchange(name_in_legend, {}), colour(m),
                  m + 1 == models.size() ? 1 : static_cast<int>(m) + 2, 0,
                  shape_of(folder / name, azimuth(load_of(steps[step].at("load"))))};
      const auto [x, z] = curve.points.back();
      if (labelled.insert(step).second) drawing.labels.push_back({x, z, number(axis.values[step])});
      drawing.curves.push_back(std::move(curve));
    }
  }
  if (drawing.curves.empty()) return {};
  drawing.window = window_of(drawing.curves);
  drawing.curves.push_back(
      {"straight", "#999999", 3, 0, {{0, 0}, {0, (*drawing.window)[3] / 1.1}}});
  const std::string some =
      drawn.size() < steps.size()
          ? fmt::format(" {} of the {} load steps are drawn.", drawn.size(), steps.size())
          : "";
  return {drawing.title,
          fmt::format("The centrelines of {} in the plane of the load; the number at a tip is the "
                      "{}.{}",
                      in_words(models), axis.label, some),
          script(drawing),
          {480, 560}};
}

/// Where the cilium touches the surface of a sweep, and the contact forces.
std::vector<Drawing> contact_drawings(const Json& summary) {
  const Json& steps = summary.at("steps");
  if (!is_sweep(steps)) return {};
  const LoadAxis axis = load_axis(steps);
  Curves heights{"Height of the touching point"};
  Curves forces{"Contact forces"};
  heights.y_label = "z, mm";
  forces.y_label = "force, mN";
  const std::vector<std::string> models = models_of(summary, "mechanics");
  for (std::size_t m = 0; m < models.size(); ++m) {
    Curve height{models[m], colour(m), 1, 0, {}};
    Curve normal{models[m] + ", normal", colour(m), 1, 0, {}};
    Curve friction{models[m] + ", friction", colour(m), 2, 0, {}};
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const Json& contact =
          at_or_null(at_or_null(steps[i].at("mechanics"), models[m].c_str()), "contact");
      if (contact.is_null()) continue;
      if (const Json& point = contact.at("point"); !point.is_null())
        height.points.emplace_back(axis.values[i], coordinate(point.at(2), 1e-3));
      normal.points.emplace_back(axis.values[i], coordinate(contact.at("normal_force"), 1e-3));
      friction.points.emplace_back(axis.values[i], coordinate(contact.at("friction_force"), 1e-3));
    }
    heights.curves.push_back(std::move(height));
    forces.curves.insert(forces.curves.end(), {std::move(normal), std::move(friction)});
  }
  std::vector<Drawing> drawings;
  for (Curves* drawing : {&heights, &forces}) {
    drawing->x_label = axis.label;
    drawing->shaded = jumps(steps, axis);
    drawings.push_back({drawing->title,
                        "What the surface does to the cilium. Shaded: between two samples a model "
                        "has jumped.",
                        script(*drawing), panel_size(*drawing)});
  }
  return drawings;
}

/// B or ΔB at the first sensor over the load: a drawing for each component.
std::vector<Drawing> field_drawings(const Json& summary, const char* quantity) {
  const bool change = std::string_view(quantity) == "dB";
  const double unit = change ? 1e-6 : 1e-3;
  const std::string symbol = change ? "ΔB" : "B";
  const Json& steps = summary.at("steps");
  const LoadAxis axis = load_axis(steps);
  const std::vector<std::string> mechanics = models_of(summary, "mechanics");
  const std::vector<std::string> pairs = models_of(summary, "fields");
  std::vector<std::string> kinds;  // of field models, each with a mark of its own
  std::vector<Drawing> drawings;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::string name = fmt::format("{}_{} at sensor 0", symbol, axes[c]);
    Curves drawing;
    drawing.title = name;
    drawing.x_label = axis.label;
    drawing.shaded = jumps(steps, axis);
    drawing.y_label = fmt::format("{}_{}, {}", symbol, axes[c], change ? "µT" : "mT");
    for (const std::string& pair : pairs) {
      const std::string bends = pair.substr(0, pair.find('/'));
      const std::string field = pair.substr(std::min(pair.size(), bends.size() + 1));
      if (std::find(kinds.begin(), kinds.end(), field) == kinds.end()) kinds.push_back(field);
      const auto kind =
          static_cast<int>(std::find(kinds.begin(), kinds.end(), field) - kinds.begin());
      const auto model = static_cast<std::size_t>(
          std::find(mechanics.begin(), mechanics.end(), bends) - mechanics.begin());
      const bool dense = is_sweep(steps);
      Curve curve{
          pair, colour(model), field == "readings" ? 0 : kind + 1, dense ? 0 : 4 + kind, {}};
      for (std::size_t step = 0; step < steps.size(); ++step) {
        const Json& of_pair = at_or_null(steps[step].at("fields"), pair.c_str());
        const Json& rows = of_pair.is_null() ? of_pair : of_pair.at(quantity);
        if (rows.is_null() || rows.empty() || rows[0].is_null()) continue;
        curve.points.emplace_back(axis.values[step], coordinate(rows[0].at(c), unit));
      }
      drawing.curves.push_back(std::move(curve));
    }
    drawings.push_back({fmt::format("{} over the load", name),
                        fmt::format("{} by each pair of models. Colour: bending; mark: field.",
                                    change ? "The change of B that the load makes" : "B itself"),
                        script(drawing), panel_size(drawing)});
  }
  return drawings;
}

/// The steps that a table lists: of a sweep, which has hundreds, some.
std::vector<std::size_t> listed_steps(const Json& steps) {
  constexpr std::size_t most_samples = 101;
  return output::evenly(steps.size(), is_sweep(steps) ? most_samples : steps.size());
}

Table mechanics_table(const Json& summary) {
  Table table{"Shapes: what each mechanics model found",
              {"step, model", "status", "tip x, mm", "y", "z", "±, µm", "angle, deg", "force, mN",
               "unknowns", "iterations", "time, s"},
              {}};
  const Json& steps = summary.at("steps");
  for (const std::size_t step : listed_steps(steps)) {
    for (const auto& [name, m] : steps[step].at("mechanics").items()) {
      const Json& tip = m.at("tip");
      const auto tip_at = [&](std::size_t i) {
        return tip.is_null() ? unknown : number(tip.at(i), 1e-3);
      };
      const std::string status = m.at("status").get<std::string>();
      table.rows.push_back({fmt::format("{}, {}", step + 1, name),
                            {status, status == "failed" ? "word bad" : "word"},
                            tip_at(0),
                            tip_at(1),
                            tip_at(2),
                            number(m.at("tip_uncertainty"), 1e-6, 2),
                            number(m.at("tip_angle"), degree),
                            number(m.at("applied_force"), 1e-3),
                            number(m.at("unknowns"), 1, 9),
                            number(m.at("iterations"), 1, 9),
                            number(m.at("seconds"), 1, 3)});
    }
  }
  return table;
}

Table field_table(const Json& summary) {
  Table table{"B and its change at the sensors",
              {"step, sensor, pair", "Bx, mT", "By", "Bz", "ΔBx, µT", "ΔBy", "ΔBz"},
              {}};
  const std::size_t sensors = summary.at("sensors").size();
  const Json& steps = summary.at("steps");
  for (const std::size_t step : listed_steps(steps)) {
    for (std::size_t s = 0; s < sensors; ++s)
      for (const auto& [name, f] : steps[step].at("fields").items()) {
        std::vector<Cell> row{fmt::format("{}, {}, {}", step + 1, s, name)};
        for (const auto& [key, unit] : {std::pair("B", 1e-3), std::pair("dB", 1e-6)})
          for (std::size_t c = 0; c < 3; ++c) {
            const Json& rows = f.at(key);
            row.emplace_back(rows.is_null() || rows.at(s).is_null()
                                 ? unknown
                                 : number(rows.at(s).at(c), unit, 6));
          }
        table.rows.push_back(std::move(row));
      }
  }
  return table;
}

/// What the models say beside their numbers, each once with the steps.
std::vector<std::string> remarks(const Json& summary) {
  std::vector<std::pair<std::string, std::vector<std::string>>> found;
  const auto add = [&](const std::string& text, const std::string& step) {
    const auto it =
        std::find_if(found.begin(), found.end(), [&](const auto& f) { return f.first == text; });
    (it == found.end() ? found.emplace_back(text, std::vector<std::string>()) : *it)
        .second.push_back(step);
  };
  std::size_t step = 0;
  for (const Json& of_step : summary.at("steps")) {
    const std::string number_of = std::to_string(++step);
    for (const auto& [name, m] : of_step.at("mechanics").items()) {
      const std::string status = m.at("status").get<std::string>();
      const std::string message = text_at(m, "message");
      if (status == "slipped_off" && message.empty() && !m.at("slip_off_force").is_null())
        add(fmt::format("{}: slips off above {} mN", name, number(m["slip_off_force"], 1e-3, 4)),
            number_of);
      if (status == "failed" || !message.empty())
        add(fmt::format("{}: {}{}", name, status == "failed" ? "failed: " : "", message),
            number_of);
    }
    for (const auto& [name, f] : of_step.at("fields").items())
      if (const std::string message = text_at(f, "message"); !message.empty())
        add(fmt::format("{}: {}", name, message), number_of);
  }
  std::vector<std::string> result;
  result.reserve(found.size());
  for (const auto& [text, steps] : found)
    result.push_back(
        fmt::format("load step{} {}: {}", steps.size() > 1 ? "s" : "", in_words(steps), text));
  return result;
}

std::string sensors_text(const Json& sensors) {
  std::vector<std::string> texts;
  texts.reserve(sensors.size());
  for (const Json& s : sensors)
    texts.push_back(fmt::format("({}, {}, {}) mm", number(s.at(0), 1e-3), number(s.at(1), 1e-3),
                                number(s.at(2), 1e-3)));
  return in_words(texts);
}

std::string what_was_run(const Json& summary, const fs::path& folder) {
  std::vector<std::string> loads;
  const Json& steps = summary.at("steps");
  for (const std::size_t step : listed_steps(steps))
    loads.push_back(load_text(steps[step].at("load")));
  std::string text = paragraph(fmt::format(
      "{} load step{}; bending by {}; field by {}; sensor{} at {}.", steps.size(),
      steps.size() == 1 ? "" : "s", in_words(models_of(summary, "mechanics")),
      in_words(models_of(summary, "fields")), summary.at("sensors").size() == 1 ? "" : "s",
      summary.at("sensors").empty() ? "none" : sensors_text(summary["sensors"])));
  text += details("The loads", list(loads));
  std::ifstream stream(folder / "case.toml", std::ios::binary);
  const std::string toml{std::istreambuf_iterator<char>(stream), {}};
  if (!toml.empty())
    text += details("The case with every value that was used", verbatim("Case file", toml));
  return text;
}

}  // namespace

std::string case_content(const Json& summary, const fs::path& folder, Figures& figures) {
  std::string text = what_was_run(summary, folder);
  const std::vector<std::string> said = remarks(summary);
  if (!said.empty()) text += heading(3, "Remarks") + list(said);
  text += heading(3, "Shapes") + figures.row({shapes(summary, folder)}) +
          figures.row(contact_drawings(summary)) +
          details("The shapes' numbers", html(mechanics_table(summary)));
  if (!models_of(summary, "fields").empty())
    text += heading(3, "Field at the sensor") + figures.row(field_drawings(summary, "dB")) +
            figures.row(field_drawings(summary, "B")) +
            details("The field's numbers", html(field_table(summary)));
  text += pair_matrices(summary);
  Table origin{"Where these results come from", provenance_columns(), {provenance_cells(summary)}};
  origin.rows[0].insert(origin.rows[0].begin(), "summary.json");
  origin.head.insert(origin.head.begin(), "file");
  return text + heading(3, "Provenance") + html(origin) + paragraph(libraries_text(summary));
}

std::vector<std::string> case_columns() {
  return {"load steps",     "bending",           "pairs of models", "without a result",
          "pairs resolved", "below uncertainty", "inconclusive"};
}

std::vector<Cell> case_row(const Json& summary) {
  std::size_t missing = 0;
  for (const Json& step : summary.at("steps"))
    for (const auto& [name, m] : step.at("mechanics").items())
      if (m.at("status").get<std::string>() != "converged") ++missing;
  std::map<std::string, std::size_t> verdicts;
  for (const Json& c : summary.at("comparisons")) ++verdicts[c.at("verdict").get<std::string>()];
  const auto count = [&](const char* verdict) { return std::to_string(verdicts[verdict]); };
  return {std::to_string(summary["steps"].size()),
          {in_words(models_of(summary, "mechanics")), "text"},
          std::to_string(models_of(summary, "fields").size()),
          {std::to_string(missing), missing > 0 ? "bad" : ""},
          count("resolved"),
          count("below uncertainty"),
          count("inconclusive")};
}

std::vector<std::string> provenance_columns() {
  return {"version", "git", "date", "command"};
}

std::vector<Cell> provenance_cells(const Json& json) {
  const Json& origin = at_or_null(json, "provenance");
  const auto cell = [&](const char* key, const char* style) {
    const std::string text = origin.is_null() ? "" : text_at(origin, key);
    return Cell(text.empty() ? "not stated" : text, style);
  };
  return {cell("version", "word"), cell("git", "word"), cell("date", "word"),
          cell("command", "text")};
}

std::string libraries_text(const Json& json) {
  const Json& origin = at_or_null(json, "provenance");
  if (origin.is_null() || !origin.contains("libraries")) return "Libraries: not stated.";
  std::vector<std::string> names;
  for (const auto& [name, version] : origin["libraries"].items())
    names.push_back(fmt::format("{} {}", name, version.get<std::string>()));
  return fmt::format("Libraries: {}.", in_words(names));
}

}  // namespace ciliaval::compare::report

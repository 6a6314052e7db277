// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/convergence/plot.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

namespace ciliaval::compare::convergence {
namespace {

constexpr plot::Size panel_size{560, 560};

/// A curve of a panel.
struct Series {
  std::string name;
  const ConvergedQuantity* quantity = nullptr;
};
using Points = std::vector<std::pair<double, double>>;

/// The tip and each pair's |ΔB| at sensor 0 at one load step, where all levels have them.
std::vector<Series> series_of(const RefinementStudy& study, std::size_t step) {
  const std::string tip = fmt::format("steps/{}/mechanics/{}/tip/deflection", step, study.model);
  const std::string fields = fmt::format("steps/{}/fields/", step);
  constexpr std::string_view norm = "/dB/0/norm";
  std::vector<Series> series;
  for (const ConvergedQuantity& q : study.quantities) {
    if (q.levels.size() != study.settings.size()) continue;
    if (q.id == tip)
      series.insert(series.begin(), {"tip", &q});
    else if (q.id.starts_with(fields) && q.id.ends_with(norm))
      series.push_back(
          {"|dB| " + q.id.substr(fields.size(), q.id.size() - fields.size() - norm.size()), &q});
  }
  return series;
}

std::string legend(const Series& series) {
  const Extrapolation& e = series.quantity->extrapolation;
  if (!e.conclusive) return fmt::format("{}: inconclusive: {}", series.name, e.reason);
  const double interval = 100 * e.uncertainty / std::abs(series.quantity->levels.front().value);
  if (!e.order) return fmt::format("{}: {}", series.name, e.reason);
  return fmt::format("{}: order {:.2f}, ± {:.2g} %", series.name, *e.order, interval);
}

/// The points of a curve, (h, |f − f₀|/|f|). A level that has no distance has no point.
Points points_of(const ConvergedQuantity& q) {
  const double finest = q.levels.front().value;
  const double limit = q.extrapolation.conclusive ? q.extrapolation.limit : finest;
  Points points;
  for (const RefinementLevel& level : q.levels) {
    const double error = std::abs(level.value - limit) / std::abs(finest);
    if (std::isfinite(error) && error > 0) points.emplace_back(level.size, error);
  }
  return points;
}

std::string data_block(const std::string& name, const Points& points) {
  std::string text = fmt::format("${} << EOD\n", name);
  for (const auto& [x, y] : points) text += fmt::format("{} {}\n", x, y);
  return text + "EOD\n";
}

/// α h^p from the coarsest to the finest level, α the geometric mean of the points.
Points fitted_line(const Points& points, double order) {
  double logarithm = 0;
  for (const auto& [h, error] : points)
    logarithm += (std::log(error) - order * std::log(h)) / static_cast<double>(points.size());
  const auto at = [&](double h) { return std::pair(h, std::exp(logarithm + order * std::log(h))); };
  return {at(points.front().first), at(points.back().first)};
}

std::string panel(const RefinementStudy& study, std::size_t step, std::size_t steps, int number) {
  std::string blocks;
  std::string curves;
  int colour = 0;
  for (const Series& series : series_of(study, step)) {
    const auto points = points_of(*series.quantity);
    if (points.empty()) continue;
    ++colour;
    const std::string name = fmt::format("points{}_{}", number, colour);
    blocks += data_block(name, points);
    const Extrapolation& e = series.quantity->extrapolation;
    curves += fmt::format(
        "{}  ${} with points {} title {}", curves.empty() ? "" : ", \\\n", name,
        e.conclusive ? fmt::format("lc {} pt {} ps 0.9", colour, 4 + 2 * ((colour - 1) % 5))
                     : "lc 'gray50' pt 2 ps 1",
        plot::quoted(legend(series)));
    if (!e.conclusive || !e.order) continue;
    blocks += data_block("line_" + name, fitted_line(points, *e.order));
    curves += fmt::format(", \\\n  $line_{} with lines lc {} lw 1.2 notitle", name, colour);
  }
  if (curves.empty()) return {};
  std::vector<double> sizes;
  for (const RefinementLevel& level : series_of(study, step).front().quantity->levels)
    sizes.push_back(level.size);
  return blocks +
         fmt::format("set title {}\nset xlabel {} offset 0,0.7\nset xtics ({})\nplot \\\n{}\n",
                     plot::quoted(fmt::format("{}, {}, load step {} of {}", study.model,
                                              study.option, step + 1, steps)),
                     plot::quoted("h: " + study.size_name), fmt::join(sizes, ", "), curves);
}

/// The last step with something to draw.
std::string last_panel(std::size_t steps, const RefinementStudy& study, int number) {
  for (std::size_t step = steps; step-- > 0;) {
    std::string text = panel(study, step, steps, number);
    if (!text.empty()) return text;
  }
  return {};
}

constexpr const char* header =
    "set logscale xy\nset format y '10^{%L}'\nset grid\nset autoscale noextend\n"
    "set offsets graph 0.08, graph 0.08, graph 0.08, graph 0.08\nset ylabel '|f - f₀| / |f|'\n"
    "set key below left vertical maxcols 1 Left reverse samplen 2\n";

/// How many load steps the quantities "steps/N/…" are of.
std::size_t step_count(const RefinementStudy& study) {
  constexpr std::string_view prefix = "steps/";
  std::size_t count = 0;
  for (const ConvergedQuantity& q : study.quantities) {
    std::size_t step = 0;
    if (q.id.starts_with(prefix) &&
        std::from_chars(q.id.data() + prefix.size(), q.id.data() + q.id.size(), step).ec ==
            std::errc())
      count = std::max(count, step + 1);
  }
  return count;
}

}  // namespace

ConvergencePlot convergence_plot(const input::Case& problem,
                                 const std::vector<RefinementStudy>& studies) {
  std::string panels;
  int count = 0;
  for (const RefinementStudy& study : studies)
    if (const std::string text = last_panel(problem.load_path.size(), study, count);
        !text.empty()) {
      panels += text;
      ++count;
    }
  if (panels.empty()) return {};
  const std::string title = fmt::format(
      "set multiplot layout 1,{} title {}\n", count,
      plot::quoted(problem.name + ": distance f - f₀ from the extrapolated limit (grey crosses, "
                                  "inconclusive: from the finest level)"));
  return {header + title + panels + "unset multiplot\n",
          {panel_size.width * count, panel_size.height}};
}

ConvergencePlot convergence_panel(const RefinementStudy& study) {
  const std::string panel = last_panel(step_count(study), study, 0);
  if (panel.empty()) return {};
  return {header + panel, panel_size};
}

}  // namespace ciliaval::compare::convergence

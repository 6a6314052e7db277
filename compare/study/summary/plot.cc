// SPDX-License-Identifier: LGPL-2.1-or-later
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compare/output/text_table.h"
#include "compare/study/summary/report.h"

namespace ciliaval::compare::study::summary {
namespace {

constexpr plot::Size plot_size{760, 520};
constexpr std::size_t most_families = 6;

/// "uT" as it is printed.
std::string with_mu(std::string unit) {
  if (unit.starts_with("uT")) unit.replace(0, 1, "µ");
  return unit;
}

/// The points that differ in the first parameter alone.
struct Family {
  std::vector<std::size_t> points;
  std::string name;  ///< the others' values; empty if there are none
};

/// Of many families some, evenly chosen.
std::vector<Family> families_of(const Study& study, bool& thinned) {
  const bool is_single = study.is_zipped || study.parameters.size() == 1;
  // The first parameter runs slowest: the first of its values has a point of each family.
  const std::size_t count =
      is_single ? 1 : study.point_count() / study.parameters.front().values.size();
  thinned = count > most_families;
  std::vector<Family> families;
  for (const std::size_t f : output::evenly(count, most_families)) {
    Family& family = families.emplace_back();
    for (std::size_t i = f; i < study.point_count(); i += count) family.points.push_back(i);
    const std::string text = study.describe(f);
    if (!is_single) family.name = text.substr(text.find(", ") + 2);
  }
  return families;
}

/// What a drawing shows along its vertical axis.
struct Extremes {
  double least = std::numeric_limits<double>::infinity();
  double largest = -std::numeric_limits<double>::infinity();
  bool any() const { return least <= largest; }
};

struct Curve {
  const StudyResult& result;
  std::size_t pair;
  std::size_t output;
  const Family& family;
};

/// The values as a data block of gnuplot's; a missing one breaks the line.
std::string data_block(const Curve& curve, const std::string& name, Extremes& extremes) {
  const Study& study = curve.result.study;
  const Parameter& x = study.parameters.front();
  const double unit = unit_of(study.outputs[curve.output], study).size;
  std::vector<std::pair<double, double>> rows;
  for (const std::size_t point : curve.family.points) {
    const auto& value = curve.result.points[point][curve.pair].values[curve.output];
    rows.emplace_back(study.values_at(point).front() / x.unit_size,
                      value ? *value / unit : std::numeric_limits<double>::quiet_NaN());
    if (!value) continue;
    extremes.least = std::min(extremes.least, rows.back().second);
    extremes.largest = std::max(extremes.largest, rows.back().second);
  }
  std::sort(rows.begin(), rows.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  std::string text = fmt::format("${} << EOD\n", name);
  for (const auto& [u, v] : rows) text += fmt::format("{} {}\n", u, v);
  return text + "EOD\n";
}

/// Marks at the foot of the drawing where a pair has no value, and which kinds there are.
std::string marks(const Curve& curve, double height, bool& slipped, bool& failed) {
  const Study& study = curve.result.study;
  std::string text;
  for (const std::size_t point : curve.family.points) {
    const PairResult& r = curve.result.points[point][curve.pair];
    if (r.status == Status::converged || r.values[curve.output]) continue;
    const bool is_slip = r.status == Status::slipped_off;
    (is_slip ? slipped : failed) = true;
    text += fmt::format("set label '' at first {}, graph {} point pt {} ps 0.5 lc rgb '{}'\n",
                        study.values_at(point).front() / study.parameters.front().unit_size, height,
                        is_slip ? 2 : 3, plot::colours[curve.pair % plot::colours.size()]);
  }
  return text;
}

/// The rest of a curve's line: its legend, the pair, the family, and the peak if there is one; then
/// a point at the peak.
std::string legend_and_peak(const Curve& curve, std::string_view colour) {
  const Study& study = curve.result.study;
  const std::string name = study.pairs[curve.pair].name();
  if (!curve.family.name.empty()) return plot::quoted(name + ", " + curve.family.name);
  const Trend t = trend(curve.result, curve.pair, curve.output);
  if (t.kind != Trend::Kind::peak) return plot::quoted(name);
  const Parameter& x = study.parameters.front();
  const double at = t.extreme_at / x.unit_size;
  return fmt::format(
      "{}, \\\n  '+' using ({}):({}) every ::0::0 with points pt 7 ps 0.9 lc rgb '{}' "
      "notitle",
      plot::quoted(fmt::format("{}, peak at {:.3g} {}", name, at, x.unit)), at,
      t.largest / unit_of(study.outputs[curve.output], study).size, colour);
}

std::string axis_label(const std::string& name, const std::string& unit) {
  return plot::quoted(unit.empty() ? name : fmt::format("{}, {}", name, unit));
}

/// The horizontal axis: from the least to the largest value.
std::string x_axis(const Parameter& x) {
  const auto [least, largest] = std::minmax_element(x.values.begin(), x.values.end());
  const double from = *least / x.unit_size;
  const double to = *largest / x.unit_size;
  std::string script = fmt::format("set xlabel {} offset 0,0.4\n", axis_label(x.name, x.unit));
  if (from == to) return script;
  return script + (x.is_logarithmic && from > 0 ? plot::logarithmic_x_axis(from, to)
                                                : fmt::format("set xrange [{}:{}]\n", from, to));
}

/// The vertical axis: logarithmic for values of one sign that differ by more than what can be read
/// off a linear one, unless there is a peak or a trough to be seen.
std::string y_axis(const StudyResult& result, std::size_t output, const Extremes& extremes) {
  const Study& study = result.study;
  const output::ShownUnit unit = unit_of(study.outputs[output], study);
  const std::string script = fmt::format(
      "set ylabel {}\n", axis_label(std::string(title(study.outputs[output])), with_mu(unit.name)));
  bool turns = false;
  if (study.is_zipped || study.parameters.size() == 1)
    for (std::size_t pair = 0; pair < study.pairs.size(); ++pair) {
      const Trend::Kind kind = trend(result, pair, output).kind;
      turns = turns || kind == Trend::Kind::peak || kind == Trend::Kind::trough;
    }
  const bool from_zero = extremes.least >= 0 && extremes.largest > 0;
  if (turns || !(extremes.least > 0 && extremes.largest > 30 * extremes.least))
    return script + (from_zero ? "set yrange [0:*]\n" : "");
  return script + fmt::format("set logscale y\nset yrange [{}:{}]\n", extremes.least / 1.5,
                              extremes.largest * 1.5);
}

StudyPlot plot_of(const StudyResult& result, std::size_t output) {
  const Study& study = result.study;
  const Parameter& x = study.parameters.front();
  bool thinned = false;
  bool slipped = false;
  bool failed = false;
  const std::vector<Family> families = families_of(study, thinned);
  Extremes extremes;
  std::string blocks;
  std::string curves;
  constexpr std::size_t few_points = 45;
  const std::string style =
      families.front().points.size() <= few_points ? "linespoints pt 7 ps 0.35" : "lines";
  for (std::size_t pair = 0; pair < study.pairs.size(); ++pair)
    for (std::size_t f = 0; f < families.size(); ++f) {
      const Curve curve{result, pair, output, families[f]};
      const std::string name = fmt::format("curve{}_{}", pair, f);
      const std::string_view colour = plot::colours[pair % plot::colours.size()];
      blocks += data_block(curve, name, extremes);
      if (families.size() == 1)
        blocks += marks(curve, 0.015 + 0.02 * static_cast<double>(pair), slipped, failed);
      curves += fmt::format("{}  ${} with {} lc rgb '{}' dt {} lw 1.8 title {}",
                            curves.empty() ? "" : ", \\\n", name, style, colour, f + 1,
                            legend_and_peak(curve, colour));
    }
  if (!extremes.any()) return {};
  if (slipped) curves += ", \\\n  NaN with points pt 2 ps 0.7 lc rgb 'gray40' title 'slipped off'";
  if (failed) curves += ", \\\n  NaN with points pt 3 ps 0.7 lc rgb 'gray40' title 'failed'";
  const std::string some = thinned ? fmt::format(" ({} of the curves)", most_families) : "";
  const std::string script = fmt::format(
      "set title {}\n{}{}set grid lc rgb '#cccccc'\nset tics nomirror\nset samples 2\n"
      "set key below Left reverse samplen 2.5 maxcols 3\n"
      "set offsets 0, 0, graph 0.06, graph {}\n",
      plot::quoted(study.title + some), x_axis(x), y_axis(result, output, extremes),
      slipped || failed ? 0.08 : 0.04);
  return {fmt::format("{}.svg", id(study.outputs[output])),
          script + blocks + "plot \\\n" + curves + "\n", plot_size};
}

}  // namespace

std::vector<StudyPlot> plots(const StudyResult& result) {
  std::vector<StudyPlot> all;
  if (result.study.parameters.empty()) return all;
  for (std::size_t output = 0; output < result.study.outputs.size(); ++output) {
    StudyPlot plot = plot_of(result, output);
    if (!plot.script.empty()) all.push_back(std::move(plot));
  }
  return all;
}

}  // namespace ciliaval::compare::study::summary

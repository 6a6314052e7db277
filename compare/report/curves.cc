// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/report/curves.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ciliaval::compare::report {
namespace {

/// The points as a block of data; a gap is an empty line.
std::string data_block(const Curve& curve, std::size_t number) {
  std::string text = fmt::format("$curve{} << EOD\n", number);
  for (const auto& [x, y] : curve.points)
    text += std::isfinite(x) && std::isfinite(y) ? fmt::format("{} {}\n", x, y) : "\n";
  return text + "EOD\n";
}

std::string style(const Curve& curve) {
  const std::string mark = curve.mark > 0 ? fmt::format(" pt {} ps 0.6", curve.mark) : "";
  if (curve.dashes == 0) return fmt::format("points{} lc rgb '{}'", mark, curve.colour);
  return fmt::format("{}{} lc rgb '{}' dt {} lw 1.8", curve.mark > 0 ? "linespoints" : "lines",
                     mark, curve.colour, curve.dashes);
}

bool has_points(const Curve& curve) {
  return std::any_of(curve.points.begin(), curve.points.end(), [](const auto& p) {
    return std::isfinite(p.first) && std::isfinite(p.second);
  });
}

/// The horizontal axis of a logarithmic drawing from its least to its largest value.
std::string logarithmic_axis(const Curves& drawing) {
  double least = std::numeric_limits<double>::infinity();
  double largest = 0;
  for (const Curve& curve : drawing.curves)
    for (const auto& [x, y] : curve.points) {
      least = std::min(least, x);
      largest = std::max(largest, x);
    }
  return plot::logarithmic_x_axis(least, largest);
}

/// What has no negative value needs no room below zero.
bool is_never_negative(const Curves& drawing) {
  for (const Curve& curve : drawing.curves)
    for (const auto& [x, y] : curve.points)
      if (y < 0) return false;
  return true;
}

}  // namespace

plot::Size panel_size(const Curves& drawing) {
  const auto entries =
      std::count_if(drawing.curves.begin(), drawing.curves.end(),
                    [](const Curve& c) { return !c.name.empty() && has_points(c); });
  return {430, 330 + 20 * static_cast<int>((entries + 1) / 2)};
}

std::string script(const Curves& drawing) {
  std::string blocks;
  std::string curves;
  for (std::size_t i = 0; i < drawing.curves.size(); ++i) {
    const Curve& curve = drawing.curves[i];
    if (!has_points(curve)) continue;
    blocks += data_block(curve, i);
    curves += fmt::format(
        "{}  $curve{} with {} {}", curves.empty() ? "" : ", \\\n", i, style(curve),
        curve.name.empty() ? std::string("notitle") : "title " + plot::quoted(curve.name));
  }
  if (curves.empty()) return {};
  std::string text = fmt::format(
      "set termoption font 'sans,14'\nset title {}\nset xlabel {} offset 0,0.6\nset ylabel {}\n"
      "set grid lt 1 lc rgb '#e4e4e4'\nset tics nomirror\n"
      "set key below Left reverse samplen 2 maxcols 2 font ',12'\n"
      "set offsets 0, 0, graph 0.05, {}\n",
      plot::quoted(drawing.title), plot::quoted(drawing.x_label), plot::quoted(drawing.y_label),
      is_never_negative(drawing) ? "0" : "graph 0.05");
  if (drawing.window)
    text += fmt::format("set xrange [{}:{}]\nset yrange [{}:{}]\n", (*drawing.window)[0],
                        (*drawing.window)[1], (*drawing.window)[2], (*drawing.window)[3]);
  text += drawing.equal_axes ? "set size ratio -1\n" : "set autoscale xfix\n";
  if (drawing.logarithmic_x) text += logarithmic_axis(drawing);
  for (const auto& [from, to] : drawing.shaded)
    text += fmt::format(
        "set object rectangle from {},graph 0 to {},graph 1 fc rgb '#f2cfcf' fs solid noborder "
        "behind\n",
        from, to);
  for (const Label& label : drawing.labels)
    text += fmt::format("set label {} at {},{} offset 0.4,0.4 font ',11' front\n",
                        plot::quoted(label.text), label.x, label.y);
  return text + blocks + "plot \\\n" + curves + "\n";
}

}  // namespace ciliaval::compare::report

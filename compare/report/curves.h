// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compare/plot/gnuplot.h"

namespace ciliaval::compare::report {

struct Curve {
  std::string name;  ///< in the legend; empty: not there
  std::string colour;
  int dashes = 1;                                 ///< gnuplot's dash type; 0: no line
  int mark = 0;                                   ///< gnuplot's point type; 0: no marks
  std::vector<std::pair<double, double>> points;  ///< what is not finite is a gap
};

struct Label {
  double x = 0;
  double y = 0;
  std::string text;
};

/// Curves over one axis.
struct Curves {
  std::string title;
  std::string x_label;
  std::string y_label;
  bool logarithmic_x = false;
  bool equal_axes = false;                      ///< a shape: one unit is as long along x as along y
  std::optional<std::array<double, 4>> window;  ///< x from, to, y from, to; else what fits
  std::vector<Curve> curves;
  std::vector<Label> labels;
  std::vector<std::pair<double, double>> shaded;  ///< ranges of x
};

/// The size of a panel, with room for its legend: its letters can still be read on a phone.
plot::Size panel_size(const Curves& drawing);

/// For gnuplot; empty if no curve has a point.
std::string script(const Curves& drawing);

}  // namespace ciliaval::compare::report

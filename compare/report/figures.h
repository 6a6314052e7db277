// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compare/plot/gnuplot.h"

namespace ciliaval::compare::report {

/// What a figure shows.
struct Drawing {
  std::string title;    ///< for those who do not see it
  std::string caption;  ///< below it
  std::string script;   ///< for gnuplot; empty: there is nothing to draw
  plot::Size size;
};

/// The figures of a page, each with ids of its own. Where one cannot be drawn, gnuplot not being
/// installed, a sentence stands in its place.
class Figures {
 public:
  using Draw = std::function<std::string(std::string_view script, plot::Size size)>;
  explicit Figures(Draw draw = plot::draw_svg) : draw_(std::move(draw)) {}

  /// The figure as HTML; empty if there is nothing to draw.
  std::string add(const Drawing& drawing);
  /// Figures beside each other where there is room.
  enum class Width { normal, wide };
  std::string row(const std::vector<Drawing>& drawings, Width width = Width::normal);
  /// A picture from a file, as a `data:` URI; `size` in pixels.
  std::string picture(std::string_view png, plot::Size size, const std::string& title);

  /// Why figures could not be drawn: the first reason, or empty.
  const std::string& failure() const { return failure_; }

 private:
  std::string next_id();

  Draw draw_;
  int count_ = 0;
  std::string failure_;
};

/// The body of gnuplot's SVG in an element of this id that scales and has a title for those who do
/// not see it; ids inside begin with `id`. Throws FileError if anything in it would load or run.
std::string inlined(std::string_view svg, const std::string& id, std::string_view title,
                    plot::Size size);

}  // namespace ciliaval::compare::report

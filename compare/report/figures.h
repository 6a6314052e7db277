// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <span>
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

/// The figures of a page, each with ids of its own, drawn all at once when the page is complete.
/// Where one cannot be drawn, gnuplot not being installed, a sentence stands in its place.
class Figures {
 public:
  using Draw = std::function<std::vector<std::string>(std::span<const plot::Script> scripts)>;
  explicit Figures(
      Draw draw = [](std::span<const plot::Script> scripts) { return plot::draw_svgs(scripts); })
      : draw_(std::move(draw)) {}

  /// What stands for the figure in the page's HTML until it is drawn; empty if there is nothing to
  /// draw.
  std::string add(const Drawing& drawing);
  /// Figures beside each other where there is room.
  enum class Width { normal, wide };
  std::string row(const std::vector<Drawing>& drawings, Width width = Width::normal);
  /// A picture from a file, as a `data:` URI; `size` in pixels.
  std::string picture(std::string_view png, plot::Size size, const std::string& title);

  /// The page with the figures that were added to it.
  std::string drawn(std::string_view page);

  /// Why figures could not be drawn: the first reason, or empty.
  const std::string& failure() const { return failure_; }

 private:
  std::string next_id();
  struct Added {
    std::string id;
    Drawing drawing;
  };
  /// Drawn by itself where there is no SVG of it yet.
  std::string html(const Added& added, const std::string* svg);

  std::vector<Added> added_;
  Draw draw_;
  int count_ = 0;
  std::string failure_;
};

/// The body of gnuplot's SVG in an element of this id that scales and has a title for those who do
/// not see it; ids inside begin with `id`. Throws FileError if anything in it would load or run.
std::string inlined(std::string_view svg, const std::string& id, std::string_view title,
                    plot::Size size);

}  // namespace ciliaval::compare::report

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ciliaval::compare::plot {

/// Size of a drawing in pixels of an SVG.
struct Size {
  int width = 800;
  int height = 500;
};

/// Paul Tol's bright colours, told apart by the colour-blind.
inline constexpr std::array<std::string_view, 7> colours{"#4477aa", "#ee6677", "#228833", "#ccbb44",
                                                         "#66ccee", "#aa3377", "#888888"};

/// A logarithmic horizontal axis from `from` > 0 to `to`; a short one has marks at 1, 2 and 5.
std::string logarithmic_x_axis(double from, double to);

/// A text as a string of gnuplot's that shows it letter by letter: quoted, and with the characters
/// escaped that gnuplot's enhanced mode reads as markup; line breaks become blanks.
std::string quoted(std::string_view text);

/// What is to be drawn: a script without a terminal of its own.
struct Script {
  std::string text;
  Size size;
};

inline constexpr double gnuplot_time_limit = 120;  ///< s; a report's drawings take a few

/// What gnuplot draws from each script, as SVG. Starts gnuplot once and directly, without a shell
/// and without the user's settings; no script sees the settings and data of another. Throws
/// FileError if it is not installed, with what to install, if it refuses a script, with its
/// message, or if it does not end within the time limit (s).
std::vector<std::string> draw_svgs(std::span<const Script> scripts,
                                   double time_limit = gnuplot_time_limit);
/// One script alone.
std::string draw_svg(std::string_view script, Size size);

/// Draws the script into a file. Throws FileError.
void write_svg(const std::filesystem::path& file, std::string_view script, Size size);

}  // namespace ciliaval::compare::plot

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/sweep/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "compare/input/case_toml.h"
#include "compare/input/csv.h"
#include "compare/input/described.h"
#include "problem/description/surface.h"
#include "problem/error.h"

namespace ciliaval::compare::input::sweep {

using surroundings::SampledProfile;

SampledProfile read_profile(const std::filesystem::path& file) {
  constexpr std::array<CsvColumn, 2> columns{
      {{"x", CsvColumn::Kind::quantity, quantity::length},
       {"height", CsvColumn::Kind::quantity, quantity::length}}};
  Faults faults;
  CsvTable table = read_csv(read_csv_file(file), columns, {}, faults);
  if (faults.empty()) {
    const std::vector<double>& x = table.numbers[0];
    for (std::size_t i = 1; i < x.size(); ++i)
      if (!(x[i] > x[i - 1]))
        faults.add(table.rows[i], fmt::format("x must increase from row to row: {:g} m is not more "
                                              "than {:g} m",
                                              x[i], x[i - 1]));
    if (x.size() < SampledProfile::fewest_points)
      faults.add(table.rows.back(), fmt::format("a profile has {} points or more, not {}",
                                                SampledProfile::fewest_points, x.size()));
  }
  if (!faults.empty()) throw InputError(faults.report(file.string()));
  // Along the way of the tip, against that of the surface.
  std::vector<double> x = table.numbers[0];
  for (double& value : x) value = -value;
  std::ranges::reverse(x);
  std::ranges::reverse(table.numbers[1]);
  return {std::move(x), std::move(table.numbers[1])};
}

StatedAndMade read_surface(Section& table, const std::filesystem::path& folder) {
  StatedAndMade result;
  surroundings::StatedSurface& stated = result.stated;
  const std::size_t before = table.faults().size();
  read(table, description::fields<surroundings::StatedSurface>(), stated);
  table.finish();
  if (table.faults().size() != before || !table.exists()) return result;
  if (stated.kind == surroundings::StatedSurface::Kind::file) {
    stated.file = std::filesystem::absolute(folder / stated.file).lexically_normal();
    stated.sampled = read_profile(stated.file);
    result.made = surface_of(stated);
    return result;
  }
  try {
    result.made = surface_of(stated);
  } catch (const InputError& error) {
    table.faults().add(table.where(), error.what());
  }
  return result;
}

}  // namespace ciliaval::compare::input::sweep

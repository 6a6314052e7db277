// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/external/external.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "compare/input/csv.h"
#include "compare/input/external/background.h"
#include "problem/centreline.h"
#include "problem/error.h"
#include "problem/lagrange.h"
#include "problem/support/rotation.h"

namespace ciliaval::compare::input::external {
namespace {

namespace fs = std::filesystem;

using Kind = CsvColumn::Kind;

/// The case that the files belong to.
struct Expected {
  const Cilium& cilium;
  const LoadPath& path;
  std::span<const std::string> sensors;  ///< names
};

// ------------------------------------------------------------------------------------ centrelines

constexpr std::size_t fewest_points = 4;
constexpr double closeness = 1e-6;  ///< in lengths of the cilium: the same place

/// The points of a file.
struct Points {
  std::vector<double> S;              ///< m
  std::vector<Vector3> r;             ///< m
  std::vector<double> theta;          ///< rad; may be empty
  std::vector<std::size_t> breaks{};  ///< where the file has a point twice
};

/// The points of the rows. One that is there twice, one after the other, is a break: there the
/// curvature may jump, as at an interface. Its second row is taken out of the table.
void take_points(CsvTable& table, Points& points) {
  std::vector<Place> rows;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const Vector3 r(table.numbers[1][i], table.numbers[2][i], table.numbers[3][i]);
    const auto is_there_at = [&](std::size_t column, const std::vector<double>& of_points) {
      return of_points.empty() || of_points.back() == table.numbers[column][i];
    };
    const std::size_t last = points.r.size() - 1;
    const bool is_break = !points.r.empty() && last > 0 && i + 1 < table.rows.size() &&
                          points.r.back() == r && is_there_at(0, points.S) &&
                          (points.breaks.empty() || points.breaks.back() != last);
    if (is_break) {
      points.breaks.push_back(last);
      continue;
    }
    points.r.push_back(r);
    if (table.has(0)) points.S.push_back(table.numbers[0][i]);
    if (table.has(4)) points.theta.push_back(table.numbers[4][i]);
    rows.push_back(table.rows[i]);
  }
  table.rows = std::move(rows);
}

/// Sum of the chords up to each point.
std::vector<double> chord_lengths(const std::vector<Vector3>& r) {
  std::vector<double> result{0};
  for (std::size_t i = 1; i < r.size(); ++i)
    result.push_back(result.back() + (r[i] - r[i - 1]).norm());
  return result;
}

/// The faults of points by themselves and beside the cilium. `S_place` is that of the column.
void check_points(const Points& points, const CsvTable& table, double L, Faults& faults) {
  const std::vector<double> chords = chord_lengths(points.r);
  for (std::size_t i = 1; i < points.r.size(); ++i) {
    if (!(chords[i] > chords[i - 1]))
      faults.add(table.rows[i], "the row has the same point as the one above");
    else if (table.has(0) && !(points.S[i] > points.S[i - 1]))
      faults.add(table.rows[i], fmt::format("S must increase from row to row: {:g} m is not more "
                                            "than {:g} m",
                                            points.S[i], points.S[i - 1]));
  }
  if (!faults.empty()) return;
  if (points.r.size() < fewest_points) {
    faults.add(table.rows.back(), fmt::format("a centreline has {} points or more, not {}",
                                              fewest_points, points.r.size()));
    return;
  }
  if (points.r.front().norm() > 0.05 * L)
    faults.add(table.rows.front(),
               fmt::format("the first point must be the cilium's base, the origin; it is {:g} m "
                           "from there",
                           points.r.front().norm()));
  if (table.has(0) &&
      (std::abs(points.S.front()) > closeness * L || std::abs(points.S.back() - L) > closeness * L))
    faults.add(table.header[0], fmt::format("S must run from 0 to the cilium's length {:g} m, not "
                                            "from {:g} m to {:g} m",
                                            L, points.S.front(), points.S.back()));
  else if (std::abs(chords.back() / L - 1) > 0.2)
    faults.add(table.rows.back(), fmt::format("the points' line is {:g} m long and the cilium {:g} "
                                              "m: is the unit right, and is it all of it?",
                                              chords.back(), L));
}

/// The indices of the points where the curvature may jump: the ends, the breaks, and the points at
/// interfaces and at a loaded section.
std::vector<std::size_t> curvature_jumps(const Points& points, const Cilium& cilium,
                                         const Load& load) {
  const std::vector<double>& S = points.S;
  std::vector<double> places = cilium.interfaces();
  if (const auto section = load.as<SectionLoad>()) places.push_back(section->arclength);
  std::vector<std::size_t> result = points.breaks;
  result.insert(result.end(), {0, S.size() - 1});
  for (const double place : places)
    for (std::size_t i = 0; i < S.size(); ++i)
      if (std::abs(S[i] - place) <= closeness * cilium.length()) result.push_back(i);
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

/// The first point of each piece and the last of all: pieces of at most three intervals, as even as
/// may be between jumps.
std::vector<std::size_t> piece_ends(const std::vector<std::size_t>& jumps) {
  constexpr std::size_t most_intervals = 3;
  std::vector<std::size_t> result{jumps.front()};
  for (std::size_t k = 0; k + 1 < jumps.size(); ++k) {
    const std::size_t intervals = jumps[k + 1] - jumps[k];
    const std::size_t pieces = (intervals + most_intervals - 1) / most_intervals;
    for (std::size_t i = 1; i <= pieces; ++i) result.push_back(jumps[k] + intervals * i / pieces);
  }
  return result;
}

/// Direction in which the cilium bends: that of its tip, or of the load if it stands upright.
Vector3 bending_direction(const Points& points, double L, const Load& load) {
  const Vector3 tip(points.r.back().x(), points.r.back().y(), 0);
  return tip.norm() > closeness * L ? Vector3(tip.normalized()) : direction(load);
}

/// Cubic interpolation, with the sections at the angle θ, or normal to the curve.
Centreline interpolated(const Points& points, const Cilium& cilium, const Load& load) {
  const std::vector<std::size_t> ends = piece_ends(curvature_jumps(points, cilium, load));
  const Vector3 e = bending_direction(points, cilium.length(), load);
  std::vector<Centreline::Piece> pieces;
  for (std::size_t p = 0; p + 1 < ends.size(); ++p) {
    Centreline::Piece piece;
    piece.S.assign(points.S.begin() + static_cast<std::ptrdiff_t>(ends[p]),
                   points.S.begin() + static_cast<std::ptrdiff_t>(ends[p + 1]) + 1);
    const LagrangeBasis basis(piece.S);
    for (std::size_t i = 0; i < piece.S.size(); ++i) {
      SectionState state;
      state.position = points.r[ends[p] + i];
      Vector3 normal = Vector3::Zero();
      if (points.theta.empty())
        for (std::size_t j = 0; j < piece.S.size(); ++j)
          normal += basis.slope(j, i) * points.r[ends[p] + j];
      else
        normal = std::sin(points.theta[ends[p] + i]) * e +
                 std::cos(points.theta[ends[p] + i]) * Vector3::UnitZ();
      state.rotation = support::turn_to(normal);
      piece.states.push_back(state);
    }
    differentiate_rotation(piece);
    pieces.push_back(std::move(piece));
  }
  return Centreline(std::move(pieces));
}

/// θ must be the angle of a plane curve's sections from +z.
void check_theta(const Points& points, const CsvTable& table, const Cilium& cilium,
                 const Load& load, Faults& faults) {
  constexpr double largest_shear = std::numbers::pi / 6;
  const Vector3 e = bending_direction(points, cilium.length(), load);
  const Vector3 across = Vector3::UnitZ().cross(e);
  for (const Vector3& r : points.r)
    if (std::abs(r.dot(across)) > 1e-3 * cilium.length()) {
      faults.add(table.header[4],
                 "'theta' goes with a plane centreline, and this one leaves the vertical plane of "
                 "its tip: leave the column out");
      return;
    }
  for (std::size_t i = 0; i + 1 < points.r.size(); ++i) {
    const Vector3 chord = points.r[i + 1] - points.r[i];
    const double mean = (points.theta[i] + points.theta[i + 1]) / 2;
    if (std::abs(std::remainder(std::atan2(chord.dot(e), chord.z()) - mean, 2 * std::numbers::pi)) >
        largest_shear) {
      faults.add(table.rows[i],
                 fmt::format("'theta' must be the angle of the section's normal from +z; here it "
                             "is {:g} rad and that of the curve {:g} rad",
                             mean, std::atan2(chord.dot(e), chord.z())));
      return;
    }
  }
}

void read_centreline(std::string_view text, const Expected& c, const Load& load,
                     ExternalModel& model, Faults& faults) {
  const std::array<CsvColumn, 5> columns{{{"S", Kind::quantity, quantity::length, false},
                                          {"x", Kind::quantity, quantity::length, true},
                                          {"y", Kind::quantity, quantity::length, true},
                                          {"z", Kind::quantity, quantity::length, true},
                                          {"theta", Kind::quantity, quantity::angle, false}}};
  constexpr std::array<std::string_view, 1> ignored{"kappa"};
  CsvTable table = read_csv(text, columns, ignored, faults, CsvOthers::not_read);
  if (!faults.empty()) return;
  const double L = c.cilium.length();
  Points points{{}, {}, {}, {}};
  take_points(table, points);
  check_points(points, table, L, faults);
  if (!faults.empty()) return;
  std::string remark;
  if (!table.not_read.empty())
    remark = fmt::format("columns not read: {}; ", fmt::join(table.not_read, ", "));
  if (points.S.empty()) {
    points.S = chord_lengths(points.r);
    const double factor = L / points.S.back();
    for (double& S : points.S) S *= factor;
    remark += fmt::format("S is the length along the points times {:.6f}", factor);
  } else if (remark.ends_with("; ")) {
    remark.resize(remark.size() - 2);
  }
  points.S.front() = 0;
  points.S.back() = L;
  if (!points.theta.empty()) check_theta(points, table, c.cilium, load, faults);
  if (!faults.empty()) return;
  model.centrelines.push_back(interpolated(points, c.cilium, load));
  model.remarks.push_back(remark);
}

// --------------------------------------------------------------------------------------- readings

void require_sensor_column(const CsvTable& table, std::size_t column, std::size_t sensors,
                           Faults& faults) {
  if (!table.has(column) && sensors > 1)
    faults.add({},
               fmt::format("there is no column 'sensor', and the case has {} sensors", sensors));
}

/// Columns of the readings: step, sensor, Bx, By, Bz, dBx, dBy, dBz.
constexpr std::size_t step_column = 0;
constexpr std::size_t sensor_column = 1;
constexpr std::size_t field_column = 2;
constexpr std::size_t change_column = 5;

CsvTable readings_table(std::string_view text, std::size_t sensors, Faults& faults) {
  const std::vector<CsvColumn> columns =
      with_field_columns({{"step", Kind::word, quantity::number, true},
                          {"sensor", Kind::word, quantity::number, false}});
  CsvTable table = read_csv(text, columns, {}, faults);
  if (!faults.empty()) return table;
  require_sensor_column(table, sensor_column, sensors, faults);
  require_field_or_change(table, field_column, change_column, faults);
  return table;
}

/// Puts the rows in their places: [0] undeformed, [1 + step]. A place without a row is empty.
std::vector<std::vector<std::optional<Vector3>>> sorted_rows(const CsvTable& table,
                                                             std::size_t first, const Expected& c,
                                                             Faults& faults) {
  const std::size_t steps = c.path.size();
  std::vector<std::vector<std::optional<Vector3>>> at(
      steps + 1, std::vector<std::optional<Vector3>>(c.sensors.size()));
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::string& word = table.words[step_column][i];
    const auto step = index_in(word, steps);
    if (!step && word != "undeformed") {
      faults.add(table.rows[i],
                 fmt::format("the step {} is neither 'undeformed' nor a load step of the case, 0 "
                             "to {}",
                             in_quotes(word), steps - 1));
      continue;
    }
    const auto sensor = sensor_of(table, sensor_column, i, c.sensors, faults);
    if (!sensor) continue;
    auto& place = at[step ? *step + 1 : 0][*sensor];
    if (place)
      faults.add(table.rows[i], fmt::format("there is a second row of step {}, sensor {}", word,
                                            c.sensors[*sensor]));
    place = row_vector(table, first, i);
  }
  return at;
}

/// Every load step has every sensor; the undeformed cilium all of them or none.
void check_complete(const std::vector<std::vector<std::optional<Vector3>>>& at, bool change,
                    const CsvTable& table, std::span<const std::string> sensors, Faults& faults) {
  const auto there = [](const std::optional<Vector3>& row) { return row.has_value(); };
  for (std::size_t step = 0; step < at.size(); ++step) {
    const bool any = std::any_of(at[step].begin(), at[step].end(), there);
    if (step == 0 && !any) continue;
    if (step == 0 && change)
      faults.add({}, "the change dB of the undeformed cilium is zero: leave its rows out");
    for (std::size_t s = 0; s < at[step].size(); ++s)
      if (!at[step][s])
        faults.add(table.rows.back(),
                   fmt::format("there is no row of step {}, sensor {}",
                               step == 0 ? "undeformed" : std::to_string(step - 1), sensors[s]));
  }
}

/// Takes the background off every reading of B. The undeformed cilium stands at the azimuth that
/// all steps have.
void subtract_background(const Background& background, const Expected& c,
                         std::vector<std::vector<std::optional<Vector3>>>& at, Faults& faults) {
  const double first = azimuth(c.path.front());
  const bool one_azimuth = std::all_of(c.path.begin(), c.path.end(), [&](const Load& load) {
    return apart(azimuth(load), first) <= same_azimuth;
  });
  for (std::size_t step = 0; step < at.size(); ++step)
    for (std::size_t s = 0; s < c.sensors.size(); ++s) {
      if (!at[step][s]) continue;
      if (step == 0 && !one_azimuth) {
        faults.add({},
                   "the load steps have different azimuths, so that the background of the "
                   "undeformed cilium's reading is not known: leave its rows out");
        return;
      }
      const double phi = step == 0 ? first : azimuth(c.path[step - 1]);
      const auto ambient = background.at(phi, s);
      if (!ambient) {
        faults.add({}, fmt::format("the background has a single azimuth, and the load's is {:g} "
                                   "deg: measure it at more of them",
                                   phi * 180 / std::numbers::pi));
        return;
      }
      *at[step][s] -= *ambient;
    }
}

ExternalReading reading(const std::vector<std::optional<Vector3>>& rows,
                        const std::vector<std::optional<Vector3>>& undeformed, bool change) {
  ExternalReading result;
  for (std::size_t s = 0; s < rows.size(); ++s) {
    result.B.push_back(change ? std::nullopt : rows[s]);
    result.dB.push_back(change ? rows[s]
                        : rows[s] && undeformed[s]
                            ? std::optional<Vector3>(*rows[s] - *undeformed[s])
                            : std::nullopt);
  }
  return result;
}

void read_readings(std::string_view text, const Background* background, const Expected& c,
                   ExternalModel& model, Faults& faults) {
  const CsvTable table = readings_table(text, c.sensors.size(), faults);
  if (!faults.empty()) return;
  const bool change = table.has(change_column);
  auto at = sorted_rows(table, change ? change_column : field_column, c, faults);
  if (!faults.empty()) return;
  check_complete(at, change, table, c.sensors, faults);
  if (background != nullptr && change)
    faults.add({}, "the change dB has no background any more: leave 'background' out");
  if (!faults.empty()) return;
  if (background != nullptr) subtract_background(*background, c, at, faults);
  if (at.front().front()) model.undeformed = reading(at.front(), at.front(), change);
  for (std::size_t step = 1; step < at.size(); ++step)
    model.readings.push_back(reading(at[step], at.front(), change));
}

/// Reads one file; what is wrong with it goes to `messages`.
template <typename Read>
void read_file(const fs::path& file, std::string& messages, const Read& read) {
  std::string message;
  try {
    const std::string text = read_csv_file(file);
    Faults faults;
    read(text, faults);
    if (!faults.empty()) message = faults.report(file.string());
  } catch (const InputError& error) {
    message = error.what();
  }
  if (!message.empty()) messages += (messages.empty() ? "" : "\n") + message;
}

}  // namespace

void read_external_files(std::vector<ExternalModel>& models, const Cilium& cilium,
                         const LoadPath& path, std::span<const std::string> sensors) {
  const Expected c{cilium, path, sensors};
  std::string messages;
  for (ExternalModel& model : models) {
    for (std::size_t i = 0; i < model.centreline_files.size(); ++i)
      read_file(model.centreline_files[i], messages, [&](const std::string& text, Faults& faults) {
        read_centreline(text, c, c.path[i], model, faults);
      });
    std::optional<Background> background;
    if (!model.background_file.empty())
      read_file(model.background_file, messages, [&](const std::string& text, Faults& faults) {
        background.emplace(text, c.sensors, faults);
        if (!faults.empty()) background.reset();
      });
    if (!model.readings_file.empty() && (background || model.background_file.empty()))
      read_file(model.readings_file, messages, [&](const std::string& text, Faults& faults) {
        read_readings(text, background ? &*background : nullptr, c, model, faults);
      });
  }
  if (!messages.empty()) throw InputError(messages);
}

}  // namespace ciliaval::compare::input::external

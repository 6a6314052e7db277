// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compare/input/csv.h"
#include "problem/types.h"

/// Common parts of the CSV files of readings.
namespace ciliaval::compare::input::external {

/// Rows of Bx, By, Bz in columns first … first + 2.
Vector3 row_vector(const CsvTable& table, std::size_t first, std::size_t row);

/// A whole number below a bound, or none.
std::optional<std::size_t> index_in(const std::string& text, std::size_t bound);

/// The sensor of a row; 0 where the file has no such column and the case one sensor. One that the
/// case does not have is a fault.
std::optional<std::size_t> sensor_of(const CsvTable& table, std::size_t column, std::size_t row,
                                     std::span<const std::string> sensors, Faults& faults);

/// The sensors for messages: "0 to 3" or "left, right".
std::string sensor_list(std::span<const std::string> sensors);

/// Optional columns for what sensors read, after others: Bx, By, Bz, dBx, dBy, dBz.
std::vector<CsvColumn> with_field_columns(std::vector<CsvColumn> columns);

/// Adds a fault unless the table has the three columns from `field` on (B) or those from `change`
/// on (ΔB), and no others of the six.
void require_field_or_change(const CsvTable& table, std::size_t field, std::size_t change,
                             Faults& faults);

/// Adds a fault for each row with a component beyond ±100 T in the three columns from `first` on.
void require_field_range(const CsvTable& table, std::size_t first, Faults& faults);

/// Distance of two azimuths on the circle, rad.
double apart(double a, double b);

inline constexpr double same_azimuth = 1e-9;  ///< rad

/// The ambient field that the sensors see at each azimuth, without the cilium. Rows of one azimuth
/// and sensor are averaged.
class Background {
 public:
  /// Adds the text's own faults, with their places.
  Background(std::string_view text, std::span<const std::string> sensors, Faults& faults);

  /// The field at an azimuth (rad), T: the mean of the rows of this azimuth (to 1e-9), else linear
  /// interpolation between the neighbours on the circle. None if there are but rows of another
  /// azimuth.
  std::optional<Vector3> at(double azimuth, std::size_t sensor) const;

 private:
  struct Mean {
    double azimuth = 0;  ///< rad, in [0, 2π)
    Vector3 B = Vector3::Zero();
    std::size_t rows = 0;
  };
  std::vector<std::vector<Mean>> of_sensor_;  ///< of each sensor, by azimuth
};

}  // namespace ciliaval::compare::input::external

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace ciliaval::compare::sensing {

/// The readings of all sensors at one time.
struct Sample {
  std::string name;        ///< as the file has it, or the row's number from 1
  Eigen::VectorXd change;  ///< ΔB of all sensors one after the other, T
};

/// Readings of loads that are not known, less all offsets.
struct SensorReadings {
  std::vector<Sample> samples;
  bool measured_offset = false;  ///< else the samples hold B, from which the offset is to be taken
  /// Standard deviation of ΔB over that of a reading: √(1 + 1/n) with the mean of n unloaded ones.
  double noise_factor = 1;
};

/// Reads readings from a CSV file with a header and units (docs/guide/sensing.md): columns Bx, By,
/// Bz, or dBx, dBy, dBz; with several sensors `sample` and `sensor`, a row for each; `azimuth`,
/// that of the sensor's own x axis, where the background is taken off; `time` is ignored. Rows of
/// the sample `unloaded` are the straight cilium: with more than one row of a sensor, their mean.
/// The earth's field and the undeformed magnet's field are subtracted:
///
///   ΔB = (B − background(azimuth)) − (B_unloaded − background(azimuth of the unloaded)).
///
/// Without unloaded rows B itself is left where ΔB should be: `measured_offset` is false.
/// Throws InputError with every fault found, a line each: `file:line:column: what is wrong`.
SensorReadings read_sensor_readings(const std::filesystem::path& file,
                                    const std::optional<std::filesystem::path>& background,
                                    std::size_t sensors);

}  // namespace ciliaval::compare::sensing

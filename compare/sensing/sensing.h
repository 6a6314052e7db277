// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compare/output/provenance.h"
#include "compare/sensing/inversion.h"

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

/// The outcome for a reading.
enum class SenseStatus {
  found,         ///< a load, with its interval
  nothing,       ///< the interval holds zero: no load is seen, and no direction known
  beyond_range,  ///< the load is larger than the largest computed
  misfit,        ///< no load explains the reading: noise alone does so once in a thousand times
  failed         ///< the least squares did not converge
};
std::string_view to_string(SenseStatus status);
SenseStatus status_of(const SensedLoad& sensed);

/// How a flow's force becomes a velocity, v = √(2q/(ρ d C_d)) (paper, Eq. 10–11).
struct FlowLaw {
  double density = 0;                              ///< ρ, kg/m³
  double drag_coefficient = 0;                     ///< C_d
  double diameter = 0;                             ///< d, m
  double velocity(double force_per_height) const;  ///< 0 for a q below 0
  double force_per_height(double velocity) const;
};
/// The law of a case whose flow is given by its velocity.
std::optional<FlowLaw> flow_law(const input::Case& problem);

/// A case's readings and the loads found from them.
struct Sensing {
  std::string case_name;
  models::ModelPair models;
  Vector3 noise = Vector3::Zero();  ///< T
  std::string unit;                 ///< of the load's magnitude
  double largest = 0;               ///< load computed
  double interpolation_error = 0;   ///< T
  double largest_change = 0;        ///< T
  bool measured_offset = false;
  std::optional<FlowLaw> flow;
  std::vector<std::pair<std::string, SensedLoad>> samples;  ///< by name
};

/// A table for people.
std::string sensing_text(const Sensing& sensing);
/// {"schema": 1, "case", "models", "noise", "unit", "largest", "interpolation_error", "offset",
/// "samples": [{"sample", "status", "load": [x, y], "magnitude", "magnitude_interval", "azimuth",
/// "azimuth_interval", "covariance", "chi_squared", "misfit_probability", "velocity",
/// "velocity_interval": [low, high]}]}; angles in rad, half-widths of 95 %.
std::string sensing_json(const Sensing& sensing, const output::Provenance& provenance);
/// A line for each sample, units in the header.
std::string sensing_csv(const Sensing& sensing);

}  // namespace ciliaval::compare::sensing

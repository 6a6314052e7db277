// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "compare/input/external/reading_options.h"
#include "compare/output/provenance.h"
#include "compare/sensing/inversion.h"

namespace ciliaval::compare::sensing {

/// The readings of all sensors at one time.
struct Sample {
  std::string name;                 ///< as the file has it, or the row's number from 1
  Eigen::VectorXd change;           ///< ΔB of all sensors one after the other, T
  std::size_t rows = 1;             ///< whose mean it is; of the sensor with the fewest
  std::optional<double> time = {};  ///< of the first row, s; none if the file has none
  /// Covariance of the sensors by the noise of the background that is taken off, over σ²; empty:
  /// none is.
  Eigen::MatrixXd background = {};
};

/// How much rows that should read the same differ.
struct Scatter {
  double squares = 0;        ///< Σ (B − mean)², T²
  std::size_t freedom = 0;   ///< degrees of freedom
  double deviation() const;  ///< standard deviation of a component, T
};

/// Readings of loads that are not known, less all offsets.
struct SensorReadings {
  std::vector<Sample> samples;
  bool measured_offset = false;  ///< else the samples hold B, from which the offset is to be taken
  double offset_variance = 0;    ///< 1/n, with the mean of n unloaded readings; else 0
  Scatter scatter;               ///< of the rows of each sample, and of the unloaded ones
  std::string remark;            ///< what was read of the file, for people

  /// Of ΔB: 1/m + 1/n with m rows and n unloaded ones, and the background's.
  ReadingError error(const Sample& sample) const;
  /// The variance over σ² that ΔB of a sample has in common with that of the others: of the offset
  /// and the background; of several sensors the largest in any combination of them.
  double common_variance(const Sample& sample) const;
};

/// Reads readings from a file as loggers write it (logger/file.h, docs/guide/sensing.md) for a case
/// with these sensors. Rows of one name in the column `sample` are averaged; without the column
/// each row is a sample, or all rows of one time where each sensor has its own rows. The unloaded
/// rows are those of the sample `unloaded`, or those that `options.unloaded` names. The earth's
/// field and the undeformed magnet's field are subtracted:
///
///   ΔB = (B − background(azimuth)) − (B_unloaded − background(azimuth of the unloaded)).
///
/// Rows of one azimuth of the background are averaged, each with the noise of a reading; what a row
/// of it adds to both parts of ΔB, its own and the unloaded one, adds no noise. With
/// `options.unloaded` "model", B itself is left where ΔB should be: `measured_offset` is
/// false. Without an unloaded row the file is refused. Throws InputError with every fault found, a
/// line each: `file:line:column: what is wrong`.
SensorReadings read_sensor_readings(const std::filesystem::path& file,
                                    const std::optional<std::filesystem::path>& background,
                                    std::span<const std::string> sensors,
                                    const input::external::ReadingOptions& options);

/// The outcome for a reading.
enum class SenseStatus {
  found,         ///< a load, with its interval
  nothing,       ///< SensedLoad::is_nothing(): no load is seen, and no direction known
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
  std::vector<std::string> remarks;  ///< what was read, and what is doubtful about it
  std::optional<FlowLaw> flow;
  std::vector<std::pair<Sample, SensedLoad>> samples;
};

/// The range of loads that is looked for, where it ends below the one asked for, and why; none
/// where it does not.
std::optional<std::string> range_remark(const Shapes& shapes, double asked, std::string_view unit);

/// A doubt about rows that should read the same and differ by more than the noise (T); none if
/// noise alone does so once in a thousand times.
std::optional<std::string> scatter_remark(const Scatter& scatter, double noise);

/// A table for people.
std::string sensing_text(const Sensing& sensing);
/// {"schema": 1, "case", "models", "noise", "unit", "largest", "interpolation_error", "offset",
/// "remarks", "samples": [{"sample", "rows", "time" (s, if known), "status", "load": [x, y],
/// "magnitude", "magnitude_interval", "azimuth", "azimuth_interval", "covariance", "chi_squared",
/// "misfit_probability", "nothing_probability", "velocity", "velocity_interval": [low, high]}]};
/// angles in rad, half-widths of 95 %.
std::string sensing_json(const Sensing& sensing, const output::Provenance& provenance);
/// A line for each sample, units in the header.
std::string sensing_csv(const Sensing& sensing);

}  // namespace ciliaval::compare::sensing

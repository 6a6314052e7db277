// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "problem/centreline.h"
#include "problem/cilium.h"
#include "problem/description/field.h"
#include "problem/load.h"
#include "problem/types.h"

namespace ciliaval::compare::input::external {

inline constexpr std::string_view table_name = "models.external";

/// Readings at one time: a vector for each sensor, T; none where it is not known.
struct ExternalReading {
  std::vector<std::optional<Vector3>> B;   ///< flux density of the cilium, background taken off
  std::vector<std::optional<Vector3>> dB;  ///< B − B(undeformed)
};

/// Results of another program or a test bench for the cilium of the case, as the tables
/// [[models.external]] and the CSV files that they name state it (docs/guide/referees.md).
struct ExternalModel {
  std::string name;                                     ///< a plain file name, not that of a model
  std::vector<std::filesystem::path> centreline_files;  ///< one for each load step, or none
  std::filesystem::path readings_file;                  ///< empty: none
  std::filesystem::path background_file;                ///< empty: none
  std::optional<double> tip_uncertainty;                ///< of each tip, m
  std::optional<double> field_uncertainty;              ///< of each component of each reading, T

  std::vector<Centreline> centrelines;        ///< one for each load step, or none
  std::vector<std::string> remarks;           ///< on each centreline; empty: nothing to say
  std::optional<ExternalReading> undeformed;  ///< of the straight cilium
  std::vector<ExternalReading> readings;      ///< one for each load step, or none
};

/// Reads the files that the models name, which are as many centrelines as load steps or none
/// (docs/guide/referees.md): fills in centrelines, remarks, undeformed and readings.
///
/// Centrelines are interpolated by cubic polynomials between the points; without a column S it is
/// the length along the points, scaled to the cilium's; without theta the sections are normal to
/// the curve. The background at the load's azimuth is subtracted from the readings B: the row of
/// this azimuth, or a linear interpolation on the circle.
///
/// `sensors`: their names. Throws InputError with every fault found, a line each:
/// `file:line:column: what is wrong`.
void read_external_files(std::vector<ExternalModel>& models, const Cilium& cilium,
                         const LoadPath& path, std::span<const std::string> sensors);

}  // namespace ciliaval::compare::input::external

namespace ciliaval::description {

/// Fields of [[models.external]] but for the name and the list of centrelines.
template <>
const Fields<compare::input::external::ExternalModel>&
fields<compare::input::external::ExternalModel>();

}  // namespace ciliaval::description

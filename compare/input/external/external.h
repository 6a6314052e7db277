// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "problem/centreline.h"
#include "problem/types.h"

namespace ciliaval::compare::input::external {

/// Readings at one time: a vector for each sensor, T; none where it is not known.
struct ExternalReading {
  std::vector<std::optional<Vector3>> B;   ///< flux density of the cilium, background taken off
  std::vector<std::optional<Vector3>> dB;  ///< B − B(undeformed)
};

/// What another program or a test bench found out about the cilium of the case, as the tables
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

}  // namespace ciliaval::compare::input::external

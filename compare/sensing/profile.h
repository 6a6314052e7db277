// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "compare/models/model_pair.h"
#include "compare/output/provenance.h"
#include "compare/sensing/sensing.h"

/// From what the sensors read while a cilium is drawn over a surface back to the surface.
namespace ciliaval::compare::sensing {

/// ΔB of all sensors under a level surface that slides over the tip, over the interference.
class LevelCurve {
 public:
  /// Follows the case's cilium under a flat surface with the case's friction, pressed from nothing
  /// to `largest` (m) in small steps, while it slides. Throws InputError if the models do not take
  /// the case, SolverError where they fail.
  LevelCurve(const input::Case& sweep, const models::ModelPair& pair, double largest,
             const Progress& progress = {});

  struct Place {
    double interference = 0;  ///< of the nearest point of the curve, m
    double distance = 0;      ///< from there, T
    double slope = 0;         ///< |dΔB/dδ| there, T/m
    bool is_end = false;      ///< the reading lies beyond the largest interference
    /// Distance of the nearest point at another interference, where the distance has a minimum too;
    /// infinite if there is none.
    double other = 0;
  };
  Place nearest(const Eigen::VectorXd& change) const;

  double largest() const { return interference_.back(); }  ///< interference, m
  /// Why the curve ends below the largest interference asked for; empty: it does not.
  const std::string& limit() const { return limit_; }

 private:
  std::vector<double> interference_;
  std::vector<Eigen::VectorXd> change_;
  std::string limit_;
};

/// A reading as that of a level surface.
struct HeightReading {
  enum class Status {
    level,      ///< it is one of a level surface, at this interference
    off_curve,  ///< no level surface gives it: a flank, a tip that sticks or turns back
    ambiguous,  ///< two interferences give it
    beyond      ///< the interference is larger than the largest computed
  };
  Status status = Status::level;
  double interference = 0;     ///< m
  double interval = 0;         ///< half-width of 95 % by the noise, m
  double common_interval = 0;  ///< the part of it that the readings have in common: the offset's, m
};
std::string_view to_string(HeightReading::Status status);

/// Successive readings of one level.
struct Level {
  std::size_t first = 0;  ///< row, from 0
  std::size_t last = 0;
  double interference = 0;  ///< mean of three quarters of the readings, m
  double interval = 0;      ///< of the mean, half-width of 95 %, m
};

struct SensedProfile {
  std::string case_name;
  models::ModelPair models;
  double noise = 0;  ///< T
  std::vector<HeightReading> readings;
  std::vector<Level> levels;
};

/// The readings one by one, and the levels among them: five or more in a row whose interferences
/// differ by no more than their noise. The interval of a level's mean: the readings' own noise
/// averages out, that of offset and background, which they have in common, does not.
SensedProfile sense_profile(const LevelCurve& curve, const SensorReadings& readings, double noise);

/// A table of the levels for people, with the steps between them and what is not known there.
std::string profile_text(const SensedProfile& profile);
/// {"schema": 1, "case", "models", "noise", "readings": [{"status", "interference", "interval"}],
/// "levels": [{"first", "last", "interference", "interval", "height"}]}, SI; height over the first
/// level, towards the cilium.
std::string profile_json(const SensedProfile& profile, const output::Provenance& provenance);
/// A line for each reading, units in the header.
std::string profile_csv(const SensedProfile& profile);

}  // namespace ciliaval::compare::sensing

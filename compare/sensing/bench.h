// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "compare/output/provenance.h"
#include "compare/sensing/inversion.h"
#include "compare/sensing/sensing.h"

namespace ciliaval::compare::sensing {

/// A test bench to be simulated, as a file NAME.sense.toml states it (docs/guide/sensing.md): a
/// sensor on a rotation stage, a load of fixed direction, the ambient field measured at each
/// azimuth before, the unloaded cilium read at the first.
struct Bench {
  std::string title;
  input::Case problem;  ///< its load path has the magnitudes, its sensors are where they should be
  models::ModelPair models;    ///< by which the readings are inverted
  models::ModelPair truth;     ///< of the cilium that bends and is read
  unsigned int azimuths = 12;  ///< of the load as the sensor sees it, evenly round the circle
  unsigned int draws = 20;     ///< sensors built and benches run, each with its own errors
  unsigned int seed = 1;
  double noise = 0;                   ///< standard deviation of a component of a reading, T
  double quantum = 0;                 ///< one digit of the sensor, T; 0: none
  double sensor_position = 0;         ///< standard deviation of each of its coordinates, m
  double stage_azimuth = 0;           ///< … of the angle between stage and flow, rad
  Vector3 ambient = Vector3::Zero();  ///< the earth's field at the stage's azimuth 0, T
};

/// Throws InputError with every fault of the file, a line each; FileError.
Bench read_bench(const std::filesystem::path& file);

/// An error of a reading.
enum class ErrorSource {
  none,
  noise,
  quantum,
  sensor_position,
  stage_azimuth,
  ambient,
  models,
  all
};
std::string_view to_string(ErrorSource source);

/// Errors of one estimator over draws, azimuths and magnitudes.
struct BenchErrors {
  double magnitude_rms = 0;  ///< of (found − true)/true
  double speed_rms = 0;      ///< m/s; 0 if the load is no flow of a velocity
  double azimuth_rms = 0;    ///< rad
  /// 95 % half-width of azimuth_rms, rad: from the scatter of its square over the draws, which are
  /// independent as the readings of one sensor are not (Student's t). 0 if there is one draw.
  double azimuth_rms_interval = 0;
  double azimuth_largest = 0;    ///< rad
  double below_ten_degrees = 0;  ///< part of the readings
  std::size_t readings = 0;
};

struct BenchRow {
  ErrorSource source = ErrorSource::none;
  BenchErrors inversion;
  BenchErrors linear_fit;
};

/// The reading of one draw, for a figure.
struct BenchPoint {
  Vector2 truth;
  Vector2 found;
};

struct BenchResult {
  std::vector<BenchRow> rows;             ///< each source alone, then all
  std::vector<BenchErrors> by_magnitude;  ///< all sources, full inversion
  std::vector<BenchPoint> first_draw;     ///< all sources, full inversion
  double linear_misfit = 0;               ///< LinearFit::misfit()
};

/// Runs the bench: each source alone, where it has a size, then all of them. A source but `models`
/// is simulated with the inverting pair itself, so that nothing else is in its errors.
BenchResult run_bench(const Bench& bench, const Progress& progress = {});

std::string bench_text(const Bench& bench, const BenchResult& result);
/// docs/guide/sensing.md; "provenance" as in summary.json.
std::string bench_json(const Bench& bench, const BenchResult& result,
                       const output::Provenance& provenance);
}  // namespace ciliaval::compare::sensing

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compare/input/external/external.h"
#include "compare/input/external/reading_options.h"
#include "compare/input/measurement/measurement.h"
#include "compare/input/model_entry.h"
#include "compare/input/sweep/signal.h"
#include "compare/input/sweep/surface.h"
#include "problem/cilium.h"
#include "problem/load.h"
#include "problem/types.h"

namespace ciliaval::compare::input {

/// Orientation and gain of a sensor's chip, by which `ciliaval sense` converts its readings.
struct Chip {
  std::vector<std::string> axes;        ///< of the case, along its x, y, z: "+y"; empty: its own
  Vector3 rotation = Vector3::Zero();   ///< of those about the case's x, then y, then z, rad
  double gain = 1;                      ///< what it reads over what there is
  std::vector<std::string> components;  ///< "x", "z": those that it reads; empty: all
  bool operator==(const Chip&) const = default;
};

/// A validation case, as a case file states it (docs/guide/cases.md), in SI units.
struct Case {
  std::string name;   ///< a plain file name: the results go to DIR/name
  std::string title;  ///< for people
  Cilium cilium;
  LoadPath load_path;
  /// Values, for each step, of the load type's LoadStatement (a flow's velocity, density and drag
  /// coefficient), if the file states the magnitude by them; otherwise empty.
  std::vector<LoadStatement::Values> stated_by;
  /// Surface of a sweep as the file states it; each load of the sweep has the surface made from it.
  std::optional<surroundings::StatedSurface> surface;
  std::optional<sweep::SignalOptions> signal;  ///< what a logger makes of a sweep
  std::vector<Vector3> sensors;                ///< m
  std::vector<std::string>
      sensor_names;                    ///< of the sensors by [[sensor]]; empty: they are numbered
  std::vector<Chip> chips;             ///< of the sensors
  std::vector<std::string> mechanics;  ///< ids of mechanics models, in the order asked for
  std::vector<std::string> fields;     ///< ids of field models
  std::vector<external::ExternalModel> external;  ///< what other programs and test benches gave
  external::ReadingOptions readings;              ///< how `ciliaval sense` reads a file
  ModelOptions options;
  measurement::Statement measured;  ///< what the models are held against
};

/// Reads and checks a case file, which may name these models. Throws InputError with every fault
/// found, a line each: `file:line:column: what is wrong; did you mean …?`. A file that is missing,
/// not a regular file, unreadable or larger than 1 MB is an InputError too: it is the user's
/// command that names it.
Case read_case(const std::filesystem::path& file, const Models& models);

/// The same from a text; `file` is the name that the messages give.
Case read_case(std::string_view text, std::string_view file, const Models& models);

/// The name of a sensor; its number from 0 where the case gives none.
std::string sensor_name(const Case& c, std::size_t sensor);
/// Those of all sensors.
std::vector<std::string> sensor_names(const Case& c);

/// The values along the path of a parameter of Case::stated_by, such as "velocity"; empty if the
/// file does not state it.
std::vector<double> stated_values(const Case& c, std::string_view parameter);

/// Computes the magnitudes of the loads from Case::stated_by, if there is any.
void set_stated_magnitudes(Case& c);

/// Gives the loads of a sweep another surface. Throws InputError as surface_of().
void set_surface(Case& c, const surroundings::StatedSurface& stated);

/// The case as TOML with every value it used, defaults included, in SI units: read_case() of it
/// gives the same case.
std::string to_toml(const Case& c, const Models& models);

}  // namespace ciliaval::compare::input

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compare/input/case.h"
#include "compare/input/case_toml.h"

namespace ciliaval::compare::input {

/// The keys that are no member's, of [case], [load], [[sensor]], [models] and [[models.external]];
/// what is said of a value is said beside its reader.
struct Keys {
  description::Key case_name;
  description::Key title;
  description::Key sensor_name;
  description::Key sensor_position;
  description::Key sensor_axes;
  description::Key sensor_rotation;
  description::Key sensor_gain;
  description::Key sensor_components;
  description::Key load_type;
  description::Key mechanics;
  description::Key fields;
  description::Key external_name;
  description::Key centrelines;
};
const Keys& keys();

/// The words of `axes` and `components`.
std::span<const std::string_view> axis_names();
std::span<const std::string_view> component_names();

/// Each function reads one table of a case file into the case and adds a fault for everything in it
/// that is wrong by itself; what contradicts another table is check_together()'s.

void read_header(Section& root, Case& c);  ///< [case]
void read_cilium(Section& root, Case& c);  ///< [cilium], [[cilium.segment]]
/// [load], and [surface] of a sweep; needs the diameter for `velocity`. `folder` is that of the
/// case file.
void read_load(Section& root, const std::filesystem::path& folder, Case& c);
void read_sensor(Section& root, Case& c);  ///< [sensor] or [[sensor]]
/// [readings]; `file` is the case file, for messages.
void read_readings(Section& root, std::string_view file, external::ReadingOptions& readings);
/// [models], [models.<id>]
void read_models(Section& root, const Models& known, Case& c);

/// [[models.external]], a part of [models]: the tables, not the files that they name.
void read_external(Section& models, const Models& known,
                   std::vector<external::ExternalModel>& external);
/// Faults between these tables and the load and the sensors.
void check_external(const Case& c, const Report& report);

/// The tables that had no fault by themselves.
struct RightTables {
  bool cilium = false;
  bool load = false;
  bool models = false;
};

/// Faults between tables of which each is right by itself: a contact height or section beyond the
/// tip, a contact kernel that does not fit, fields without a sensor or a magnet, more results than
/// a machine can hold, … and those that the models find (Entry::check).
void check_together(const toml::table& root, const Case& c, const Models& known,
                    const RightTables& right, Faults& faults);

/// Puts a section that lies within rounding of a segment's end exactly there, so that "20 mm" is
/// the tip of 3 mm + 17 mm.
void snap_to_interfaces(const Cilium& cilium, LoadPath& path);

/// Changes the names of the files that the case states: options of its models, its external models
/// and its surface; not those of measurements, whose values are the case's.
void change_files(const Models& models, Case& c,
                  const std::function<void(Option::File, std::filesystem::path&)>& change);

/// The files that a case names and that are read with it: its meshes, its surface, the results of
/// its external models, and its measurements.
std::vector<std::filesystem::path> named_files(const Models& models, const Case& c);

/// A point or vector of three components, each as the key says, or a fault.
std::optional<Vector3> read_point(const toml::node& node, const description::Key& k,
                                  Faults& faults);

/// A text for people: a line, not empty, of at most `longest` bytes. Adds a fault otherwise.
std::optional<std::string> read_line(const toml::node& node, std::string_view name,
                                     std::size_t longest, Faults& faults);

/// A table that must be there: one that is missing is a fault.
Section require_section(Section& root, std::string_view key);

/// `name`, which names a folder of results, and `title`, by default the name.
void read_name_and_title(Section& table, std::string& name, std::string& title);

/// True if the name is a plain file name: [A-Za-z0-9._-], 1 to 100 long, not starting with '.' or
/// '-'.
bool is_plain_file_name(std::string_view name);

}  // namespace ciliaval::compare::input

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "problem/description/field.h"
#include "problem/parameter.h"

namespace ciliaval::compare::input {
class Section;
struct Case;
}  // namespace ciliaval::compare::input

/// Measured values, [[measurement]], and the uncertainty of the case's inputs,
/// [[input_uncertainty]] (docs/guide/validation.md).
namespace ciliaval::compare::input::measurement {

/// Number that was measured, and that a model computes.
struct Measurand {
  enum class Kind {
    position,    ///< a coordinate of a point of the end section, m
    deflection,  ///< of that point's displacement, the part along the load's azimuth, m
    angle,       ///< θ of the end section, rad
    B,           ///< a component of B at a sensor, T
    dB,          ///< of B − B(straight)
    number       ///< another number of a load step: results::quantities()
  };
  std::string name;  ///< as the case states it: "tip.x", "dB.left.z", "slip_off_force"
  Kind kind = Kind::deflection;
  std::size_t axis = 0;           ///< of a coordinate or component: 0 x, 1 y, 2 z
  std::size_t sensor = 0;         ///< of B and dB
  std::array<double, 2> point{};  ///< X, Y of the point in the end section, m
  std::size_t index = 0;          ///< of a number: among results::quantities()

  bool operator==(const Measurand&) const = default;
  /// Length, angle, flux density or the number's.
  const ciliaval::Quantity& quantity() const;
  bool is_field() const { return kind == Kind::B || kind == Kind::dB; }
};

/// The keys of [[measurement]] and [[input_uncertainty]].
std::vector<const description::Key*> measurement_keys();
std::vector<const description::Key*> input_keys();

/// A measured value. SI units.
struct Measurement {
  Measurand measurand;
  std::size_t step = 0;    ///< of the load path
  double value = 0;        ///< D
  double uncertainty = 0;  ///< u_D, standard
  std::string source;      ///< where it is from
  bool fitted = false;     ///< parameters of the case were fitted to it
};

/// Uncertainty of a number of the case, as the file states it. The studies know the numbers
/// (compare/study/case_number.h), so compare/validation/input_number.h reads it.
struct InputUncertainty {
  std::string number;  ///< dotted: "cilium.segment.base.young_modulus"
  /// Standard, "2 %", "0.05 MPa" or, of a plain number, "0.005"; or the two ends of a range between
  /// which every value is as likely.
  std::vector<std::string> uncertainty;
  bool is_plain = false;     ///< a number without a unit
  std::string source;        ///< where it is from; may be empty
  std::string number_place;  ///< for messages: "a.toml:12:10: [[input_uncertainty]] number"
  std::string uncertainty_place;
};

struct Statement {
  std::vector<Measurement> measurements;
  std::vector<InputUncertainty> inputs;
  std::vector<std::filesystem::path> files;  ///< from which values were read
  /// Matches of each file's rows with the load steps, and columns that were not read; for people.
  std::vector<std::string> remarks;
};

inline constexpr std::string_view measurement_table = "measurement";
inline constexpr std::string_view input_table = "input_uncertainty";
inline constexpr std::size_t most_values = 2000;  ///< χ² takes a matrix of them

/// The rows of a file are the load steps in their order, whatever the columns say.
inline constexpr std::string_view in_order = "in order";

/// A table [[measurement]] that names a file, which is read when the rest is right.
struct MeasuredFile {
  Measurement all;     ///< what its values have in common
  std::size_t at = 0;  ///< place of its values among the measurements
  std::filesystem::path path;
  std::string column = "value";
  /// The column with the load of each row, "x" or "x [mT]", or `in_order`; empty: the columns whose
  /// unit is that of the load, otherwise the order.
  std::string load = {};
  std::optional<double> scale;        ///< what a 1 in a column without a unit is, SI
  std::optional<double> uncertainty;  ///< of each value; none: relative, or a column
  std::optional<double> relative_uncertainty;
};

/// Reads both tables; `file` is the case file. Faults with their places go to the root's. Sensors,
/// cilium and load are compared with if they are right. The files' contents are read afterwards.
std::vector<MeasuredFile> read_measurements(Section& root, std::string_view file,
                                            bool case_is_right, Case& c);

/// Reads the files and puts their values among the measurements of the case. The rows belong to the
/// load steps by a column `step`; by the loads that a column in the load's unit has
/// (match_loads()); or, where there is no such column, by their order: then a column of numbers
/// without a unit, which may be the loads, is a fault unless MeasuredFile::load says what it is.
/// Throws InputError with every fault, `file:line:column: …`.
void read_measured_files(const std::vector<MeasuredFile>& files, Case& c);

/// Both tables as TOML, a table for each value; empty if there are none.
std::string to_toml(const Statement& statement);

}  // namespace ciliaval::compare::input::measurement

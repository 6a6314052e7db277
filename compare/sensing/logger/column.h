// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "compare/input/csv.h"

/// Headers and units of a logger's columns.
namespace ciliaval::compare::sensing::logger {

/// What a column holds.
struct ColumnRole {
  enum class Kind { other, field, change, time, sample, sensor, azimuth };
  Kind kind = Kind::other;
  std::size_t axis = 0;  ///< of B or ΔB: 0, 1, 2 for x, y, z
  std::string sensor;    ///< of B or ΔB: a number or name as the header has it; empty: none
  std::string family;    ///< of B: what stands before the axis, "b" or "mag"; empty: nothing

  bool is_field() const { return kind == Kind::field || kind == Kind::change; }
};

/// A column by its header.
struct Column {
  std::string header;               ///< as the file has it
  std::string name;                 ///< without the unit
  std::optional<std::string> unit;  ///< as the header has it
  input::Place place;
  ColumnRole role;
};

/// Takes a header apart. Case, blanks and the characters _ - . : / do not matter.
///
/// B: `Bx`, `B_x`, `x`, `X axis`, `mag x`, `Magnetic field x`, `mx`; ΔB: `dBx`, `delta B x`. The
/// sensor's number or name (of `sensors`) stands before or after, `s0_Bx`, `Bx0`, `left Bx`. The
/// unit follows in brackets, or after a blank, comma, slash or underscore: `Bx [G]`, `Bx (mG)`,
/// `Bx_uT`. Others: `time`, `t`, `timestamp`, `date`, `millis` (ms), `micros` (us); `sample`,
/// `sensor`, `azimuth`.
Column column_of(const input::CsvCell& cell, std::span<const std::string> sensors);

/// A unit of flux density in T (input::parse_quantity()); none for the digits of a sensor (LSB,
/// counts, digits, raw). Throws InputError if it is neither.
std::optional<double> flux_density_unit(std::string_view unit);

/// Whether flux_density_unit() takes it.
bool is_flux_density_unit(std::string_view unit);

/// A unit of time in s (input::parse_quantity()). Throws InputError.
double time_unit(std::string_view unit);

/// The flux density of one LSB along x, y, z, T: "0.15 uT", "0.15 uT/LSB", "6842 LSB/G", or three
/// of them with commas between. Throws InputError.
std::array<double, 3> lsb_scale(std::string_view text);

}  // namespace ciliaval::compare::sensing::logger

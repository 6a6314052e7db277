// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <functional>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "compare/input/case.h"
#include "compare/input/units.h"
#include "problem/parameter.h"

namespace ciliaval::compare::input {

/// "from 1e-09 m to 100 m" or "between -1 and 0.5, both excluded"; angles in deg.
std::string describe(const Range& range, const Quantity& quantity);

namespace key {
inline constexpr QuantityKey diameter{
    "cilium",     "diameter", quantity::length,
    length_range, "",         "Diameter d of the circular section, the same all along."};
inline constexpr QuantityKey segment_length{
    "cilium.segment", "length", quantity::length,
    length_range,     "",       "Length along the straight axis."};
inline constexpr QuantityKey young_modulus{
    "cilium.segment",    "young_modulus", quantity::pressure, {1, 1e15, false, unit_slip}, "",
    "Young's modulus E."};
inline constexpr QuantityKey poisson_ratio{
    "cilium.segment",
    "poisson_ratio",
    quantity::number,
    {-1, 0.5, true, "an elastic solid is stable only in between, and a compressible one below 0.5"},
    "",
    "Poisson's ratio; rubber is near 0.49."};
inline constexpr QuantityKey magnetization{
    "cilium.segment",
    "magnetization",
    quantity::magnetization,
    {-1e8, 1e8, false, "the strongest magnets have about 1.2e6 A/m; divide a B_r in T by mu_0"},
    "0 A/m",
    "Axial magnetisation B_r/mu_0 from base to tip; negative points to the base."};
/// Each coordinate of a sensor point.
inline constexpr QuantityKey position{
    "sensor",
    "position",
    quantity::length,
    {-1000, 1000, false, "a sensor farther away is taken for a slip in the unit"},
    "none",
    "The point `[x, y, z]` where the field is computed, or a list of points; required if `fields` "
    "are asked for."};
inline constexpr std::string_view plate_table = "models.potential.plate";
inline constexpr Range permeability_range{
    0, 1e6, true, "a permeability is positive, that of vacuum is 1 and iron has some thousands"};
/// Each coordinate of a plate's corner.
inline constexpr QuantityKey plate_lower{
    plate_table,
    "lower",
    quantity::length,
    {-1000, 1000, false, "a plate farther away is taken for a slip in the unit"},
    "",
    "The corner `[x, y, z]` of a permeable box with the lowest coordinates; one "
    "`[[models.potential.plate]]` for each box."};
inline constexpr QuantityKey plate_upper{
    plate_table,       "upper", quantity::length,
    plate_lower.range, "",      "The corner with the highest coordinates."};
inline constexpr QuantityKey plate_permeability{
    plate_table, "relative_permeability", quantity::number, permeability_range,
    "",          "The plate's μ_r."};
inline constexpr std::string_view external_table = "models.external";
inline constexpr QuantityKey tip_uncertainty{
    external_table,   "tip_uncertainty",
    quantity::length, {0, 100, false, unit_slip},
    "not known",      "Uncertainty of the tip's position in each centreline."};
inline constexpr QuantityKey field_uncertainty{external_table,
                                               "field_uncertainty",
                                               quantity::flux_density,
                                               {0, 100, false, unit_slip},
                                               "not known",
                                               "Uncertainty of each component of each reading."};
}  // namespace key

/// A key whose value is text or a list of texts, for the table of keys.
struct TextKey {
  std::string_view table;
  std::string_view name;
  std::string_view value;  ///< what may stand there
  std::string_view fallback;
  std::string_view doc;
};

/// The value of a model's knob.
using KnobValue = std::variant<bool, unsigned int, double, std::string, std::array<double, 2>>;

/// A setting of one model, [models.<model>] name = …: the one declaration from which it is read,
/// written back and documented. Its default is that of the model's options.
struct Knob {
  std::string_view model;
  std::string_view name;
  Quantity quantity;                      ///< of a double
  Range range;                            ///< of a number or of each number of a pair
  std::vector<std::string_view> choices;  ///< of a text
  std::string_view doc;                   ///< one sentence
  std::function<KnobValue(const ModelOptions&)> get;
  std::function<void(ModelOptions&, const KnobValue&)> set;
  /// Whether the knob means anything with the other options; empty: it always does. A file that
  /// states it where it does not is refused, and it is not written back.
  std::function<bool(const ModelOptions&)> belongs{};
  std::string_view goes_with{};  ///< what makes it belong, as the file would state it
};

/// Every knob of every model, the models in the order of the registry.
const std::vector<Knob>& knobs();

/// Whether a case with these options may state the knob.
bool belongs(const Knob& knob, const ModelOptions& options);

/// The ids that a case file may name, as in the registry (compare/models/registry.h), which is not
/// used here so that reading a case needs none of the models.
std::span<const std::string_view> mechanics_ids();
std::span<const std::string_view> field_ids();

/// What a later version will read: a dotted key ("environment") or a value, and what it is.
struct LaterKey {
  std::string_view name;
  std::string_view doc;
};
std::span<const LaterKey> later_keys();

/// A knob's value as the file would state it: `"0.0005 m"`, `1`, `false`, `"wedge"`.
std::string to_toml(const Knob& knob, const KnobValue& value);

/// Every key of a case file as a Markdown table: key, value, range, default, meaning.
std::string key_table();

}  // namespace ciliaval::compare::input

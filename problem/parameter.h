// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string_view>

namespace ciliaval {

/// A kind of physical quantity that a file states as text with a unit.
struct Quantity {
  std::string_view article;  ///< "a" or "an", for messages
  std::string_view name;     ///< "length"
  std::string_view unit;     ///< its SI unit as UDUNITS-2 writes it, "m"; empty: a plain number
  std::string_view example;  ///< as a person would write it, "3 mm"
};

namespace quantity {
inline constexpr Quantity length{"a", "length", "m", "3 mm"};
inline constexpr Quantity pressure{"a", "pressure", "Pa", "0.1 MPa"};
inline constexpr Quantity magnetization{"a", "magnetization M = B_r/mu_0", "A/m", "75 kA/m"};
inline constexpr Quantity force{"a", "force", "N", "1 mN"};
inline constexpr Quantity force_per_length{"a", "force per length", "N/m", "0.3 N/m"};
inline constexpr Quantity moment{"a", "moment", "N m", "1 uN m"};
inline constexpr Quantity velocity{"a", "velocity", "m/s", "0.5 m/s"};
inline constexpr Quantity acceleration{"an", "acceleration", "m/s^2", "-9.81 m/s2"};
inline constexpr Quantity density{"a", "density", "kg/m^3", "1000 kg/m^3"};
inline constexpr Quantity viscosity{"a", "dynamic viscosity", "Pa s", "1 mPa s"};
inline constexpr Quantity angle{"an", "angle", "rad", "30 deg"};
inline constexpr Quantity frequency{"a", "frequency", "Hz", "100 Hz"};
inline constexpr Quantity time{"a", "time", "s", "10 min"};
inline constexpr Quantity flux_density{"a", "flux density", "T", "50 uT"};
inline constexpr Quantity percentage{"a", "percentage", "%", "0.1 %"};  ///< held in per cent
inline constexpr Quantity number{"a", "plain number", "", "0.49"};
}  // namespace quantity

/// The values of a key that make sense, in SI units.
struct Range {
  double lower = 0;
  double upper = 0;
  bool excludes_ends = false;
  std::string_view reason;  ///< why, said when a value is refused

  bool contains(double value) const {
    return excludes_ends ? value > lower && value < upper : value >= lower && value <= upper;
  }
};

inline constexpr std::string_view unit_slip =
    "a value beyond is taken for a slip in the sign or the unit";
inline constexpr Range length_range{1e-9, 100, false, unit_slip};
inline constexpr std::string_view turn_round =
    "a load is not negative (to turn it round, add 180 deg to the azimuth) and a larger one is "
    "taken for a slip in the unit";

}  // namespace ciliaval

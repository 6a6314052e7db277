// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "problem/parameter.h"
#include "problem/surroundings/surface.h"

namespace ciliaval::compare::input {
class Section;
}

/// The table [surface] of a case file.
namespace ciliaval::compare::input::sweep {

/// A kind of profile: the one declaration from which it is read, written back and documented.
struct ProfileKind {
  std::string_view name;
  std::vector<QuantityKey> keys{};
  /// The profile of its keys' values, SI. Throws InputError.
  surroundings::Profile (*make)(std::span<const double> values) = nullptr;
  /// The values of a profile of this kind; none of another kind.
  std::optional<std::vector<double>> (*values)(const surroundings::Profile& profile) = nullptr;
};
/// Every kind but `file`.
std::span<const ProfileKind> profile_kinds();
std::vector<std::string_view> profile_names();

/// The keys that every surface has.
inline constexpr QuantityKey friction{
    "surface",
    "friction",
    quantity::number,
    {0, 10, false, "Coulomb's coefficient is not negative, and of the order of 1"},
    "0",
    "Coulomb's coefficient of friction between the cilium and the surface."};
inline constexpr QuantityKey tilt{
    "surface",       "tilt",
    quantity::angle, {-0.7, 0.7, false, "a surface that is tilted so much cannot be swept over"},
    "0 deg",         "Angle by which the surface rises towards the cilium along the azimuth."};

/// The keys of a surface's numbers: its profile's, friction and tilt.
std::vector<QuantityKey> keys(const surroundings::Surface& surface);
double value(const surroundings::Surface& surface, std::string_view key);
/// The same surface with another value of a key. Throws InputError if it is not valid.
std::shared_ptr<const surroundings::Surface> with_value(const surroundings::Surface& surface,
                                                        std::string_view key, double value);

/// What the table states.
struct Statement {
  std::shared_ptr<const surroundings::Surface> surface;
  std::filesystem::path file;  ///< of a profile that is one
};

/// Reads the table; a file's name is that of a file in `folder`, unless absolute. The file's own
/// faults are thrown as an InputError that names it; all others are added.
Statement read_surface(Section& table, const std::filesystem::path& folder);

/// The profile in a CSV file, `x [mm], height [mm]`: x counts along the way that the tip goes over
/// the surface, x = s − (place over the base). Throws InputError with every fault and its place.
surroundings::SampledProfile read_profile(const std::filesystem::path& file);

/// The table as TOML.
std::string to_toml(const Statement& statement);

}  // namespace ciliaval::compare::input::sweep

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/sweep/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "compare/input/case_toml.h"
#include "compare/input/csv.h"
#include "problem/error.h"
#include "problem/support/words.h"

namespace ciliaval::compare::input::sweep {
namespace {

using namespace surroundings;

constexpr std::string_view surface_table = "surface";
constexpr std::string_view file_kind = "file";
constexpr std::string_view seed_name = "seed";

constexpr QuantityKey length(std::string_view name, const Range& range, std::string_view doc) {
  return {surface_table, name, quantity::length, range, "", doc};
}

constexpr Range height_range{0, 1, false, unit_slip};

/// The kind that holds a T in the profile; `members` in the order of the keys.
template <class T, auto... members>
ProfileKind kind(std::string_view name, std::vector<QuantityKey> keys) {
  return {name, std::move(keys),
          [](std::span<const double> values) -> Profile {
            T result;
            std::size_t i = 0;
            ((result.*members = values[i++]), ...);
            return result;
          },
          [](const Profile& profile) -> std::optional<std::vector<double>> {
            const T* held = std::get_if<T>(&profile);
            if (held == nullptr) return std::nullopt;
            return std::vector<double>{(held->*members)...};
          }};
}

ProfileKind flat() {
  return {"flat",
          {},
          [](std::span<const double>) -> Profile { return FlatProfile{}; },
          [](const Profile& profile) -> std::optional<std::vector<double>> {
            if (!std::holds_alternative<FlatProfile>(profile)) return std::nullopt;
            return std::vector<double>{};
          }};
}

ProfileKind random_kind() {
  const auto wavelength = [](std::string_view name, std::string_view doc) {
    return length(name, length_range, doc);
  };
  return {"random",
          {length("rms", height_range, "`random`: root mean square of the height."),
           {surface_table,
            "hurst",
            quantity::number,
            {0, 1, false, "a self-affine profile has an exponent between 0 and 1"},
            "",
            "`random`: the Hurst exponent; 1 is the smoothest."},
           wavelength("longest", "`random`: the longest wavelength, after which it repeats."),
           wavelength("shortest", "`random`: the shortest wavelength."),
           {surface_table,
            seed_name,
            quantity::number,
            {0, 4294967295.0, false, "a seed has 32 bits"},
            "1",
            "`random`: a whole number; another one gives another profile."}},
          [](std::span<const double> v) -> Profile {
            return RandomProfile({v[0], v[1], v[2], v[3], static_cast<std::uint32_t>(v[4])});
          },
          [](const Profile& profile) -> std::optional<std::vector<double>> {
            const auto* held = std::get_if<RandomProfile>(&profile);
            if (held == nullptr) return std::nullopt;
            const RandomProfile::Parameters& p = held->parameters();
            return std::vector<double>{p.rms, p.hurst, p.longest, p.shortest,
                                       static_cast<double>(p.seed)};
          }};
}

/// The kind of a profile; null of one in a file.
const ProfileKind* kind_of(const Profile& profile) {
  const std::span<const ProfileKind> kinds = profile_kinds();
  const auto found = std::ranges::find_if(
      kinds, [&](const ProfileKind& kind) { return kind.values(profile).has_value(); });
  return found == kinds.end() ? nullptr : &*found;
}

/// In the order of keys().
std::vector<double> values(const Surface& surface) {
  std::vector<double> result;
  if (const ProfileKind* kind = kind_of(surface.profile))
    result = kind->values(surface.profile).value();
  result.insert(result.end(), {surface.friction, surface.tilt});
  return result;
}

std::size_t index_of(const Surface& surface, std::string_view key) {
  const std::vector<QuantityKey> all = keys(surface);
  const auto found = std::ranges::find(all, key, &QuantityKey::name);
  if (found == all.end()) throw InputError("the surface has no '" + std::string(key) + "'");
  return static_cast<std::size_t>(found - all.begin());
}

/// The values of the kind's keys; fewer if one has a fault.
std::vector<double> read_values(Section& table, const ProfileKind& kind) {
  std::vector<double> values;
  for (const QuantityKey& k : kind.keys) {
    if (k.name != seed_name) {
      if (const auto value = table.value(k)) values.push_back(*value);
      continue;
    }
    unsigned int seed = 1;
    table.read(k.name, k.range, seed);
    values.push_back(seed);
  }
  return values;
}

}  // namespace

std::span<const ProfileKind> profile_kinds() {
  static const std::vector<ProfileKind> kinds{
      flat(),
      kind<SineProfile, &SineProfile::amplitude, &SineProfile::wavelength>(
          "sine", {length("amplitude", height_range, "`sine`: half the height from valley to top."),
                   length("wavelength", length_range, "`sine`: from top to top.")}),
      kind<TrapezoidProfile, &TrapezoidProfile::height, &TrapezoidProfile::top,
           &TrapezoidProfile::bottom, &TrapezoidProfile::flank, &TrapezoidProfile::radius>(
          "trapezoid",
          {length("height", height_range, "`trapezoid`: of the plateaus over the valleys."),
           length("top", length_range, "`trapezoid`: length of a plateau."),
           length("bottom", length_range, "`trapezoid`: length of a valley."),
           length("flank", length_range, "`trapezoid`: length of a flank along the travel."),
           length("radius", length_range, "`trapezoid`: of the rounded edges.")}),
      random_kind()};
  return kinds;
}

std::vector<std::string_view> profile_names() {
  std::vector<std::string_view> names;
  for (const ProfileKind& kind : profile_kinds()) names.push_back(kind.name);
  names.push_back(file_kind);
  return names;
}

SampledProfile read_profile(const std::filesystem::path& file) {
  constexpr std::array<CsvColumn, 2> columns{
      {{"x", CsvColumn::Kind::quantity, quantity::length},
       {"height", CsvColumn::Kind::quantity, quantity::length}}};
  Faults faults;
  CsvTable table = read_csv(read_csv_file(file), columns, {}, faults);
  if (faults.empty()) {
    const std::vector<double>& x = table.numbers[0];
    for (std::size_t i = 1; i < x.size(); ++i)
      if (!(x[i] > x[i - 1]))
        faults.add(table.rows[i], fmt::format("x must increase from row to row: {:g} m is not more "
                                              "than {:g} m",
                                              x[i], x[i - 1]));
    if (x.size() < SampledProfile::fewest_points)
      faults.add(table.rows.back(), fmt::format("a profile has {} points or more, not {}",
                                                SampledProfile::fewest_points, x.size()));
  }
  if (!faults.empty()) throw InputError(faults.report(file.string()));
  // Along the way of the tip, against that of the surface.
  std::vector<double> x = table.numbers[0];
  for (double& value : x) value = -value;
  std::ranges::reverse(x);
  std::ranges::reverse(table.numbers[1]);
  return {std::move(x), std::move(table.numbers[1])};
}

Statement read_surface(Section& table, const std::filesystem::path& folder) {
  Faults& faults = table.faults();
  const std::size_t before = faults.size();
  Statement statement;
  Surface surface;
  const toml::node* node = table.require("profile");
  const std::vector<std::string_view> names = profile_names();
  const auto name = node == nullptr ? std::nullopt : read_choice(*node, "profile", names, faults);
  surface.friction = table.value(friction).value_or(0);
  surface.tilt = table.value(tilt).value_or(0);
  const auto kind = std::ranges::find(profile_kinds(), name.value_or(""), &ProfileKind::name);
  std::vector<double> values;
  if (kind != profile_kinds().end()) {
    values = read_values(table, *kind);
  } else if (name) {
    const toml::node* path = table.require("path");
    if (const auto text = path == nullptr ? std::nullopt : read_text(*path, "path", faults))
      statement.file = std::filesystem::absolute(folder / *text).lexically_normal();
  } else {
    for (const ProfileKind& any : profile_kinds())
      for (const QuantityKey& k : any.keys) table.find(k.name);
    table.find("path");
  }
  table.finish();
  if (faults.size() != before || !table.exists()) return statement;
  try {
    surface.profile = statement.file.empty() ? kind->make(values) : read_profile(statement.file);
    require_valid(surface);
    statement.surface = std::make_shared<const Surface>(std::move(surface));
  } catch (const InputError& error) {
    if (!statement.file.empty()) throw;
    faults.add(table.where(), error.what());
  }
  return statement;
}

std::vector<QuantityKey> keys(const Surface& surface) {
  std::vector<QuantityKey> result;
  if (const ProfileKind* kind = kind_of(surface.profile)) result = kind->keys;
  result.insert(result.end(), {friction, tilt});
  return result;
}

double value(const Surface& surface, std::string_view key) {
  return values(surface)[index_of(surface, key)];
}

std::shared_ptr<const Surface> with_value(const Surface& surface, std::string_view key,
                                          double value) {
  std::vector<double> all = values(surface);
  all[index_of(surface, key)] = value;
  Surface result = surface;
  result.tilt = all.back();
  result.friction = all[all.size() - 2];
  all.resize(all.size() - 2);
  if (const ProfileKind* kind = kind_of(surface.profile)) result.profile = kind->make(all);
  require_valid(result);
  return std::make_shared<const Surface>(std::move(result));
}

std::string to_toml(const Statement& statement) {
  const Surface& surface = *statement.surface;
  const ProfileKind* kind = kind_of(surface.profile);
  std::string text = fmt::format("\n[{}]\nprofile = \"{}\"\n", surface_table,
                                 kind != nullptr ? kind->name : file_kind);
  if (kind == nullptr) text += fmt::format("path = {}\n", toml_text(statement.file.string()));
  const std::vector<double> all = values(surface);
  const std::vector<QuantityKey> names = keys(surface);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string number = names[i].name == seed_name
                                   ? fmt::format("{}", static_cast<std::uint32_t>(all[i]))
                                   : format_quantity(all[i], names[i].quantity);
    text += names[i].quantity.unit.empty() ? fmt::format("{} = {}\n", names[i].name, number)
                                           : fmt::format("{} = \"{}\"\n", names[i].name, number);
  }
  return text;
}

}  // namespace ciliaval::compare::input::sweep

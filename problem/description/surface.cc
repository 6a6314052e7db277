// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/description/surface.h"

namespace ciliaval::description {
namespace {

using surroundings::RandomProfile;
using surroundings::SineProfile;
using surroundings::StatedSurface;
using surroundings::TrapezoidProfile;
using Kind = StatedSurface::Kind;

constexpr Range height_range{0, 1, false, unit_slip};

// A member that is added does not compile until it stands here; describe it below.
[[maybe_unused]] void every_member_of_surface(const StatedSurface& surface, const SweepWay& way) {
  [[maybe_unused]] const auto& [kind, sine, trapezoid, random, file, sampled, friction, tilt] =
      surface;
  [[maybe_unused]] const auto& [amplitude, wavelength] = sine;
  [[maybe_unused]] const auto& [height, top, bottom, flank, radius] = trapezoid;
  [[maybe_unused]] const auto& [rms, hurst, longest, shortest, seed] = random;
  [[maybe_unused]] const auto& [travel, samples, there_and_back] = way;
}

Field<StatedSurface> of_kind(Kind kind, std::string_view words, Field<StatedSurface> field) {
  return only_with(&StatedSurface::kind, kind, words, std::move(field));
}

Field<StatedSurface> of_sine(const Field<SineProfile>& field) {
  return of_kind(Kind::sine, R"(profile = "sine")",
                 required(of_part<StatedSurface>(
                     field, [](auto& of) -> auto& { return of.sine; })));
}

Field<StatedSurface> of_trapezoid(const Field<TrapezoidProfile>& field) {
  return of_kind(Kind::trapezoid, R"(profile = "trapezoid")",
                 required(of_part<StatedSurface>(
                     field, [](auto& of) -> auto& { return of.trapezoid; })));
}

Field<StatedSurface> of_random(const Field<RandomProfile::Parameters>& field) {
  return of_kind(Kind::random, R"(profile = "random")",
                 of_part<StatedSurface>(
                     field, [](auto& of) -> auto& { return of.random; }));
}

template <class Owner>
Field<Owner> length(double Owner::*member, std::string_view name, std::string_view doc,
                    const Range& range = length_range) {
  return field(member, name, quantity::length, range, doc);
}

}  // namespace

template <>
const Fields<StatedSurface>& fields<StatedSurface>() {
  using Random = RandomProfile::Parameters;
  static const Fields<StatedSurface> all{
      required(choice(&StatedSurface::kind, "profile",
                      {{"flat", Kind::flat},
                       {"sine", Kind::sine},
                       {"trapezoid", Kind::trapezoid},
                       {"random", Kind::random},
                       {"file", Kind::file}},
                      "The surface of a `sweep`: z = L - interference - p(x - travel), x along the "
                      "azimuth; p counts towards the cilium.")),
      of_kind(Kind::file, R"(profile = "file")",
              required(file(&StatedSurface::file, "path", Key::File::data,
                            "`file`: CSV with `x` and `height`, at least four rows; x counts along "
                            "the way that the tip goes over the surface, from the place over the "
                            "base at the start."))),
      of_sine(length(&SineProfile::amplitude, "amplitude",
                     "`sine`: half the height from valley to top.", height_range)),
      of_sine(length(&SineProfile::wavelength, "wavelength", "`sine`: from top to top.")),
      of_trapezoid(length(&TrapezoidProfile::height, "height",
                          "`trapezoid`: of the plateaus over the valleys.", height_range)),
      of_trapezoid(length(&TrapezoidProfile::top, "top", "`trapezoid`: length of a plateau.")),
      of_trapezoid(length(&TrapezoidProfile::bottom, "bottom", "`trapezoid`: length of a valley.")),
      of_trapezoid(length(&TrapezoidProfile::flank, "flank",
                          "`trapezoid`: length of a flank along the travel.")),
      of_trapezoid(
          length(&TrapezoidProfile::radius, "radius", "`trapezoid`: of the rounded edges.")),
      of_random(required(
          length(&Random::rms, "rms", "`random`: root mean square of the height.", height_range))),
      of_random(
          required(field(&Random::hurst, "hurst",
                         {0, 1, false, "a self-affine profile has an exponent between 0 and 1"},
                         "`random`: the Hurst exponent; 1 is the smoothest."))),
      of_random(required(length(&Random::longest, "longest",
                                "`random`: the longest wavelength, after which it repeats."))),
      of_random(
          required(length(&Random::shortest, "shortest", "`random`: the shortest wavelength."))),
      of_random(
          falls_back_to(field(&Random::seed, "seed", {0, 4294967295.0, false, "a seed has 32 bits"},
                              "`random`: a whole number; another one gives another profile."),
                        "1")),
      falls_back_to(
          field(&StatedSurface::friction, friction_key,
                {0, 10, false, "Coulomb's coefficient is not negative, and of the order of 1"},
                "Coulomb's coefficient of friction between the cilium and the surface."),
          "0"),
      falls_back_to(
          field(&StatedSurface::tilt, "tilt", quantity::angle,
                {-0.7, 0.7, false, "a surface that is tilted so much cannot be swept over"},
                "Angle by which the surface rises towards the cilium along the azimuth."),
          "0 deg")};
  return all;
}

template <>
const Fields<SweepWay>& fields<SweepWay>() {
  static const Fields<SweepWay> all{
      falls_back_to(
          field(&SweepWay::samples, "samples",
                {2, 10000, false, "each is a step, of which every model writes files"},
                "`sweep`: places of equal distance along the travel, both ends included."),
          "101"),
      falls_back_to(field(&SweepWay::there_and_back, "return",
                          "`sweep`: whether the surface goes back again over the same places."),
                    "`false`")};
  return all;
}

}  // namespace ciliaval::description

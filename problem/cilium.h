// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "problem/types.h"

namespace ciliaval {

/// A length of cilium of one material.
struct Segment {
  std::string name;
  double length = 0;         ///< reference arc length, m
  double young_modulus = 0;  ///< E, Pa
  double poisson_ratio = 0;  ///< ν, −1 < ν < 0.5
  double magnetization =
      0;  ///< M = B_r/μ₀ along the reference axis, base to tip positive, A/m; 0: not magnetic
  double density = 0;  ///< ρ, kg/m³, which gravity needs; 0: not known
  /// M along the reference's x and y axes, A/m; with magnetization along z the vector M.
  std::array<double, 2> transverse_magnetization{0, 0};

  /// μ = E/(2(1+ν)), Pa.
  double shear_modulus() const { return young_modulus / (2 * (1 + poisson_ratio)); }
  /// K = E/(3(1−2ν)), Pa.
  double bulk_modulus() const { return young_modulus / (3 * (1 - 2 * poisson_ratio)); }
};

/// The shape of the section, the same from base to tip.
struct CrossSection {
  enum class Shape { circle, rectangle, tube };
  Shape shape = Shape::circle;
  double width = 0;           ///< rectangle: along its first axis, m
  double height = 0;          ///< rectangle: along its second axis, m
  double inner_diameter = 0;  ///< tube, m
  double orientation = 0;     ///< rectangle: angle of the first axis from +x about z, rad

  bool operator==(const CrossSection& other) const = default;
};

/// A straight prism that stands on z = 0, clamped there, axis +z through the centres of its
/// sections; segments from base to tip.
struct Cilium {
  double diameter = 0;  ///< d of a circle, outer one of a tube, m; a rectangle has none
  std::vector<Segment> segments;
  CrossSection section{};

  bool is_rectangular() const { return section.shape == CrossSection::Shape::rectangle; }
  /// The smallest extent across the axis, m: the scale of all that is local.
  double thickness() const;
  /// Radius of the smallest circle around the section, m.
  double radius() const;
  double area() const;  ///< A, m²
  /// (∫Y² dA, ∫X² dA) about the section's own first and second axis, m⁴.
  std::array<double, 2> second_moments() const;
  /// I of bending in the vertical plane of an azimuth (rad), m⁴. Throws InputError if a rectangle
  /// has no side along it: it would leave the plane.
  double second_moment(double azimuth = 0) const;
  /// Extent along the direction of an azimuth (rad), m, which must be as for second_moment().
  double extent(double azimuth) const;
  double length() const;  ///< L, the sum of the segments' lengths, m

  /// Arc lengths 0 = S₀ < S₁ < … < S_N = L of the segments' ends, m.
  std::vector<double> interfaces() const;
  /// Index of the segment that holds the material point S; at an interface the upper one, at the
  /// tip the last.
  std::size_t segment_at(double S) const;
};

/// The same turned by the angle (rad) about the z axis.
Cilium turned(Cilium cilium, double angle);

/// M of a segment along the reference's axes x, y, z, A/m.
inline Vector3 magnetization(const Segment& segment) {
  const auto& [x, y] = segment.transverse_magnetization;
  return {x, y, segment.magnetization};
}

inline bool is_magnetic(const Segment& segment) {
  return !magnetization(segment).isZero(0);
}

inline bool has_magnet(const Cilium& cilium) {
  return std::ranges::any_of(cilium.segments, is_magnetic);
}

/// True if a segment is magnetised across the axis.
inline bool has_transverse_magnetization(const Cilium& cilium) {
  return std::ranges::any_of(cilium.segments, [](const Segment& segment) {
    return segment.transverse_magnetization != std::array{0.0, 0.0};
  });
}

/// Throws InputError if a length or modulus is not finite and positive, −1 < ν < 0.5 does not hold,
/// or the section is none.
void require_valid(const Cilium& cilium);

}  // namespace ciliaval

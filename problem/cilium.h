// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

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

  /// μ = E/(2(1+ν)), Pa.
  double shear_modulus() const { return young_modulus / (2 * (1 + poisson_ratio)); }
  /// K = E/(3(1−2ν)), Pa.
  double bulk_modulus() const { return young_modulus / (3 * (1 - 2 * poisson_ratio)); }
};

/// A straight circular cylinder that stands on z = 0, clamped there, axis +z; segments from base to
/// tip.
struct Cilium {
  double diameter = 0;  ///< d, m
  std::vector<Segment> segments;

  double radius() const { return diameter / 2; }
  double area() const;           ///< A = πd²/4, m²
  double second_moment() const;  ///< I = πd⁴/64, m⁴
  double length() const;         ///< L, the sum of the segments' lengths, m

  /// Arc lengths 0 = S₀ < S₁ < … < S_N = L of the segments' ends, m.
  std::vector<double> interfaces() const;
  /// Index of the segment that holds the material point S; at an interface the upper one, at the
  /// tip the last.
  std::size_t segment_at(double S) const;
};

/// Throws InputError if a length or modulus is not finite and positive, or −1 < ν < 0.5 does not
/// hold.
void require_valid(const Cilium& cilium);

}  // namespace ciliaval

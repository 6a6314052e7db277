// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <vector>

namespace ciliaval::joints {

/// An excess compliance in units of the softer material: d/EI, d²/EI, d³/EI and d/EA.
struct Entry {
  double rotation = 0;
  double coupling = 0;
  double displacement = 0;
  double extension = 0;
};
/// The members of an Entry, for loops over them.
inline constexpr double Entry::*components[] = {&Entry::rotation, &Entry::coupling,
                                                &Entry::displacement, &Entry::extension};

/// Limits of the table.
inline constexpr double largest_poisson_ratio = 0.4999;  ///< from 0
inline constexpr double shortest = 0.3;                  ///< segment, in diameters
inline constexpr double apart = 1.5;  ///< length from which on a segment's ends are alone

/// Nodes of the table: Chebyshev's, ends included; of the ratio t of the softer modulus to the
/// stiffer one, 0 … 1, in s = t (1 + κ)/(t + κ).
inline constexpr std::size_t n_poisson = 6;
inline constexpr std::size_t n_ratio = 7;
inline constexpr std::size_t n_length = 7;
std::vector<double> poisson_nodes();
std::vector<double> ratio_nodes();
std::vector<double> length_nodes();

/// A joint whose segments are long: the softer one, of Poisson's ratio node i, below the stiffer
/// one, of node j, at ratio node k. With the stiffer one below, the coupling changes its sign.
extern const Entry alone[n_poisson][n_poisson][n_ratio];
/// Excess compliance of a segment between a rigid body below and a stiffer one above (ratio node j,
/// length node k) beyond its two joints alone, M taken at its middle.
extern const Entry together[n_poisson][n_ratio][n_length];

}  // namespace ciliaval::joints

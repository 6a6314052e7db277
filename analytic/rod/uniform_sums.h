// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "analytic/rod/field_models.h"
#include "analytic/rod/rod_magnet.h"

namespace ciliaval::analytic::rod {

/// The slice of the magnet at the middle of one of n equal steps of height.
struct UniformSlice {
  CentrelinePoint point;
  double thickness;    ///< dS = dz/(dr/dS·e_z), m
  RodStretch stretch;  ///< that it is of
};

/// The paper's discretisation of a bent magnet (its section on the numerical integration after
/// Eq. 6): each magnetic segment in n slices of uniform height dz, with dS = dz/cosθ. Throws
/// InputError if the centreline does not rise all along, or n is 0.
std::vector<UniformSlice> uniform_slices(const RodMagnet& magnet, std::size_t n);

/// B (T) by the paper's sum of n dipoles A M t dS (Eq. 5–7; M₁ d₁ + M₂ d₂ besides), by the
/// midpoint rule. The uncertainty is the change from half as many (of one dipole: to two): for a
/// rule of second order three times the error. Throws InputError as above, SolverError on a dipole.
Field field_of_uniform_line(const RodMagnet& magnet, const LineOptions& options,
                            std::span<const Vector3> points);

/// B (T) by the paper's sum of n³ dipoles (Eq. 8–9 with one 1/cosθ), by the midpoint rule in z, r
/// and φ; with the Jacobian if `wedge`. The uncertainty is the change from half as many in each
/// direction. Throws InputError as above, SolverError inside the magnet.
Field field_of_uniform_volume(const RodMagnet& magnet, const VolumeOptions& options,
                              std::span<const Vector3> points);

}  // namespace ciliaval::analytic::rod

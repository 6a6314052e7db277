// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "analytic/rod/rod_magnet.h"
#include "problem/solid_body.h"
#include "problem/surroundings/magnets/magnet.h"

namespace ciliaval::analytic::forces {

/// A magnetic charge, A·m.
struct PointCharge {
  Vector3 position;  ///< m
  double strength;
};

/// Nodes of a quadrature of a magnet's surface charge M·n dA, of the given order: Gauss–Legendre
/// on flat faces, along radii and along a ball's axis, twice as many nodes of the trapezoidal rule
/// around an axis.
using Charges = std::function<std::vector<PointCharge>(std::size_t order)>;

/// Charges of a given magnet.
Charges charges_of(const surroundings::magnets::Magnet& magnet);
/// Charges of the sections where a rod's magnetisation jumps and of its mantle: all that the wedge
/// of the model `volume` has. They refer to the deformation.
Charges charges_of(const rod::RodMagnet& magnet);
/// The poles of the model `line` at the centres of these sections, of an axial magnetisation.
Charges poles_of(const rod::RodMagnet& magnet);
/// Charges of a solid's charged faces, at their deformed places (Piola). They refer to the body.
Charges charges_of(const SolidBody& body);

}  // namespace ciliaval::analytic::forces

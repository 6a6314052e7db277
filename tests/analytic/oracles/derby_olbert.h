// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "problem/types.h"

namespace ciliaval::oracle {

/// B (T) of an axially magnetised cylinder about the z axis from z = bottom to top, magnetisation M
/// (A/m): Derby & Olbert, Am. J. Phys. 78, 229 (2010), evaluated in 50 digits with Boost.Math's
/// Legendre integrals of the first, second and third kind, and rounded once. B inside as well;
/// not on ρ = R.
Vector3 derby_olbert(double M, double radius, double bottom, double top, const Vector3& x);

/// B (T) of a flat disc of uniform magnetic charge σ (A/m), centre (m), unit normal and radius
/// (m), any way up: one end of Derby & Olbert's cylinder less the magnetisation it ends, in 50
/// digits as above and rounded once; the normal is normalised in 50 digits. Not in its plane.
Vector3 charged_disc(double sigma, const Vector3& centre, const Vector3& normal, double radius,
                     const Vector3& x);

}  // namespace ciliaval::oracle

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "problem/centreline.h"
#include "problem/cilium.h"
#include "problem/types.h"

namespace ciliaval::compare::claims {

/// The integrals of Eq. 6 and of Eq. 8 to the letter, and as they are meant (Eq. 5 with dS =
/// dz/cos θ). To the letter Eq. 6 has 1/cos θ once in x and twice in y and z, Eq. 8 twice in all:
/// one is that of dS = dz/cos θ, the other too many.
struct PrintedFields {
  Vector3 line;            ///< T
  Vector3 line_printed;    ///< T
  Vector3 volume;          ///< T
  Vector3 volume_printed;  ///< T
};

/// B of a rod's magnet at a point outside of it, by Gauss–Legendre quadrature along each piece (and
/// over the section, Gauss in r and equal angles).
PrintedFields printed_fields(const Cilium& cilium, const Centreline& centreline, const Vector3& x);

}  // namespace ciliaval::compare::claims

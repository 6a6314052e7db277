// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "problem/types.h"

namespace ciliaval::support {

/// The shortest turn from the third axis to the direction, which is not zero; half a turn about the
/// first, if it is the opposite one.
Quaternion turn_to(const Vector3& direction);

/// The rotation R of the polar decomposition F = R·U, det F > 0.
Matrix3 polar_rotation(const Matrix3& F);

}  // namespace ciliaval::support

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <span>
#include <string>

#include "problem/field_model.h"

namespace ciliaval::analytic {

/// B at one point and the estimate of its numerical error, T.
struct FieldValue {
  Vector3 B = Vector3::Zero();
  Vector3 uncertainty = Vector3::Zero();

  FieldValue& operator+=(const FieldValue& other) {
    B += other.B;
    uncertainty += other.uncertainty;
    return *this;
  }
};

/// `field` at each of the points. Throws InputError if a point is not finite, SolverError if a
/// result is not.
Field field_at(std::span<const Vector3> points,
               const std::function<FieldValue(const Vector3&)>& field);

/// "(x, y, z) m", for messages.
std::string to_string(const Vector3& x);

/// The error (m) that the rounding of two positions leaves in their difference: 4ε(|x| + |y|).
double rounding_of_offset(const Vector3& x, const Vector3& y);

/// B of a point source of strength proportional to `B` at the offset x − y: |B| to 8 ε, and the
/// rounding of the offset times the largest gradient 4|B|/a that a dipole's field has.
FieldValue with_rounding(const Vector3& B, const Vector3& x, const Vector3& y);

}  // namespace ciliaval::analytic

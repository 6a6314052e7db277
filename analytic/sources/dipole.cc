// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/sources/dipole.h"

#include <cmath>
#include <numbers>

#include "problem/field_model.h"

namespace ciliaval::analytic::sources {

Vector3 dipole_field(const Vector3& moment, const Vector3& offset) {
  const double a2 = offset.squaredNorm();
  const double scale = vacuum_permeability / (4 * std::numbers::pi) / (a2 * std::sqrt(a2));
  return scale * (3 * moment.dot(offset) / a2 * offset - moment);
}

double largest_dipole_field(double moment, double a) {
  return vacuum_permeability / (2 * std::numbers::pi) * moment / (a * a * a);
}

Vector3 pole_field(double strength, const Vector3& offset) {
  const double a2 = offset.squaredNorm();
  return vacuum_permeability / (4 * std::numbers::pi) * strength / (a2 * std::sqrt(a2)) * offset;
}

Matrix3 dipole_gradient(const Vector3& moment, const Vector3& offset) {
  const double a2 = offset.squaredNorm();
  const double scale = 3 * vacuum_permeability / (4 * std::numbers::pi) / (a2 * a2 * std::sqrt(a2));
  const Matrix3 outer = moment * offset.transpose();
  const double product = moment.dot(offset);
  return scale * (outer + outer.transpose() +
                  product * (Matrix3::Identity() - 5 / a2 * offset * offset.transpose()));
}

Matrix3 pole_gradient(double strength, const Vector3& offset) {
  const double a2 = offset.squaredNorm();
  return vacuum_permeability / (4 * std::numbers::pi) * strength / (a2 * std::sqrt(a2)) *
         (Matrix3::Identity() - 3 / a2 * offset * offset.transpose());
}

}  // namespace ciliaval::analytic::sources

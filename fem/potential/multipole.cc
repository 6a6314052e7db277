// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/potential/multipole.h"

#include <cmath>
#include <numbers>

namespace ciliaval::fem::potential {

void Multipole::add(const Vector3& position, const Vector3& moment) {
  dipole += moment;
  moments += moment * (position - centre).transpose();
}

double Multipole::potential(const Vector3& position) const {
  const Vector3 x = position - centre;
  const double r = x.norm();
  return dipole_potential(dipole, x) +
         (3 * x.dot(moments * x) / std::pow(r, 5) - moments.trace() / std::pow(r, 3)) /
             (4 * std::numbers::pi);
}

double dipole_potential(const Vector3& moment, const Vector3& position) {
  return moment.dot(position) / (4 * std::numbers::pi * std::pow(position.norm(), 3));
}

}  // namespace ciliaval::fem::potential

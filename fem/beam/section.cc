// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/section.h"

#include <cmath>
#include <numbers>

#include "problem/error.h"

namespace ciliaval::fem::beam {

Section section(const SectionStiffness& s) {
  for (const double stiffness : {s.EA, s.kGA1, s.kGA2, s.GJ, s.EI1, s.EI2})
    if (!(stiffness > 0)) throw InputError("every stiffness of a beam section must be positive");
  return {{1 / s.kGA1, 1 / s.kGA2, 1 / s.EA}, {1 / s.EI1, 1 / s.EI2, 1 / s.GJ}};
}

double cowper_circle(double poisson_ratio) {
  return 6 * (1 + poisson_ratio) / (7 + 6 * poisson_ratio);
}

SectionStiffness circular_section(double diameter, double young_modulus, double poisson_ratio) {
  const double area = std::numbers::pi * diameter * diameter / 4;
  const double I = std::numbers::pi * std::pow(diameter, 4) / 64;
  const double G = young_modulus / (2 * (1 + poisson_ratio));
  const double kGA = cowper_circle(poisson_ratio) * G * area;
  return {.EA = young_modulus * area,
          .kGA1 = kGA,
          .kGA2 = kGA,
          .GJ = 2 * G * I,
          .EI1 = young_modulus * I,
          .EI2 = young_modulus * I};
}

Section rigid_in_shear(const Section& section) {
  return {Vector3::Zero(), section.moment_compliance};
}

}  // namespace ciliaval::fem::beam

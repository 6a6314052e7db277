// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/section.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "problem/error.h"
#include "problem/joints/shear_coefficient.h"

namespace ciliaval::fem::beam {

double Section::complementary_energy(const Vector3& n, const Vector3& m) const {
  const double square = m.head<2>().squaredNorm();
  return n.dot(force_compliance.cwiseProduct(n)) / 2 +
         m.dot(moment_compliance.cwiseProduct(m)) / 2 + coupling * (n[0] * m[1] - n[1] * m[0]) +
         square * (beyond.lengthening * n[2] + square * beyond.softening / 4 +
                   square * square * beyond.further_softening / 6);
}

Eigen::Matrix<double, 6, 6> Section::compliance(const Vector3& n, const Vector3& m) const {
  Eigen::Matrix<double, 6, 6> C = Eigen::Matrix<double, 6, 6>::Zero();
  C.diagonal() << force_compliance, moment_compliance;
  C(0, 4) = C(4, 0) = coupling;
  C(1, 3) = C(3, 1) = -coupling;
  const Eigen::Vector2d bending = m.head<2>();
  C.diagonal().segment<2>(3).array() += softening(n, m);
  C.block<2, 2>(3, 3) +=
      (2 * beyond.softening + 4 * beyond.further_softening * bending.squaredNorm()) * bending *
      bending.transpose();
  C.block<2, 1>(3, 2) = 2 * beyond.lengthening * bending;
  C.block<1, 2>(2, 3) = C.block<2, 1>(3, 2).transpose();
  return C;
}

Section section(const SectionStiffness& s) {
  for (const double stiffness : {s.EA, s.kGA1, s.kGA2, s.GJ, s.EI1, s.EI2})
    if (!(stiffness > 0)) throw InputError("every stiffness of a beam section must be positive");
  return {{1 / s.kGA1, 1 / s.kGA2, 1 / s.EA}, {1 / s.EI1, 1 / s.EI2, 1 / s.GJ}};
}

SectionStiffness circular_section(double diameter, double young_modulus, double poisson_ratio) {
  const double area = std::numbers::pi * diameter * diameter / 4;
  const double I = std::numbers::pi * std::pow(diameter, 4) / 64;
  const double G = young_modulus / (2 * (1 + poisson_ratio));
  const double kGA = joints::cowper_shear_coefficient(poisson_ratio) * G * area;
  return {.EA = young_modulus * area,
          .kGA1 = kGA,
          .kGA2 = kGA,
          .GJ = 2 * G * I,
          .EI1 = young_modulus * I,
          .EI2 = young_modulus * I};
}

SectionStiffness tube_section(double diameter, double inner_diameter, double young_modulus,
                              double poisson_ratio) {
  const double nu = poisson_ratio;
  SectionStiffness outer = circular_section(diameter, young_modulus, nu);
  const SectionStiffness inner = circular_section(inner_diameter, young_modulus, nu);
  outer.EA -= inner.EA;
  outer.GJ -= inner.GJ;
  outer.EI1 -= inner.EI1;
  outer.EI2 -= inner.EI2;
  const double m2 = std::pow(inner_diameter / diameter, 2);
  const double square = std::pow(1 + m2, 2);
  const double k = 6 * (1 + nu) * square / ((7 + 6 * nu) * square + (20 + 12 * nu) * m2);
  outer.kGA1 = outer.kGA2 = k * outer.EA / (2 * (1 + nu));
  return outer;
}

SectionStiffness rectangular_section(double a, double b, double young_modulus,
                                     double poisson_ratio) {
  const double G = young_modulus / (2 * (1 + poisson_ratio));
  const double kGA = 10 * (1 + poisson_ratio) / (12 + 11 * poisson_ratio) * G * a * b;
  const auto [s, l] = std::minmax(a, b);
  using std::numbers::pi;
  double sum = 0;
  for (int n = 399; n > 0; n -= 2) sum += std::tanh(n * pi * l / (2 * s)) / std::pow(n, 5);
  const double J = l * std::pow(s, 3) * (1.0 / 3 - 64 / std::pow(pi, 5) * s / l * sum);
  return {.EA = young_modulus * a * b,
          .kGA1 = kGA,
          .kGA2 = kGA,
          .GJ = G * J,
          .EI1 = young_modulus * a * std::pow(b, 3) / 12,
          .EI2 = young_modulus * std::pow(a, 3) * b / 12};
}

Section joint_section(const joints::Joint& joint) {
  return {{joint.displacement, joint.displacement, joint.extension},
          {joint.rotation, joint.rotation, 0},
          joint.coupling,
          true,
          joint.beyond};
}

Section rigid_in_shear(const Section& section) {
  return {Vector3::Zero(), section.moment_compliance};
}

}  // namespace ciliaval::fem::beam

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "fem/beam/newton.h"
#include "fem/beam/section.h"
#include "oracles.h"
#include "problem/cilium.h"

// Declarations that the tests of the beam share.
namespace beams {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
using std::numbers::pi;
inline constexpr double L = 20e-3;  ///< of the paper's cilium, m
inline constexpr double h = 16e-3;  ///< of its contact, m

/// A rod of one material in n segments.
inline ciliaval::Cilium equal_segments(std::size_t n) {
  return {3e-3,
          std::vector<ciliaval::Segment>(n, {"rod", L / static_cast<double>(n), 1e6, 0.49, 0})};
}

/// The paper's cilium; E₁ = E₂/ratio.
inline ciliaval::Cilium paper_cilium(double ratio = 30) {
  return {3e-3, {{"base", 3e-3, 3e6 / ratio, 0.49, 0}, {"magnet", 17e-3, 3e6, 0.49, 75e3}}};
}

/// Stretches of the beam for the oracles.
inline std::vector<oracle::Stretch> stretches(const ciliaval::Cilium& cilium, bool shear_rigid) {
  std::vector<oracle::Stretch> beam;
  for (const ciliaval::Segment& s : cilium.segments) {
    const auto k =
        ciliaval::fem::beam::circular_section(cilium.diameter, s.young_modulus, s.poisson_ratio);
    const double stretch = shear_rigid ? 0 : 1 / k.EA;
    const double shear = shear_rigid ? 0 : 1 / k.kGA1;
    beam.push_back({s.length, k.EI1, stretch - shear, stretch, shear});
  }
  return beam;
}

/// Records the largest of a test's measured errors of one name in its report (--gtest_output), and
/// hands the error on.
inline double measured(const std::string& what, double error) {
  static std::map<std::pair<const void*, std::string>, double> worst;
  double& record = worst[{testing::UnitTest::GetInstance()->current_test_info(), what}];
  record = std::max(record, error);
  std::ostringstream text;
  text << std::scientific << record;
  testing::Test::RecordProperty(what, text.str());
  return error;
}

inline ciliaval::fem::beam::Mesh uniform_mesh(double length, std::size_t elements,
                                              unsigned int degree,
                                              const ciliaval::fem::beam::Section& law) {
  ciliaval::fem::beam::Mesh mesh;
  mesh.degree = degree;
  mesh.sections.assign(elements, law);
  for (std::size_t i = 0; i <= elements; ++i)
    mesh.vertices.push_back(length * static_cast<double>(i) / static_cast<double>(elements));
  return mesh;
}

inline ciliaval::fem::beam::Section isotropic(double EI, double GJ, double EA, double kGA) {
  return ciliaval::fem::beam::section(
      {.EA = EA, .kGA1 = kGA, .kGA2 = kGA, .GJ = GJ, .EI1 = EI, .EI2 = EI});
}

inline ciliaval::fem::beam::Loads end_load(std::size_t vertex, const ciliaval::Vector3& force,
                                           const ciliaval::Vector3& moment) {
  ciliaval::fem::beam::Loads loads;
  loads.points.push_back({vertex, force, moment});
  return loads;
}

/// Circular arc of radius R in the plane z = 0, base tangent +x, curving to −y; d₁ = e_z.
inline ciliaval::fem::beam::Pose arc(double R, double S) {
  const double phi = S / R;
  ciliaval::Matrix3 directors;
  directors.col(0) = ciliaval::Vector3::UnitZ();
  directors.col(1) = ciliaval::Vector3(-std::sin(phi), -std::cos(phi), 0);
  directors.col(2) = ciliaval::Vector3(std::cos(phi), -std::sin(phi), 0);
  return {R * ciliaval::Vector3(std::sin(phi), std::cos(phi) - 1, 0),
          ciliaval::Quaternion(directors)};
}

}  // namespace beams

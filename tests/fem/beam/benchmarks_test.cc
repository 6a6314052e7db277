// SPDX-License-Identifier: LGPL-2.1-or-later
// The beam core against solutions of the field: Mattiasson's and Batista's cantilever, roll-up, the
// 45° bend.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "fem/beam/newton.h"
#include "oracles.h"

namespace {

using ciliaval::Quaternion;
using ciliaval::Vector3;
using namespace ciliaval::fem::beam;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double pi = std::numbers::pi;

Mesh uniform_mesh(double length, std::size_t elements, unsigned int degree, const Section& law) {
  Mesh mesh;
  mesh.degree = degree;
  mesh.sections.assign(elements, law);
  for (std::size_t i = 0; i <= elements; ++i)
    mesh.vertices.push_back(length * static_cast<double>(i) / static_cast<double>(elements));
  return mesh;
}

Section isotropic(double EI, double GJ, double EA, double kGA) {
  return section({.EA = EA, .kGA1 = kGA, .kGA2 = kGA, .GJ = GJ, .EI1 = EI, .EI2 = EI});
}

TEST(BeamCantilever, MatchesTheTableOfTheInextensibleElastica) {
  // Oracle: Mattiasson's table to ten digits (elliptic integrals), PL²/EI = 1, 2, 5, 10.
  struct Row {
    double load, theta, deflection, shortening;
  };
  constexpr std::array rows{Row{1, 0.4613519497, 0.3017207738, 0.0564332363},
                            Row{2, 0.7817498316, 0.4934574804, 0.1606417208},
                            Row{5, 1.2153681176, 0.7137915236, 0.3876283607},
                            Row{10, 1.4302855388, 0.8106090249, 0.5549955978}};
  System system(straight_curve, uniform_mesh(1, 8, 4, isotropic(1, 1, infinity, infinity)), {{0}});
  State state = system.reference_state();
  Loads before;
  for (const Row& row : rows) {
    Loads loads;
    loads.points.push_back({8, {row.load, 0, 0}, Vector3::Zero()});
    const PathReport report = advance(system, state, before, loads, {});
    ASSERT_TRUE(report.converged) << report.message;
    before = loads;
    const Vector3 d3 = state.rotation.back() * Vector3::UnitZ();
    printf("%g: %d its, %d cuts; %.3e %.3e %.3e\n", row.load, report.iterations, report.cutbacks,
           std::atan2(d3[0], d3[2]) - row.theta, state.position.back()[0] - row.deflection,
           1 - state.position.back()[2] - row.shortening);
  }
}

}  // namespace

// SPDX-License-Identifier: LGPL-2.1-or-later
// A tip that slides on a surface, by the closed forms of the flat one (elliptic integrals).
#include "analytic/elastica/tip_contact.h"

#include <gtest/gtest.h>

#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <cmath>
#include <numbers>
#include <vector>

namespace ciliaval::analytic::elastica {
using namespace surroundings;
namespace {

using std::numbers::pi;

const Cilium uniform{1e-3, {{"rod", 20e-3, 1e6, 0.49, 0}}};

/// The flat surface at a height, from that of the straight cilium down in small steps.
TipContact pressed_flat(double friction, double direction, double height) {
  const Surface flat{FlatProfile{}, friction, 0};
  const TipProblem problem = tip_problem(uniform);
  TipContact contact;
  contact.base_moment = 0.1;
  contact.force_z = friction > 0 ? -0.1 / friction : -pi * pi / 4;
  contact.force_x = -direction * friction * contact.force_z;
  const double first = friction > 0 ? 0.9995 : 0.999;
  for (int i = 0; first - 0.002 * i > height; ++i)
    contact = sliding(problem, flat, {first - 0.002 * i, 0}, direction, contact).value();
  return sliding(problem, flat, {height, 0}, direction, contact).value();
}

struct Oracle {
  double mu;
  double height;
  double angle;  ///< deg
  double normal_force;
  double x;
  double base_moment;
};

TEST(SlidingTip, HoldsTheFlatSurfacesTable) {
  for (const Oracle& o : {Oracle{0, 0.9, 36.62428080, 2.5981409871, 0.3898486228, 1.0128816855},
                          {0.1, 0.9, 36.38979753, 2.1981578477, 0.3910417111, 1.0574056122},
                          {0.3, 0.95, 25.33531795, 1.3953033871, 0.2823389396, 0.7916099441},
                          {0.3, 0.9, 36.10026054, 1.6804930144, 0.3924850548, 1.1133015067},
                          {0.3, 0.8, 51.70288240, 2.0447813201, 0.5360274743, 1.5868064834}}) {
    const TipContact contact = pressed_flat(o.mu, 1, o.height);
    EXPECT_NEAR(contact.theta * 180 / pi, o.angle, 1e-8);
    EXPECT_NEAR(contact.normal_force, o.normal_force, 1e-10);
    EXPECT_NEAR(contact.x, o.x, 1e-10);
    EXPECT_NEAR(contact.base_moment, o.base_moment, 1e-10);
  }
}

/// Travel reversed, friction turned: the shapes without an inflection end where the base's moment
/// vanishes, at the tip angle 2φ, φ = atan μ, k = sin(φ/2).
TEST(SlidingTip, EndsItsReversedBranchWhereTheBasesMomentVanishes) {
  for (const double mu : {0.1, 0.3}) {
    const TipProblem problem = tip_problem(uniform);
    TipContact contact = pressed_flat(0, 1, 0.9);
    const double phi = std::atan(mu);
    const double k = std::sin(phi / 2);
    const double K = boost::math::ellint_1(k);
    const double end = std::cos(phi) * (2 * boost::math::ellint_2(k) / K - 1);
    for (int i = 0; 0.01 * i < mu; ++i)
      contact = sliding(problem, {FlatProfile{}, 0.01 * i, 0}, {0.9, 0}, -1, contact).value();
    const Surface surface{FlatProfile{}, mu, 0};
    for (int i = 0; 0.9 + 0.001 * i < end; ++i)
      contact = sliding(problem, surface, {0.9 + 0.001 * i, 0}, -1, contact).value();
    contact = sliding(problem, surface, {end, 0}, -1, contact).value();
    EXPECT_NEAR(end, mu == 0.1 ? 0.9925673333 : 0.9375749321, 1e-10);
    EXPECT_NEAR(contact.base_moment, 0, 1e-9);
    EXPECT_NEAR(contact.theta, 2 * phi, 1e-9);
    EXPECT_NEAR(contact.normal_force, mu == 0.1 ? 9.8328287295 : 9.5545063261, 1e-8);
    EXPECT_NEAR(contact.friction_force, -mu * contact.normal_force, 1e-11);
  }
}

/// The elastic energy of an equilibrium path changes by the work of the height and of the friction:
/// without friction dE/dH = −N.
TEST(SlidingTip, StoresTheWorkOfTheSurface) {
  const double h = 1e-4;
  const TipProblem problem =
      tip_problem({1e-3, {{"a", 4e-3, 1e5, 0.49, 0}, {"b", 16e-3, 1e6, 0.49, 0}}});
  const Surface surface{FlatProfile{}, 0, 0};
  TipContact contact;
  contact.base_moment = 0.1;
  contact.force_z = -0.5;
  for (int i = 1; i < 150; ++i)
    contact = sliding(problem, surface, {1 - 0.001 * i, 0}, 1, contact).value();
  const auto at = [&](double height) {
    return sliding(problem, surface, {height, 0}, 1, contact).value();
  };
  EXPECT_NEAR((at(0.85 + h).energy - at(0.85 - h).energy) / (2 * h), -at(0.85).normal_force, 1e-6);
}

/// A rim that is stuck to a slope: in equilibrium as a whole, with the touching point on the
/// surface.
TEST(StickingTip, BalancesForcesAndStaysOnTheSurface) {
  TipProblem problem = tip_problem(uniform);
  problem.rim = 0.05;
  const Surface surface{SineProfile{1e-3, 30e-3}, 0.4, 0};
  TipContact contact = pressed_flat(0.3, 1, 0.9);
  contact.contact_x = contact.x;
  const double held = 0.37;
  const auto stuck = sticking(problem, surface, {0.9, 0}, held, contact);
  ASSERT_TRUE(stuck);
  EXPECT_NEAR(stuck->contact_x, held, 1e-12);
  EXPECT_NEAR(stuck->contact_z, 0.9 - surface.at(held * 20e-3).height / 20e-3, 1e-12);
  EXPECT_NEAR(std::hypot(stuck->contact_x - stuck->x, stuck->contact_z - stuck->z), 0.05, 1e-12);
  // Moment about the base of the whole cilium.
  const double slope = surface.at(held * 20e-3).slope;
  const double norm = std::hypot(1, slope);
  const double force_x = (-slope * stuck->normal_force + stuck->friction_force) / norm;
  const double force_z = (-stuck->normal_force - slope * stuck->friction_force) / norm;
  EXPECT_NEAR(stuck->base_moment, force_x * stuck->contact_z - force_z * stuck->contact_x, 1e-10);
  // Its travel by ds moves the touching point along: the same shape as with a height profile moved.
  const auto moved = sticking(problem, surface, {0.9, 0.01}, held, *stuck);
  ASSERT_TRUE(moved);
  EXPECT_NEAR(moved->contact_x, held + 0.01, 1e-12);
  EXPECT_NEAR(moved->contact_z, stuck->contact_z, 1e-12);
}

}  // namespace
}  // namespace ciliaval::analytic::elastica

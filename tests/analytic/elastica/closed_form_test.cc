// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "cases.h"

namespace ciliaval::analytic {
namespace {

/// A contact force at the height of 10 mm on the uniform cilium of 20 mm that turns it to
/// sin θ = `sine` at the contact: F = 2 EI sin θ/h².
ContactLoad contact_with_sine(double sine) {
  const Cilium cilium = uniform_cilium();
  ContactLoad load;
  load.height = 10e-3;
  load.force = 2 * bending_stiffness(cilium) * sine / (load.height * load.height);
  return load;
}

PointForceElastica contact_oracle(const ContactLoad& load) {
  const Real stiffness = bending_stiffness(uniform_cilium());
  const Real sine = Real(load.force) * load.height * load.height / (2 * stiffness);
  return PointForceElastica::with_end_angle(sqrt(Real(load.force) / stiffness), sine);
}

// Oracle: Legendre's integrals in 50 digits (cases.h), z in closed form. Measured: 2e-14 of the
// length and 5e-14 rad, by interpolation; margin 4.
TEST(ElasticaClosedForm, ContactOnOneMaterialFollowsLegendresIntegrals) {
  const double length = uniform_cilium().length();
  for (const double sine : {1e-4, 0.1, 0.5, 0.8, 0.94}) {
    const ContactLoad load = contact_with_sine(sine);
    const PointForceElastica oracle = contact_oracle(load);
    const MechanicsStep step = solve(uniform_cilium(), load);
    ASSERT_TRUE(step.contact_arclength);
    const auto contact = static_cast<double>(oracle.length());
    ASSERT_LT(contact, length);
    EXPECT_NEAR(*step.contact_arclength, contact, 1e-13 * length) << sine;
    const auto end = static_cast<double>(oracle.end_angle());
    for (const double part : {0.02, 0.2, 0.5, 0.7, 0.9, 0.99}) {
      const double theta = part * end;
      const PointForceElastica::Point exact = oracle.at(theta);
      const PlanarPoint point = planar_point(step, static_cast<double>(exact.S));
      EXPECT_NEAR(point.w, static_cast<double>(exact.w), 1e-13 * length) << sine << ' ' << part;
      EXPECT_NEAR(point.z, static_cast<double>(exact.z), 1e-13 * length) << sine << ' ' << part;
      EXPECT_NEAR(point.theta, theta, 2e-13) << sine << ' ' << part;
    }
    // Above the contact point: straight.
    const PlanarPoint tip = planar_point(step, length);
    EXPECT_NEAR(tip.theta, end, 2e-13) << sine;
    EXPECT_NEAR(
        tip.w,
        static_cast<double>(oracle.deflection() + (length - oracle.length()) * oracle.sine()),
        1e-13 * length);
    EXPECT_NEAR(tip.z, load.height + (length - contact) * std::cos(end), 1e-13 * length);
  }
}

// Oracle: K. Mattiasson, Int. J. Numer. Meth. Eng. 17, 145 (1981), to the ten digits printed: half
// a unit of the last one.
TEST(ElasticaClosedForm, DeadTipForceGivesMattiassonsTable) {
  struct Row {
    double load, angle, deflection, shortening;
  };
  const Cilium cilium = uniform_cilium();
  const double length = cilium.length();
  for (const Row& row : {Row{1, 0.4613519497, 0.3017207738, 0.0564332363},
                         Row{2, 0.7817498316, 0.4934574804, 0.1606417208},
                         Row{5, 1.2153681176, 0.7137915236, 0.3876283607},
                         Row{10, 1.4302855388, 0.8106090249, 0.5549955978}}) {
    SectionLoad load;
    load.arclength = length;
    load.force = row.load * bending_stiffness(cilium) / (length * length);
    const PlanarPoint tip = planar_point(solve(cilium, load), length);
    EXPECT_NEAR(tip.theta, row.angle, 0.51e-10);
    EXPECT_NEAR(tip.w / length, row.deflection, 0.51e-10);
    EXPECT_NEAR(1 - tip.z / length, row.shortening, 0.51e-10);
  }
}

// Oracle: Legendre's integrals in 50 digits, θ_c from K(p) − F(ψ₀, p) = λL. Measured: 4e-15;
// margin 25.
TEST(ElasticaClosedForm, DeadTipForceFollowsLegendresIntegrals) {
  const Cilium cilium = uniform_cilium();
  const double length = cilium.length();
  for (const double load_number : {1e-6, 0.01, 1.0, 2.0, 5.0, 10.0, 100.0, 1000.0}) {
    SectionLoad load;
    load.arclength = length;
    load.force = load_number * bending_stiffness(cilium) / (length * length);
    const PointForceElastica oracle = PointForceElastica::with_length(
        sqrt(Real(load.force) / Real(bending_stiffness(cilium))), length);
    const PlanarPoint tip = planar_point(solve(cilium, load), length);
    const auto angle = static_cast<double>(oracle.end_angle());
    EXPECT_NEAR(tip.theta, angle, 1e-13 * angle) << load_number;
    EXPECT_NEAR(tip.w, static_cast<double>(oracle.deflection()), 1e-13 * length) << load_number;
    EXPECT_NEAR(tip.z, static_cast<double>(oracle.height()), 1e-13 * length) << load_number;
  }
}

// Oracle: the same, for the part below the loaded section; the part above is straight. Measured:
// 2e-16; margin 500.
TEST(ElasticaClosedForm, DeadForceOnAnInnerSectionLeavesTheTopStraight) {
  const Cilium cilium = uniform_cilium();
  const double length = cilium.length();
  SectionLoad load;
  load.arclength = 13e-3;
  load.force = 4 * bending_stiffness(cilium) / (load.arclength * load.arclength);
  const PointForceElastica oracle = PointForceElastica::with_length(
      sqrt(Real(load.force) / Real(bending_stiffness(cilium))), load.arclength);
  const MechanicsStep step = solve(cilium, load);
  const PlanarPoint tip = planar_point(step, length);
  const double straight = length - load.arclength;
  EXPECT_NEAR(tip.theta, static_cast<double>(oracle.end_angle()), 1e-13);
  EXPECT_NEAR(tip.w, static_cast<double>(oracle.deflection() + straight * oracle.sine()),
              1e-13 * length);
  EXPECT_NEAR(tip.z, static_cast<double>(oracle.height()) + straight * std::cos(tip.theta),
              1e-13 * length);
  const CentrelinePoint above = step.deformation->centreline.at(16e-3);
  EXPECT_EQ(above.forces.force.norm(), 0);
  EXPECT_EQ(above.forces.moment.norm(), 0);
  EXPECT_EQ(above.curvature.norm(), 0);
}

}  // namespace
}  // namespace ciliaval::analytic

// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <boost/math/quadrature/tanh_sinh.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <numbers>

#include "cases.h"

namespace ciliaval::analytic {
namespace {

constexpr double right_angle = std::numbers::pi / 2;

// Oracle: Legendre's integrals. Near 90° the last bit of F moves cos θ_c by ε/cos θ_c, so 1e-13 is
// what double precision can hold at 89.9°. Measured 7e-14 of the length, 1e-13 rad at 89.9°;
// margin 5.
TEST(ElasticaExtremes, ContactHoldsUpTo89Point999Degrees) {
  const Cilium cilium = uniform_cilium();
  const double length = cilium.length();
  const double stiffness = bending_stiffness(cilium);
  struct Row {
    double degrees, tolerance;
  };
  for (const Row& row : {Row{80, 1e-13}, Row{89, 1e-13}, Row{89.9, 5e-13}, Row{89.999, 5e-11}}) {
    ContactLoad load;
    load.height = 1.5e-3;
    load.force = 2 * stiffness * std::sin(row.degrees * std::numbers::pi / 180) /
                 (load.height * load.height);
    const Real sine = Real(load.force) * load.height * load.height / (2 * Real(stiffness));
    const auto oracle =
        PointForceElastica::with_end_angle(sqrt(Real(load.force) / Real(stiffness)), sine);
    ASSERT_LT(oracle.length(), length);
    const MechanicsStep step = solve(cilium, load);
    const PlanarPoint tip = planar_point(step, length);
    const Real tail = length - oracle.length();
    EXPECT_NEAR(*step.contact_arclength, static_cast<double>(oracle.length()),
                1e3 * row.tolerance * length)
        << row.degrees;  // s_c depends on ln cos θ_c
    EXPECT_NEAR(tip.theta, static_cast<double>(oracle.end_angle()), row.tolerance) << row.degrees;
    EXPECT_NEAR(tip.w, static_cast<double>(oracle.deflection() + tail * oracle.sine()),
                row.tolerance * length)
        << row.degrees;
    EXPECT_NEAR(tip.z,
                static_cast<double>(load.height + tail * sqrt(1 - oracle.sine() * oracle.sine())),
                row.tolerance * length)
        << row.degrees;
  }
}

// Oracle: the separatrix tan((π/2 − θ)/4) = tan(π/8) e^{−λS} of an endless cilium, from which the
// tip differs by e^{−λL} < 1e-43: z_tip = √2/λ, w_tip = L − (2 − √2)/λ. Up to 3e9, ten thousand
// times what "1e5 times past linear" asks. Measured 2e-14, for z relative to z_tip; margin 40.
TEST(ElasticaExtremes, DeadForceTurnsTheCiliumLevel) {
  const Cilium cilium = uniform_cilium();
  const double length = cilium.length();
  for (const double load_number : {1e4, 3e5, 3e7, 3e9}) {
    SectionLoad load;
    load.arclength = length;
    load.force = load_number * bending_stiffness(cilium) / (length * length);
    const double lambda = std::sqrt(load_number) / length;
    const MechanicsStep step = solve(cilium, load);
    const PlanarPoint tip = planar_point(step, length);
    const double root2 = std::numbers::sqrt2;
    EXPECT_NEAR(tip.z, root2 / lambda, 1e-12 * root2 / lambda) << load_number;
    EXPECT_NEAR(tip.w, length - (2 - root2) / lambda, 1e-13 * length) << load_number;
    EXPECT_NEAR(tip.theta, right_angle, 1e-14) << load_number;
    for (const double folds : {0.1, 1.0, 4.0, 20.0}) {
      const double phi = 4 * std::atan(std::tan(std::numbers::pi / 8) * std::exp(-folds));
      EXPECT_NEAR(planar_point(step, folds / lambda).theta, right_angle - phi, 1e-12)
          << load_number << ' ' << folds;
    }
  }
}

/// ∫_0^z₂ du/√(1 − (1 − δ − (1 − δ)(u/z₂)³)²) over z₂ with 1 − δ = sin θ at the tip of a flow on
/// one material: its length over its height, in 50 digits.
Real flow_slenderness(const Real& delta) {
  static boost::math::quadrature::tanh_sinh<Real> rule(12);
  const auto inverse_cosine = [&](const Real& u) -> Real {
    const Real rest = delta + (1 - delta) * u * u * u;  // 1 − sin θ
    return 1 / sqrt(rest * (2 - rest));
  };
  // The integrand has its scale at u = δ^{1/3}: the two parts, both over (0, 1), where Boost's
  // assertions on the places near the limits hold.
  const Real knee = cbrt(delta);
  const auto both_parts = [&](const Real& t) -> Real {
    return knee * inverse_cosine(knee * t) + (1 - knee) * inverse_cosine(knee + (1 - knee) * t);
  };
  return rule.integrate(both_parts, Real(0), Real(1), Real(1e-25));
}

// Oracle: the quadrature in z on one material in 50 digits, from the tip's own δ = 1 − sin θ:
// qL³/EI = 6 (1 − δ) (L/z₂)³. Up to 5e7. Measured 7e-14, for z relative to z_tip; margin 14.
TEST(ElasticaExtremes, FlowTurnsTheCiliumLevel) {
  const Cilium cilium = uniform_cilium();
  const double length = cilium.length();
  for (const double exponent : {-1.0, -4.0, -8.0, -12.0}) {
    const Real delta = pow(Real(10), exponent);
    const Real slenderness = flow_slenderness(delta);
    const auto load_number = static_cast<double>(6 * (1 - delta) * pow(slenderness, 3));
    const FlowLoad load{load_number * bending_stiffness(cilium) / std::pow(length, 3), 0};
    const MechanicsStep step = solve(cilium, load);
    const PlanarPoint tip = planar_point(step, length);
    const double height = length / static_cast<double>(slenderness);
    EXPECT_NEAR(tip.z, height, 1e-12 * height) << load_number;
    EXPECT_NEAR(tip.theta, static_cast<double>(asin(1 - delta)), 1e-13) << load_number;
    EXPECT_NEAR(step.applied_force, load.force_per_height * height, 1e-12 * step.applied_force);
  }
}

// Claim: stiffness ratios of 1e12 do not spoil the solution. Oracle: in the limit the stiff part is
// rigid. A soft foot below a rigid rod of length b with the force F on its end: θ and z of the foot
// obey the point-force elastica with the rod's lever, F b cos θ₁ = EI θ' at its end, so
// λ²(z₂ − z₁) = θ'; the energy integral θ'² = 2λ²(sin θ_c − sin θ) holds with the virtual end angle
// θ_c. A rigid foot below a soft rod is that rod clamped at its height. Measured 1e-12:
// the bending of the rigid part, 1e-12 times the load number.
TEST(ElasticaExtremes, StiffnessRatioOf1e12IsARigidPart) {
  Cilium cilium = uniform_cilium();
  cilium.segments[0].length = 8e-3;
  cilium.segments.push_back(cilium.segments[0]);
  cilium.segments[1].length = 12e-3;
  const double soft = bending_stiffness(cilium);
  SectionLoad load;
  load.arclength = cilium.length();
  load.force = 10 * soft / (12e-3 * 12e-3);

  cilium.segments[0].young_modulus = 1e18;
  const PlanarPoint top = planar_point(solve(cilium, load), cilium.length());
  const auto clamped =
      PointForceElastica::with_length(sqrt(Real(load.force) / Real(soft)), Real(12e-3));
  EXPECT_NEAR(top.theta, static_cast<double>(clamped.end_angle()), 5e-11);
  EXPECT_NEAR(top.z, 8e-3 + static_cast<double>(clamped.height()), 5e-11 * cilium.length());

  cilium.segments[0].young_modulus = 1e6;
  cilium.segments[1].young_modulus = 1e18;
  const MechanicsStep step = solve(cilium, load);
  const PlanarPoint joint = planar_point(step, 8e-3);
  const double lambda = std::sqrt(load.force / soft);
  const double rate = lambda * lambda * 12e-3 * std::cos(joint.theta);  // θ' at the foot's end
  const double sine = std::sin(joint.theta) + rate * rate / (2 * lambda * lambda);
  const auto foot = PointForceElastica::with_end_angle(lambda, sine).at(joint.theta);
  EXPECT_NEAR(static_cast<double>(foot.S), 8e-3, 5e-11 * 8e-3);
  EXPECT_NEAR(joint.z, static_cast<double>(foot.z), 5e-11 * cilium.length());
  EXPECT_NEAR(joint.w, static_cast<double>(foot.w), 5e-11 * cilium.length());
  EXPECT_NEAR(planar_point(step, cilium.length()).theta, joint.theta, 5e-11);
}

// Claim: the solution depends on PL²/(EI) alone: slenderness 1e4 in nanonewton gives the same
// shape.
TEST(ElasticaExtremes, SlendernessOf1e4ScalesOut) {
  const Cilium thick = paper_cilium();
  Cilium slender = thick;
  slender.diameter = thick.length() / 1e4;
  const double scale = slender.second_moment() / thick.second_moment();
  for (const Load& load : {Load(ContactLoad{4e-3, 16e-3, 0}), Load(FlowLoad{1, 0}),
                           Load(SectionLoad{4e-3, 16e-3, 0}), Load(DeadLoad{1, 0})}) {
    const PlanarPoint a = planar_point(solve(thick, load), thick.length());
    const PlanarPoint b =
        planar_point(solve(slender, with_magnitude(load, magnitude(load) * scale)), thick.length());
    EXPECT_NEAR(a.w, b.w, 1e-13 * thick.length()) << type(load);
    EXPECT_NEAR(a.z, b.z, 1e-13 * thick.length()) << type(load);
    EXPECT_NEAR(a.theta, b.theta, 1e-13) << type(load);
  }
}

// Claim: the error estimate that comes with a step is never above the tolerance asked, and a looser
// tolerance is honoured against the tight solution.
TEST(ElasticaExtremes, LooserToleranceIsMet) {
  const Cilium cilium = paper_cilium();
  const FlowLoad load{1, 0};
  const PlanarPoint exact = planar_point(solve(cilium, load), cilium.length());
  for (const double tolerance : {1e-4, 1e-6, 1e-9}) {
    elastica::ElasticaOptions options;
    options.tolerance = tolerance;
    const MechanicsStep step = solve(cilium, load, options);
    const PlanarPoint tip = planar_point(step, cilium.length());
    EXPECT_NEAR(tip.w, exact.w, tolerance * cilium.length());
    EXPECT_NEAR(tip.z, exact.z, tolerance * cilium.length());
    EXPECT_LE(*step.tip_uncertainty, tolerance * cilium.length());
  }
}

}  // namespace
}  // namespace ciliaval::analytic

// SPDX-License-Identifier: LGPL-2.1-or-later
// fem::beam::Beam, the layer for the cilium, under its four loads.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "beams.h"
#include "fem/beam/beam.h"
#include "fem/beam/section.h"
#include "oracles.h"
#include "problem/error.h"

namespace {

using namespace ciliaval;
using beams::measured;

using beams::equal_segments;
using beams::h;
using beams::L;
using beams::paper_cilium;
using beams::stretches;

fem::beam::BeamOptions options(bool shear_rigid) {
  fem::beam::BeamOptions result;
  result.shear_rigid = shear_rigid;
  return result;
}

CentrelinePoint tip(const MechanicsStep& step) {
  return step.deformation->centreline.at(L);
}

/// Largest error of the tip's position relative to its deflection, and of its angle.
double tip_error(const MechanicsStep& step, const oracle::Tip& exact) {
  const CentrelinePoint t = tip(step);
  const double position = Vector3(t.position - Vector3(exact.x, 0, exact.z)).norm();
  return std::max(position / exact.x, std::abs(t.theta() - exact.theta));
}

TEST(BeamSection, CircularStiffnesses) {
  // Oracle: textbook figures for d = 2, E = 5.2, ν = 0.3 (G = 2): A = π, I = π/4, J = π/2;
  // Cowper's k = 7.8/8.8.
  const auto k = fem::beam::circular_section(2, 5.2, 0.3);
  EXPECT_NEAR(k.EA, 5.2 * beams::pi, 1e-14);
  EXPECT_NEAR(k.EI1, 5.2 * beams::pi / 4, 1e-14);
  EXPECT_NEAR(k.GJ, beams::pi, 1e-14);
  EXPECT_NEAR(k.kGA2, 2 * beams::pi * 7.8 / 8.8, 1e-14);
}

TEST(BeamContact, MatchesTheContactElastica) {
  // Oracle: closed forms by quadrature (oracles.h), without shear and with it. The default
  // discretisation; measured below 5e-14.
  for (const bool shear_rigid : {true, false}) {
    const Cilium cilium = paper_cilium();
    const auto result = fem::beam::Beam(options(shear_rigid))
                            .solve(cilium, {ContactLoad{1e-3, h, 0}, ContactLoad{4e-3, h, 0},
                                            ContactLoad{5.5e-3, h, 0}});
    for (const MechanicsStep& step : result.steps) {
      ASSERT_EQ(step.status, Status::converged) << step.message;
      const auto exact = oracle::contact(stretches(cilium, shear_rigid), magnitude(step.load), h);
      EXPECT_LT(measured("tip", tip_error(step, exact.tip)), 1e-12);
      EXPECT_LT(measured("arclength", std::abs(*step.contact_arclength - exact.arclength) / L),
                1e-12);
      const CentrelinePoint c = step.deformation->centreline.at(*step.contact_arclength);
      EXPECT_LT(measured("height", std::abs(c.position[2] - h) / L), 1e-14);
      EXPECT_NEAR(step.applied_force / magnitude(step.load), 1, 1e-12);
    }
  }
}

TEST(BeamContact, OneMaterial) {
  // Oracle: z = h − √(h² − 2EI sin θ/F) of a uniform beam, that is sin θ = F h²/(2EI) at and above
  // the contact.
  const Cilium cilium{3e-3, {{"rod", L, 1e6, 0.49, 0}}};
  const double EI = 1e6 * cilium.second_moment();
  const double F = 0.5 * 2 * EI / (h * h);
  const auto result = fem::beam::Beam(options(true)).solve(cilium, {ContactLoad{F, h, 0}});
  ASSERT_EQ(result.steps[0].status, Status::converged) << result.steps[0].message;
  EXPECT_NEAR(std::sin(tip(result.steps[0]).theta()), 0.5, 1e-12);
}

TEST(BeamContact, AlignsWithTheLoadWhereverItSlides) {
  // Oracle: the same closed form. A low contact that leaves the base for the magnet as it slides,
  // at stiffness ratios of 30 and 1000; each step also alone, without the path before it.
  fem::beam::BeamOptions fine;
  fine.refinement = 2;
  for (const double ratio : {30.0, 1000.0}) {
    const Cilium cilium = paper_cilium(ratio);
    const double low = 2e-3;
    const double unit = 2 * stretches(cilium, false)[0].EI / (low * low);
    LoadPath path;  // up to 98 % of the slip-off force at the ratio 30
    for (const double F : {0.25, 0.6, 0.83, 0.4}) path.push_back(ContactLoad{F * unit, low, 0});
    const auto result = fem::beam::Beam(fine).solve(cilium, path);
    bool in_base = false;
    bool in_magnet = false;
    for (const MechanicsStep& step : result.steps) {
      ASSERT_EQ(step.status, Status::converged) << step.message;
      (*step.contact_arclength < 3e-3 ? in_base : in_magnet) = true;
      const auto exact = oracle::contact(stretches(cilium, false), magnitude(step.load), low);
      EXPECT_LT(measured("tip", tip_error(step, exact.tip)), 1e-10);
      EXPECT_LT(measured("arclength", std::abs(*step.contact_arclength - exact.arclength) / L),
                1e-10);
      const auto alone = fem::beam::Beam(fine).solve(cilium, {step.load});
      EXPECT_LT(measured("path", (tip(alone.steps[0]).position - tip(step).position).norm() / L),
                1e-10);
    }
    EXPECT_TRUE(in_base && in_magnet);
  }
}

TEST(BeamContact, SlipsOffWhereTheElasticaDoes) {
  // Oracle: root of the closed form's arc length; 5.862 mN in the shear-rigid limit.
  const Cilium cilium = paper_cilium();
  for (const bool shear_rigid : {true, false}) {
    const auto result = fem::beam::Beam(options(shear_rigid))
                            .solve(cilium, {ContactLoad{5e-3, h, 0}, ContactLoad{6e-3, h, 0},
                                            ContactLoad{4e-3, h, 0}});
    const double exact = oracle::slip_off_force(stretches(cilium, shear_rigid), h);
    if (shear_rigid) {
      EXPECT_NEAR(exact, 5.862e-3, 5e-7);
    }
    ASSERT_TRUE(result.steps[1].slip_off_force);
    EXPECT_LT(measured("force", std::abs(*result.steps[1].slip_off_force / exact - 1)), 1e-11);
    EXPECT_EQ(result.steps[0].status, Status::converged);
    EXPECT_EQ(result.steps[1].status, Status::slipped_off);
    EXPECT_FALSE(result.steps[1].deformation);
    EXPECT_NE(result.steps[1].message.find("no equilibrium"), std::string::npos);
    // The path goes on after it.
    ASSERT_EQ(result.steps[2].status, Status::converged);
    const auto after = oracle::contact(stretches(cilium, shear_rigid), 4e-3, h);
    EXPECT_LT(tip_error(result.steps[2], after.tip), 1e-12);
  }
}

TEST(BeamContact, HoldsUpToTheSlipOffForce) {
  const Cilium cilium = paper_cilium();
  const double limit = oracle::slip_off_force(stretches(cilium, false), h);
  const auto result = fem::beam::Beam().solve(
      cilium, {ContactLoad{limit * (1 - 1e-9), h, 0}, ContactLoad{limit * (1 + 1e-9), h, 0}});
  ASSERT_EQ(result.steps[0].status, Status::converged) << result.steps[0].message;
  EXPECT_NEAR(*result.steps[0].contact_arclength / L, 1, 1e-8);
  EXPECT_EQ(result.steps[1].status, Status::slipped_off);
}

TEST(BeamContact, UnloadedStandsStraight) {
  const auto result = fem::beam::Beam().solve(paper_cilium(), {ContactLoad{0, h, 0}});
  ASSERT_EQ(result.steps[0].status, Status::converged) << result.steps[0].message;
  EXPECT_NEAR(*result.steps[0].contact_arclength, h, 1e-17);
  EXPECT_LT((tip(result.steps[0]).position - L * Vector3::UnitZ()).norm(), 1e-17);
}

TEST(BeamContact, CutsInOneMaterialDoNotMatter) {
  // Oracle: the same rod in one piece. Heights between, on and a rounding error or a nanometre
  // beside an interface; the last force slides the contact over an interface. Measured: 2e-11,
  // the discretisation of the one piece.
  const Cilium one = equal_segments(1);
  const Cilium twenty = equal_segments(20);
  for (const double height : {15.5e-3, h, h * (1 - 2e-16), h - 1e-9}) {
    const LoadPath path{ContactLoad{0, height, 0}, ContactLoad{1e-6, height, 0},
                        ContactLoad{1e-3, height, 0}, ContactLoad{20e-3, height, 0}};
    const auto whole = fem::beam::Beam().solve(one, path);
    const auto cut = fem::beam::Beam().solve(twenty, path);
    for (std::size_t i = 0; i < path.size(); ++i) {
      ASSERT_EQ(whole.steps[i].status, Status::converged) << whole.steps[i].message;
      ASSERT_EQ(cut.steps[i].status, Status::converged) << cut.steps[i].message;
      const Vector3 gap = tip(whole.steps[i]).position - tip(cut.steps[i]).position;
      EXPECT_LT(measured("tip", gap.norm() / L), 1e-10);
      EXPECT_LT(measured("arclength", std::abs(*whole.steps[i].contact_arclength -
                                               *cut.steps[i].contact_arclength) /
                                          L),
                1e-10);
    }
    EXPECT_GT(*cut.steps[3].contact_arclength, height + 1e-3);  // an interface further
  }
}

TEST(BeamContact, ManySegmentsCostNoMoreIterations) {
  // A contact that stays in its segment needs Newton's method once, measured 4 iterations; each
  // interface it slides over needs it twice, measured 10.
  const auto result = fem::beam::Beam().solve(
      equal_segments(50),
      {ContactLoad{0, h, 0}, ContactLoad{1e-3, h, 0}, ContactLoad{10e-3, h, 0}});
  for (const MechanicsStep& step : result.steps)
    ASSERT_EQ(step.status, Status::converged) << step.message;
  EXPECT_LE(result.steps[0].iterations, 1);
  EXPECT_LE(result.steps[1].iterations, 8);
  const double crossed = std::floor((*result.steps[2].contact_arclength - h) / (L / 50));
  EXPECT_GE(crossed, 1);
  EXPECT_LE(result.steps[2].iterations, 8 + 15 * static_cast<int>(crossed));
}

TEST(BeamContact, AForceFarBeyondTheSlipOffForceSlipsOff) {
  // Oracle: the closed form's slip-off force.
  const Cilium cilium = equal_segments(5);
  const auto result = fem::beam::Beam().solve(cilium, {ContactLoad{1e3, h, 0}});
  ASSERT_EQ(result.steps[0].status, Status::slipped_off) << result.steps[0].message;
  const double exact = oracle::slip_off_force(stretches(cilium, false), h);
  EXPECT_LT(measured("force", std::abs(*result.steps[0].slip_off_force / exact - 1)), 1e-10);
}

TEST(BeamContactSlow, ALowContactPastItsLimitSlipsOff) {
  // Oracle: the closed form's slip-off force. The base turns to nearly 90° there, where the contact
  // point runs away with the force. The layer in which it turns is √(EI/F) long: a fine mesh.
  const Cilium cilium = equal_segments(1);
  fem::beam::BeamOptions fine;
  fine.refinement = 5;
  for (const double low : {4e-3, 2e-3, 1e-3}) {
    const auto result = fem::beam::Beam(fine).solve(cilium, {ContactLoad{100, low, 0}});
    ASSERT_EQ(result.steps[0].status, Status::slipped_off) << result.steps[0].message;
    const double exact = oracle::slip_off_force(stretches(cilium, false), low);
    EXPECT_LT(measured("force", std::abs(*result.steps[0].slip_off_force / exact - 1)), 1e-10);
  }
}

TEST(BeamContact, ALargeStepDoesNotTakeTheContactBelowItsSegment) {
  // Oracle: the same limit by another path of loads. From nothing to 0.3 N Newton's method may end
  // with a contact below the clamp. Measured: 4e-16.
  const Cilium cilium = paper_cilium();
  const double low = 2.5e-3;
  const auto at_once = fem::beam::Beam().solve(cilium, {ContactLoad{0.3, low, 0}});
  const auto by_steps =
      fem::beam::Beam().solve(cilium, {ContactLoad{0.1, low, 0}, ContactLoad{0.3, low, 0}});
  ASSERT_EQ(at_once.steps[0].status, Status::slipped_off) << at_once.steps[0].message;
  ASSERT_EQ(by_steps.steps[1].status, Status::slipped_off) << by_steps.steps[1].message;
  EXPECT_LT(
      measured("force",
               std::abs(*at_once.steps[0].slip_off_force / *by_steps.steps[1].slip_off_force - 1)),
      1e-10);
}

TEST(BeamContact, NextToTheClampConvergesOrFailsSoon) {
  // Oracle: s_c = h and no bending: a millinewton a nanometre above the clamp. No force is known
  // that shears the clamp off; one of 1e10 N is given up.
  const auto result = fem::beam::Beam().solve(
      equal_segments(1), {ContactLoad{1e-3, 1e-9, 0}, ContactLoad{1e10, 1e-9, 0}});
  ASSERT_EQ(result.steps[0].status, Status::converged) << result.steps[0].message;
  EXPECT_NEAR(*result.steps[0].contact_arclength, 1e-9, 1e-17);
  EXPECT_LE(result.steps[0].iterations, 8);
  EXPECT_NE(result.steps[1].status, Status::converged);
  EXPECT_LE(result.steps[1].iterations, 1000);  // 673 measured, most of them to find no limit
}

TEST(BeamFlow, MatchesTheElasticaOfThePaper) {
  // Oracle: EI d(sin θ) = ½q(z₂ − z)² dz by quadrature (oracles.h), shear-rigid limit.
  const Cilium cilium = paper_cilium();
  const auto result = fem::beam::Beam(options(true))
                          .solve(cilium, {FlowLoad{0.1, 0}, FlowLoad{0.5, 0}, FlowLoad{1, 0}});
  for (const MechanicsStep& step : result.steps) {
    ASSERT_EQ(step.status, Status::converged) << step.message;
    const oracle::Tip exact = oracle::flow(stretches(cilium, true), magnitude(step.load));
    EXPECT_LT(measured("tip", tip_error(step, exact)), 1e-9);
    // The whole force is q z₂.
    EXPECT_NEAR(step.applied_force / (magnitude(step.load) * exact.z), 1, 1e-9);
  }
}

TEST(BeamLoads, SmallLoadsGiveTimoshenko) {
  // Oracle: unit-load theorem for Timoshenko's beam of two materials,
  //   w = ∫ M (L−S)/EI dS + ∫ V/kGA dS, with M = F(a−S), V = F or M = q(L−S)²/2, V = q(L−S).
  // Deflections of 1e-6 L: the nonlinear part is 1e-12, rounding error 1e-10.
  const Cilium cilium = paper_cilium();
  const auto k1 = fem::beam::circular_section(3e-3, 0.1e6, 0.49);
  const auto k2 = fem::beam::circular_section(3e-3, 3e6, 0.49);
  const auto integral = [&](const auto& f1, const auto& f2, double end) {
    const QuadratureRule a = gauss_legendre(4, 0, 3e-3);
    const QuadratureRule b = gauss_legendre(4, 3e-3, end);
    double sum = 0;
    for (std::size_t g = 0; g < 4; ++g)
      sum += a.weights[g] * f1(a.nodes[g]) + b.weights[g] * f2(b.nodes[g]);
    return sum;
  };
  const auto deflection = [&](const auto& M, const auto& V, double end) {
    return integral([&](double S) { return M(S) * (L - S) / k1.EI1 + V(S) / k1.kGA1; },
                    [&](double S) { return M(S) * (L - S) / k2.EI1 + V(S) / k2.kGA1; }, end);
  };
  const double F = 1e-8;
  const double q = 1e-6;
  const auto point = [&](double a) {
    return deflection([=](double S) { return F * (a - S); }, [=](double) { return F; }, a);
  };
  const double spread = deflection([=](double S) { return q * (L - S) * (L - S) / 2; },
                                   [=](double S) { return q * (L - S); }, L);
  struct Row {
    Load load;
    double deflection;
    double force;
  };
  const std::vector<Row> rows{{ContactLoad{F, h, 0}, point(h), F},
                              {SectionLoad{F, 12e-3, 0}, point(12e-3), F},
                              {SectionLoad{F, L, 0}, point(L), F},
                              {FlowLoad{q, 0}, spread, q * L},
                              {DeadLoad{q, 0}, spread, q * L}};
  for (const Row& row : rows) {
    const auto result = fem::beam::Beam().solve(cilium, {row.load});
    ASSERT_EQ(result.steps[0].status, Status::converged) << result.steps[0].message;
    EXPECT_LT(measured(std::string(type(row.load)),
                       std::abs(tip(result.steps[0]).position[0] / row.deflection - 1)),
              1e-9);
    EXPECT_NEAR(result.steps[0].applied_force / row.force, 1, 1e-9);
  }
}

TEST(BeamLoads, TheBaseBearsTheLoadAsked) {
  // Oracle: balance of forces, at large deflection.
  const Cilium cilium = paper_cilium();
  for (const Load& load : LoadPath{ContactLoad{4e-3, h, 2.1}, SectionLoad{4e-3, 12e-3, 2.1},
                                   DeadLoad{0.3, 2.1}, FlowLoad{0.3, 2.1}}) {
    const auto result = fem::beam::Beam().solve(cilium, {load});
    const MechanicsStep& step = result.steps[0];
    ASSERT_EQ(step.status, Status::converged) << step.message;
    double force = magnitude(load);
    if (load.is<DeadLoad>()) force *= L;
    if (load.is<FlowLoad>()) force *= tip(step).position[2];
    EXPECT_LT(measured(std::string(type(load)), std::abs(step.applied_force / force - 1)), 1e-12);
    const SectionForces base = step.deformation->centreline.at(0).forces;
    EXPECT_LT((base.force - force * direction(load)).norm() / force, 1e-6);
  }
}

TEST(BeamLoads, ACoupleRollsTheTipUp) {
  // Oracle: θ = ∫ M/(EI) dS; n = 0 and m = M e_z × e in every section.
  const Cilium cilium = paper_cilium();
  double flexibility = 0;
  for (const Segment& segment : cilium.segments)
    flexibility += segment.length / (segment.young_modulus * cilium.second_moment(0));
  const double M = 1.8 * pi / flexibility;
  const MechanicsStep step = fem::beam::Beam().solve(cilium, {MomentLoad{M, 2.1}}).steps[0];
  ASSERT_EQ(step.status, Status::converged) << step.message;
  const Vector3 e = direction(step.load);
  for (const double S : {0.0, 5e-3, L}) {
    const SectionForces forces = step.deformation->centreline.at(S).forces;
    EXPECT_LT((forces.moment - M * Vector3::UnitZ().cross(e)).norm(), 1e-6 * M);
    EXPECT_LT(forces.force.norm() * L, 1e-6 * M);
  }
  const Vector3 normal = step.deformation->centreline.at(L).normal();
  EXPECT_NEAR(normal.dot(e), std::sin(1.8 * pi), 1e-9);
  EXPECT_NEAR(normal.z(), std::cos(1.8 * pi), 1e-9);
}

TEST(BeamLoads, AzimuthTurnsTheSolution) {
  const Cilium cilium = paper_cilium();
  const double phi = 0.7;
  const Quaternion turn(Eigen::AngleAxisd(phi, Vector3::UnitZ()));
  const LoadPath plain{ContactLoad{4e-3, h, 0}, ContactLoad{5e-3, h, 0}};
  const LoadPath turned{ContactLoad{4e-3, h, phi}, ContactLoad{5e-3, h, phi}};
  const auto a = fem::beam::Beam().solve(cilium, plain);
  const auto b = fem::beam::Beam().solve(cilium, turned);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_LT((turn * tip(a.steps[i]).position - tip(b.steps[i]).position).norm() / L, 1e-13);
}

TEST(BeamLoads, ResultsDoNotDependOnThePath) {
  // Oracle: uniqueness; every step of a wild path against the same load alone.
  const Cilium cilium = paper_cilium();
  for (const LoadPath& path :
       {LoadPath{FlowLoad{0.5, 0}, FlowLoad{0.2, 1}, FlowLoad{0.6, 3}},
        LoadPath{SectionLoad{5e-3, L, 0}, SectionLoad{1e-3, 8e-3, 2}, SectionLoad{3e-3, 8e-3, -1}},
        LoadPath{ContactLoad{5e-3, h, 0}, ContactLoad{1e-3, h, 3}, ContactLoad{3e-3, 12e-3, 3}}}) {
    const auto result = fem::beam::Beam().solve(cilium, path);
    for (const MechanicsStep& step : result.steps) {
      const auto alone = fem::beam::Beam().solve(cilium, {step.load});
      ASSERT_EQ(step.status, Status::converged) << step.message;
      EXPECT_LT(measured(std::string(type(step.load)),
                         (tip(step).position - tip(alone.steps[0]).position).norm() / L),
                1e-11);
    }
  }
}

TEST(BeamCentreline, CarriesCurvatureAndSectionForces) {
  // Oracle: statics. Under a contact force F at height h: n = F e, m = (h − z) F e_y, κ = m/EI
  // below the contact and nothing above, at any S.
  const Cilium cilium = paper_cilium();
  const double F = 4e-3;
  const auto result = fem::beam::Beam().solve(cilium, {ContactLoad{F, h, 0}});
  const Centreline& curve = result.steps[0].deformation->centreline;
  const double contact = *result.steps[0].contact_arclength;
  double error = 0;
  for (int i = 0; i <= 97; ++i) {
    const double S = L * i / 97;
    const CentrelinePoint point = curve.at(S);
    const double EI = (S < 3e-3 ? 0.1e6 : 3e6) * cilium.second_moment();
    const double M = S < contact ? F * (h - point.position[2]) : 0;
    const Vector3 n = (S < contact ? F : 0) * Vector3::UnitX();
    error = std::max({error, (point.forces.force - n).norm() / F,
                      (point.forces.moment - M * Vector3::UnitY()).norm() / (F * h),
                      (point.curvature - M / EI * Vector3::UnitY()).norm() * EI / (F * h)});
  }
  EXPECT_LT(measured("error", error), 1e-6);
  // Interfaces and the contact are breaks.
  const auto has_break = [&](double S) {
    for (const double b : curve.breaks())
      if (std::abs(b - S) < 1e-15) return true;
    return false;
  };
  EXPECT_TRUE(has_break(3e-3) && has_break(contact) && has_break(0) && has_break(L));
}

TEST(BeamCentreline, UndeformedIsStraight) {
  const auto result = fem::beam::Beam().solve(paper_cilium(), {});
  for (const double S : {0.0, 1e-3, 3e-3, 11e-3, L}) {
    const CentrelinePoint point = result.undeformed.centreline.at(S);
    EXPECT_LT((point.position - S * Vector3::UnitZ()).norm(), 1e-17);
    EXPECT_EQ(point.theta(), 0);
    EXPECT_EQ(point.curvature.norm(), 0);
  }
}

TEST(BeamUncertainty, IsNotBelowTheError) {
  // Oracle: the closed form. On coarse meshes the estimate must hold what it says.
  const Cilium cilium = paper_cilium();
  for (const unsigned int degree : {2U, 3U, 4U}) {
    fem::beam::BeamOptions coarse;
    coarse.degree = degree;
    coarse.refinement = 0;
    const auto result = fem::beam::Beam(coarse).solve(cilium, {ContactLoad{4e-3, h, 0}});
    const auto exact = oracle::contact(stretches(cilium, false), 4e-3, h).tip;
    const double error = (tip(result.steps[0]).position - Vector3(exact.x, 0, exact.z)).norm();
    EXPECT_GT(error, 1e-14);
    EXPECT_GE(*result.steps[0].tip_uncertainty, error);
  }
}

TEST(BeamFailure, IsAStatusWithAReasonAndThePathGoesOn) {
  fem::beam::BeamOptions impatient;
  impatient.max_iterations = 4;
  impatient.max_cutbacks = 0;
  const auto result = fem::beam::Beam(impatient).solve(
      paper_cilium(), {DeadLoad{1e-7, 0}, DeadLoad{5, 0}, DeadLoad{2e-7, 0}});
  EXPECT_EQ(result.steps[0].status, Status::converged) << result.steps[0].message;
  EXPECT_EQ(result.steps[1].status, Status::failed);
  EXPECT_FALSE(result.steps[1].deformation);
  EXPECT_NE(result.steps[1].message.find("residuals"), std::string::npos);
  EXPECT_EQ(result.steps[2].status, Status::converged) << result.steps[2].message;
}

TEST(BeamFailure, IncrementsThatAllConvergeButNeverArriveAreGivenUp) {
  // One iteration converges where the increment is below the tolerance: 2⁻⁴⁰ of the load and less.
  fem::beam::BeamOptions tiny;
  tiny.max_iterations = 1;
  tiny.max_cutbacks = 50;
  for (const Load& load :
       LoadPath{DeadLoad{0.3, 0}, ContactLoad{1e-3, h, 0}, ProbeLoad{1e-3, h, 0}}) {
    const MechanicsStep step = fem::beam::Beam(tiny).solve(paper_cilium(), {load}).steps[0];
    EXPECT_EQ(step.status, Status::failed);
    EXPECT_NE(step.message.find("a larger max_iterations (1 now)"), std::string::npos)
        << step.message;
    EXPECT_LE(step.iterations, 3000);
  }
}

TEST(BeamFailure, RefusesOptionsOutOfRange) {
  for (const auto& spoil : std::vector<std::function<void(fem::beam::BeamOptions&)>>{
           [](auto& o) { o.degree = 0; }, [](auto& o) { o.refinement = 40; },
           [](auto& o) { o.tolerance = 0; }, [](auto& o) { o.max_iterations = 0; }}) {
    fem::beam::BeamOptions bad;
    spoil(bad);
    EXPECT_THROW(fem::beam::Beam(bad).solve(paper_cilium(), {}), InputError);
  }
}

}  // namespace

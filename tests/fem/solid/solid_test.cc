// SPDX-License-Identifier: LGPL-2.1-or-later
// The cilium as a solid: extraction, limits, slip-off, input.
#include "fem/solid/solid.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "problem/error.h"
#include "tests/fem/solid/cilia.h"

namespace ciliaval::fem::solid {
namespace {

const MechanicsStep& converged(const MechanicsResult& result, std::size_t i = 0) {
  const MechanicsStep& step = result.steps.at(i);
  EXPECT_EQ(step.status, Status::converged) << step.message;
  if (!step.deformation) throw SolverError(step.message);
  return step;
}

/// One solution that several tests look at.
const MechanicsResult& bent() {
  static const MechanicsResult result =
      Solid(coarse()).solve(stub_and_magnet(), {ContactLoad{2e-3, 16e-3, 0.4}});
  return result;
}

TEST(Solid, CentrelineIsStraightAndItsFrameTheIdentityWhenUndeformed) {
  const Centreline centreline = Solid(coarse()).solve(stub_and_magnet(), {}).undeformed.centreline;
  EXPECT_DOUBLE_EQ(centreline.length(), 20e-3);
  for (const double S : {0.0, 1e-3, 3e-3, 11.3e-3, 20e-3}) {
    const CentrelinePoint point = centreline.at(S);
    EXPECT_NEAR((point.position - S * Vector3::UnitZ()).norm(), 0, 1e-14);
    EXPECT_NEAR(point.rotation.angularDistance(Quaternion::Identity()), 0, 1e-12);
    EXPECT_NEAR(point.curvature.norm(), 0, 1e-9);
    EXPECT_NEAR(point.forces.force.norm(), 0, 1e-15);
  }
}

// Oracle: equilibrium. At every section up to the kernel the force is F along e, and its moment is
// F (h − z) (the kernel is symmetric about h); above the kernel there is none. Sections are tilted
// by up to 12°: the kernel meets extrusion lines within 0.5 mm + R sin 12° of h. Measured: n 3e-13,
// m below 1e-8.
TEST(Solid, SectionForcesBalanceTheLoadInEveryLayer) {
  const MechanicsStep& step = converged(bent());
  const Vector3 e = direction(step.load);
  const double F = 2e-3;
  const double h = 16e-3;
  EXPECT_NEAR(step.applied_force, F, 1e-9 * F);
  const Centreline& centreline = step.deformation->centreline;
  int below = 0;
  int above = 0;
  for (std::size_t i = 0; i < centreline.pieces().size(); ++i)
    for (const double t : {0.0, 0.1, 0.5, 0.9, 1.0}) {
      const double S = (1 - t) * centreline.breaks()[i] + t * centreline.breaks()[i + 1];
      const CentrelinePoint point = centreline.at(S, i);
      const double z = point.position.z();
      const double reach = 0.5e-3 + 1.5e-3 * std::sin(point.theta());
      if (z < h - reach) {
        ++below;
        EXPECT_NEAR((point.forces.force - F * e).norm() / F, 0, 1e-9) << "S " << S;
        const Vector3 moment = F * (h - z) * Vector3::UnitZ().cross(e);
        EXPECT_NEAR((point.forces.moment - moment).norm() / (F * h), 0, 1e-6) << "S " << S;
      } else if (z > h + reach) {
        ++above;
        EXPECT_NEAR(point.forces.force.norm() / F, 0, 1e-9) << "S " << S;
        EXPECT_NEAR(point.forces.moment.norm() / (F * h), 0, 1e-9) << "S " << S;
      }
    }
  EXPECT_GT(below, 50);
  EXPECT_GT(above, 4);
}

// Oracle: statics. The base bears the whole load, of each type; under a dead load n falls linearly,
// a section load is borne below its plane and not above. Newton's tolerance is small, because with
// the default the increment decides while residuals of 3e-6 may be left.
TEST(Solid, BaseBearsTheWholeLoad) {
  const Solid exact({.refinement = 0, .newton_tolerance = 1e-11});
  const Cilium rod{1e-3, {{"rod", 8e-3, 1e6, 0.3, 0}}};
  const LoadPath loads{ContactLoad{1e-4, 6e-3, 0.3}, FlowLoad{0.02, 0.3},
                       SectionLoad{1e-4, 6e-3, 0.3}, DeadLoad{0.02, 0.3},
                       ProbeLoad{2e-3, 6e-3, 0.3}};
  for (const Load& load : loads) {
    const MechanicsResult result = exact.solve(rod, {load});
    const MechanicsStep& step = converged(result);
    const Centreline& centreline = step.deformation->centreline;
    const double F = step.applied_force;
    const auto n = [&](double S) { return centreline.at(S).forces.force; };
    EXPECT_NEAR((n(0) - F * direction(load)).norm() / F, 0, 1e-8) << type(load);
    EXPECT_NEAR(n(8e-3).norm() / F, 0, 1e-8) << type(load);
    if (type(load) == "dead") {
      EXPECT_NEAR((n(3.3e-3) - 0.02 * 4.7e-3 * direction(load)).norm() / F, 0, 1e-8);
    }
    if (type(load) == "section") {
      EXPECT_NEAR((n(5.99e-3) - F * direction(load)).norm() / F, 0, 1e-8);
      EXPECT_NEAR(n(6.01e-3).norm() / F, 0, 1e-8);
    }
  }
}

TEST(Solid, ContactPointIsWhereTheCentrelineCrossesTheHeight) {
  const MechanicsStep& step = converged(bent());
  ASSERT_TRUE(step.contact_arclength);
  const Vector3 r = step.deformation->centreline.at(*step.contact_arclength).position;
  EXPECT_NEAR(r.z(), 16e-3, 1e-12);
}

TEST(Solid, CentrelineIsContinuousAndTurnsWithItsCurvature) {
  const Centreline& centreline = converged(bent()).deformation->centreline;
  Vector3 turned = Vector3::Zero();
  for (std::size_t i = 0; i < centreline.pieces().size(); ++i) {
    const double a = centreline.breaks()[i];
    const double b = centreline.breaks()[i + 1];
    if (i > 0) {
      EXPECT_EQ((centreline.at(a, i).position - centreline.at(a, i - 1).position).norm(), 0);
    }
    const QuadratureRule rule = gauss_legendre(4, a, b);
    for (std::size_t q = 0; q < rule.nodes.size(); ++q)
      turned += rule.weights[q] * centreline.at(rule.nodes[q], i).curvature;
  }
  // Plane bending: the angle is the integral of the curvature.
  const double theta = centreline.at(centreline.length()).theta() - centreline.at(0).theta();
  EXPECT_NEAR(turned.norm(), theta, 2e-3 * theta);
}

// Oracle: det of the patch's own polynomial derivative.
TEST(Solid, BodyStoresTheJacobianOfItsPatches) {
  const SolidBody& body = *converged(bent()).deformation->body;
  const std::vector<double>& nodes = body.nodes.nodes();
  const std::size_t n = nodes.size();
  double volume_change = 0;
  for (const SolidCell& cell : body.cells) {
    ASSERT_EQ(cell.jacobian.size(), n * n * n);
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t node = i + n * (n - 1 - i) + n * n * i;
      const SolidPoint point =
          evaluate(body.nodes, cell, Vector3(nodes[i], nodes[n - 1 - i], nodes[i]));
      EXPECT_NEAR(point.deformation_gradient.determinant(), cell.jacobian[node], 1e-10);
      EXPECT_NEAR((point.current - cell.current[node]).norm(), 0, 1e-15);
      volume_change = std::max(volume_change, std::abs(cell.jacobian[node] - 1));
      EXPECT_NEAR((cell.cauchy_stress[node] - cell.cauchy_stress[node].transpose()).norm(), 0,
                  1e-9 * cell.cauchy_stress[node].norm());
    }
    EXPECT_EQ(cell.magnetization.z(), cell.segment == 1 ? 75e3 : 0);
  }
  EXPECT_GT(volume_change, 1e-6);  // a copied 1 would not do
}

// Oracle: Gauss's law; the charge of each end of the magnet is ±MπR², and the area vector of each
// end face points out of the magnet along ±Z. The mesh has the area πR² exactly.
TEST(Solid, ChargedFacesCarryTheMagnetsEndCharges) {
  const SolidBody& body = *converged(bent()).deformation->body;
  double north = 0;
  double south = 0;
  const QuadratureRule rule = gauss_legendre(4, 0, 1);
  for (const ChargedFace& face : body.charged_faces) {
    double charge = 0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j)
        charge += rule.weights[i] * rule.weights[j] *
                  face.magnetization_jump.dot(
                      evaluate(body.nodes, face, rule.nodes[i], rule.nodes[j]).reference_area);
    (face.reference.front().z() > 10e-3 ? north : south) += charge;
  }
  const double exact = 75e3 * stub_and_magnet().area();
  EXPECT_NEAR(north / exact, 1, 1e-9);
  EXPECT_NEAR(south / exact, -1, 1e-9);
  EXPECT_NEAR((north + south) / exact, 0, 1e-10);
}

// A magnet that stands on the base has its south pole there, with a normal along −Z.
TEST(Solid, ChargedFacesOfAMagnetOnTheBasePointDownThere) {
  const Cilium magnet{1e-3, {{"magnet", 3e-3, 1e6, 0.45, 1e4}}};
  const SolidBody body = *Solid(coarse()).solve(magnet, {}).undeformed.body;
  bool found = false;
  for (const ChargedFace& face : body.charged_faces) {
    const FacePoint point = evaluate(body.nodes, face, 0.5, 0.5);
    const bool base = face.reference.front().z() < 1e-6;
    found = found || base;
    EXPECT_LT(point.reference_area.z() * (base ? 1 : -1), 0);
    EXPECT_EQ(face.magnetization_jump.z(), 1e4);
  }
  EXPECT_TRUE(found);
}

// Oracle: isotropy. The same load in another direction gives the turned result; the mesh turns with
// it, so that only rounding is left, in the body as in the centreline.
TEST(Solid, TurnsWithTheAzimuth) {
  const MechanicsResult straight =
      Solid(coarse()).solve(stub_and_magnet(), {ContactLoad{2e-3, 16e-3, 0}});
  const Deformation& plane = *converged(straight).deformation;
  const Deformation& bent_to = *converged(bent()).deformation;
  const Eigen::AngleAxisd turn(0.4, Vector3::UnitZ());
  for (const double S : {1e-3, 3e-3, 15e-3, 20e-3}) {
    const CentrelinePoint a = plane.centreline.at(S);
    const CentrelinePoint b = bent_to.centreline.at(S);
    EXPECT_NEAR((turn * a.position - b.position).norm(), 0, 1e-12);
    EXPECT_NEAR((turn * a.normal() - b.normal()).norm(), 0, 1e-10);
    EXPECT_NEAR((turn * a.curvature - b.curvature).norm(), 0, 1e-9 * a.curvature.norm());
    EXPECT_NEAR((turn * a.forces.moment - b.forces.moment).norm(), 0, 1e-14);
  }
  ASSERT_EQ(plane.body->cells.size(), bent_to.body->cells.size());
  for (std::size_t i = 0; i < plane.body->cells.size(); ++i) {
    const SolidCell& a = plane.body->cells[i];
    const SolidCell& b = bent_to.body->cells[i];
    EXPECT_NEAR((turn * a.reference[5] - b.reference[5]).norm(), 0, 1e-12);
    EXPECT_NEAR((turn * a.current[5] - b.current[5]).norm(), 0, 1e-12);
    const Matrix3 stress = turn * a.cauchy_stress[5] * turn.inverse();
    EXPECT_NEAR((stress - b.cauchy_stress[5]).norm(), 0, 1e-7 * stress.norm());
  }
}

// Oracle: the whole cylinder, solved without the symmetry; its mesh is the half's with its image.
// Every load type; a section force and moment of the half are those of the whole.
TEST(Solid, HalfAnswersAsTheWholeCylinder) {
  const Cilium cilium{3e-3, {{"base", 3e-3, 1e5, 0.49, 0}, {"magnet", 7e-3, 3e6, 0.49, 75e3}}};
  const Solid whole({.refinement = 0, .symmetry = false});
  const LoadPath loads{ContactLoad{2e-3, 8e-3, 0.3}, FlowLoad{0.3, 0.3},
                       SectionLoad{2e-3, 8e-3, 0.3}, DeadLoad{0.3, 0.3},
                       ProbeLoad{1e-3, 8e-3, 0.3}};
  for (const Load& load : loads) {
    const MechanicsResult halves = Solid(coarse()).solve(cilium, {load});
    const MechanicsResult wholes = whole.solve(cilium, {load});
    const MechanicsStep& half = converged(halves);
    const MechanicsStep& full = converged(wholes);
    EXPECT_LT(half.unknowns, 0.6 * static_cast<double>(full.unknowns));
    EXPECT_NEAR(half.applied_force / full.applied_force, 1, 1e-9) << type(load);
    const double w = tip(full).head<2>().norm();
    for (const double S : {0.7e-3, 3e-3, 7.9e-3, 10e-3}) {
      const CentrelinePoint a = half.deformation->centreline.at(S);
      const CentrelinePoint b = full.deformation->centreline.at(S);
      EXPECT_NEAR((a.position - b.position).norm() / w, 0, 1e-8) << type(load) << S;
      EXPECT_NEAR((a.forces.force - b.forces.force).norm(), 0, 1e-8 * full.applied_force);
      EXPECT_NEAR((a.forces.moment - b.forces.moment).norm(), 0, 1e-8 * full.applied_force * 8e-3);
      EXPECT_NEAR(a.rotation.angularDistance(b.rotation), 0, 1e-7);
    }
  }
}

// Oracle: the whole cylinder's patches, found by their reference nodes: the image of a half has the
// same displacement and stress there.
TEST(Solid, MirrorImageCompletesTheBody) {
  const Cilium cilium{3e-3, {{"magnet", 5e-3, 1e5, 0.49, 75e3}}};
  const LoadPath load{SectionLoad{1e-3, 5e-3, 0}};
  const MechanicsResult halves = Solid(coarse()).solve(cilium, load);
  const MechanicsResult wholes = Solid({.refinement = 0, .symmetry = false}).solve(cilium, load);
  const SolidBody& half = *converged(halves).deformation->body;
  const SolidBody& full = *converged(wholes).deformation->body;
  ASSERT_EQ(half.cells.size(), full.cells.size());
  ASSERT_EQ(half.charged_faces.size(), full.charged_faces.size());
  const auto middle = [](const SolidCell& cell) { return cell.reference[13]; };
  int below = 0;
  for (const SolidCell& a : half.cells) {
    const auto b = std::min_element(
        full.cells.begin(), full.cells.end(), [&](const SolidCell& p, const SolidCell& q) {
          return (middle(p) - middle(a)).norm() < (middle(q) - middle(a)).norm();
        });
    EXPECT_NEAR((middle(a) - middle(*b)).norm(), 0, 1e-12);
    EXPECT_NEAR((a.current[13] - b->current[13]).norm(), 0, 1e-11);
    EXPECT_NEAR((a.cauchy_stress[13] - b->cauchy_stress[13]).norm(), 0,
                1e-6 * b->cauchy_stress[13].norm());
    EXPECT_GT(evaluate(half.nodes, a, Vector3::Constant(0.3)).reference_gradient.determinant(), 0);
    below += middle(a).y() < 0;
  }
  EXPECT_EQ(2 * static_cast<std::size_t>(below), half.cells.size());
}

// Oracle: Timoshenko's cantilever under a dead end force, w = FL³/(3EI) + FL/(kGA) with
// k = 6(1+ν)/(7+6ν), at L/d = 20 and a rotation of 4e-5: no locking at ν = 0.4999. The clamped end
// (no warping, no lateral contraction) stiffens a 3D rod by about 0.2 d/L at ν = 0.3, more at 0.5.
TEST(Solid, BendsAsTimoshenkosCantileverForSmallLoads) {
  const double F = 1e-8;
  for (const double nu : {0.3, 0.4999}) {
    const Cilium rod{1e-3, {{"rod", 20e-3, 1e6, nu, 0}}};
    const double L = rod.length();
    const double G = rod.segments[0].shear_modulus();
    const double k = 6 * (1 + nu) / (7 + 6 * nu);
    const double w = F * L * L * L / (3 * 1e6 * rod.second_moment()) + F * L / (k * G * rod.area());
    const MechanicsResult result = Solid(coarse()).solve(rod, {SectionLoad{F, L, 0}});
    EXPECT_NEAR(tip(converged(result)).x() / w, 1, nu < 0.4 ? 0.01 : 0.015) << "nu " << nu;
    EXPECT_LE(result.steps[0].iterations, 6);
  }
}

// Oracle: statics. Small loads of every type: the tip of the straight rod moves as
// Euler–Bernoulli's w = F h²(3L − h)/(6EI) and w = qL⁴/(8EI), and the probe takes F = 3EI δ/h³.
TEST(Solid, AllLoadTypesHaveTheirBeamLimit) {
  const Cilium rod{1e-3, {{"rod", 20e-3, 1e6, 0.3, 0}}};
  const double EI = 1e6 * rod.second_moment();
  const double L = rod.length();
  const double h = 15e-3;
  const double F = 1e-8;
  const double q = F / L;
  const double at_h = F * h * h * (3 * L - h) / (6 * EI);
  const double spread = q * std::pow(L, 4) / (8 * EI);
  const auto w = [&](const Load& load) {
    return tip(converged(Solid(coarse()).solve(rod, {load}))).x();
  };
  EXPECT_NEAR(w(ContactLoad{F, h, 0}) / at_h, 1, 0.015);
  EXPECT_NEAR(w(SectionLoad{F, h, 0}) / at_h, 1, 0.015);
  EXPECT_NEAR(w(FlowLoad{q, 0}) / spread, 1, 0.015);
  EXPECT_NEAR(w(DeadLoad{q, 0}) / spread, 1, 0.015);
  const double delta = 1e-6;
  const MechanicsResult probe = Solid(coarse()).solve(rod, {ProbeLoad{delta, h, 0}});
  EXPECT_NEAR(converged(probe).applied_force / (3 * EI * delta / (h * h * h)), 1, 0.015);
}

/// Tip of the paper's cilium under a force on its end face, by its material.
Vector3 tip_of(SolidOptions options, double force) {
  options.refinement = 0;
  const Load load = SectionLoad{force, 20e-3, 0};
  return tip(converged(Solid(options).solve(stub_and_magnet(), {load})));
}
constexpr auto mooney_rivlin = SolidOptions::Material::mooney_rivlin;
constexpr auto yeoh = SolidOptions::Material::yeoh;

// Oracle: linear elasticity, in which E and ν alone count. The tips differ by the square of the
// load: measured 2e-10 and 1.2e-9 (a hundredfold at ten times the load).
TEST(Solid, MaterialsHaveTheSameStiffnessAtASmallLoad) {
  const double F = 1e-6;
  const double w = tip_of({}, F).x();
  EXPECT_NEAR(tip_of({.material = mooney_rivlin}, F).x() / w, 1, 1e-8);
  EXPECT_NEAR(tip_of({.material = yeoh}, F).x() / w, 1, 1e-8);
}

// Oracle: the energies. Yeoh's with C₂₀ < 0 is below neo-Hooke's wherever the strain is moderate
// (Ī₁ − 3 < 10), so that the cilium bends farther, measured 0.25 %; Mooney–Rivlin's 0.04 %. Without
// C₀₁, C₂₀ and C₃₀ the others are neo-Hooke's.
TEST(Solid, MaterialsDifferAtALargeLoad) {
  const double F = 1.5e-3;
  const double w = tip_of({}, F).x();
  EXPECT_GT(tip_of({.material = yeoh}, F).x() / w, 1.0012);
  EXPECT_GT(std::abs(tip_of({.material = mooney_rivlin}, F).x() / w - 1), 2e-4);
  SolidOptions plain{.material = mooney_rivlin};
  plain.mooney_ratio = 0;
  EXPECT_NEAR(tip_of(plain, F).x() / w, 1, 1e-9);
  plain = {.material = yeoh};
  plain.yeoh_ratios = {0, 0};
  EXPECT_NEAR(tip_of(plain, F).x() / w, 1, 1e-9);
}

// Past the largest contact force the step is marked, the bracket's lower end is a force that the
// model does bear, and a smaller force after it is solved.
TEST(Solid, FindsTheSlipOffForceAndGoesOn) {
  const LoadPath path{ContactLoad{4e-3, 16e-3, 0}, ContactLoad{8e-3, 16e-3, 0},
                      ContactLoad{9e-3, 16e-3, 0}, ContactLoad{3e-3, 16e-3, 0}};
  const MechanicsResult result = Solid(coarse()).solve(stub_and_magnet(), path);
  converged(result, 0);
  EXPECT_EQ(result.steps[1].status, Status::slipped_off) << result.steps[1].message;
  EXPECT_EQ(result.steps[2].status, Status::slipped_off) << result.steps[2].message;
  EXPECT_FALSE(result.steps[1].deformation);
  ASSERT_TRUE(result.steps[1].slip_off_force);
  const double slip_off = *result.steps[1].slip_off_force;
  EXPECT_EQ(slip_off, result.steps[2].slip_off_force);
  EXPECT_NEAR(converged(result, 3).applied_force, 3e-3, 3e-9);

  // Just below it all of the force is applied, 1.5 % above it is not.
  const MechanicsResult check = Solid(coarse()).solve(
      stub_and_magnet(),
      {ContactLoad{slip_off, 16e-3, 0}, ContactLoad{1.015 * slip_off, 16e-3, 0}});
  EXPECT_NEAR(converged(check, 0).applied_force / slip_off, 1, 1e-6);
  EXPECT_EQ(check.steps[1].status, Status::slipped_off);
}

// Oracle: each load alone. Height and azimuth change along the path: the slip-off is that of the
// target's own place, whatever came before.
TEST(Solid, PlaceOfAnEarlierLoadDoesNotMatter) {
  const LoadPath path{ContactLoad{1e-3, 16e-3, 0}, ContactLoad{8e-3, 15e-3, 0},
                      ContactLoad{5e-3, 16e-3, 0.5}, ContactLoad{8e-3, 16e-3, 0.5}};
  const MechanicsResult result = Solid(coarse()).solve(stub_and_magnet(), path);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const MechanicsResult alone = Solid(coarse()).solve(stub_and_magnet(), {path[i]});
    EXPECT_EQ(result.steps[i].status, alone.steps[0].status) << i;
    if (alone.steps[0].deformation) {
      EXPECT_NEAR((tip(converged(result, i)) - tip(converged(alone))).norm(), 0, 1e-10) << i;
      continue;
    }
    ASSERT_TRUE(result.steps[i].slip_off_force && alone.steps[0].slip_off_force) << i;
    // Both are lower ends of brackets of 1 % around the same force.
    EXPECT_NEAR(*result.steps[i].slip_off_force / *alone.steps[0].slip_off_force, 1, 0.01) << i;
    EXPECT_NE(result.steps[i].message.find("tip face"), std::string::npos);
  }
  EXPECT_EQ(result.steps[1].status, Status::slipped_off);
  EXPECT_EQ(result.steps[2].status, Status::converged);
  EXPECT_EQ(result.steps[3].status, Status::slipped_off);
}

// Oracle: the slip-off force found from 8 mN, 5.34 mN (FindsTheSlipOffForceAndGoesOn). 1 N is 190
// times that.
TEST(Solid, SlipsOffUnderAHugeForceToo) {
  const MechanicsResult result =
      Solid(coarse()).solve(stub_and_magnet(), {ContactLoad{1, 16e-3, 0}});
  EXPECT_EQ(result.steps[0].status, Status::slipped_off) << result.steps[0].message;
  ASSERT_TRUE(result.steps[0].slip_off_force);
  EXPECT_NEAR(*result.steps[0].slip_off_force / 5.34e-3, 1, 0.011);
}

// One iteration is not enough: the step fails and says so, and the next load is tried again.
TEST(Solid, SaysWhyAStepFailed) {
  const Solid impatient({.refinement = 0, .max_iterations = 1, .max_cutbacks = 1});
  const MechanicsResult result = impatient.solve(stub_and_magnet(), {ContactLoad{4e-3, 16e-3, 0}});
  EXPECT_EQ(result.steps[0].status, Status::failed);
  EXPECT_FALSE(result.steps[0].deformation);
  EXPECT_NE(result.steps[0].message.find("step 1/1"), std::string::npos);
  EXPECT_NE(result.steps[0].message.find("residual"), std::string::npos);
  EXPECT_NE(result.steps[0].message.find("last load that converged"), std::string::npos);
}

// Loading and unloading: back at zero force the solid is straight again.
TEST(Solid, IsStraightAgainWhenUnloaded) {
  const MechanicsResult result = Solid(coarse()).solve(
      stub_and_magnet(), {ContactLoad{1e-3, 16e-3, 0}, ContactLoad{0, 16e-3, 0}});
  EXPECT_GT(tip(converged(result, 0)).x(), 1e-3);
  EXPECT_NEAR((tip(converged(result, 1)) - 20e-3 * Vector3::UnitZ()).norm(), 0, 1e-12);
}

// Oracle: the same loads one by one, each from the beam's guess.
TEST(Solid, LaterLoadsGoOnFromTheLastTwoAndEndAsTheyWouldAlone) {
  const LoadPath path{ContactLoad{1e-3, 16e-3, 0}, ContactLoad{2e-3, 16e-3, 0},
                      ContactLoad{3e-3, 16e-3, 0}};
  const MechanicsResult together = Solid().solve(stub_and_magnet(), path);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const MechanicsResult alone = Solid().solve(stub_and_magnet(), {path[i]});
    EXPECT_LT((tip(converged(together, i)) - tip(converged(alone))).norm(), 1e-10 * 20e-3) << i;
    EXPECT_LE(together.steps[i].iterations, alone.steps[0].iterations) << i;
  }
  EXPECT_LE(together.steps[1].iterations, 2);
}

TEST(Solid, ReportsItsProgress) {
  std::vector<std::string> lines;
  std::vector<Status> ended;
  Solid(coarse()).solve({1e-3, {{"rod", 5e-3, 1e6, 0.3, 0}}}, {DeadLoad{1e-3, 0}},
                        [&](const ProgressReport& report) {
                          lines.push_back(report.text);
                          if (report.step != nullptr) ended.push_back(report.step->status);
                        });
  ASSERT_GE(lines.size(), 2U);
  EXPECT_NE(lines.back().find("step 1/1"), std::string::npos);
  EXPECT_EQ(ended, std::vector{Status::converged});
}

TEST(Solid, RejectsBadInput) {
  EXPECT_THROW(Solid({.refinement = 4}), InputError);
  EXPECT_THROW(Solid({.kernel_width = 0}), InputError);
  EXPECT_THROW(Solid({.newton_tolerance = std::numeric_limits<double>::quiet_NaN()}), InputError);
  EXPECT_THROW(Solid({.max_iterations = 0}), InputError);
  EXPECT_THROW(Solid({.mooney_ratio = -0.1}), InputError);
  EXPECT_THROW(Solid({.yeoh_ratios = {-0.1, 0.005}}), InputError);
  EXPECT_THROW(Solid({.yeoh_ratios = {std::numeric_limits<double>::infinity(), 0}}), InputError);
  const Cilium cilium = stub_and_magnet();
  const auto rejects = [&](const LoadPath& path) {
    EXPECT_THROW(Solid(coarse()).solve(cilium, path), InputError);
  };
  rejects({ContactLoad{1e-3, 19.8e-3, 0}});
  rejects({ContactLoad{1e-3, 0.3e-3, 0}});
  rejects({ContactLoad{1e-3, 19.5e-3, 0}});  // h + w = L
  rejects({ContactLoad{1e-3, 0.5e-3, 0}});   // h = w
  rejects({ContactLoad{-1e-3, 16e-3, 0}});
  rejects({ProbeLoad{1e-3, 19.5e-3, 0}});
  rejects({ProbeLoad{-1e-3, 16e-3, 0}});
  rejects({ProbeLoad{1e-3, 16e-3, 0}, ContactLoad{1e-3, 16e-3, 0}});
  rejects({ContactLoad{1e-3, 16e-3, 0}, FlowLoad{1, 0}});
  rejects({SectionLoad{1e-3, 21e-3, 0}});
  EXPECT_THROW(Solid(coarse()).solve({3e-3, {}}, {}), InputError);
}

/// The error of the tip of `rough` against `fine`, and the estimate of it.
std::pair<double, double> error_and_estimate(const MechanicsResult& rough,
                                             const MechanicsResult& fine) {
  const MechanicsStep& step = converged(rough);
  EXPECT_TRUE(step.tip_uncertainty);
  return {(tip(step) - tip(converged(fine))).norm(), step.tip_uncertainty.value_or(0)};
}

// Nearly incompressible, on the thin layers of the default mesh, rounding keeps the residual above
// 1e-6 of the load: the increment tells that the solution is there.
TEST(Solid, ConvergesNearlyIncompressibleOnTheDefaultMesh) {
  Cilium cilium = stub_and_magnet();
  for (Segment& segment : cilium.segments) segment.poisson_ratio = 0.4999;
  const MechanicsResult result = Solid().solve(cilium, {ContactLoad{2e-3, 16e-3, 0}});
  converged(result);
  EXPECT_LE(result.steps[0].iterations, 8);
}

// Oracle: the default mesh, whose error is a tenth of the coarse one's. Measured ratios of estimate
// and error: 5.2 for all three, as the paper's stub converges faster than random cilia
// (tests/coverage: 2.3 in the median).
TEST(Solid, EstimatesTheErrorOfItsTip) {
  for (const Load& load :
       LoadPath{ContactLoad{2e-3, 16e-3, 0}, FlowLoad{0.1, 0}, SectionLoad{1e-3, 20e-3, 0}}) {
    const auto [error, estimate] = error_and_estimate(
        Solid(coarse()).solve(stub_and_magnet(), {load}), Solid().solve(stub_and_magnet(), {load}));
    EXPECT_GT(estimate / error, 1) << type(load);
    EXPECT_LT(estimate / error, 6) << type(load);
  }
}

// Oracle: the finest mesh. The claims of docs/evidence/solid.md: the default mesh is within 0.1 %,
// its error inside its interval, and that below 0.2 %. Measured: 0.016 % and 0.164 %.
TEST(SolidSlow, DefaultMeshIsWithinATenthOfAPercentAndKnowsIt) {
  const LoadPath path{ContactLoad{2e-3, 16e-3, 0}};
  const MechanicsResult finest = Solid({.refinement = 3}).solve(stub_and_magnet(), path);
  const MechanicsResult standard = Solid().solve(stub_and_magnet(), path);
  const auto [error, estimate] = error_and_estimate(standard, finest);
  EXPECT_LT(error / tip(converged(finest)).x(), 1e-3);
  EXPECT_LT(converged(standard).unknowns, 60000);
  EXPECT_LT(error, estimate);
  EXPECT_LT(estimate / tip(converged(finest)).x(), 2e-3);
}

// Oracle: the fine mesh, at ν = 0.3, 0.49 and nearly incompressible: no locking. Measured at
// ν = 0.49 (tip deflection): the default mesh is below the fine one by 0.010 %, the coarse one by
// 0.14 %.
TEST(SolidSlow, TipOfTheDefaultMeshAgreesWithTheFineMesh) {
  for (const double nu : {0.3, 0.49, 0.4999}) {
    Cilium cilium = stub_and_magnet();
    for (Segment& segment : cilium.segments) segment.poisson_ratio = nu;
    const LoadPath path{ContactLoad{2e-3, 16e-3, 0}};
    const Vector3 fine = tip(converged(Solid({.refinement = 2}).solve(cilium, path)));
    const Vector3 standard = tip(converged(Solid({.refinement = 1}).solve(cilium, path)));
    const Vector3 crude = tip(converged(Solid(coarse()).solve(cilium, path)));
    EXPECT_NEAR(standard.x() / fine.x(), 1, 2e-3) << "nu " << nu;
    EXPECT_NEAR(crude.x() / fine.x(), 1, 5e-3) << "nu " << nu;
  }
}

}  // namespace
}  // namespace ciliaval::fem::solid

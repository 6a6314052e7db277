// SPDX-License-Identifier: LGPL-2.1-or-later
// fem::beam::Beam under displacement control of the contact point.
#include <gtest/gtest.h>

#include <cmath>

#include "beams.h"
#include "fem/beam/beam.h"
#include "fem/beam/section.h"
#include "oracles.h"
#include "problem/lagrange.h"

namespace {

using namespace ciliaval;
using beams::measured;

using beams::equal_segments;
using beams::h;
using beams::L;
using beams::paper_cilium;
using beams::stretches;

fem::beam::Beam beam(bool shear_rigid) {
  fem::beam::BeamOptions result;
  result.shear_rigid = shear_rigid;
  return fem::beam::Beam(result);
}

MechanicsStep solved(const fem::beam::Beam& model, const Cilium& cilium, const Load& load) {
  MechanicsStep step = model.solve(cilium, {load}).steps.at(0);
  EXPECT_EQ(step.status, Status::converged) << step.message;
  return step;
}

/// Position of the material point in contact.
Vector3 contact_point(const MechanicsStep& step) {
  return step.deformation->centreline.at(*step.contact_arclength).position;
}

/// δ of a contact force: the cilium is straight and unstrained above the contact.
double displacement(const oracle::Contact& contact) {
  return contact.tip.x - (L - contact.arclength) * std::sin(contact.tip.theta);
}

TEST(BeamProbe, FindsTheForceOfTheContactElastica) {
  // Oracle: closed forms by quadrature (oracles.h), shear-rigid and not, which give δ for F; a path
  // up and down, and each step alone.
  const Cilium cilium = paper_cilium();
  for (const bool shear_rigid : {true, false}) {
    LoadPath path;
    std::vector<oracle::Contact> exact;
    const std::vector<double> forces{1e-3, 4e-3, 5.5e-3, 2e-3};
    for (const double F : forces) {
      exact.push_back(oracle::contact(stretches(cilium, shear_rigid), F, h));
      path.push_back(ProbeLoad{displacement(exact.back()), h, 0});
    }
    const auto result = beam(shear_rigid).solve(cilium, path);
    for (std::size_t i = 0; i < path.size(); ++i) {
      const MechanicsStep& step = result.steps[i];
      ASSERT_EQ(step.status, Status::converged) << step.message;
      const MechanicsStep alone = solved(beam(shear_rigid), cilium, path[i]);
      for (const MechanicsStep* s : {&step, &alone}) {
        EXPECT_LT(measured("force", std::abs(s->applied_force / forces[i] - 1)), 1e-11);
        EXPECT_LT(measured("arclength", std::abs(*s->contact_arclength - exact[i].arclength) / L),
                  1e-12);
        const Vector3 gap = contact_point(*s) - Vector3(magnitude(path[i]), 0, h);
        EXPECT_LT(measured("point", gap.norm() / L), 1e-14);
      }
    }
  }
}

TEST(BeamProbe, GivesTheContactForceBack) {
  // Oracle: uniqueness. The contact solved for F, its point pushed to where it was. From a force
  // that moves the point by 1e-5 L; a low contact that slides from the base into the magnet; an
  // azimuth.
  const Cilium cilium = paper_cilium();
  for (const double phi : {0.0, 2.1})
    for (const ContactLoad& contact :
         {ContactLoad{1e-6, h, phi}, ContactLoad{3e-3, h, phi}, ContactLoad{5.8e-3, h, phi},
          ContactLoad{60e-3, 2e-3, phi}, ContactLoad{150e-3, 2e-3, phi}}) {
      const MechanicsStep given = solved(fem::beam::Beam(), cilium, contact);
      const Vector3 point = contact_point(given);
      const ProbeLoad probe{point.dot(direction(contact)), contact.height, phi};
      const MechanicsStep step = solved(fem::beam::Beam(), cilium, probe);
      EXPECT_LT(measured("force", std::abs(step.applied_force / contact.force - 1)), 1e-9)
          << contact.force;
      EXPECT_LT(measured("tip", (step.deformation->centreline.at(L).position -
                                 given.deformation->centreline.at(L).position)
                                        .norm() /
                                    L),
                1e-11);
    }
}

TEST(BeamProbe, SlipsOffWhereTheElasticaDoes) {
  // Oracle: root of the closed form's arc length, and the tip's deflection there.
  const Cilium cilium = paper_cilium();
  for (const bool shear_rigid : {true, false}) {
    const double force = oracle::slip_off_force(stretches(cilium, shear_rigid), h);
    const double limit =
        displacement(oracle::contact(stretches(cilium, shear_rigid), force * (1 - 1e-15), h));
    const auto result =
        beam(shear_rigid)
            .solve(cilium, {ProbeLoad{4e-3, h, 0}, ProbeLoad{limit * (1 - 1e-9), h, 0},
                            ProbeLoad{limit * (1 + 1e-9), h, 0}, ProbeLoad{1, h, 0},
                            ProbeLoad{2e-3, h, 0}});
    for (const std::size_t i : {0, 1, 4})
      EXPECT_EQ(result.steps[i].status, Status::converged) << i << ' ' << result.steps[i].message;
    for (const std::size_t i : {2, 3}) {
      const MechanicsStep& step = result.steps[i];
      ASSERT_EQ(step.status, Status::slipped_off) << step.message;
      EXPECT_LT(measured("force", std::abs(*step.slip_off_force / force - 1)), 1e-11);
      EXPECT_LT(measured("displacement", std::abs(*step.slip_off_displacement / limit - 1)), 1e-11);
      EXPECT_FALSE(step.deformation);
      EXPECT_NE(step.message.find("no equilibrium"), std::string::npos);
    }
    EXPECT_NEAR(*result.steps[1].contact_arclength / L, 1, 1e-8);
  }
}

TEST(BeamProbe, UnloadedStandsStraight) {
  const MechanicsStep step = solved(fem::beam::Beam(), paper_cilium(), ProbeLoad{0, h, 0});
  EXPECT_EQ(step.applied_force, 0);
  EXPECT_NEAR(*step.contact_arclength, h, 1e-17);
}

TEST(BeamProbe, CutsInOneMaterialDoNotMatter) {
  // Oracle: the same rod in one piece; heights on, a nanometre beside and between interfaces, a δ
  // that slides the contact over one or two of them. Measured: 2e-11 at h, 1e-7 at 4 mm, the
  // discretisation of the one piece.
  for (const double height : {h, h - 1e-9, 4e-3}) {
    const LoadPath path{ProbeLoad{1e-5, height, 0}, ProbeLoad{8e-3, height, 0}};
    const auto whole = beam(false).solve(equal_segments(1), path);
    const auto cut = beam(false).solve(equal_segments(5), path);
    for (std::size_t i = 0; i < path.size(); ++i) {
      ASSERT_EQ(whole.steps[i].status, Status::converged) << whole.steps[i].message;
      ASSERT_EQ(cut.steps[i].status, Status::converged) << cut.steps[i].message;
      const double ratio = whole.steps[i].applied_force / cut.steps[i].applied_force;
      EXPECT_LT(measured("force", std::abs(ratio - 1)), height > 5e-3 ? 1e-10 : 1e-6) << height;
    }
  }
}

/// δ/h of one material, without shear, whose contact has cos θ = c: ∫ tan θ dz with
/// sin θ = s (1 − u²), u = (h − z)/h, s² + c² = 1; u = c sinh x makes it smooth as c → 0.
double deflection_over_height(double c) {
  const double s = std::sqrt((1 - c) * (1 + c));
  const QuadratureRule rule = gauss_legendre(60, 0, std::asinh(1 / c));
  double sum = 0;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double u = c * std::sinh(rule.nodes[i]);
    const double sine = s * (1 - u * u);
    const double one_less_sine = c * c / (1 + s) + s * u * u;
    sum += rule.weights[i] * c * std::cosh(rule.nodes[i]) * sine /
           std::sqrt(one_less_sine * (1 + sine));
  }
  return sum;
}

TEST(BeamProbe, GoesWhereTheForceNoLongerTellsTheDisplacement) {
  // Oracle: the paper's closed form of one material, F = 2 EI sin θ/h², and δ for the angle that
  // the tip has. At δ = 6 h, 0.014° from level, the last bit of F moves δ by 4e-9 h.
  fem::beam::BeamOptions fine;
  fine.shear_rigid = true;
  fine.refinement = 4;
  const Cilium cilium = equal_segments(1);
  const double low = 2e-3;
  const double limit = 2 * 1e6 * cilium.second_moment() / (low * low);
  const auto result =
      fem::beam::Beam(fine).solve(cilium, {ProbeLoad{6e-3, low, 0}, ProbeLoad{12e-3, low, 0}});
  for (const MechanicsStep& step : result.steps) {
    ASSERT_EQ(step.status, Status::converged) << step.message;
    const Vector3 tangent = step.deformation->centreline.at(L).normal();
    EXPECT_LT(measured("force", std::abs(step.applied_force / (limit * tangent[0]) - 1)), 1e-11);
    const double displacement = low * deflection_over_height(tangent[2]);
    EXPECT_LT(measured("displacement", std::abs(displacement / magnitude(step.load) - 1)), 1e-9);
  }
}

}  // namespace

// SPDX-License-Identifier: LGPL-2.1-or-later
// The elastica under displacement control of the contact point.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "cases.h"

namespace ciliaval::analytic {
namespace {

/// w of the contact point of a contact or probe step, m.
double contact_deflection(const MechanicsStep& step) {
  return planar_point(step, *step.contact_arclength).w;
}

/// The contact force that turns a uniform cilium to θ_c at its contact, by Legendre's integrals in
/// 50 digits (cases.h): F = 2 EI sin θ_c/h², δ, S_c.
struct UniformProbe {
  double force;
  double displacement;
  double arclength;
};
UniformProbe uniform_probe(double height, const Real& cosine) {
  const Real stiffness = bending_stiffness(uniform_cilium());
  const Real sine = sqrt(1 - cosine * cosine);
  const Real force = 2 * stiffness * sine / (Real(height) * height);
  const auto exact = PointForceElastica::with_end_angle(sqrt(force / stiffness), sine);
  return {static_cast<double>(force), static_cast<double>(exact.deflection()),
          static_cast<double>(exact.length())};
}

// Oracle: Legendre's integrals in 50 digits. From 0.6° to 89.9994°, where the contact force is told
// from its limit 2 EI/h² by its last five digits only.
TEST(ElasticaProbe, OnOneMaterialFollowsLegendresIntegrals) {
  const Cilium cilium = uniform_cilium();
  const double length = cilium.length();
  const double height = 2e-3;
  for (const double cosine : {0.99995, 0.9, 0.5, 0.1, 0.05, 0.03, 1e-2, 1e-3, 1e-4, 1e-5}) {
    const UniformProbe exact = uniform_probe(height, cosine);
    ASSERT_LT(exact.arclength, length);
    const MechanicsStep step = solve(cilium, ProbeLoad{exact.displacement, height, 0.3});
    EXPECT_NEAR(step.applied_force, exact.force, 1e-13 * exact.force) << cosine;
    EXPECT_NEAR(*step.contact_arclength, exact.arclength, 2e-12 * exact.arclength) << cosine;
    EXPECT_NEAR(contact_deflection(step), exact.displacement, 1e-12 * exact.displacement) << cosine;
    EXPECT_NEAR(planar_point(step, *step.contact_arclength).z, height, 1e-13 * length) << cosine;
  }
}

// Oracle: linear theory, δ = F h³/(3EI); the nonlinear part is (δ/h)².
TEST(ElasticaProbe, SmallDisplacementsTakeTheForceOfLinearTheory) {
  const Cilium cilium = uniform_cilium();
  const double height = 16e-3;
  for (const double relative : {1e-7, 1e-10, 1e-100}) {
    const double displacement = relative * height;
    const double force = 3 * bending_stiffness(cilium) * displacement / std::pow(height, 3);
    const MechanicsStep step = solve(cilium, ProbeLoad{displacement, height, 0});
    EXPECT_NEAR(step.applied_force / force, 1, 1e-12) << relative;
    EXPECT_NEAR(contact_deflection(step) / displacement, 1, 1e-12) << relative;
  }
  const MechanicsStep upright = solve(cilium, ProbeLoad{0, height, 0});
  EXPECT_EQ(upright.applied_force, 0);
  EXPECT_EQ(planar_point(upright, cilium.length()).w, 0);
  EXPECT_NEAR(*upright.contact_arclength, height, 1e-17);
}

// Claim: contact and probe are each other's inverse, in both forms, and so is each form's contact
// that of the other's probe.
TEST(ElasticaProbe, GivesTheContactForceBack) {
  for (const elastica::ElasticaOptions& contact_form : {elastica::ElasticaOptions{}, height_form()})
    for (const elastica::ElasticaOptions& probe_form : {elastica::ElasticaOptions{}, height_form()})
      for (const Cilium& cilium : {paper_cilium(), three_segments()})
        for (const double height : {2e-3, 10e-3, 16e-3}) {
          const double limit = *solve(cilium, ContactLoad{0, height, 0}).slip_off_force;
          for (const double part : {1e-6, 0.1, 0.6, 0.9, 0.999}) {
            const double force = part * limit;
            const MechanicsStep contact =
                solve(cilium, ContactLoad{force, height, 0}, contact_form);
            const double displacement = contact_deflection(contact);
            const MechanicsStep probe =
                solve(cilium, ProbeLoad{displacement, height, 0}, probe_form);
            EXPECT_NEAR(probe.applied_force / force, 1, 1e-11) << height << ' ' << part;
            EXPECT_NEAR(contact_deflection(probe) / displacement, 1, 1e-11)
                << height << ' ' << part;
          }
        }
}

// Claim of the header: F grows with δ up to the slip-off, for any stiffnesses; so the path of
// displacements needs no force maximum to be passed, and the slip-off has the largest of both.
TEST(ElasticaProbe, ForceGrowsWithTheDisplacementUpToTheSlipOff) {
  const Cilium soft_top{3e-3, {{"base", 3e-3, 3e6, 0.49, 0}, {"top", 17e-3, 0.1e6, 0.49, 0}}};
  for (const Cilium& cilium : {paper_cilium(), three_segments(), soft_top, uniform_cilium()})
    for (const double height : {3.5e-3, 10e-3, 16e-3}) {
      const MechanicsStep first = solve(cilium, ProbeLoad{0, height, 0});
      const double limit = *first.slip_off_displacement;
      double before = 0;
      for (int i = 1; i <= 20; ++i) {
        // limit · 20/20 may be rounded to beyond the limit.
        const double displacement = i < 20 ? limit * i / 20 : limit;
        const MechanicsStep step = solve(cilium, ProbeLoad{displacement, height, 0});
        // Near 90° the force has reached its limit, to 6e-14 measured.
        EXPECT_GE(step.applied_force, before * (1 - 3e-13)) << height << ' ' << i;
        EXPECT_LE(step.applied_force, *first.slip_off_force * (1 + 1e-13));
        before = step.applied_force;
      }
      EXPECT_NEAR(before, *first.slip_off_force, 1e-10 * before) << height;
    }
}

// Oracle: Legendre's integrals in 50 digits; the end angle fixes h/L, and δ of the tip is w there.
// h is rounded, and d ln δ/d ln h is up to 100 (first case).
TEST(ElasticaProbe, SlipOffDisplacementFollowsLegendresIntegrals) {
  const Cilium cilium = uniform_cilium();
  const double length = cilium.length();
  for (const double cosine : {0.99, 0.9, 0.5, 0.1, 1e-2, 2e-4}) {
    const Real sine = sqrt(1 - Real(cosine) * cosine);
    const UniformSlipOff exact = uniform_slip_off(sine);
    const Real lambda = sqrt(exact.load) / length;
    const auto displacement =
        static_cast<double>(PointForceElastica::with_end_angle(lambda, sine).deflection());
    const double height = static_cast<double>(exact.height) * length;
    const MechanicsStep step = solve(cilium, ProbeLoad{0, height, 0});
    EXPECT_NEAR(*step.slip_off_displacement, displacement, 1e-13 * displacement) << cosine;
  }
}

// Oracle: the other form, up to where it holds.
TEST(ElasticaProbe, SlipOffDisplacementIsTheSameInBothForms) {
  for (const Cilium& cilium : {paper_cilium(), three_segments()})
    for (const double height : {10e-3, 16e-3, 19.9e-3}) {
      const ProbeLoad load{0, height, 0};
      const double arclength = *solve(cilium, load).slip_off_displacement;
      const double quadrature = *solve(cilium, load, height_form()).slip_off_displacement;
      EXPECT_NEAR(arclength, quadrature, 1e-11 * quadrature) << height;
    }
}

TEST(ElasticaProbe, BeyondTheSlipOffIsAStatusAndThePathGoesOn) {
  const Cilium cilium = paper_cilium();
  const double height = 16e-3;
  const double limit = *solve(cilium, ProbeLoad{0, height, 0}).slip_off_displacement;
  for (const elastica::ElasticaOptions& options : {elastica::ElasticaOptions{}, height_form()}) {
    const LoadPath path{ProbeLoad{(1 - 1e-9) * limit, height, 0},
                        ProbeLoad{(1 + 1e-9) * limit, height, 0}, ProbeLoad{1, height, 0},
                        ProbeLoad{4e-3, height, 0}};
    const MechanicsResult result = elastica::Elastica(options).solve(cilium, path);
    EXPECT_EQ(result.steps[0].status, Status::converged) << result.steps[0].message;
    EXPECT_EQ(result.steps[3].status, Status::converged) << result.steps[3].message;
    for (const std::size_t i : {1, 2}) {
      const MechanicsStep& step = result.steps[i];
      EXPECT_EQ(step.status, Status::slipped_off);
      EXPECT_FALSE(step.deformation);
      EXPECT_NEAR(*step.slip_off_force, 5.862e-3, 0.5e-6);  // 5.862 mN: independent calculation
      EXPECT_NEAR(*step.slip_off_displacement, limit, 1e-12);
      EXPECT_NE(step.message.find("displacement"), std::string::npos) << step.message;
      EXPECT_NE(step.message.find("5.862379"), std::string::npos) << step.message;
    }
  }
  EXPECT_FALSE(solve(cilium, ContactLoad{1e-3, height, 0}).slip_off_displacement);
}

// The height form cannot tell forces so near to 90° apart; it says so.
TEST(ElasticaProbe, HeightFormFailsWhereTheForceDoesNotTellTheDisplacement) {
  const ProbeLoad load{15e-3, 1e-3, 0};
  EXPECT_EQ(solve(uniform_cilium(), load).status, Status::converged);
  const MechanicsStep step =
      elastica::Elastica(height_form()).solve(uniform_cilium(), {load}).steps.at(0);
  EXPECT_EQ(step.status, Status::failed);
  EXPECT_NE(step.message.find("arclength"), std::string::npos) << step.message;
}

}  // namespace
}  // namespace ciliaval::analytic

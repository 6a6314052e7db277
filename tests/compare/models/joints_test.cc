// SPDX-License-Identifier: LGPL-2.1-or-later
// The rods with corrected joints: against closed forms, against each other, and what they say.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "analytic/elastica/elastica.h"
#include "analytic/rod/field_models.h"
#include "fem/beam/beam.h"
#include "fem/beam/cilium_beam.h"
#include "fem/beam/section.h"
#include "fem/beam/stability/stability.h"
#include "problem/error.h"
#include "problem/joints/companions.h"
#include "problem/lagrange.h"
#include "problem/surroundings/surface.h"

namespace ciliaval {
namespace {

using analytic::elastica::Elastica;
using analytic::elastica::ElasticaOptions;
using fem::beam::Beam;
using fem::beam::BeamOptions;
using testing::HasSubstr;

constexpr double degree = std::numbers::pi / 180;

ElasticaOptions corrected_elastica(bool error_estimate = false) {
  ElasticaOptions options;
  options.joints = joints::Correction::corrected;
  options.error_estimate = error_estimate;
  return options;
}

BeamOptions corrected_beam(bool error_estimate = false) {
  BeamOptions options;
  options.joints = joints::Correction::corrected;
  options.error_estimate = error_estimate;
  return options;
}

Cilium paper() {
  return {3e-3, {{"base", 3e-3, 1e5, 0.49, 0}, {"magnet", 17e-3, 3e6, 0.49, 75e3}}};
}

/// One to three segments of 1 to 5 diameters, of 0.1 to 3 MPa.
Cilium random_cilium(std::mt19937& engine) {
  std::uniform_real_distribution<double> uniform(0, 1);
  Cilium cilium{2e-3, {}};
  const int segments = 1 + static_cast<int>(3 * uniform(engine));
  for (int i = 0; i < segments; ++i)
    cilium.segments.push_back({"s" + std::to_string(i), (1 + 4 * uniform(engine)) * 2e-3,
                               1e5 * std::pow(30, uniform(engine)), 0.49, 75e3});
  return cilium;
}

MechanicsStep solved(const MechanicsModel& model, const Cilium& cilium, const Load& load) {
  MechanicsStep step = model.solve(cilium, {load}).steps.at(0);
  EXPECT_EQ(step.status, Status::converged) << type(load) << ": " << step.message;
  return step;
}

CentrelinePoint tip(const MechanicsStep& step) {
  const Centreline& line = step.deformation.value().centreline;
  return line.at(line.length());
}

/// The tip's deflection and angle under a small dead force on it, per force: of the segments'
/// bending and shear, and at each joint, l below the tip, a l² + 2 b l + c and a l + b.
std::pair<double, double> response(const Cilium& cilium) {
  const joints::Corrections corrections = joints::corrections(cilium);
  const std::vector<double> ends = cilium.interfaces();
  double w = 0;
  double theta = 0;
  for (std::size_t i = 0; i < cilium.segments.size(); ++i) {
    const Segment& s = cilium.segments[i];
    const auto k = fem::beam::circular_section(cilium.diameter, s.young_modulus, s.poisson_ratio);
    const double below = ends.back() - ends[i];
    const double above = ends.back() - ends[i + 1];
    const joints::Joint& joint = corrections.joints[i];
    w += (std::pow(below, 3) - std::pow(above, 3)) / (3 * k.EI1) + s.length / k.kGA1 +
         joint.rotation * below * below + 2 * joint.coupling * below + joint.displacement;
    theta +=
        (below * below - above * above) / (2 * k.EI1) + joint.rotation * below + joint.coupling;
  }
  return {w, theta};
}

// Oracle: the principle of virtual forces. The force turns the tip by 1e-5 rad at most.
TEST(Joints, UnderASmallLoadFollowTheClosedForm) {
  std::mt19937 engine(3);
  for (int n = 0; n < 10; ++n) {
    const Cilium cilium = random_cilium(engine);
    const auto [w, theta] = response(cilium);
    const double F = 1e-6 / theta;
    const Load load = SectionLoad{F, cilium.length(), 0};
    const CentrelinePoint elastica = tip(solved(Elastica(corrected_elastica()), cilium, load));
    const CentrelinePoint beam = tip(solved(Beam(corrected_beam()), cilium, load));
    for (const CentrelinePoint& point : {elastica, beam}) {
      EXPECT_NEAR(point.position.x() / (F * w), 1, 1e-9);
      EXPECT_NEAR(point.theta() / (F * theta), 1, 1e-9);
    }
  }
}

/// A load of each type.
std::vector<Load> loads_on(const Cilium& cilium) {
  const double L = cilium.length();
  return {ContactLoad{1, 0.7 * L, 0.3}, FlowLoad{1, 1},
          SectionLoad{1, 0.8 * L, -2},  DeadLoad{1, 0},
          ProbeLoad{1, 0.7 * L, 2},     MomentLoad{1, 0.5}};
}

/// The magnitude at which the tip of the elastica turns by an angle, or 0.9 of that at which it
/// slips off.
Load turning(const Cilium& cilium, const Load& load, double angle) {
  const Elastica model(corrected_elastica());
  double low = 1e-9;
  double high = 1e3;
  bool slips = false;
  for (int i = 0; i < 60; ++i) {
    const double middle = std::sqrt(low * high);
    const MechanicsStep step = model.solve(cilium, {with_magnitude(load, middle)}).steps.at(0);
    const bool is_above = step.status != Status::converged || tip(step).theta() > angle;
    if (is_above) slips = step.status != Status::converged;
    (is_above ? high : low) = middle;
  }
  return with_magnitude(load, slips ? 0.9 * low : low);
}

/// Largest distance of two centrelines away from their jumps, over the length.
double distance(const Centreline& a, const Centreline& b) {
  double largest = 0;
  for (int i = 1; i <= 200; ++i) {
    const double S = a.length() * (i - 0.5) / 200;
    largest = std::max(largest, (a.at(S).position - b.at(S).position).norm() / a.length());
  }
  return largest;
}

// The elastica's jumps are in the mean axes of both sides, the beam's go on across an element: the
// difference is of the third order in the jump. At 45 deg measured: up to 4e-5 of the length, for a
// single stub of 1.2 diameters; 1e-7 for most.
TEST(Joints, OfElasticaAndBeamAgreeUnderEveryLoad) {
  std::mt19937 engine(5);
  double largest = 0;
  for (int n = 0; n < 8; ++n) {
    const Cilium cilium = random_cilium(engine);
    for (const Load& any : loads_on(cilium)) {
      const Load load = turning(cilium, any, 45 * degree);
      const MechanicsStep elastica =
          Elastica(corrected_elastica()).solve(cilium, {load}).steps.at(0);
      if (!elastica.deformation || !elastica.message.empty()) continue;  // outside of the domain
      const MechanicsStep beam = solved(Beam(corrected_beam()), cilium, load);
      if (!beam.deformation) continue;
      const double d = distance(elastica.deformation->centreline, beam.deformation->centreline);
      // The plain beam slips off earlier.
      const MechanicsStep plain = Beam().solve(cilium, {load}).steps.at(0);
      if (plain.deformation) {
        EXPECT_LT(20 * d, distance(plain.deformation->centreline, beam.deformation->centreline))
            << type(load);
      }
      EXPECT_NEAR(tip(elastica).theta(), tip(beam).theta(), 1e-4) << type(load);
      EXPECT_NEAR(beam.applied_force, elastica.applied_force,
                  1e-4 * elastica.applied_force + 1e-12 * magnitude(load) / cilium.length());
      largest = std::max(largest, d);
    }
  }
  RecordProperty("distance", std::to_string(1e9 * largest) + "e-9");
  std::printf("elastica and beam, in the domain: %.1e of the length apart\n", largest);
  EXPECT_LT(largest, 1e-4);
  EXPECT_GT(largest, 0);
}

// Oracle: quadrature, piece by piece. The closed form has the poles of both sides of a joint
// between two magnets.
TEST(Joints, BetweenTwoMagnetsHavePoles) {
  using namespace analytic::rod;
  Cilium cilium = paper();
  cilium.segments[0].magnetization = 75e3;
  const MechanicsStep step =
      solved(Elastica(corrected_elastica()), cilium, ContactLoad{4e-3, 16e-3, 0.5});
  const std::vector<Vector3> points{{0, 0, -1.5e-3}, {3e-3, 1e-3, 3e-3}};
  const Field line = LineField().field(cilium, *step.deformation, points);
  const Field sum = LineField({.method = Method::quadrature, .tolerance = 1e-10})
                        .field(cilium, *step.deformation, points);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_LT((line.B[i] - sum.B[i]).norm(), 1e-8 * sum.B[i].norm());
}

/// Unstable modes of a rod of unit stiffness, length and magnet in an opposing field λ, with a
/// joint of rotation a at its clamp.
int unstable_modes(double lambda, double a) {
  const double d = 0.01;
  const double area = std::numbers::pi * d * d / 4;
  const Cilium rod{d, {{"rod", 1, 64 / (std::numbers::pi * std::pow(d, 4)), 0.3, 1 / area}}};
  BeamOptions options;
  options.shear_rigid = true;
  const joints::Corrections corrections{{{.rotation = a}}, {{}}};
  fem::beam::CiliumBeam beam = fem::beam::cilium_beam(rod, options, {}, corrections);
  fem::beam::State state = beam.system.reference_state();
  const fem::beam::Loads loads = fem::beam::loads(
      rod, with_environment(EnvironmentLoad{}, {.uniform_field = {0, 0, -lambda}}), beam);
  const fem::beam::PathReport report = advance(beam.system, state, {}, loads, {1e-12, 30, 8});
  EXPECT_TRUE(report.converged) << report.message;
  return fem::beam::stability::unstable_modes(beam.system, state, loads);
}

// Oracle: θ″ + λθ = 0 with θ(0) = a θ′(0) and θ′(1) = 0, so a √λ tan √λ = 1. The joint's negative
// compliance is no unstable mode.
TEST(Joints, RaiseTheBucklingLoad) {
  for (const double a : {-0.05, -0.2, 0.1}) {
    const auto gap = [&](double k) { return std::cos(k) - a * k * std::sin(k); };
    double low = 0.5;  // (π/2, π) or (0, π/2)
    double high = std::numbers::pi;
    for (int i = 0; i < 60; ++i) (gap((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
    const double critical = low * low;
    EXPECT_EQ(critical > std::numbers::pi * std::numbers::pi / 4, a < 0);
    EXPECT_EQ(unstable_modes(0, a), 0);
    EXPECT_EQ(unstable_modes(0.999 * critical, a), 0) << a;
    EXPECT_EQ(unstable_modes(1.001 * critical, a), 2) << a;
  }
}

/// The moment of what acts above S = 0 about the section there, the upper one of the clamp's joint.
double moment_at_base(const MechanicsStep& step) {
  const Centreline& line = step.deformation->centreline;
  const double z = line.at(0).position.z();
  const double rise = tip(step).position.z() - z;
  if (const auto height = contact_height(step.load)) return step.applied_force * (*height - z);
  if (step.load.is<FlowLoad>()) return magnitude(step.load) * rise * rise / 2;
  if (step.load.is<MomentLoad>()) return magnitude(step.load);
  if (const auto section = step.load.as<SectionLoad>())
    return section->force * (line.at(section->arclength).position.z() - z);
  double sum = 0;
  for (std::size_t i = 0; i + 1 < line.breaks().size(); ++i) {
    const QuadratureRule rule = gauss_legendre(20, line.breaks()[i], line.breaks()[i + 1]);
    for (std::size_t q = 0; q < rule.nodes.size(); ++q)
      sum += rule.weights[q] * (line.at(rule.nodes[q], i).position.z() - z);
  }
  return magnitude(step.load) * sum;
}

// Oracle: the definition. Global equilibrium of moments about the base, and each jump by its law in
// the mean axes of both sides.
TEST(Joints, OfTheElasticaAreInEquilibriumAndObeyTheirLaw) {
  std::mt19937 engine(7);
  int judged = 0;
  for (int n = 0; n < 8; ++n) {
    const Cilium cilium = random_cilium(engine);
    const joints::Corrections corrections = joints::corrections(cilium);
    for (const Load& any : loads_on(cilium)) {
      const Load load = turning(cilium, any, 45 * degree);
      const Vector3 e = direction(load);
      const Vector3 axis = Vector3::UnitZ().cross(e);
      const MechanicsStep step = Elastica(corrected_elastica()).solve(cilium, {load}).steps.at(0);
      if (!step.deformation || !step.message.empty()) continue;  // outside of the domain
      ++judged;
      const Centreline& line = step.deformation->centreline;
      const double base = line.at(0).forces.moment.dot(axis);
      EXPECT_NEAR(moment_at_base(step) / base, 1, 1e-13) << type(load);
      const std::vector<double> ends = cilium.interfaces();
      for (std::size_t i = 0; i < corrections.joints.size(); ++i) {
        CentrelinePoint lower;  // of the clamp
        // The break may be the interface but for rounding.
        const std::size_t above = line.piece_at(ends[i] + 1e-12 * cilium.length());
        if (i > 0) lower = line.at(ends[i], above - 1);
        const CentrelinePoint upper = line.at(ends[i], above);
        const Vector3 jump = upper.position - lower.position;
        const double q = load.is<FlowLoad>() ? magnitude(load) : 0;
        const double H = upper.forces.force.dot(e) + q * jump.z() / 2;
        const double M_upper = upper.forces.moment.dot(axis);
        const double M_lower = i > 0 ? lower.forces.moment.dot(axis) : M_upper + H * jump.z();
        const double M = (M_lower + M_upper) / 2;
        const auto angle = [&](const CentrelinePoint& p) {
          return std::atan2(p.normal().dot(e), p.normal().z());
        };
        const double theta = (angle(lower) + angle(upper)) / 2;
        const Vector3 normal = std::cos(theta) * Vector3::UnitZ() + std::sin(theta) * e;
        const Vector3 across = std::cos(theta) * e - std::sin(theta) * Vector3::UnitZ();
        const joints::Joint& joint = corrections.joints[i];
        const double Q = H * std::cos(theta);
        const double N = H * std::sin(theta);
        const auto& [p, g, h] = joint.beyond;
        const double turn = joint.rotation * M + joint.coupling * Q + 2 * p * N * M +
                            g * std::pow(M, 3) + h * std::pow(M, 5);
        EXPECT_NEAR(angle(upper) - angle(lower), turn, 1e-13) << type(load) << i;
        EXPECT_NEAR(jump.dot(across), joint.coupling * M + joint.displacement * Q,
                    1e-13 * cilium.length());
        EXPECT_NEAR(jump.dot(normal), joint.extension * N + p * M * M, 1e-13 * cilium.length());
        EXPECT_NEAR(M_lower - M_upper, H * jump.z(), 1e-13 * base);
      }
    }
  }
  EXPECT_GE(judged, 20);
}

// Oracle: two algorithms. A low contact that passes an interface, and slips off.
TEST(Joints, LetAContactPass) {
  LoadPath path;
  for (const double F : {5e-3, 20e-3, 40e-3, 10e-3}) path.push_back(ContactLoad{F, 2.95e-3, 0});
  const MechanicsResult elastica = Elastica(corrected_elastica()).solve(paper(), path);
  const MechanicsResult beam = Beam(corrected_beam()).solve(paper(), path);
  bool is_in_base = false;
  bool is_in_magnet = false;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const MechanicsStep& a = elastica.steps[i];
    const MechanicsStep& b = beam.steps[i];
    ASSERT_EQ(a.status, Status::converged) << i << a.message;
    ASSERT_EQ(b.status, Status::converged) << i << b.message;
    (*a.contact_arclength < 3e-3 ? is_in_base : is_in_magnet) = true;
    EXPECT_NEAR(*b.contact_arclength / *a.contact_arclength, 1, 1e-3) << i;
  }
  EXPECT_TRUE(is_in_base);
  EXPECT_TRUE(is_in_magnet);
}

TEST(Joints, LetAContactSlipOff) {
  const Elastica model(corrected_elastica());
  const double limit = *model.solve(paper(), {ContactLoad{1e-3, 16e-3, 0}}).steps[0].slip_off_force;
  LoadPath path;
  for (const double part : {0.5, 0.9, 1.1}) path.push_back(ContactLoad{part * limit, 16e-3, 0});
  const MechanicsResult elastica = model.solve(paper(), path);
  const MechanicsResult beam = Beam(corrected_beam()).solve(paper(), path);
  for (std::size_t i = 0; i < path.size(); ++i) {
    ASSERT_EQ(elastica.steps[i].status, beam.steps[i].status) << beam.steps[i].message;
    EXPECT_EQ(beam.steps[i].status, i == 2 ? Status::slipped_off : Status::converged);
  }
  EXPECT_NEAR(*beam.steps[2].slip_off_force / limit, 1, 1e-3);
}

// A probe's displacement gives back the force of a contact.
TEST(Joints, LetAProbeFindItsForce) {
  for (const double F : {1e-3, 4e-3}) {
    const MechanicsStep contact =
        solved(Elastica(corrected_elastica()), paper(), ContactLoad{F, 16e-3, 0});
    const double S = *contact.contact_arclength;
    const double w = contact.deformation->centreline.at(S).position.x();
    const MechanicsStep probe =
        solved(Elastica(corrected_elastica()), paper(), ProbeLoad{w, 16e-3, 0});
    EXPECT_NEAR(probe.applied_force / F, 1, 1e-11);
    const MechanicsStep beam = solved(Beam(corrected_beam()), paper(), ProbeLoad{w, 16e-3, 0});
    EXPECT_NEAR(beam.applied_force / F, 1, 1e-4);
  }
}

// The companions carry the corrections' uncertainty to tip, angle and slip-off force.
TEST(Joints, CountTheirUncertaintyAsError) {
  const Cilium cilium = paper();
  const LoadPath path{ContactLoad{1e-3, 16e-3, 0}, ContactLoad{4e-3, 16e-3, 0},
                      ContactLoad{9e-3, 16e-3, 0}};
  const MechanicsResult elastica = Elastica(corrected_elastica(true)).solve(cilium, path);
  const MechanicsResult beam = Beam(corrected_beam(true)).solve(cilium, path);
  ASSERT_EQ(elastica.companions.size(), 1U);
  EXPECT_EQ(elastica.error_parts.front().direction, "joints");
  ASSERT_EQ(beam.companions.size(), 2U);
  EXPECT_EQ(beam.error_parts[1].direction, "joints");
  for (std::size_t i = 0; i < 2; ++i) {
    const double distance =
        (tip(elastica.companions[0].steps[i]).position - tip(elastica.steps[i]).position).norm();
    EXPECT_NEAR(*elastica.steps[i].tip_uncertainty, distance, 1e-13);
    EXPECT_GT(distance, 1e-7);
    EXPECT_NEAR(*beam.steps[i].tip_uncertainty / *elastica.steps[i].tip_uncertainty, 1, 1e-3);
    EXPECT_GT(*elastica.steps[i].tip_angle_uncertainty, 0);
  }
  EXPECT_EQ(elastica.steps[2].status, Status::slipped_off);
  EXPECT_GT(*elastica.steps[2].slip_off_uncertainty, 1e-6 * *elastica.steps[2].slip_off_force);
}

// Oracle: |κ| d/2 of the base.
TEST(Joints, SayWhereTheyAreOutOfTheirDomain) {
  for (const double F : {1e-3, 15e-3}) {
    const Load load = SectionLoad{F, 16e-3, 0};
    const MechanicsStep step = solved(Elastica(corrected_elastica()), paper(), load);
    const MechanicsStep beam = solved(Beam(corrected_beam()), paper(), load);
    const double strain = step.deformation->centreline.at(0).bending_curvature() * 1.5e-3;
    const bool is_outside = strain > joints::largest_strain;
    EXPECT_EQ(is_outside, F > 2e-3) << strain;
    for (const MechanicsStep& each : {step, beam}) {
      EXPECT_EQ(each.message.empty(), !is_outside) << each.message;
      EXPECT_THAT(each.message,
                  is_outside ? HasSubstr("segment 'base' is bent to a strain of") : HasSubstr(""));
    }
  }
}

// Oracle: without joints nothing of them is read, and the elastica does not shear.
TEST(Joints, AreLeftAloneByDefault) {
  const MechanicsResult result = Elastica().solve(paper(), {ContactLoad{4e-3, 16e-3, 0}});
  EXPECT_TRUE(result.companions.empty());
  EXPECT_EQ(result.steps[0].message, "");
  EXPECT_EQ(result.steps[0].deformation->centreline.at(0).theta(), 0);
  Cilium square = paper();
  square.section = {.shape = CrossSection::Shape::rectangle, .width = 3e-3, .height = 3e-3};
  solved(Elastica(), square, ContactLoad{1e-3, 16e-3, 0});
  EXPECT_THROW(Elastica(corrected_elastica()).solve(square, {ContactLoad{1e-3, 16e-3, 0}}),
               InputError);
  EXPECT_THROW(Beam(corrected_beam()).solve(square, {ContactLoad{1e-3, 16e-3, 0}}), InputError);
}

template <class Model>
std::string refusal(const Model& model, const Load& load) {
  try {
    model.solve(paper(), {load});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Joints, RefuseWhatTheyDoNotReach) {
  ElasticaOptions height = corrected_elastica();
  height.form = ElasticaOptions::Form::height;
  EXPECT_THAT(refusal(Elastica(height), ContactLoad{1e-3, 16e-3, 0}),
              HasSubstr("use form = \"arclength\""));
  const Load in_field =
      with_environment(ContactLoad{1e-3, 16e-3, 0}, {.uniform_field = {1e-3, 0, 0}});
  EXPECT_THAT(refusal(Elastica(corrected_elastica()), in_field), HasSubstr("take the beam"));
  EXPECT_EQ(refusal(Beam(corrected_beam()), in_field), "");
  const Load sweep(SweepLoad{1e-3, 1e-3, 0, 0},
                   std::make_shared<const surroundings::Surface>(
                       surroundings::Surface{surroundings::FlatProfile{}, 0, 0}));
  EXPECT_THAT(refusal(Elastica(corrected_elastica()), sweep), HasSubstr("takes no sweep"));
  EXPECT_THAT(refusal(Beam(corrected_beam()), sweep), HasSubstr("takes no sweep"));
}

// Oracle: the plain beam. A stiffer clamp bends less in a field, by either law of the energy; and
// without shear the laws are one, which the joint, being no magnet, does not change.
TEST(Joints, StandInAnEnvironment) {
  using surroundings::MagneticEnergy;
  BeamOptions rigid = corrected_beam();
  rigid.shear_rigid = true;
  BeamOptions plain;
  plain.error_estimate = false;
  const auto in_field = [](MagneticEnergy law) {
    return with_environment(EnvironmentLoad{},
                            {.uniform_field = {5e-3, 0, 2e-3}, .magnetic_energy = law});
  };
  const CentrelinePoint by_F = tip(solved(Beam(rigid), paper(), in_field(MagneticEnergy::F)));
  const CentrelinePoint by_R = tip(solved(Beam(rigid), paper(), in_field(MagneticEnergy::R)));
  EXPECT_GT(by_F.theta(), 0.05);
  EXPECT_LT((by_F.position - by_R.position).norm(), 1e-12);
  EXPECT_LT(by_F.theta(), tip(solved(Beam(plain), paper(), in_field(MagneticEnergy::F))).theta());
}

}  // namespace
}  // namespace ciliaval

// SPDX-License-Identifier: LGPL-2.1-or-later
// A pin that touches the cilium from the side. Oracle: figures of shooting and quadrature apart
// from this project, which agree to 1e-13 (docs/theory/touch.md).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "cases.h"
#include "problem/error.h"
#include "problem/lagrange.h"

namespace ciliaval::analytic {
namespace {

constexpr double milli = 1e-3;
constexpr double degree = std::numbers::pi / 180;

TouchLaw coulomb(double friction, TouchLaw::At at = TouchLaw::At::axis, double radius = 0) {
  return {TouchLaw::Law::coulomb, friction, at, radius};
}

Load touched(Load load, const TouchLaw& touch) {
  load.set_touch(touch);
  return load;
}

std::vector<MechanicsStep> steps_of(const Cilium& cilium, const LoadPath& path) {
  return elastica::Elastica().solve(cilium, path).steps;
}

double EI(const Cilium& cilium) {
  return cilium.segments.front().young_modulus * cilium.second_moment(0);
}

/// A uniform cilium touched at half its length, in whose units the oracle's figures are.
struct Uniform {
  Cilium cilium = uniform_cilium();
  double h = cilium.length() / 2;
  double force = EI(cilium) / (h * h);

  Load probe(double X, const TouchLaw& touch) const {
    return touched(ProbeLoad{X * h, h, 0}, touch);
  }
  Load contact(double H, const TouchLaw& touch) const {
    return touched(ContactLoad{H * force, h, 0}, touch);
  }
};

struct Row {
  double friction;
  double angle;  ///< deg
  double H, X, S;
};

// Measured: 1e-10, the digits of the figures.
TEST(ElasticaTouch, SlidesForwardAsTheOracle) {
  const Uniform u;
  for (const Row& row : std::vector<Row>{{0, 10, 0.3385573670, 0.1168641921, 1.0081705119},
                                         {0, 25, 0.7183066912, 0.2990573588, 1.0526729844},
                                         {0, 40, 0.8321427324, 0.5006709728, 1.1431372751},
                                         {0.2, 10, 0.3484636366, 0.1170006773, 1.0081841275},
                                         {0.2, 25, 0.7736825298, 0.2999764870, 1.0529018799},
                                         {0.2, 40, 0.9475977084, 0.5034157153, 1.1442271284},
                                         {0.5, 10, 0.3631360493, 0.1172012705, 1.0082041749},
                                         {0.5, 25, 0.8541208632, 0.3012883518, 1.0532300088},
                                         {0.5, 40, 1.1116436145, 0.5072262118, 1.1457501879}}) {
    const MechanicsStep step = steps_of(u.cilium, {u.probe(row.X, coulomb(row.friction))}).front();
    ASSERT_EQ(step.status, Status::converged) << step.message;
    EXPECT_NEAR(step.applied_force / u.force, row.H, 1e-9);
    EXPECT_NEAR(*step.contact_arclength / u.h, row.S, 1e-9);
    EXPECT_NEAR(step.deformation->centreline.at(u.cilium.length()).theta(), row.angle * degree,
                1e-9);
    EXPECT_NEAR(step.touch->vertical_force / step.applied_force,
                std::tan(row.angle * degree - std::atan(row.friction)), 1e-9);
    EXPECT_EQ(step.touch->state, ProbeContact::State::slip);
  }
}

// The horizontal law at the axis is the paper's; the two solvers share the Taylor steps alone.
TEST(ElasticaTouch, OfTheHorizontalLawIsThePapers) {
  const Uniform u;
  const TouchLaw law{.law = TouchLaw::Law::horizontal, .radius = 1e-12};
  for (const double X : {0.1169846392, 0.3011447845, 0.5111565333}) {
    const MechanicsStep own = steps_of(u.cilium, {u.probe(X, law)}).front();
    const MechanicsStep plain = steps_of(u.cilium, {u.probe(X, {})}).front();
    EXPECT_NEAR(own.applied_force / plain.applied_force, 1, 1e-9);
    EXPECT_NEAR(own.slip_off_force.value() / plain.slip_off_force.value(), 1, 1e-8);
    EXPECT_NEAR(own.touch->vertical_force, 0, 1e-15);
  }
}

// Turned back at 40 deg, the pin sticks and then slides down the other side of the cone.
TEST(ElasticaTouch, TurnedBackSticksAndSlidesDown) {
  const Uniform u;
  struct Turned {
    double friction, X40, slides_X, slides_H, slides_angle;
    std::vector<Row> back;
  };
  for (const Turned& t :
       std::vector<Turned>{{0.2,
                            0.5034157153,
                            0.5018431703,
                            0.7092933014,
                            40.287844,
                            {{0.2, 40, 0.7111637344, 0.4977369038, 1.1419789898},
                             {0.2, 25, 0.6614205313, 0.2980991601, 1.0524352397},
                             {0.2, 10, 0.3285483355, 0.1167254185, 1.0081566888}}},
                           {0.5,
                            0.5072262118,
                            0.5031927608,
                            0.5076230190,
                            40.735485,
                            {{0.5, 40, 0.5178023161, 0.4929186486, 1.1400921353},
                             {0.5, 25, 0.5730227140, 0.2965811094, 1.0520604342},
                             {0.5, 10, 0.3133361106, 0.1165128014, 1.0081355505}}}}) {
    const TouchLaw law = coulomb(t.friction);
    LoadPath path{u.probe(t.X40, law), u.probe((t.X40 + t.slides_X) / 2, law),
                  u.probe(t.slides_X, law)};
    for (const Row& row : t.back) path.push_back(u.probe(row.X, law));
    path.push_back(u.probe(0, law));
    const std::vector<MechanicsStep> steps = steps_of(u.cilium, path);
    EXPECT_EQ(steps[1].touch->state, ProbeContact::State::stick);
    EXPECT_EQ(steps[1].contact_arclength.value(), steps[0].contact_arclength.value());
    EXPECT_NEAR(steps[2].applied_force / u.force, t.slides_H, 2e-8);  // dH/dX is 150 there
    EXPECT_NEAR(steps[2].deformation->centreline.at(u.cilium.length()).theta() / degree,
                t.slides_angle, 1e-6);
    for (std::size_t i = 0; i < t.back.size(); ++i) {
      EXPECT_NEAR(steps[3 + i].applied_force / u.force, t.back[i].H, 1e-9);
      EXPECT_NEAR(*steps[3 + i].contact_arclength / u.h, t.back[i].S, 1e-9);
      EXPECT_EQ(steps[3 + i].touch->state, ProbeContact::State::slip);
    }
    EXPECT_EQ(steps.back().applied_force, 0);
  }
}

// At the fold the place is known to 1e-8 by the oracle, which looks for the largest force.
TEST(ElasticaTouch, UnderAForceEndsAtTheFold) {
  const Uniform u;
  for (const Row& row : std::vector<Row>{{0, 38.301215, 0.8339760543, 0.4763775979, 0},
                                         {0.2, 41.268928, 0.9486513795, 0.5220894764, 0},
                                         {0.5, 44.768192, 1.1278303247, 0.5801762335, 0}}) {
    const TouchLaw law = coulomb(row.friction);
    const auto steps = steps_of(
        u.cilium, {u.contact(row.H * (1 - 1e-6), law), u.contact(row.H * (1 + 1e-6), law)});
    EXPECT_EQ(steps[0].status, Status::converged) << steps[0].message;
    EXPECT_EQ(steps[1].status, Status::slipped_off);
    EXPECT_NE(steps[1].message.find("fold"), std::string::npos) << steps[1].message;
    EXPECT_NEAR(*steps[1].slip_off_force / u.force, row.H, 1e-9);
    const auto at_fold = steps_of(u.cilium, {u.probe(row.X, law)}).front();
    EXPECT_NEAR(at_fold.deformation->centreline.at(u.cilium.length()).theta() / degree, row.angle,
                1e-5);
  }
}

struct PaperRow {
  TouchLaw touch;
  double X;                           ///< mm
  double H, V, angle, S, w, z, base;  ///< mN, mN, deg, mm, mm, mm, uN m
};

TEST(ElasticaTouch, OfThePapersCiliumOnItsAxisAndItsMantle) {
  const auto mantle = TouchLaw::At::mantle;
  for (const PaperRow& row : std::vector<PaperRow>{
           {{.radius = 1e-15}, 6, 3.42869, 0, 23.0416, 17.1548, 7.1136, 18.6182, 54.859},
           {coulomb(0), 6, 2.92999, 1.24681, 23.0514, 17.1551, 7.1139, 18.6177, 54.361},
           {coulomb(0.3), 6, 3.28269, 0.36504, 23.0445, 17.1549, 7.1137, 18.6181, 54.713},
           {coulomb(0, mantle), 6, 3.10206, 1.34671, 23.4673, 16.5544, 7.2481, 18.5633, 55.693},
           {coulomb(0.3, mantle, 1e-3), 6, 3.52088, 0.43815, 23.7928, 16.1401, 7.3447, 18.5233,
            56.848},
           {coulomb(0.3, mantle, 1e-3), 3, 1.86211, -0.14751, 12.1700, 15.7689, 3.8358, 19.6090,
            29.183}}) {
    const Cilium cilium = paper_cilium();
    const MechanicsStep step =
        steps_of(cilium, {touched(ProbeLoad{row.X * milli, 16 * milli, 0}, row.touch)}).front();
    ASSERT_EQ(step.status, Status::converged) << step.message;
    const CentrelinePoint tip = step.deformation->centreline.at(cilium.length());
    EXPECT_NEAR(step.applied_force / milli, row.H, 6e-6);
    EXPECT_NEAR(step.touch->vertical_force / milli, row.V, 6e-6);
    EXPECT_NEAR(tip.theta() / degree, row.angle, 6e-5);
    EXPECT_NEAR(*step.contact_arclength / milli, row.S, 6e-5);
    EXPECT_NEAR(tip.position.x() / milli, row.w, 6e-5);
    EXPECT_NEAR(tip.position.z() / milli, row.z, 6e-5);
    EXPECT_NEAR(step.touch->base_moment / 1e-6, row.base, 6e-4);
    const SectionForces base = step.deformation->centreline.at(0).forces;
    EXPECT_NEAR(base.moment.y(), step.touch->base_moment, 1e-12 * base.moment.norm());
    EXPECT_NEAR(base.force.x(), step.applied_force, 1e-12 * base.force.norm());
    EXPECT_NEAR(base.force.z(), -step.touch->vertical_force, 1e-12 * base.force.norm());
  }
}

/// ∫ H dδ over the displacements by Simpson's rule.
double work(const std::vector<MechanicsStep>& steps, std::size_t first, std::size_t last) {
  double sum = 0;
  for (std::size_t i = first; i + 2 <= last; i += 2)
    sum += (steps[i + 2].touch->displacement - steps[i].touch->displacement) / 6 *
           (steps[i].applied_force + 4 * steps[i + 1].applied_force + steps[i + 2].applied_force);
  return sum;
}

/// ∫ M²/2EI dS.
double energy(const Cilium& cilium, const MechanicsStep& step) {
  const QuadratureRule rule = gauss_legendre(20, 0, 1);
  const std::vector<double> breaks = step.deformation->centreline.breaks();
  double sum = 0;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
    for (std::size_t q = 0; q < rule.nodes.size(); ++q) {
      const double S = std::lerp(breaks[i], breaks[i + 1], rule.nodes[q]);
      std::size_t segment = 0;
      while (cilium.interfaces()[segment + 1] < S) ++segment;
      const double M = step.deformation->centreline.at(S).forces.moment.norm();
      sum += (breaks[i + 1] - breaks[i]) * rule.weights[q] * M * M /
             (2 * cilium.segments[segment].young_modulus * cilium.second_moment(0));
    }
  return sum;
}

/// Places from a to b, b included; an even number of pieces.
void go(LoadPath& path, const Cilium& cilium, double a, double b, const TouchLaw& touch) {
  constexpr int pieces = 200;
  for (int i = path.empty() ? 0 : 1; i <= pieces; ++i)
    path.push_back(touched(
        ProbeLoad{std::lerp(a, b, i / double{pieces}) * cilium.length(), 0.7 * cilium.length(), 0},
        touch));
}

// Without friction the work is the energy, on random cilia and pins. Measured: up to 5e-11.
TEST(ElasticaTouch, WithoutFrictionStoresTheWork) {
  std::mt19937 random(20261129);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int k = 0; k < 10; ++k) {
    Cilium cilium = paper_cilium();
    cilium.segments[0].young_modulus *= std::pow(30, uniform(random));
    const TouchLaw law = coulomb(0, k % 2 == 0 ? TouchLaw::At::mantle : TouchLaw::At::axis,
                                 2 * milli * uniform(random));
    LoadPath path;
    go(path, cilium, 0, 0.2 + 0.2 * uniform(random), law);
    const auto steps = steps_of(cilium, path);
    ASSERT_EQ(steps.back().status, Status::converged) << steps.back().message;
    EXPECT_NEAR(work(steps, 0, steps.size() - 1) / energy(cilium, steps.back()), 1, 1e-9);
  }
}

// Round a loop the pin loses ∫ T ds, s = S + r θ the way that it slides on the cilium.
TEST(ElasticaTouch, LosesTheFrictionalWorkRoundALoop) {
  const Cilium cilium = paper_cilium();
  for (const TouchLaw& law : {coulomb(0.3), coulomb(0.5, TouchLaw::At::axis, 1 * milli)}) {
    LoadPath path;
    go(path, cilium, 0, 0.35, law);
    go(path, cilium, 0.35, 0, law);
    const auto steps = steps_of(cilium, path);
    double lost = 0;
    for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
      const auto at = [&](const MechanicsStep& step) {
        const double theta = step.deformation->centreline.at(cilium.length()).theta();
        const double T =
            step.applied_force * std::sin(theta) - step.touch->vertical_force * std::cos(theta);
        const double s = step.contact_arclength.value() + law.radius * theta;
        return std::pair(T, s);
      };
      const auto [T0, s0] = at(steps[i]);
      const auto [T1, s1] = at(steps[i + 1]);
      lost += (T0 + T1) / 2 * (s1 - s0);
    }
    EXPECT_GT(lost, 0);
    const std::size_t half = (steps.size() - 1) / 2;
    const double input = work(steps, 0, half) + work(steps, half, steps.size() - 1);
    EXPECT_NEAR(input / lost, 1, 5e-3);  // measured 2.2e-3, of the trapezia
  }
}

// A pin that is moved in one go, to and back, ends as one that is moved in small steps, on random
// cilia, heights and pins.
TEST(ElasticaTouch, DoesNotDependOnTheSteps) {
  std::mt19937 random(20261130);
  std::uniform_real_distribution<double> uniform(0, 1);
  int compared = 0;
  for (int k = 0; k < 300; ++k) {
    Cilium cilium = paper_cilium();
    cilium.segments[0].young_modulus *= std::pow(30, uniform(random));
    const double height = (0.15 + 0.75 * uniform(random)) * cilium.length();
    const double radius = std::min(2 * milli, 0.5 * height) * uniform(random);
    const double friction = 0.6 * uniform(random);
    const auto at = k % 3 == 0 ? TouchLaw::At::axis : TouchLaw::At::mantle;
    const TouchLaw law = coulomb(friction, at, radius);
    const double far = (0.05 + 0.35 * uniform(random)) * height;
    const double back = far * uniform(random);
    LoadPath fine;
    for (int i = 1; i <= 40; ++i) fine.push_back(touched(ProbeLoad{far * i / 40, height, 0}, law));
    for (int i = 1; i <= 40; ++i)
      fine.push_back(touched(ProbeLoad{std::lerp(far, back, i / 40.0), height, 0}, law));
    const auto slow = steps_of(cilium, fine);
    const auto quick = steps_of(cilium, {fine[39], fine[79]});
    for (const auto& [one, other] :
         {std::pair(slow[39], quick[0]), std::pair(slow[79], quick[1])}) {
      SCOPED_TRACE(std::to_string(k));
      ASSERT_EQ(one.status, other.status) << one.message << other.message;
      if (one.status != Status::converged) continue;
      ++compared;
      EXPECT_NEAR(other.applied_force / one.applied_force, 1, 1e-7);
      EXPECT_NEAR(other.touch->vertical_force, one.touch->vertical_force, 1e-7 * one.applied_force);
    }
  }
  EXPECT_GT(compared, 500);
}

TEST(ElasticaTouch, TouchesAnewAfterASlipOff) {
  const Uniform u;
  const TouchLaw law = coulomb(0.2);
  const auto steps =
      steps_of(u.cilium, {u.contact(0.5, law), u.contact(2, law), u.contact(0.5, law)});
  EXPECT_EQ(steps[1].status, Status::slipped_off);
  EXPECT_EQ(steps[2].applied_force, steps[0].applied_force);
  EXPECT_EQ(steps[2].contact_arclength.value(), steps[0].contact_arclength.value());
}

TEST(ElasticaTouch, RefusesWhatItCannotState) {
  const Uniform u;
  Load in_field = u.probe(0.1, coulomb(0.2));
  surroundings::Environment field;
  field.uniform_field = {0, 0, 1e-3};
  in_field.set_environment(field);
  EXPECT_THROW(steps_of(u.cilium, {in_field}), InputError);
  EXPECT_THROW(steps_of(u.cilium, {u.probe(0.1, coulomb(0.2, TouchLaw::At::axis, 2 * u.h))}),
               InputError);
  elastica::ElasticaOptions options;
  options.form = elastica::ElasticaOptions::Form::height;
  EXPECT_THROW(elastica::Elastica(options).solve(u.cilium, {u.probe(0.1, coulomb(0.2))}),
               InputError);
  Load rim = u.probe(0.1, coulomb(0.2));
  rim.set_slip_off_point(SlipOffPoint::rim);
  EXPECT_THROW(steps_of(u.cilium, {rim}), InputError);
}

}  // namespace
}  // namespace ciliaval::analytic

// SPDX-License-Identifier: LGPL-2.1-or-later
// A cilium whose end is a disc: its rim, its face and its mantle under a surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iostream>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "analytic/elastica/sweep.h"
#include "problem/error.h"
#include "tests/analytic/elastica/sweeps.h"

namespace ciliaval::analytic::elastica {
using namespace surroundings;
namespace {

using std::numbers::pi;

const Cilium paper{3e-3, {{"base", 3e-3, 1e5, 0.49, 0}, {"magnet", 17e-3, 3e6, 0.49, 75e3}}};
const Cilium uniform{2e-3, {{"rod", 20e-3, 1e6, 0.49, 0}}};

Surface step(double height, double friction) {
  return {TrapezoidProfile{
              .height = height, .top = 12e-3, .bottom = 12e-3, .flank = height, .radius = 0.5e-3},
          friction, 0};
}

std::vector<SurfacePlace> there_and_back(double height, double travel, int samples) {
  std::vector<SurfacePlace> places = straight_on(height, travel, samples);
  for (int i = samples - 1; i >= 0; --i) places.push_back({height, travel * i / samples});
  return places;
}

/// Work of the surface − friction − losses − change of the energy, over the surface's work.
double imbalance(const std::vector<SweepSample>& samples) {
  double sum = samples.front().contact.energy - samples.back().contact.energy;
  double total = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    sum += samples[i].surface_work - samples[i].friction_work;
    total += std::abs(samples[i].surface_work);
    for (const TipJump& jump : samples[i].jumps) sum -= jump.energy_lost;
  }
  return total > 0 ? std::abs(sum) / total : 0;
}

// ------------------------------------------------------------------------------ closed form

/// A uniform rod of length 1 whose rim, behind, slides on a flat surface. With φ = atan μ, ψ = θ +
/// φ and the force F: ψ″ = −F sin ψ, at the tip ψ′ = −F R cos ψ₁, so ψ′² = 2F (cos ψ − cos ψ_m),
/// cos ψ_m = cos ψ₁ − F R² cos² ψ₁/2: ψ grows from φ to ψ_m and falls to ψ₁. With k = sin(ψ_m/2),
/// sin α = sin(ψ/2)/k the parts from α to π/2 are elliptic integrals.
struct RimOnFlat {
  double height;
  double normal_force;
  double x;
  double base_moment;
};

RimOnFlat rim_on_flat(double mu, double rim, double tip_angle) {
  using boost::math::ellint_1;
  using boost::math::ellint_2;
  const double phi = std::atan(mu);
  const double last = tip_angle + phi;
  const auto modulus = [&](double force) {
    return std::sqrt((1 - std::cos(last)) / 2 + force * std::pow(rim * std::cos(last), 2) / 4);
  };
  const auto amplitude = [&](double psi, double k) { return std::asin(std::sin(psi / 2) / k); };
  const auto excess = [&](double force) {
    const double k = modulus(force);
    return 2 * ellint_1(k) - ellint_1(k, amplitude(phi, k)) - ellint_1(k, amplitude(last, k)) -
           std::sqrt(force);
  };
  std::uintmax_t most = 200;
  const auto [a, b] = boost::math::tools::toms748_solve(
      excess, 0.05, 12.0, boost::math::tools::eps_tolerance<double>(), most);
  const double force = std::midpoint(a, b);
  const double k = modulus(force);
  const double first_amplitude = amplitude(phi, k);
  const double last_amplitude = amplitude(last, k);
  const double E = 2 * ellint_2(k) - ellint_2(k, first_amplitude) - ellint_2(k, last_amplitude);
  const double cosines = 2 * E / std::sqrt(force) - 1;
  const double sines =
      2 * k / std::sqrt(force) * (std::cos(first_amplitude) + std::cos(last_amplitude));
  return {.height = std::cos(phi) * cosines + std::sin(phi) * sines + rim * std::sin(tip_angle),
          .normal_force = force * std::cos(phi),
          .x = std::cos(phi) * sines - std::sin(phi) * cosines,
          .base_moment = 2 * k * std::sqrt(force) * std::cos(first_amplitude)};
}

TEST(DiscEnd, SlidesOnItsRimAsTheEllipticIntegralsSay) {
  for (const double mu : {0.0, 0.1, 0.3, 0.6})
    for (const double angle : {0.4, 0.7, 0.9}) {
      TipProblem problem = tip_problem(uniform, CiliumEnd::disc);
      EXPECT_NEAR(problem.rim, 0.05, 1e-15);
      const RimOnFlat oracle = rim_on_flat(mu, problem.rim, angle);
      const auto samples =
          sweep(problem, {FlatProfile{}, mu, 0}, {{oracle.height, 0}, {oracle.height, 0.05}});
      const TipContact& contact = samples.back().contact;
      ASSERT_EQ(contact.touches.size(), 1U);
      EXPECT_EQ(contact.touches[0].where, TouchPoint::rim);
      EXPECT_EQ(contact.touches[0].side, -1);
      EXPECT_NEAR(contact.theta, angle, 1e-9);
      EXPECT_NEAR(contact.normal_force, oracle.normal_force, 1e-9);
      EXPECT_NEAR(contact.x, oracle.x, 1e-9);
      EXPECT_NEAR(contact.base_moment, oracle.base_moment, 1e-9);
    }
}

TEST(DiscEnd, IsAPointTipIfItIsThin) {
  const auto surface = step(1e-3, 0.3);
  TipProblem thin = tip_problem(paper);
  const auto point = sweep(thin, surface, straight_on(0.95, 0.6, 30));
  thin.rim = 1e-9;
  const auto disc = sweep(thin, surface, straight_on(0.95, 0.6, 30));
  for (std::size_t i = 0; i < point.size(); ++i) {
    EXPECT_NEAR(point[i].contact.contact_x, disc[i].contact.contact_x, 1e-7) << i;
    EXPECT_NEAR(point[i].contact.energy, disc[i].contact.energy, 1e-8) << i;
  }
}

// ------------------------------------------------------------------- independent integration

using State = std::array<double, 4>;  ///< θ, x, z, M

/// The rod under the contact's forces, by Runge–Kutta–Fehlberg 7(8): the state at the tip. Calls
/// each(S, θ, x, z) on the way.
State integrate_rod(const TipProblem& problem, const TipContact& contact,
                    const std::function<void(double, const State&)>& each) {
  namespace odeint = boost::numeric::odeint;
  std::vector<double> stops = problem.ends;
  double force_x = 0;
  double force_z = 0;
  for (const Touch& touch : contact.touches) {
    force_x += touch.force_x;
    force_z += touch.force_z;
    stops.push_back(touch.S);
  }
  for (int i = 1; i < 400; ++i) stops.push_back(i / 400.0);
  std::ranges::sort(stops);
  State state{0, 0, 0, contact.base_moment};
  const auto stepper =
      odeint::make_controlled(1e-14, 1e-14, odeint::runge_kutta_fehlberg78<State>());
  for (std::size_t i = 1; i < stops.size(); ++i) {
    if (stops[i] > stops[i - 1]) {
      const auto segment = std::ranges::lower_bound(problem.ends, stops[i]) - problem.ends.begin();
      const double f = problem.compliance[static_cast<std::size_t>(segment) - 1];
      odeint::integrate_adaptive(
          stepper,
          [&](const State& s, State& rate, double) {
            const double sine = std::sin(s[0]);
            const double cosine = std::cos(s[0]);
            rate = {f * s[3], sine, cosine, force_z * sine - force_x * cosine};
          },
          state, stops[i - 1], stops[i], (stops[i] - stops[i - 1]) / 2);
      each(stops[i], state);
    }
    for (const Touch& touch : contact.touches)
      if (touch.S < 1 && touch.S == stops[i]) {
        state[3] -= touch.force_x * (touch.z - state[2]) - touch.force_z * (touch.x - state[1]);
        force_x -= touch.force_x;
        force_z -= touch.force_z;
        stops[i] = std::nextafter(stops[i], 2.0);  // once
        break;
      }
  }
  return state;
}

/// Balance of the whole rod about the base; the shape and the free end by an independent
/// integration; the touching points on the surface, on the outline and within Coulomb's law; no
/// penetration of the face and the mantle.
void expect_equilibrium(const TipProblem& problem, const Surface& surface,
                        const SweepSample& sample) {
  const TipContact& contact = sample.contact;
  const auto gap = [&](double x, double z) {
    return sample.place.height - z -
           surface.at((x - sample.place.travel) * problem.length).height / problem.length;
  };
  double base = 0;
  for (const Touch& touch : contact.touches)
    base += touch.force_x * touch.z - touch.force_z * touch.x;
  EXPECT_NEAR(base, contact.base_moment, 1e-10);
  double deepest = 0;
  std::map<double, State> at;
  const State tip = integrate_rod(problem, contact, [&](double S, const State& s) {
    at[S] = s;
    for (const double a : {-problem.rim, problem.rim})
      deepest = std::min(deepest, gap(s[1] + a * std::cos(s[0]), s[2] - a * std::sin(s[0])));
  });
  for (int i = -50; i <= 50; ++i) {
    const double a = problem.rim * i / 50;
    deepest = std::min(deepest, gap(tip[1] + a * std::cos(tip[0]), tip[2] - a * std::sin(tip[0])));
  }
  EXPECT_GT(deepest, -2e-9);
  EXPECT_NEAR(tip[0], contact.theta, 1e-9);
  EXPECT_NEAR(tip[1], contact.x, 1e-9);
  EXPECT_NEAR(tip[2], contact.z, 1e-9);
  double moment = tip[3];
  for (const Touch& touch : contact.touches) {
    const bool on_mantle = touch.where == TouchPoint::mantle && touch.S < 1;
    const State& s = on_mantle ? at.at(touch.S) : tip;
    if (!on_mantle)
      moment -= touch.force_x * (touch.z - tip[2]) - touch.force_z * (touch.x - tip[1]);
    EXPECT_NEAR(gap(touch.x, touch.z), 0, 1e-10);
    EXPECT_NEAR(s[1] + touch.offset * std::cos(s[0]), touch.x, 1e-9);
    EXPECT_NEAR(s[2] - touch.offset * std::sin(s[0]), touch.z, 1e-9);
    const double beta =
        std::atan(surface.at((touch.x - sample.place.travel) * problem.length).slope);
    const double turned = touch.side * (beta - s[0]);
    if (touch.where == TouchPoint::rim) {
      EXPECT_GE(turned, -1e-9);
      EXPECT_LE(turned, pi / 2 + 1e-9);
    } else {
      EXPECT_NEAR(turned, on_mantle ? pi / 2 : 0, 1e-9);
    }
    const double normal = -std::sin(beta) * touch.force_x - std::cos(beta) * touch.force_z;
    const double friction = std::cos(beta) * touch.force_x - std::sin(beta) * touch.force_z;
    EXPECT_GE(normal, -1e-9);
    EXPECT_LE(std::abs(friction), surface.friction * normal + 1e-9);
    if (sample.state == TipState::slip && contact.touches.size() == 1) {
      EXPECT_NEAR(std::abs(friction), surface.friction * normal, 1e-9);
    }
  }
  EXPECT_NEAR(moment, 0, 1e-9);
}

const std::map<TouchPoint, std::string> names{{TouchPoint::tip, "tip"},
                                              {TouchPoint::rim, "rim"},
                                              {TouchPoint::face, "face"},
                                              {TouchPoint::mantle, "mantle"}};

std::string points_of(const TipContact& contact) {
  std::string points;
  for (const Touch& touch : contact.touches) points += names.at(touch.where) + " ";
  return points;
}

/// Plateaus with steep flanks, there and back: the disc touches with its rim, its face, its mantle,
/// and with two points at once.
TEST(DiscEnd, IsInEquilibriumWhateverTouches) {
  std::map<std::string, int> seen;
  const auto check = [&](const Cilium& cilium, const Surface& surface, double height) {
    const TipProblem problem = tip_problem(cilium, CiliumEnd::disc);
    const auto samples = sweep(problem, surface, there_and_back(height, 1.4, 140));
    EXPECT_LT(imbalance(samples), 1e-6);
    for (std::size_t i = 0; i < samples.size(); i += 3) {
      SCOPED_TRACE(i);
      if (samples[i].state == TipState::open) continue;
      ++seen[points_of(samples[i].contact)];
      expect_equilibrium(problem, surface, samples[i]);
    }
  };
  check(paper, step(2.5e-3, 0.2), 0.9);
  check(paper, step(1.5e-3, 0.4), 0.95);
  check(uniform, step(2.5e-3, 0.3), 0.9);
  check(uniform, {SineProfile{0.8e-3, 11e-3}, 0.4, 0}, 0.96);
  check(paper, {SineProfile{0.5e-3, 6e-3}, 0.2, 0}, 0.93);
  const Cilium thick{3e-3, {{"rod", 20e-3, 1e6, 0.49, 0}}};
  check(thick, {TrapezoidProfile{2.77e-3, 14.2e-3, 13.5e-3, 1.85e-3, 0.362e-3}, 0.48, 0}, 0.895);
  check(paper, {TrapezoidProfile{2.79e-3, 6.48e-3, 10.8e-3, 0.731e-3, 0.214e-3}, 0.55, 0}, 0.963);
  for (const auto& [points, count] : seen) std::cout << points << ": " << count << "\n";
  EXPECT_GT(seen["rim "], 0);
  EXPECT_GT(seen["face "], 0);
  EXPECT_GT(seen["mantle "], 0);
  const auto two = std::ranges::count_if(
      seen, [](const auto& entry) { return std::ranges::count(entry.first, ' ') == 2; });
  EXPECT_GT(two, 0);
}

// ---------------------------------------------------------------------------- derivatives

/// Derivatives of the forces by the surface's place and by the slip, against differences of
/// solutions.
TEST(DiscEnd, HasTheDerivativesOfItsSolutions) {
  const TipProblem problem = tip_problem(paper, CiliumEnd::disc);
  const Surface surface = step(2.5e-3, 0.2);
  std::map<std::string, int> seen;
  const auto samples = sweep(problem, surface, there_and_back(0.9, 1.4, 70));
  for (const SweepSample& sample : samples) {
    if (sample.state != TipState::slip || seen[points_of(sample.contact)] > 3) continue;
    const double direction = sample.contact.friction_force < 0 ? -1 : 1;
    const double h = 1e-6;
    const auto slide = [&](double travel, double height) {
      return sliding(problem, surface, {sample.place.height + height, sample.place.travel + travel},
                     direction, sample.contact);
    };
    const auto move = [&](double slip) {
      return solve_contact(problem, surface, sample.place, {FrictionLaw::Kind::moved, slip},
                           sample.contact);
    };
    const auto here = slide(0, 0);
    ASSERT_TRUE(here);
    const auto further = slide(2 * h, 0);
    const auto bend_of = [&](const TipContact& contact, double travel) {
      return surface.at((contact.touches[0].x - travel) * problem.length).curvature;
    };
    if (!further || (bend_of(*further, sample.place.travel + 2 * h) == 0) !=
                        (bend_of(*here, sample.place.travel) == 0))
      continue;  // beyond a jump of the curvature
    ++seen[points_of(sample.contact)];
    SCOPED_TRACE(points_of(sample.contact));
    const double size = 1 + here->force_x_by_place.norm() + here->force_z_by_place.norm();
    EXPECT_NEAR((slide(h, 0)->force_x - slide(-h, 0)->force_x) / (2 * h), here->force_x_by_place[0],
                1e-5 * size);
    EXPECT_NEAR((slide(0, h)->force_z - slide(0, -h)->force_z) / (2 * h), here->force_z_by_place[1],
                1e-5 * size);
    EXPECT_NEAR((slide(h, 0)->touches[0].slip - slide(-h, 0)->touches[0].slip) / (2 * h),
                here->touches[0].slip_by_place[0], 1e-5 * size);
    if (here->touches.size() > 1) continue;
    const double slope = 1 + std::abs(here->normal_slope) + std::abs(here->friction_slope);
    EXPECT_NEAR((move(h)->normal_force - move(-h)->normal_force) / (2 * h), here->normal_slope,
                1e-5 * slope);
    EXPECT_NEAR((move(h)->friction_force - move(-h)->friction_force) / (2 * h),
                here->friction_slope, 1e-5 * slope);
  }
  EXPECT_GT(seen["rim "], 0);
  EXPECT_GT(seen["mantle "], 0);
}

// ----------------------------------------------------------------------------------- paths

/// The place of the jumps and their energies, whatever the samples.
TEST(DiscEnd, DoesNotDependOnTheSamples) {
  const auto places = [](const std::vector<SweepSample>& samples) {
    std::vector<double> at;
    for (std::size_t i = 1; i < samples.size(); ++i)
      for (const TipJump& jump : samples[i].jumps)
        at.push_back(std::lerp(samples[i - 1].place.travel, samples[i].place.travel, jump.at));
    return at;
  };
  for (const double friction : {0.0, 0.3}) {
    const TipProblem problem = tip_problem(paper, CiliumEnd::disc);
    const Surface surface = step(1e-3, friction);
    const auto few = sweep(problem, surface, straight_on(0.95, 2.8, 28));
    const auto many = sweep(problem, surface, straight_on(0.95, 2.8, 700));
    ASSERT_EQ(jumps(few).size(), 3U);
    ASSERT_EQ(jumps(many).size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(places(few)[i], places(many)[i], 2e-8);
      EXPECT_NEAR(jumps(few)[i].energy_lost, jumps(many)[i].energy_lost, 1e-8);
    }
    EXPECT_NEAR(few.back().contact.energy, many.back().contact.energy, 1e-9);
    EXPECT_LT(imbalance(few), 1e-7);
    EXPECT_LT(imbalance(many), 1e-7);
  }
}

/// A surface that comes back: the tip sticks, the rod snaps through and is dragged the other way,
/// to the mirror image of where it was.
TEST(DiscEnd, SnapsThroughWhenTheSurfaceComesBack) {
  for (const Cilium& cilium : {paper, uniform}) {
    const auto samples = sweep(tip_problem(cilium, CiliumEnd::disc), {FlatProfile{}, 0.3, 0},
                               there_and_back(0.97, 1.5, 100));
    EXPECT_NEAR(samples.back().contact.x, -samples.front().contact.x, 1e-9);
    EXPECT_NEAR(samples.back().contact.normal_force, samples.front().contact.normal_force, 1e-8);
    EXPECT_LT(imbalance(samples), 1e-6);
    EXPECT_GE(jumps(samples).size(), 1U);
    for (const TipJump& jump : jumps(samples)) EXPECT_GT(jump.energy_lost, 0);
  }
}

struct RandomCase {
  Cilium cilium;
  Surface surface;
  std::vector<SurfacePlace> places;
};

/// Sines, noise and plateaus, friction 0 to 0.6, interference 0.2 to 3 mm; half of them come back.
RandomCase random_case(unsigned seed) {
  std::mt19937 generator(1000 + seed);
  const auto uniformly = [&](double a, double b) {
    return std::lerp(a, b, (static_cast<double>(generator()) + 0.5) / 4294967296.0);
  };
  RandomCase result{seed % 2 == 0 ? paper : uniform, {}, {}};
  result.surface.friction = seed % 7 == 0 ? 0 : uniformly(0, 0.6);
  const double height = 1 - uniformly(0.2e-3, 3e-3) / 20e-3;
  result.places = seed % 4 < 2 ? straight_on(height, 2, 100) : there_and_back(height, 1.5, 75);
  if (seed % 3 == 0) {
    const double wavelength = uniformly(3e-3, 40e-3);
    result.surface.profile =
        SineProfile{std::min(3e-3, uniformly(0.005, 0.15) * wavelength), wavelength};
  } else if (seed % 3 == 1) {
    const double longest = uniformly(10e-3, 40e-3);
    result.surface.profile = RandomProfile({.rms = uniformly(0.02e-3, 0.3e-3),
                                            .hurst = uniformly(0.5, 1),
                                            .longest = longest,
                                            .shortest = longest / uniformly(4, 20),
                                            .seed = seed});
  } else {
    result.surface.profile = TrapezoidProfile{.height = uniformly(0.2e-3, 3e-3),
                                              .top = uniformly(6e-3, 15e-3),
                                              .bottom = uniformly(6e-3, 15e-3),
                                              .flank = uniformly(0.8e-3, 3e-3),
                                              .radius = uniformly(0.2e-3, 0.5e-3)};
  }
  return result;
}

/// Every sweep completes and balances its energy, but for `most_failures` that end in an error.
void expect_random_cases(unsigned first, unsigned last, int most_failures) {
  std::vector<double> balances;
  std::size_t count = 0;
  std::ptrdiff_t unfollowed = 0;
  int failures = 0;
  for (unsigned seed = first; seed < last; ++seed) {
    const RandomCase random = random_case(seed);
    try {
      const auto samples =
          sweep(tip_problem(random.cilium, CiliumEnd::disc), random.surface, random.places);
      balances.push_back(imbalance(samples));
      EXPECT_LE(balances.back(), 1e-6) << seed;
      const auto all = jumps(samples);
      count += all.size();
      unfollowed += std::ranges::count(all, false, &TipJump::is_followed);
    } catch (const SolverError& error) {
      ++failures;
      std::cout << "seed " << seed << ": " << error.what() << "\n";
    }
  }
  std::ranges::sort(balances);
  std::cout << balances.size() << " sweeps, " << failures << " failed; " << count << " jumps, "
            << unfollowed << " not followed; imbalance";
  for (const double q : {0.5, 0.9, 0.99, 1.0})
    std::cout
        << " q" << q << " "
        << balances[std::min(balances.size() - 1,
                             static_cast<std::size_t>(q * static_cast<double>(balances.size())))];
  std::cout << "\n";
  EXPECT_LE(failures, most_failures);
}

TEST(DiscEnd, CompletesSweepsOverRandomSurfaces) {
  expect_random_cases(0, 20, 0);
}

TEST(DiscEndSlow, CompletesSweepsOverRandomSurfaces) {
  expect_random_cases(20, 60, 0);
  expect_random_cases(60, 600, 16);  // 3 %; measured: 5 of some 300
}

}  // namespace
}  // namespace ciliaval::analytic::elastica

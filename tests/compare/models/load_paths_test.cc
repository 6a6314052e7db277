// SPDX-License-Identifier: LGPL-2.1-or-later
// Mixed load paths: azimuths, heights, environments and load types in any order, forces up and
// down. Oracle: each load alone, from rest. Sweeps have a history, by friction
// (docs/theory/sweep.md), and are not among them.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "analytic/elastica/elastica.h"
#include "fem/beam/beam.h"
#include "fem/calculix/calculix_model.h"
#include "fem/solid/solid.h"

namespace ciliaval {
namespace {

using std::numbers::pi;
using surroundings::Environment;

/// A soft base below a magnet; all of one magnetic rubber.
Cilium stub_and_magnet() {
  return {3e-3, {{"base", 3e-3, 0.1e6, 0.49, 0, 1000}, {"magnet", 17e-3, 3e6, 0.49, 75e3, 1700}}};
}
Cilium thin_magnet() {
  return {1e-3, {{"rod", 20e-3, 1e6, 0.49, 100e3, 1500}}};
}

/// Status, slip-off force and tip of each step are those of its load alone, within the stated
/// uncertainties of both.
void expect_no_history(const MechanicsModel& model, const Cilium& cilium, const LoadPath& path) {
  const MechanicsResult result = model.solve(cilium, path);
  ASSERT_EQ(result.steps.size(), path.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    SCOPED_TRACE("step " + std::to_string(i + 1) + ", " + std::string(type(path[i])));
    const MechanicsStep& step = result.steps[i];
    const MechanicsStep alone = model.solve(cilium, {path[i]}).steps.at(0);
    ASSERT_EQ(step.status, alone.status) << step.message << " | " << alone.message;
    ASSERT_EQ(step.slip_off_force.has_value(), alone.slip_off_force.has_value());
    if (step.slip_off_force) {
      const double force = *alone.slip_off_force;
      const double bracket = step.slip_off_uncertainty.value_or(0.01 * force);
      EXPECT_NEAR(*step.slip_off_force, force,
                  bracket + alone.slip_off_uncertainty.value_or(0.01 * force));
    }
    if (step.status != Status::converged) continue;
    const double L = cilium.length();
    const Vector3 tip = step.deformation->centreline.at(L).position;
    const Vector3 exact = alone.deformation->centreline.at(L).position;
    EXPECT_LE((tip - exact).norm(),
              step.tip_uncertainty.value_or(0) + alone.tip_uncertainty.value_or(0) + 1e-12 * L);
  }
}

/// Six loads at two heights and in two directions, in two environments or none.
class RandomPath {
 public:
  explicit RandomPath(unsigned int seed) : engine_(seed) {}

  Cilium cilium() { return part() < 0.5 ? stub_and_magnet() : thin_magnet(); }

  /// `kind` is a type of load, or beyond them a mixture. For the elastica the environment lies in
  /// the plane of the load.
  LoadPath loads(int kind, const Cilium& cilium, bool is_planar) {
    const bool is_thin = cilium.segments.size() == 1;
    const double largest_force = is_thin ? 0.3e-3 : 9e-3;
    const double largest_field = is_thin ? 2e-3 : 10e-3;
    const std::array heights{between(4e-3, 19e-3), between(4e-3, 19e-3)};
    const std::array azimuths{between(-pi, pi), between(-pi, pi)};
    std::array<Environment, 3> environments;
    for (std::size_t k = 0; k < 2; ++k) {
      environments[k].gravity = (is_thin ? 1.0 : 10.0) * vector();
      environments[k].uniform_field = largest_field * vector();
    }
    LoadPath path;
    for (int i = 0; i < 6; ++i) {
      const double azimuth = azimuths[below(2)];
      const double height = heights[below(2)];
      const double force = part() * largest_force;
      Load load;
      switch (kind < types ? kind : static_cast<int>(below(types))) {
        case 0:
          load = ContactLoad{force, height, azimuth};
          break;
        case 1:
          load = ProbeLoad{between(0, 12e-3), height, azimuth};
          break;
        case 2:
          load = FlowLoad{100 * force, azimuth};
          break;
        case 3:
          load = SectionLoad{2 * force, height, azimuth};
          break;
        case 4:
          load = DeadLoad{100 * force, azimuth};
          break;
        default:
          load = EnvironmentLoad{between(0, 2), azimuth};
      }
      Environment environment = environments[below(3)];
      if (is_planar)
        for (Vector3* v : {&environment.gravity, &environment.uniform_field})
          *v = v->dot(direction(load)) * direction(load) + v->z() * Vector3::UnitZ();
      load.set_environment(environment);
      path.push_back(load);
    }
    return path;
  }

  static constexpr int types = 6;

 private:
  double part() { return std::uniform_real_distribution<double>(0, 1)(engine_); }
  double between(double a, double b) { return std::lerp(a, b, part()); }
  std::size_t below(std::size_t n) { return engine_() % n; }
  Vector3 vector() { return {between(-1, 1), between(-1, 1), between(-1, 1)}; }

  std::mt19937 engine_;
};

void expect_no_history_on_random_paths(const MechanicsModel& model, bool is_planar,
                                       unsigned int paths) {
  for (unsigned int seed = 0; seed < paths; ++seed)
    for (int kind = 0; kind <= RandomPath::types; ++kind) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", kind " + std::to_string(kind));
      RandomPath random(100 * seed + static_cast<unsigned int>(kind));
      const Cilium cilium = random.cilium();
      expect_no_history(model, cilium, random.loads(kind, cilium, is_planar));
    }
}

TEST(LoadPaths, StepsOfTheElasticaDoNotDependOnThoseBefore) {
  expect_no_history_on_random_paths(analytic::elastica::Elastica(), true, 12);
}

TEST(LoadPaths, StepsOfTheBeamDoNotDependOnThoseBefore) {
  expect_no_history_on_random_paths(fem::beam::Beam({.error_estimate = false}), false, 2);
}

// The slip-off force in a field is another one for each direction and each field, also at the same
// height: 6 mN slips off along the field, and not against it.
TEST(LoadPaths, ASlipOffOfTheBeamIsThatOfItsDirectionAndEnvironment) {
  const Environment along{.uniform_field = {5e-3, 0, 0}};
  LoadPath path;
  for (const double azimuth : {0.0, pi, 0.0})
    path.push_back(with_environment(ContactLoad{6e-3, 16e-3, azimuth}, along));
  path.push_back(with_environment(ContactLoad{6e-3, 16e-3, 0}, {.uniform_field = {-5e-3, 0, 0}}));
  path.emplace_back(ContactLoad{6e-3, 16e-3, 0});
  const fem::beam::Beam beam;
  expect_no_history(beam, stub_and_magnet(), path);
  const MechanicsResult result = beam.solve(stub_and_magnet(), path);
  EXPECT_EQ(result.steps[0].status, Status::slipped_off);
  EXPECT_EQ(result.steps[1].status, Status::converged) << result.steps[1].message;
  EXPECT_EQ(result.steps[2].status, Status::slipped_off);
  EXPECT_EQ(result.steps[3].status, Status::converged) << result.steps[3].message;
}

// A tip that the field has turned beyond the axis stays there if the field comes round slowly; from
// rest it goes the short way. The beam and the elastica state the latter.
TEST(LoadPaths, AFieldThatTurnsRoundLeavesNoHistory) {
  LoadPath path;
  for (const double degrees : {90.0, 150.0, 175.0, -175.0, -150.0, 60.0}) {
    const double angle = degrees * pi / 180;
    path.push_back(
        with_environment(EnvironmentLoad{},
                         {.uniform_field = 10e-3 * Vector3(std::sin(angle), 0, std::cos(angle))}));
  }
  expect_no_history(analytic::elastica::Elastica(), thin_magnet(), path);
  expect_no_history(fem::beam::Beam(), thin_magnet(), path);
}

TEST(LoadPaths, StepsOfTheSolidDoNotDependOnThoseBefore) {
  const Environment one{.gravity = {3, 0, -9.81}, .uniform_field = {3e-3, 0, -2e-3}};
  const Environment other{.gravity = {0, 0, -9.81}, .uniform_field = {-4e-3, 0, -2e-3}};
  const fem::solid::Solid solid({.refinement = 0});
  LoadPath contacts;
  for (const auto& [force, height, azimuth, environment] :
       std::vector<std::tuple<double, double, double, Environment>>{{3e-3, 16e-3, 0, {}},
                                                                    {9e-3, 16e-3, 0, {}},
                                                                    {2e-3, 16e-3, 0, one},
                                                                    {3e-3, 16e-3, pi, one},
                                                                    {1e-3, 16e-3, pi, other},
                                                                    {2e-3, 12e-3, pi, {}}})
    contacts.push_back(with_environment(ContactLoad{force, height, azimuth}, environment));
  expect_no_history(solid, stub_and_magnet(), contacts);
  LoadPath alone;
  for (const Environment& environment : {one, other, one})
    alone.push_back(with_environment(EnvironmentLoad{}, environment));
  expect_no_history(solid, stub_and_magnet(), alone);
}

TEST(LoadPaths, StepsOfCalculixDoNotDependOnThoseBefore) {
  if (std::system("command -v ccx > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "CalculiX is not installed: apt-get install calculix-ccx";
  expect_no_history(fem::calculix::Calculix({.refinement = 0}), stub_and_magnet(),
                    {DeadLoad{0.2, 0}, DeadLoad{0.05, pi / 2}, DeadLoad{0.1, 0}});
}

}  // namespace
}  // namespace ciliaval

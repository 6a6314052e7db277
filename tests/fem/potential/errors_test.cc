// SPDX-License-Identifier: LGPL-2.1-or-later
// Problems that cannot be computed are refused with a message, before anything is solved where
// possible.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "bodies.h"
#include "fem/potential/adaptive.h"
#include "fem/potential/potential.h"
#include "problem/error.h"

namespace ciliaval::fem::potential {
namespace {

using testing::HasSubstr;

template <typename Error>
std::string message_of(const PotentialOptions& options, const Vector3& point,
                       const Cilium& cilium = test::paper_cilium()) {
  try {
    Potential(options).field(cilium, test::arc(0), std::span(&point, 1));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(BadInput, ASensorInTheMagnetOrInALeafThatItCutsIsRefused) {
  EXPECT_THAT(message_of<InputError>({}, {0, 0, 10e-3}), HasSubstr("lies in the magnet"));
  EXPECT_THAT(message_of<InputError>({}, {1.5005e-3, 0, 10e-3}), HasSubstr("leaf"));
  EXPECT_THAT(message_of<InputError>({}, {0, std::numeric_limits<double>::quiet_NaN(), 0}),
              HasSubstr("not finite"));
}

TEST(BadInput, APermeabilityThatIsNotPositiveIsRefused) {
  for (const double mu : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                          std::numeric_limits<double>::infinity()}) {
    PotentialOptions options;
    options.relative_permeability = mu;
    EXPECT_THAT(message_of<InputError>(options, test::paper_sensor()),
                HasSubstr("must be finite and positive"));
    options = {};
    options.plates = {{{Vector3(-1e-2, -1e-2, -5e-3), Vector3(1e-2, 1e-2, -3e-3)}, mu}};
    EXPECT_THAT(message_of<InputError>(options, test::paper_sensor()),
                HasSubstr("must be finite and positive"));
  }
}

TEST(BadInput, APlateThatMeetsAnotherBodyIsRefused) {
  PotentialOptions options;
  const PermeableBox below{{Vector3(-1e-2, -1e-2, -5e-3), Vector3(1e-2, 1e-2, -3e-3)}, 2};
  options.plates = {below, below};
  EXPECT_THAT(message_of<InputError>(options, test::paper_sensor()), HasSubstr("overlap"));
  // A corner of the plate reaches into the magnet, its centre does not.
  options.plates = {{{Vector3(0, 0, 19e-3), Vector3(1e-1, 1e-1, 1e-1)}, 2}};
  EXPECT_THAT(message_of<InputError>(options, test::paper_sensor()), HasSubstr("overlap"));
  options.plates = {{{Vector3(0, 0, 0), Vector3(1e-2, -1e-2, 1e-2)}, 2}};
  EXPECT_THAT(message_of<InputError>(options, test::paper_sensor()), HasSubstr("upper corner"));
  options.plates = {below};
  EXPECT_THAT(message_of<InputError>(options, {0, 0, -4e-3}), HasSubstr("a plate"));
}

TEST(BadInput, ACiliumWithoutAMagnetIsRefused) {
  Cilium cilium = test::paper_cilium();
  cilium.segments[1].magnetization = 0;
  EXPECT_THAT(message_of<InputError>({}, test::paper_sensor(), cilium), HasSubstr("magnetised"));
}

TEST(BadInput, AnAccuracyThatCannotBeReachedIsAnError) {
  PotentialOptions options;
  options.tolerance = 1e-7;
  options.max_unknowns = 20000;
  EXPECT_THAT(message_of<SolverError>(options, test::paper_sensor()),
              HasSubstr("allow more unknowns"));
}

/// The paper's straight cilium over a plate.
PotentialProblem over_a_plate(double plate, double magnet) {
  PotentialProblem problem;
  problem.magnet = Magnet(test::paper_cilium(), test::arc(0), MagnetPushForward::F);
  problem.relative_permeability = magnet;
  problem.plates = std::make_shared<const plates::Plates>(std::vector<PermeableBox>{
      {{Vector3(-1e-2, -1e-2, -6e-3), Vector3(1e-2, 1e-2, -4e-3)}, plate}});
  problem.points = {{0, 0, -2.1e-3}};
  return problem;
}

// A tolerance that cannot be kept: the work ends, for more of it would not make the error known.
TEST(UntestedPermeability, HasNoUncertaintyAndBoundedWork) {
  PotentialControl control;
  control.tolerance = 1e-6;
  control.untested_unknowns = 3000;
  for (const auto& [plate, magnet] : {std::pair(4000.0, 2.1), std::pair(1.0, 2.1)}) {
    const PotentialProblem problem = over_a_plate(plate, magnet);
    EXPECT_TRUE(has_untested_jump(problem));
    const PotentialResult result = solve_potential(problem, control);
    EXPECT_TRUE(result.uncertainty.empty());
    EXPECT_TRUE(result.B.at(0).allFinite());
    for (std::size_t i = 0; i + 1 < result.cycles.size(); ++i)
      EXPECT_LE(result.cycles[i].unknowns, control.untested_unknowns);
  }
}

TEST(UntestedPermeability, BeginsBeyondTheTestedOnes) {
  PotentialControl control;
  control.tolerance = 0.2;
  const PotentialProblem problem = over_a_plate(4000, largest_tested_jump);
  EXPECT_FALSE(has_untested_jump(problem));
  EXPECT_EQ(solve_potential(problem, control).uncertainty.size(), 1U);
}

TEST(UntestedPermeability, IsSaidWithTheField) {
  PotentialOptions options;
  options.tolerance = 0.1;
  options.relative_permeability = 3;
  const Vector3 point = test::paper_sensor();
  const auto field_of = [&] {
    return Potential(options).field(test::paper_cilium(), test::arc(0), std::span(&point, 1));
  };
  const Field field = field_of();
  EXPECT_TRUE(field.uncertainty.empty());
  EXPECT_THAT(field.remark, HasSubstr("not known"));
  EXPECT_THAT(field.remark, HasSubstr("relative_permeability"));
  options.relative_permeability = 1.05;
  EXPECT_EQ(field_of().remark, "");
  EXPECT_EQ(field_of().uncertainty.size(), 1U);
}

}  // namespace
}  // namespace ciliaval::fem::potential

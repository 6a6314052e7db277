// SPDX-License-Identifier: LGPL-2.1-or-later
// What cannot be computed is refused with a message, before anything is solved where possible.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "bodies.h"
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

}  // namespace
}  // namespace ciliaval::fem::potential

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tools/end_problem/excess.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "problem/error.h"

namespace ciliaval::tools::end_problem {
namespace {

constexpr double EA = std::numbers::pi / 4;
constexpr double EI = EA / 16;

// Saint-Venant's solution is exact where nothing hinders it.
TEST(EndProblem, ABarOfOneMaterialHasNoExcess) {
  for (const double nu : {0.0, 0.3, 0.49}) {
    const Excess e = excess({{2, 1, nu}, {2, 1, nu}}, Base::free, 1.3);
    EXPECT_NEAR(e.rotation * EI, 0, 1e-9) << nu;
    EXPECT_NEAR(e.coupling * EI, 0, 1e-9) << nu;
    EXPECT_NEAR(e.displacement * EI, 0, 1e-9) << nu;
    EXPECT_NEAR(e.extension * EA, 0, 1e-10) << nu;
  }
}

// Without Poisson's effect a clamp hinders the warping by shear alone.
TEST(EndProblem, AClampWithoutPoissonsEffect) {
  const Excess e = excess({{2, 1, 0}}, Base::clamped, 0);
  EXPECT_NEAR(e.rotation * EI, 0, 1e-10);
  EXPECT_NEAR(e.coupling * EI, 0, 1e-10);
  EXPECT_NEAR(e.extension * EA, 0, 1e-10);
  EXPECT_LT(e.displacement * EI, -1e-3);
}

// The complementary energy is least in the true state, and Saint-Venant's is in balance where
// Poisson's ratio, and so its shear stress, is the same on both sides.
TEST(EndProblem, TheExcessIsNegative) {
  for (const double nu : {0.1, 0.45})
    for (const double t : {0.02, 0.5}) {
      const Excess e = excess({{2, 1, nu}, {2, 1 / t, nu}}, Base::free, 2);
      EXPECT_LT(e.rotation, 0);
      EXPECT_LT(e.extension, 0);
      EXPECT_GT(e.rotation * e.displacement, e.coupling * e.coupling);
    }
}

// A stack seen from above is the stack seen from below.
TEST(EndProblem, AStackUpsideDown) {
  const Excess a = excess({{2, 1, 0.45}, {2, 8, 0.3}}, Base::free, 1.5);
  const Excess b = excess({{2, 8, 0.3}, {2, 1, 0.45}}, Base::free, 2.5);
  EXPECT_NEAR(a.rotation * EI, b.rotation * EI, 1e-9);
  EXPECT_NEAR(a.coupling * EI, -b.coupling * EI, 1e-9);
  EXPECT_NEAR(a.displacement * EI, b.displacement * EI, 1e-9);
  EXPECT_NEAR(a.extension * EA, b.extension * EA, 1e-9);
}

// Bonded discs of incompressible rubber, by the parabolic pressure of their theory, which is exact
// for thin ones: compression E (1 + 2 S²) (Gent & Lindley, Proc. Inst. Mech. Eng. 173, 1959), tilt
// E (1 + 2 S²/3) (Gent & Meinecke, Polymer Eng. Sci. 10, 1970), S = d/4L.
TEST(EndProblem, AThinBondedDisc) {
  constexpr double L = 0.04;
  constexpr double S = 1 / (4 * L);
  const Excess e = excess({{L, 1, 0.4999999}, {1, 1e6, 0.3}}, Base::clamped, L / 2);
  const double stretch = e.extension * EA + L;
  const double tilt = e.rotation * EI + L;
  EXPECT_NEAR(L / stretch, 1 + 2 * S * S, 0.05 * 2 * S * S);
  EXPECT_NEAR(L / tilt, 1 + 2 * S * S / 3, 0.05 * 2 * S * S / 3);
}

// 5e-6 d/EI, 1e-4 of a clamp of rubber.
TEST(EndProblem, FinerElementsAgree) {
  for (const double nu : {0.3, 0.4999}) {
    const std::vector<Bar> bars{{0.5, 1, nu}, {2, 30, 0.45}};
    const Excess a = excess(bars, Base::clamped, 0.25);
    const Excess b = excess(bars, Base::clamped, 0.25, {5, 6, 0.2});
    EXPECT_NEAR(a.rotation * EI, b.rotation * EI, 2e-5) << nu;
    EXPECT_NEAR(a.coupling * EI, b.coupling * EI, 2e-5) << nu;
    EXPECT_NEAR(a.displacement * EI, b.displacement * EI, 2e-5) << nu;
    EXPECT_NEAR(a.extension * EA, b.extension * EA, 2e-5) << nu;
  }
}

TEST(EndProblem, RefusesWhatIsNoBar) {
  EXPECT_THROW(excess({}, Base::free, 0), InputError);
  EXPECT_THROW(excess({{0, 1, 0.3}}, Base::free, 0), InputError);
  EXPECT_THROW(excess({{1, -1, 0.3}}, Base::free, 0), InputError);
  EXPECT_THROW(excess({{1, 1, 0.5}}, Base::free, 0), InputError);
}

}  // namespace
}  // namespace ciliaval::tools::end_problem

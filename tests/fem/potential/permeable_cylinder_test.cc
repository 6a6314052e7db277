// SPDX-License-Identifier: LGPL-2.1-or-later
// The oracle of the permeable cylinder against what is known of it.
#include "permeable_cylinder.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "bodies.h"
#include "tests/analytic/oracles/derby_olbert.h"

namespace ciliaval::oracle {
namespace {

using test::R;

// Oracle: Derby & Olbert for mu_r = 1, where the charge is known and the kernel of a ring is
// integrated alone. Measured 1e-15.
TEST(PermeableCylinder, WithoutSusceptibilityIsDerbyAndOlberts) {
  const PermeableCylinder cylinder(75e3, 1, R, 3e-3, 20e-3, {});
  for (const Vector3& x :
       {test::paper_sensor(), Vector3(2e-3, 1e-3, 12e-3), Vector3(0, 0, 25e-3)}) {
    const Vector3 exact = derby_olbert(75e3, R, 3e-3, 20e-3, x);
    EXPECT_LT((cylinder.B(x) - exact).norm(), 1e-12 * exact.norm());
  }
}

// Its own convergence: halvings of the panels at the edge, and points on each. Measured 2e-6, 2e-9
// and 9e-12 of the finest.
TEST(PermeableCylinder, ConvergesToElevenDigits) {
  const Vector3 x = test::paper_sensor();
  const auto B = [&](PermeableCylinder::Resolution resolution) {
    return PermeableCylinder(75e3, 1.05, R, 3e-3, 20e-3, resolution).B(x);
  };
  const Vector3 finest = B({32, 10});
  double last = 1e-5;
  for (const auto& resolution : {PermeableCylinder::Resolution{8, 4}, {16, 8}, {24, 8}}) {
    const double error = (B(resolution) - finest).norm() / finest.norm();
    std::printf("%d halvings, %d points: %.1e\n", resolution.halvings, resolution.points, error);
    EXPECT_LT(error, last);
    last = error / 50;
  }
  std::printf("B_z = %.7f uT\n", finest[2] * 1e6);
}

// Oracle: inside of a thin plate magnetised across, B = 0 and H = -M/mu_r, so that its charge is
// M n/mu_r; what is left falls with its thickness. Checks sign and size of the term in mu_r - 1.
TEST(PermeableCylinder, ThinPlateCarriesTheChargeOfAPlate) {
  double last = 0.05;
  for (const double thickness : {0.1, 0.03, 0.01}) {
    const PermeableCylinder plate(1, 3, 1, 0, thickness, {});
    const double error = std::abs(plate.charge_at_centre() * -3 - 1);
    EXPECT_LT(error, last);
    last = error / 2;
  }
}

}  // namespace
}  // namespace ciliaval::oracle

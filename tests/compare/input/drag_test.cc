// SPDX-License-Identifier: LGPL-2.1-or-later
// The drag of a cylinder at its Reynolds number, as a case states it.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "compare/input/case.h"
#include "problem/error.h"
#include "problem/load.h"
#include "tests/support/same_case.h"

namespace ciliaval::compare {
namespace {

input::Case case_of_flow(const std::string& keys) {
  return read(
      "[case]\nname = \"a\"\n[cilium]\ndiameter = \"3 mm\"\n[[cilium.segment]]\n"
      "name = \"rod\"\nlength = \"20 mm\"\nyoung_modulus = \"1 MPa\"\n"
      "poisson_ratio = 0.49\n[load]\ntype = \"flow\"\n" +
      keys + "[models]\nmechanics = [\"elastica\"]\n");
}

TEST(Drag, OfACylinderFollowsItsReynoldsNumber) {
  // Oracle: the curve of measurements that textbooks show (Schlichting, Boundary-Layer Theory),
  // read to 5 %; the correlation's own scatter about it is 10 %.
  const std::vector<std::pair<double, double>> measured{{1, 10.2},  {10, 2.8},  {100, 1.4},
                                                        {1e3, 1.0}, {1e4, 1.1}, {1e5, 1.2}};
  for (const auto& [Re, C_d] : measured)
    EXPECT_NEAR(cylinder_drag_coefficient(Re), C_d, 0.1 * C_d) << Re;
  for (const double beyond : {0.0, 3e5})
    EXPECT_THROW(cylinder_drag_coefficient(beyond), InputError);
  // Re = 900 kg/m³ · v · 3 mm/(9 mPa s) = 300 v s/m.
  const input::Case c = case_of_flow(
      "velocity = [\"0 m/s\", \"0.5 m/s\", \"0.5 m/s\"]\ndensity = \"0.9 g/cm3\"\n"
      "drag_coefficient = [\"cylinder\", \"cylinder\", 1.2]\nviscosity = \"9 mPa s\"\n");
  const auto q = [&](std::size_t i) { return c.load_path[i].as<FlowLoad>()->force_per_height; };
  EXPECT_EQ(q(0), 0);
  EXPECT_NEAR(q(1), 0.5 * 900 * 0.25 * cylinder_drag_coefficient(150) * 3e-3, 1e-15);
  EXPECT_NEAR(q(2), 0.5 * 900 * 0.25 * 1.2 * 3e-3, 1e-15);
  expect_read_back(c);
}

}  // namespace
}  // namespace ciliaval::compare

// SPDX-License-Identifier: LGPL-2.1-or-later
// The solid's sweep against CalculiX's contact, another program with another element.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "fem/solid/solid.h"
#include "tests/fem/calculix/sweep_deck.h"
#include "tests/support/temporary_folder.h"

namespace ciliaval::fem::calculix {
namespace {

using namespace surroundings;

const Cilium paper{3e-3, {{"base", 3e-3, 1e5, 0.49, 0}, {"magnet", 17e-3, 3e6, 0.49, 75e3}}};

bool has_ccx() {
  return std::system("command -v ccx > /dev/null 2>&1") == 0;
}

std::vector<RefereeState> solid_sweep(const RefereeSweep& sweep) {
  solid::SolidOptions options;
  options.refinement = sweep.refinement;
  const Load start(SweepLoad{sweep.interference, sweep.travels.front(), 0.01, 0},
                   std::make_shared<const Surface>(sweep.surface));
  std::vector<RefereeState> states;
  for (const MechanicsStep& step :
       solid::Solid(options)
           .solve(paper, sweep_path(start, {sweep.travels.back(), sweep.travels.size()}))
           .steps) {
    EXPECT_EQ(step.status, Status::converged) << step.message;
    if (!step.contact) return states;
    const CentrelinePoint tip = step.deformation->centreline.at(paper.length());
    states.push_back(
        {step.contact->normal_force, step.contact->friction_force, tip.position, tip.theta()});
  }
  return states;
}

void print(const char* name, const std::vector<RefereeState>& states) {
  for (const RefereeState& s : states)
    std::printf("%s: N %.5f mN, T/N %.6f, tip %.5f %.5f mm, %.4f deg\n", name, 1e3 * s.normal_force,
                s.friction_force / s.normal_force, 1e3 * s.tip.x(), 1e3 * s.tip.z(),
                s.angle * 57.29577951308232);
}

TEST(CalculixSweepSlow, Prototype) {
  if (!has_ccx()) GTEST_SKIP();
  const test::TemporaryFolder folder;
  RefereeSweep sweep{paper, 0, {FlatProfile{}, 0.3, 0}, 1e-3, {0, 1e-3}};
  if (getenv("REF")) sweep.refinement = atoi(getenv("REF"));
  if (getenv("SINE")) sweep.surface.profile = SineProfile{0.3e-3, 20e-3};
  if (getenv("SINE")) sweep.travels = {0, 2e-3, 4e-3};
  if (getenv("K")) sweep.stiffness = atof(getenv("K"));
  auto t0 = std::chrono::steady_clock::now();
  if (getenv("KEEP"))
    print("ccx", run_referee(sweep, getenv("KEEP")));
  else
    print("ccx", run_referee(sweep, folder.path()));
  std::printf("%.1f s\n",
              std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count());
  t0 = std::chrono::steady_clock::now();
  if (!getenv("NOSOLID")) print("solid", solid_sweep(sweep));
  std::printf("%.1f s\n",
              std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count());
}

}  // namespace
}  // namespace ciliaval::fem::calculix

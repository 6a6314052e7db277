// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <span>

#include "bodies.h"
#include "fem/parallel.h"
#include "fem/potential/octree.h"
#include "fem/potential/potential.h"
#include "problem/error.h"

namespace ciliaval::fem::potential {
namespace {

// Oracle: all ranks' common solution, on as many leaves; sums are in another order. The other ranks
// wait meanwhile: a call that needs them too would not return.
TEST(Communicator, OneRankSolvesAlone) {
  start_mpi();
  PotentialOptions options;
  options.tolerance = 0.05;
  const Vector3 point = test::paper_sensor();
  const auto field = [&](MPI_Comm communicator) {
    return Potential(options, communicator)
        .field(test::paper_cilium(), test::arc(0), std::span(&point, 1));
  };
  Vector3 alone = Vector3::Zero();
  if (rank() == 0) alone = field(MPI_COMM_SELF).B.at(0);
  const Vector3 together = field(MPI_COMM_WORLD).B.at(0);
  if (rank() == 0) {
    EXPECT_LE((alone - together).norm(), 1e-6 * together.norm());
  }
}

// The leaf at a corner of the cube is one rank's. Each of them must hear that it is too deep,
// instead of waiting for the other to refine: oracle is the time-out of the test on two ranks.
TEST(Communicator, ATreeThatIsTooDeepOnOneRankFailsOnAll) {
  start_mpi();
  const Vector3 corner = Vector3::Constant(-1);
  Octree octree(Vector3::Zero(), 1, MPI_COMM_WORLD);
  const auto is_at_corner = [&](const Cube& cube) {
    return cube.box().exteriorDistance(corner) < 1e-12;
  };
  const auto refine = [&] {
    while (octree.refine(is_at_corner)) {
    }
  };
  EXPECT_THROW(refine(), SolverError);
}

}  // namespace
}  // namespace ciliaval::fem::potential

// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <span>

#include "bodies.h"
#include "fem/parallel.h"
#include "fem/potential/potential.h"

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

}  // namespace
}  // namespace ciliaval::fem::potential

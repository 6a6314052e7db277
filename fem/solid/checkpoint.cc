// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/checkpoint.h"

#include <deal.II/base/mpi.h>

#include <boost/serialization/map.hpp>
#include <boost/serialization/string.hpp>

#include "fem/parallel.h"
#include "problem/error.h"

namespace ciliaval::fem::solid {
using dealii::Utilities::MPI::broadcast;

Checkpoint::Entries kept_entries(const Checkpoint& checkpoint, const std::string& always,
                                 MPI_Comm communicator) {
  Checkpoint::Entries kept = broadcast(communicator, checkpoint.kept);
  if (!kept.empty() && !kept.contains(always))
    throw CheckpointError(
        "the checkpoint cannot be used: it is of another version; start anew with --fresh, which "
        "deletes it");
  return kept;
}

void save_entries(const Checkpoint& checkpoint, MPI_Comm communicator,
                  const std::function<Checkpoint::Entries()>& make) {
  if (!broadcast(communicator, static_cast<bool>(checkpoint.save))) return;
  const Checkpoint::Entries entries = make();
  std::string failure;
  if (rank(communicator) == 0) {
    try {
      checkpoint.save(entries);
    } catch (const CheckpointError& error) {
      failure = error.what();
    }
  }
  failure = broadcast(communicator, failure);
  if (!failure.empty()) throw CheckpointError(failure);
}

}  // namespace ciliaval::fem::solid

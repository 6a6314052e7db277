// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <mpi.h>

#include <functional>
#include <string>

#include "problem/mechanics_model.h"

namespace ciliaval::fem::solid {

/// Entries that rank 0 has kept, on all ranks: none, or entries among which `always` is. Throws
/// CheckpointError if that one is missing. Collective.
Checkpoint::Entries kept_entries(const Checkpoint& checkpoint, const std::string& always,
                                 MPI_Comm communicator);

/// All ranks make entries, and rank 0 keeps its own. Throws CheckpointError on all ranks if it
/// cannot. Collective.
void save_entries(const Checkpoint& checkpoint, MPI_Comm communicator,
                  const std::function<Checkpoint::Entries()>& make);

}  // namespace ciliaval::fem::solid

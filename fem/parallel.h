// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <mpi.h>

#include <span>
#include <string>

namespace ciliaval::fem {

/// Starts MPI unless it runs already, and ends it at the end of the program. With more than one
/// rank each of them uses one thread. Throws SolverError if it cannot be started.
void start_mpi();

/// True if a process manager (mpirun, srun …) has started this program on more than one rank. Does
/// not start MPI.
bool launched_on_several_ranks();

/// Number of this rank, and of all ranks: 0 and 1 unless MPI was started.
int rank(MPI_Comm communicator = MPI_COMM_WORLD);
int rank_count(MPI_Comm communicator = MPI_COMM_WORLD);

/// Ends all ranks with the exit code, if there are several, after a failure of one rank alone.
void abort_all_ranks(int exit_code);

/// For a rank that has caught an exception in work that all ranks share. Returns if there is only
/// one rank or if all catch one within some seconds. Otherwise the others still wait for this rank
/// in that work: throws RankFailure with the message.
void require_failure_of_all_ranks(const std::string& message);

/// Rank 0's value, on all ranks of the program, which sleep until it comes. Collective.
int from_first_rank(int value);

/// The sums of the ranks' values, in their place, with the same bits on all ranks. Collective.
void sum_over_ranks(MPI_Comm communicator, std::span<double> values);

/// True if all ranks have the same text. Collective.
bool is_same_on_all_ranks(MPI_Comm communicator, const std::string& text);

/// The first rank's text that is not empty. Collective.
std::string first_text(MPI_Comm communicator, const std::string& text);

}  // namespace ciliaval::fem

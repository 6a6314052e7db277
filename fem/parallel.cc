// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/parallel.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/multithread_info.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <string_view>
#include <thread>

#include "problem/error.h"

namespace ciliaval::fem {
namespace {

using dealii::Utilities::MPI::n_mpi_processes;
using dealii::Utilities::MPI::this_mpi_process;

/// Seconds that a failed rank waits for the others to fail too. All ranks do the same work, so they
/// meet a fault of it at nearly the same time.
constexpr double patience = 10;

/// A duplicate of all ranks' communicator. On it they agree on a failure, while some of them may
/// be waiting for a message of the solver's.
MPI_Comm failures = MPI_COMM_NULL;

bool running() {
  int started = 0;
  int ended = 0;
  MPI_Initialized(&started);
  MPI_Finalized(&ended);
  return started != 0 && ended == 0;
}

void end_mpi() {
  if (running()) MPI_Finalize();
}

/// Spares Open MPI a daemon to start other ranks and the search for fast networks, which one rank,
/// or ranks on one machine, do not need. The user's settings stand; other MPI libraries do not know
/// these names.
void spare_open_mpi_the_network() {
  constexpr int keep_what_is_set = 0;
  const char* all = std::getenv("OMPI_COMM_WORLD_SIZE");
  const char* here = std::getenv("OMPI_COMM_WORLD_LOCAL_SIZE");
  const bool single = all == nullptr && !launched_on_several_ranks();
  if (single) setenv("OMPI_MCA_ess_singleton_isolated", "1", keep_what_is_set);
  if (single || (all != nullptr && here != nullptr && std::string_view(all) == here))
    setenv("OMPI_MCA_pml", "ob1", keep_what_is_set);
}

}  // namespace

void start_mpi() {
  if (running()) return;
  spare_open_mpi_the_network();
  int provided = 0;
  if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided) != MPI_SUCCESS)
    throw SolverError("MPI cannot be started");
  std::atexit(end_mpi);
  if (rank_count() == 1) return;
  MPI_Comm_dup(MPI_COMM_WORLD, &failures);
  dealii::MultithreadInfo::set_thread_limit(1);
}

bool launched_on_several_ranks() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MPI_LOCALNRANKS"})
    if (const char* value = std::getenv(name)) return std::atoi(value) > 1;
  return false;
}

int rank(MPI_Comm communicator) {
  return running() ? static_cast<int>(this_mpi_process(communicator)) : 0;
}

int rank_count(MPI_Comm communicator) {
  return running() ? static_cast<int>(n_mpi_processes(communicator)) : 1;
}

void abort_all_ranks(int exit_code) {
  if (rank_count() > 1) MPI_Abort(MPI_COMM_WORLD, exit_code);
}

void require_failure_of_all_ranks(const std::string& message) {
  if (rank_count() == 1) return;
  MPI_Request all = MPI_REQUEST_NULL;
  MPI_Ibarrier(failures, &all);
  const double start = MPI_Wtime();
  int done = 0;
  while (MPI_Wtime() - start < patience) {
    MPI_Test(&all, &done, MPI_STATUS_IGNORE);
    if (done != 0) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  throw RankFailure("rank " + std::to_string(rank()) + " of " + std::to_string(rank_count()) +
                    " failed alone: " + message);
}

int from_first_rank(int value) {
  using namespace std::chrono_literals;
  if (rank_count() == 1) return value;
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibcast(&value, 1, MPI_INT, 0, MPI_COMM_WORLD, &request);
  int done = 0;
  // Asleep, however long that takes, instead of taking a processor from rank 0.
  for (auto nap = 0us; done == 0; nap = std::min(2 * nap + 10us, 2000us)) {
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done == 0) std::this_thread::sleep_for(nap);
  }
  return value;
}

void sum_over_ranks(MPI_Comm communicator, std::span<double> values) {
  const dealii::ArrayView<double> view(values.data(), values.size());
  dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(view), communicator, view);
}

bool is_same_on_all_ranks(MPI_Comm communicator, const std::string& text) {
  if (rank_count(communicator) == 1) return true;
  const bool differs = dealii::Utilities::MPI::broadcast(communicator, text, 0) != text;
  return dealii::Utilities::MPI::max(differs ? 1 : 0, communicator) == 0;
}

std::string first_text(MPI_Comm communicator, const std::string& text) {
  if (rank_count(communicator) == 1) return text;
  const int ranks = rank_count(communicator);
  const int first =
      dealii::Utilities::MPI::min(text.empty() ? ranks : rank(communicator), communicator);
  if (first == ranks) return {};
  return dealii::Utilities::MPI::broadcast(communicator, text, static_cast<unsigned int>(first));
}

}  // namespace ciliaval::fem

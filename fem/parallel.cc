// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/parallel.h"

#include <deal.II/base/multithread_info.h>
#include <dlfcn.h>
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <string_view>
#include <thread>
#include <vector>

#include "problem/error.h"

namespace ciliaval::fem {
namespace {

/// Seconds that a rank which has failed waits for the others to fail too. They do the same work,
/// and what is wrong with it all ranks find at nearly the same time.
constexpr double patience = 10;

/// All ranks once more: on it they tell one another that they have failed, while some of them may
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

/// Two ranks with two threads each would be twice as many as the cores they were given.
void use_one_thread() {
  dealii::MultithreadInfo::set_thread_limit(1);
  using SetThreads = void (*)(int);
  if (void* blas = dlsym(RTLD_DEFAULT, "openblas_set_num_threads"))
    reinterpret_cast<SetThreads>(blas)(1);
}

/// Spreads rank 0's value. The others sleep until it comes, however long that takes, instead of
/// taking a processor from it.
void idle_until_first_rank_sends(int& value) {
  using namespace std::chrono_literals;
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibcast(&value, 1, MPI_INT, 0, MPI_COMM_WORLD, &request);
  int done = 0;
  for (auto nap = 0us; done == 0; nap = std::min(2 * nap + 10us, 10000us)) {
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done == 0) std::this_thread::sleep_for(nap);
  }
}

/// Spares Open MPI what one rank, or the ranks of one machine, do not need: a daemon to start other
/// ranks, and the search for fast networks, 0.3 s together. What the user has set stands; other MPI
/// libraries do not know these names.
void spare_open_mpi_the_network() {
  constexpr int keep_what_is_set = 0;
  const char* all = std::getenv("OMPI_COMM_WORLD_SIZE");
  const char* here = std::getenv("OMPI_COMM_WORLD_LOCAL_SIZE");
  const bool alone = all == nullptr && !launched_on_several_ranks();
  if (alone) setenv("OMPI_MCA_ess_singleton_isolated", "1", keep_what_is_set);
  if (alone || (all != nullptr && here != nullptr && std::string_view(all) == here))
    setenv("OMPI_MCA_pml", "ob1", keep_what_is_set);
}

int to_int(std::size_t value) {
  return static_cast<int>(value);
}

RowRange range_of(Row size, int part, int parts) {
  const auto bound = [&](int i) {
    const auto exact = static_cast<Row>(static_cast<long long>(size) * i / parts);
    return i == parts ? size : exact - exact % node_unknowns;
  };
  return {bound(part), bound(part + 1)};
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
  use_one_thread();
}

bool launched_on_several_ranks() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MPI_LOCALNRANKS"})
    if (const char* value = std::getenv(name)) return std::atoi(value) > 1;
  return false;
}

int rank() {
  int result = 0;
  if (running()) MPI_Comm_rank(MPI_COMM_WORLD, &result);
  return result;
}

int rank_count() {
  int result = 1;
  if (running()) MPI_Comm_size(MPI_COMM_WORLD, &result);
  return result;
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
  if (rank_count() > 1) MPI_Bcast(&value, 1, MPI_INT, 0, MPI_COMM_WORLD);
  return value;
}

std::string from_first_rank(const std::function<std::string()>& work) {
  if (rank_count() == 1) return work();
  std::string text;
  int failed = 0;
  if (rank() == 0) {
    try {
      text = work();
    } catch (const CheckpointError& error) {
      text = error.what();
      failed = 1;
    }
  }
  unsigned long long size = text.size();
  idle_until_first_rank_sends(failed);
  MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG_LONG, 0, MPI_COMM_WORLD);
  text.resize(size);
  constexpr std::size_t part = std::size_t{1} << 30;
  for (std::size_t start = 0; start < text.size(); start += part)
    MPI_Bcast(text.data() + start, to_int(std::min(part, text.size() - start)), MPI_CHAR, 0,
              MPI_COMM_WORLD);
  if (failed != 0) throw CheckpointError(text);
  return text;
}

void sum_over_ranks(std::span<double> values) {
  if (rank_count() == 1) return;
  // Reduced at one place: MPI_Allreduce may sum in another order on another rank.
  const bool root = rank() == 0;
  MPI_Reduce(root ? MPI_IN_PLACE : values.data(), root ? values.data() : nullptr,
             to_int(values.size()), MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
  spread_from_first_rank(values);
}

void spread_from_first_rank(std::span<double> values) {
  if (rank_count() > 1)
    MPI_Bcast(values.data(), to_int(values.size()), MPI_DOUBLE, 0, MPI_COMM_WORLD);
}

RowRange own_range(Row size) {
  return range_of(size, rank(), rank_count());
}

void gather_over_ranks(std::span<double> values) {
  const int ranks = rank_count();
  if (ranks == 1) return;
  std::vector<int> counts;
  std::vector<int> starts;
  for (int r = 0; r < ranks; ++r) {
    const RowRange part = range_of(static_cast<Row>(values.size()), r, ranks);
    starts.push_back(to_int(part.begin));
    counts.push_back(to_int(part.end - part.begin));
  }
  MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, values.data(), counts.data(), starts.data(),
                 MPI_DOUBLE, MPI_COMM_WORLD);
}

}  // namespace ciliaval::fem

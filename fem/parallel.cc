// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/parallel.h"

#include <deal.II/base/multithread_info.h>
#include <dlfcn.h>
#include <mpi.h>
#include <petscsys.h>

#include <cstdlib>
#include <vector>

#include "problem/error.h"

namespace ciliaval::fem {
namespace {

bool running() {
  int started = 0;
  int ended = 0;
  MPI_Initialized(&started);
  MPI_Finalized(&ended);
  return started != 0 && ended == 0;
}

void end_mpi() {
  if (!running()) return;
  PetscFinalize();
  MPI_Finalize();
}

/// Two ranks with two threads each would be twice as many as the cores they were given.
void use_one_thread() {
  dealii::MultithreadInfo::set_thread_limit(1);
  using SetThreads = void (*)(int);
  if (void* blas = dlsym(RTLD_DEFAULT, "openblas_set_num_threads"))
    reinterpret_cast<SetThreads>(blas)(1);
}

int to_int(std::size_t value) {
  return static_cast<int>(value);
}

RowRange range_of(Row size, int part, int parts) {
  const auto bound = [&](int i) {
    return static_cast<Row>(static_cast<long long>(size) * i / parts);
  };
  return {bound(part), bound(part + 1)};
}

}  // namespace

void start_mpi() {
  if (!running()) {
    int provided = 0;
    if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided) != MPI_SUCCESS)
      throw SolverError("MPI cannot be started");
    std::atexit(end_mpi);
  }
  PetscBool started = PETSC_FALSE;
  PetscInitialized(&started);
  if (started) return;
  if (PetscInitializeNoArguments() != 0) throw SolverError("PETSc cannot be started");
  PetscPopSignalHandler();
  PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
  if (rank_count() > 1) use_one_thread();
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

int from_first_rank(int value) {
  if (rank_count() > 1) MPI_Bcast(&value, 1, MPI_INT, 0, MPI_COMM_WORLD);
  return value;
}

void sum_over_ranks(std::span<double> values) {
  if (rank_count() == 1) return;
  // Reduced at one place: MPI_Allreduce may sum in another order on another rank.
  const bool root = rank() == 0;
  MPI_Reduce(root ? MPI_IN_PLACE : values.data(), root ? values.data() : nullptr,
             to_int(values.size()), MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
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

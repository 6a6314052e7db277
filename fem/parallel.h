// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/types.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace ciliaval::fem {

/// Starts MPI unless it runs already, and ends it at the end of the program. With more than one
/// rank each of them uses one thread. Throws SolverError if it cannot be started.
void start_mpi();

/// Whether a process manager (mpirun, srun …) has started this program on more than one rank. Does
/// not start MPI.
bool launched_on_several_ranks();

/// Number of this rank, and of all ranks: 0 and 1 unless MPI was started, or while RankAlone lives.
int rank();
int rank_count();

/// While it lives this rank works alone: rank() is 0, rank_count() is 1, and what is collective
/// concerns no other rank. For work that the ranks do not share. A solver that was built meanwhile
/// must be used meanwhile, and no other one may be.
class RankAlone {
 public:
  explicit RankAlone(bool alone = true);
  ~RankAlone();
  RankAlone(const RankAlone&) = delete;
  RankAlone& operator=(const RankAlone&) = delete;

 private:
  bool before_;
};

/// Does rank 0's work at the end of a case, for which the other ranks wait: with a thread for each
/// rank on this machine, on the processors of all of them. On one rank it is done as it is.
void with_threads_of_all_ranks(const std::function<void()>& work);

/// The ranks that work together now, as MPI's Fortran interface names them.
int fortran_communicator();

/// Ends all ranks with the exit code, if there are several: after a failure of one rank alone, for
/// which the others would wait forever.
void abort_all_ranks(int exit_code);

/// For a rank that has caught an exception in work that all ranks share. Returns if all of them
/// have caught one, within some seconds, or if there is only one rank; otherwise the others still
/// wait for this one in that work: throws RankFailure with the message.
void require_failure_of_all_ranks(const std::string& message);

/// Rank 0's value, on all ranks, which sleep until it comes. Collective.
int from_first_rank(int value);

/// What the work, done by rank 0 alone, returns, on all ranks; so is a CheckpointError that it
/// throws. Collective.
std::string from_first_rank(const std::function<std::string()>& work);

/// A rank's text, on all ranks. Collective.
std::string from_rank(int source, std::string text);

/// Texts that ranks send one another while each works alone: what one posts under a number, from 0
/// to `numbers` − 1, every other one collects. All ranks make the same ones in the same order: what
/// one has left behind never gets into the next.
class Mail {
 public:
  explicit Mail(std::size_t numbers);
  /// What has not been collected by then is lost, with its memory; finish() waits for that.
  ~Mail();
  Mail(const Mail&) = delete;
  Mail& operator=(const Mail&) = delete;

  void post(int number, std::string text);
  /// Whether collect() would not wait. To be called now and then in long work, whatever it returns:
  /// what was posted here leaves meanwhile.
  bool arrived(int source, int number) const;
  std::string collect(int source, int number) const;
  void finish();

 private:
  struct Letters;
  std::unique_ptr<Letters> posted_;
  int first_tag_;
};

/// Replaces the values by their sums over the ranks: the same bits on all of them. Collective.
void sum_over_ranks(std::span<double> values);

/// Replaces the values by rank 0's. Collective.
void spread_from_first_rank(std::span<double> values);

using Row = dealii::types::global_dof_index;

inline constexpr Row node_unknowns = 3;  ///< of a node of the solid, numbered one after the other

/// A contiguous part of a range of rows.
struct RowRange {
  Row begin = 0;
  Row end = 0;
  bool contains(Row index) const { return index >= begin && index < end; }
};

/// This rank's part of 0 … size − 1; the ranks' parts are contiguous, in order and nearly equal,
/// and begin at multiples of three: the unknowns of a node stay together.
RowRange own_range(Row size);

/// Every rank holds its own_range() of the values; afterwards all of them. Collective.
void gather_over_ranks(std::span<double> values);

}  // namespace ciliaval::fem

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/parallel.h"

#include <deal.II/base/multithread_info.h>
#include <dlfcn.h>
#include <mpi.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sched.h>
#include <sys/socket.h>
#include <tbb/task_arena.h>
#include <tbb/task_scheduler_observer.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <memory>
#include <string_view>
#include <thread>
#include <utility>
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

/// All ranks once more, for Mail.
MPI_Comm mails = MPI_COMM_NULL;

/// The tag that the next Mail begins with, of those that each MPI library has.
int next_tag = 0;
constexpr int tags = 32768;

/// Of all ranks, those on this machine, and the processors that they may use.
int ranks_here = 1;
cpu_set_t processors_here{};

/// Whether this rank works alone.
bool alone = false;

/// The ranks that work together.
MPI_Comm together() {
  return alone ? MPI_COMM_SELF : MPI_COMM_WORLD;
}

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
  MPI_Ibcast(&value, 1, MPI_INT, 0, together(), &request);
  int done = 0;
  for (auto nap = 0us; done == 0; nap = std::min(2 * nap + 10us, 2000us)) {
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
  const bool single = all == nullptr && !launched_on_several_ranks();
  if (single) setenv("OMPI_MCA_ess_singleton_isolated", "1", keep_what_is_set);
  if (single || (all != nullptr && here != nullptr && std::string_view(all) == here))
    setenv("OMPI_MCA_pml", "ob1", keep_what_is_set);
}

/// Open MPI talks to mpirun by short messages over TCP without TCP_NODELAY: at the end one waits
/// 0.04 s for the acknowledgement of another, which the receiver delays that long.
void send_short_messages_at_once() {
  std::error_code unreadable;
  std::filesystem::directory_iterator entry("/proc/self/fd", unreadable);
  for (; !unreadable && entry != std::filesystem::directory_iterator();
       entry.increment(unreadable)) {
    const std::string name = entry->path().filename().string();
    int descriptor = 0;
    const int on = 1;
    if (std::from_chars(name.data(), name.data() + name.size(), descriptor).ec == std::errc())
      setsockopt(descriptor, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);  // other files refuse it
  }
}

/// Counts the ranks on this machine and finds their processors: mpirun binds each to its own.
void find_ranks_here() {
  MPI_Comm here = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
  MPI_Comm_size(here, &ranks_here);
  sched_getaffinity(0, sizeof processors_here, &processors_here);
  MPI_Allreduce(MPI_IN_PLACE, &processors_here, sizeof processors_here, MPI_BYTE, MPI_BOR, here);
  MPI_Comm_free(&here);
}

/// A thread for each rank on this machine: the calling one stays where it is, the others go to the
/// processors of the other ranks. Left to itself, Linux had both on one processor for 0.1 s.
class ThreadsOfAllRanks : public tbb::task_scheduler_observer {
 public:
  explicit ThreadsOfAllRanks(tbb::task_arena& arena) : task_scheduler_observer(arena) {
    dealii::MultithreadInfo::set_thread_limit(static_cast<unsigned int>(ranks_here));
    cpu_set_t own{};
    if (sched_getaffinity(0, sizeof own, &own) == 0) {
      CPU_AND(&elsewhere_, &processors_here, &own);  // not those that the rank was moved to since
      CPU_XOR(&elsewhere_, &processors_here, &elsewhere_);
      // Without binding all ranks have the same processors.
      if (CPU_COUNT(&elsewhere_) == 0) elsewhere_ = processors_here;
      observe(true);
    }
  }
  ~ThreadsOfAllRanks() override {
    observe(false);
    dealii::MultithreadInfo::set_thread_limit(1);
  }
  ThreadsOfAllRanks(const ThreadsOfAllRanks&) = delete;
  ThreadsOfAllRanks& operator=(const ThreadsOfAllRanks&) = delete;

  void on_scheduler_entry(bool is_worker) override {
    if (is_worker) sched_setaffinity(0, sizeof elsewhere_, &elsewhere_);
  }

 private:
  cpu_set_t elsewhere_{};
};

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
  MPI_Comm_dup(MPI_COMM_WORLD, &mails);
  find_ranks_here();
  send_short_messages_at_once();
  use_one_thread();
}

bool launched_on_several_ranks() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MPI_LOCALNRANKS"})
    if (const char* value = std::getenv(name)) return std::atoi(value) > 1;
  return false;
}

int rank() {
  int result = 0;
  if (running()) MPI_Comm_rank(together(), &result);
  return result;
}

int rank_count() {
  int result = 1;
  if (running()) MPI_Comm_size(together(), &result);
  return result;
}

RankAlone::RankAlone(bool now) : before_(alone) {
  alone = alone || now;
}

RankAlone::~RankAlone() {
  alone = before_;
}

void with_threads_of_all_ranks(const std::function<void()>& work) {
  if (rank_count() == 1) return work();
  tbb::task_arena arena(ranks_here);
  const ThreadsOfAllRanks threads(arena);
  arena.execute(work);
}

int fortran_communicator() {
  return MPI_Comm_c2f(together());
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
  if (rank_count() > 1) idle_until_first_rank_sends(value);
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
  idle_until_first_rank_sends(failed);
  text = from_rank(0, std::move(text));
  if (failed != 0) throw CheckpointError(text);
  return text;
}

std::string from_rank(int source, std::string text) {
  if (rank_count() == 1) return text;
  unsigned long long size = text.size();
  MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG_LONG, source, together());
  text.resize(size);
  constexpr std::size_t part = std::size_t{1} << 30;
  for (std::size_t start = 0; start < text.size(); start += part)
    MPI_Bcast(text.data() + start, to_int(std::min(part, text.size() - start)), MPI_CHAR, source,
              together());
  return text;
}

struct Mail::Letters {
  std::vector<std::shared_ptr<const std::string>> texts;
  std::vector<MPI_Request> requests;
};

Mail::Mail(std::size_t numbers) : posted_(std::make_unique<Letters>()) {
  if (numbers > tags) throw SolverError("too many tasks for messages between ranks");
  if (next_tag + to_int(numbers) > tags) next_tag = 0;
  first_tag_ = next_tag;
  next_tag += to_int(numbers);
}

Mail::~Mail() {
  int gone = 0;
  if (running())
    MPI_Testall(to_int(posted_->requests.size()), posted_->requests.data(), &gone,
                MPI_STATUSES_IGNORE);
  // MPI may still read what has not gone.
  if (gone == 0) static_cast<void>(posted_.release());
}

void Mail::post(int number, std::string text) {
  int ranks = 0;
  int own = 0;
  MPI_Comm_size(mails, &ranks);
  MPI_Comm_rank(mails, &own);
  if (text.size() > std::numeric_limits<int>::max())
    throw SolverError("a state is too large for a message between ranks");
  const auto letter = std::make_shared<const std::string>(std::move(text));
  for (int rank = 0; rank < ranks; ++rank) {
    if (rank == own) continue;
    posted_->texts.push_back(letter);
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Isend(letter->data(), to_int(letter->size()), MPI_CHAR, rank, first_tag_ + number, mails,
              &request);
    posted_->requests.push_back(request);
  }
}

bool Mail::arrived(int source, int number) const {
  int there = 0;
  MPI_Iprobe(source, first_tag_ + number, mails, &there, MPI_STATUS_IGNORE);
  return there != 0;
}

std::string Mail::collect(int source, int number) const {
  MPI_Status status;
  MPI_Probe(source, first_tag_ + number, mails, &status);
  int size = 0;
  MPI_Get_count(&status, MPI_CHAR, &size);
  std::string text(static_cast<std::size_t>(size), '\0');
  MPI_Recv(text.data(), size, MPI_CHAR, source, first_tag_ + number, mails, MPI_STATUS_IGNORE);
  return text;
}

void Mail::finish() {
  MPI_Waitall(to_int(posted_->requests.size()), posted_->requests.data(), MPI_STATUSES_IGNORE);
  *posted_ = {};
}

void sum_over_ranks(std::span<double> values) {
  if (rank_count() == 1) return;
  // Reduced at one place: MPI_Allreduce may sum in another order on another rank.
  const bool root = rank() == 0;
  MPI_Reduce(root ? MPI_IN_PLACE : values.data(), root ? values.data() : nullptr,
             to_int(values.size()), MPI_DOUBLE, MPI_SUM, 0, together());
  spread_from_first_rank(values);
}

void spread_from_first_rank(std::span<double> values) {
  if (rank_count() > 1) MPI_Bcast(values.data(), to_int(values.size()), MPI_DOUBLE, 0, together());
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
                 MPI_DOUBLE, together());
}

}  // namespace ciliaval::fem

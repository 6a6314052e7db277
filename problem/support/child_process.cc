// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/support/child_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <system_error>
#include <thread>

#include "problem/error.h"

namespace ciliaval::fem {
namespace {

namespace fs = std::filesystem;

constexpr std::array<int, 3> kept_back{SIGINT, SIGTERM, SIGHUP};
volatile std::sig_atomic_t signal_that_came = 0;
std::array<struct sigaction, kept_back.size()> handlers_before;
int pauses = 0;

void remember(int number) {
  signal_that_came = number;
}

/// This program's environment with the child's number of threads.
std::vector<std::string> environment(unsigned int threads) {
  constexpr std::array<std::string_view, 4> thread_counts{
      "OMP_NUM_THREADS=", "NUMBER_OF_CPUS=", "CCX_NPROC", "OMP_THREAD_LIMIT="};
  std::vector<std::string> result;
  for (char** entry = environ; *entry != nullptr; ++entry)
    if (std::none_of(thread_counts.begin(), thread_counts.end(), [&](std::string_view name) {
          return std::string_view(*entry).starts_with(name);
        }))
      result.emplace_back(*entry);
  result.push_back("OMP_NUM_THREADS=" + std::to_string(threads));
  return result;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  result.reserve(texts.size() + 1);
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

/// Starts the child; errno of the failure, or 0.
int spawn(const ChildCommand& command, pid_t& child) {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, command.log.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, S_IRUSR | S_IWUSR);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  posix_spawn_file_actions_addchdir_np(&actions, command.folder.c_str());
  // A group of its own, so that its children can be killed with it; signals as at the start of a
  // program.
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
  posix_spawnattr_setpgroup(&attributes, 0);
  sigset_t defaults;
  sigemptyset(&defaults);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) sigaddset(&defaults, number);
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  std::vector<std::string> words = command.arguments;
  words.insert(words.begin(), command.program);
  std::vector<std::string> variables = environment(command.threads);
  const int error = posix_spawnp(&child, command.program.c_str(), &actions, &attributes,
                                 pointers(words).data(), pointers(variables).data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

}  // namespace

ChildEnd run_child(const ChildCommand& command) {
  using namespace std::chrono_literals;
  const SignalPause pause;
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  pid_t child = 0;
  if (const int error = spawn(command, child); error != 0)
    return {error == ENOENT ? ChildEnd::How::not_found : ChildEnd::How::not_started, error, 0};
  int status = 0;
  for (auto nap = 1ms; waitpid(child, &status, WNOHANG) == 0; nap = std::min(2 * nap, 20ms)) {
    const bool late = elapsed() > command.time_limit;
    if (late || SignalPause::interrupted()) {
      kill(-child, SIGKILL);
      waitpid(child, &status, 0);
      return {ChildEnd::How::timed_out, 0, elapsed()};
    }
    std::this_thread::sleep_for(nap);
  }
  kill(-child, SIGKILL);  // what it may have left behind
  const bool exited = WIFEXITED(status);
  return {exited ? ChildEnd::How::exited : ChildEnd::How::signalled,
          exited ? WEXITSTATUS(status) : WTERMSIG(status), elapsed()};
}

SignalPause::SignalPause() {
  if (pauses++ > 0) return;
  signal_that_came = 0;
  for (std::size_t i = 0; i < kept_back.size(); ++i) {
    struct sigaction action {};
    action.sa_handler = remember;
    sigemptyset(&action.sa_mask);
    sigaction(kept_back[i], nullptr, &handlers_before[i]);
    if (handlers_before[i].sa_handler != SIG_IGN) sigaction(kept_back[i], &action, nullptr);
  }
}

SignalPause::~SignalPause() {
  if (--pauses > 0) return;
  for (std::size_t i = 0; i < kept_back.size(); ++i)
    sigaction(kept_back[i], &handlers_before[i], nullptr);
  if (signal_that_came != 0) raise(signal_that_came);
}

bool SignalPause::interrupted() {
  return signal_that_came != 0;
}

WorkFolder::WorkFolder() : removed_(true) {
  std::error_code error;
  const fs::path parent = fs::temp_directory_path(error);
  std::string name = (parent / "ciliaval-ccx-XXXXXX").string();
  if (error || mkdtemp(name.data()) == nullptr)
    throw FileError(
        "cannot make a temporary folder: " + (error ? error.message() : std::strerror(errno)) +
        "; name a place for it by the environment variable TMPDIR");
  path_ = name;
}

WorkFolder::WorkFolder(const fs::path& kept) : path_(fs::absolute(kept)) {
  std::error_code error;
  fs::create_directories(path_, error);
  if (error) throw FileError("cannot make the folder `" + path_.string() + "`: " + error.message());
}

WorkFolder::~WorkFolder() {
  std::error_code error;
  if (removed_) fs::remove_all(path_, error);
}

}  // namespace ciliaval::fem

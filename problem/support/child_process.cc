// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/support/child_process.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/process/args.hpp>
#include <boost/process/child.hpp>
#include <boost/process/env.hpp>
#include <boost/process/environment.hpp>
#include <boost/process/exe.hpp>
#include <boost/process/extend.hpp>
#include <boost/process/group.hpp>
#include <boost/process/io.hpp>
#include <boost/process/search_path.hpp>
#include <boost/process/start_dir.hpp>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <system_error>
#include <thread>

#include "problem/error.h"

namespace ciliaval::support {
namespace {

namespace fs = std::filesystem;
namespace bp = boost::process;

constexpr std::array<int, 3> kept_back{SIGINT, SIGTERM, SIGHUP};
volatile std::sig_atomic_t signal_that_came = 0;
std::array<struct sigaction, kept_back.size()> handlers_before;
int pauses = 0;

void remember(int number) {
  signal_that_came = number;
}

}  // namespace

std::string ChildEnd::text() const {
  std::ostringstream text;
  switch (how) {
    case How::exited:
      text << "ended with the exit code " << code;
      break;
    case How::signalled:
      text << "was killed by the signal " << code << " (" << strsignal(code) << ")";
      break;
    case How::timed_out:
      text << "did not end by itself and was killed after " << std::round(10 * seconds) / 10
           << " s";
      break;
    case How::not_found:
      text << "is not there";
      break;
    case How::not_started:
      text << "cannot be started: " << std::strerror(code);
  }
  return text.str();
}

ChildEnd run_child(const ChildCommand& command) {
  using namespace std::chrono_literals;
  const SignalPause pause;
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const std::string program = command.program.find('/') == std::string::npos
                                  ? bp::search_path(command.program).string()
                                  : command.program;
  if (program.empty() || !fs::exists(program)) return {ChildEnd::How::not_found, ENOENT, 0};
  bp::environment variables = boost::this_process::environment();
  for (const auto& [name, value] : command.variables)
    if (value.empty())
      variables.erase(name);
    else
      variables[name] = value;
  // Signals as at the start of a program.
  const auto default_signals = [](auto&) {
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ})
      std::signal(number, SIG_DFL);
  };
  std::error_code error;
  fs::remove(command.log, error);  // Boost.Process would write over its beginning
  bp::group group;                 // so that its children can be killed with it
  bp::child child(bp::exe = program, bp::args = command.arguments, variables,
                  bp::start_dir = command.folder.string(),
                  bp::std_in<bp::null, (bp::std_out & bp::std_err)> command.log.string(),
                  bp::extend::on_exec_setup = default_signals, group, error);
  if (error) return {ChildEnd::How::not_started, error.value(), 0};
  bool killed = false;
  for (auto nap = 1ms; child.running(error); nap = std::min(2 * nap, 20ms)) {
    if (elapsed() > command.time_limit || SignalPause::interrupted()) {
      killed = true;
      group.terminate(error);
      child.wait(error);
      break;
    }
    std::this_thread::sleep_for(nap);
  }
  if (killed) return {ChildEnd::How::timed_out, 0, elapsed()};
  group.terminate(error);  // processes that it may have left behind
  const int status = child.native_exit_code();
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
  std::string name = (parent / "ciliaval-XXXXXX").string();
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

}  // namespace ciliaval::support

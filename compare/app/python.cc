// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/python.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string_view>
#include <system_error>

#include "compare/app/terminal.h"
#include "problem/error.h"
#include "problem/support/child_process.h"

namespace ciliaval::compare::app {
namespace {

namespace fs = std::filesystem;

constexpr double time_limit = 600;  // s; a report of many cases takes ten
constexpr const char* needs =
    "; it needs the Python package `ciliaval` and, on Debian, python3-numpy, python3-scipy, "
    "python3-pandas, python3-matplotlib and python3-jinja2 (docs/guide/python.md)";

/// Folder of the package beside this program: in a build tree, in an installation, or around it, as
/// pip installs it. Empty if it is none of these.
fs::path package_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const char* place : {"python", CILIAVAL_INSTALLED_PYTHON, "../.."}) {
    fs::path folder = (program / place).lexically_normal();
    if (!program.empty() && fs::exists(folder / "ciliaval" / "report" / "__main__.py", error))
      return folder;
  }
  return {};
}

/// $CILIAVAL_PYTHON, or the interpreter that the package's compiled module is of.
std::string interpreter() {
  const char* stated = std::getenv("CILIAVAL_PYTHON");
  return stated != nullptr && *stated != '\0' ? stated : CILIAVAL_PYTHON_EXECUTABLE;
}

/// PYTHONPATH with the package that goes with this program before the user's own; empty if there is
/// neither.
std::string python_path() {
  std::string path = package_folder().string();
  if (const char* others = std::getenv("PYTHONPATH"); others != nullptr && *others != '\0')
    path += (path.empty() ? "" : ":") + std::string(others);
  return path;
}

std::vector<std::string> lines_of(const fs::path& log) {
  std::vector<std::string> lines;
  std::ifstream stream(log);
  for (std::string line; std::getline(stream, line);)
    if (!line.empty()) lines.push_back(line);
  return lines;
}

}  // namespace

std::vector<std::string> run_python_module(const std::string& module,
                                           const std::vector<fs::path>& files,
                                           const std::vector<std::string>& options) {
  const support::SignalPause pause;  // the folder is removed before a signal ends the program
  const support::WorkFolder folder;
  support::ChildCommand command;
  command.program = interpreter();
  command.arguments = {"-m", module};
  command.arguments.insert(command.arguments.end(), options.begin(), options.end());
  command.arguments.emplace_back("--");  // a file may be called -o
  for (const fs::path& file : files) command.arguments.push_back(file.string());
  command.folder = fs::current_path();  // the arguments may be relative
  command.log = folder.path() / "log";
  command.time_limit = time_limit;
  if (const std::string path = python_path(); !path.empty()) command.variables["PYTHONPATH"] = path;
  const support::ChildEnd end = support::run_child(command);
  if (end.how == support::ChildEnd::How::not_found)
    throw FileError(fmt::format("there is no Python `{}`{}", command.program, needs));

  std::vector<std::string> warnings;
  constexpr std::string_view warning = "warning: ";
  constexpr std::string_view failure = "error: ";
  std::string last;
  for (const std::string& line : lines_of(command.log)) {
    if (line.starts_with(failure)) throw FileError(line.substr(failure.size()));
    if (line.starts_with(warning)) warnings.push_back(line.substr(warning.size()));
    last = line;
  }
  const bool done =
      end.succeeded() || (end.how == support::ChildEnd::How::exited && !warnings.empty());
  if (!done)
    throw FileError(fmt::format("`{} -m {}` {}: {}{}", command.program, module, end.text(), last,
                                last.find("No module named") != std::string::npos ? needs : ""));
  return warnings;
}

void become_python_module(const std::string& module, const std::vector<std::string>& arguments) {
  const std::string script = fmt::format(
      "import signal, sys\n"
      "signal.signal(signal.SIGINT, signal.SIG_DFL)\n"
      "signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT])\n"
      "try:\n"
      "    from ciliaval.command import main\n"
      "    sys.exit(main())\n"
      "except ImportError as error:\n"
      "    sys.exit(print(f'ciliaval: {{error}}{}', file=sys.stderr) or 4)\n",
      needs);
  std::vector<std::string> words{interpreter(), "-c", script, module};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  if (const std::string path = python_path(); !path.empty()) setenv("PYTHONPATH", path.c_str(), 1);
  std::error_code error;
  setenv("CILIAVAL_PROGRAM", fs::read_symlink("/proc/self/exe", error).c_str(), 1);
  // Ctrl-C while Python starts waits until it ends the process as it should.
  sigset_t interrupt;
  sigset_t before;
  sigemptyset(&interrupt);
  sigaddset(&interrupt, SIGINT);
  pthread_sigmask(SIG_BLOCK, &interrupt, &before);
  execvp(pointers.front(), pointers.data());
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  throw FileError(fmt::format("cannot start Python `{}` ({}){}", words.front(),
                              std::generic_category().message(errno), needs));
}

void become_python_command(const std::string& module, const CLI::App& command,
                           const std::string& words, const std::vector<std::string>& files) {
  std::vector<std::string> arguments{"--command=" + words};
  if (!shows_progress()) arguments.emplace_back("--quiet");
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0 || option->get_positional()) continue;
    const bool is_flag = option->get_items_expected_max() == 0;
    for (const std::string& value : option->results())
      arguments.push_back(option->get_name() + (is_flag ? "" : "=" + value));
  }
  arguments.emplace_back("--");
  arguments.insert(arguments.end(), files.begin(), files.end());
  become_python_module(module, arguments);
}

void draw_figure(const std::string& json, const fs::path& figure) {
  const support::SignalPause pause;
  const support::WorkFolder folder;
  const fs::path file = folder.path() / "results.json";
  std::ofstream(file) << json;
  for (const std::string& what : run_python_module("ciliaval.plot", {file, figure})) warn(what);
}

}  // namespace ciliaval::compare::app

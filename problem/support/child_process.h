// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace ciliaval::support {

/// A program to run in a folder, without a shell and without input.
struct ChildCommand {
  std::string program;  ///< a name that is looked for in PATH, or a path with a slash
  std::vector<std::string> arguments;
  std::filesystem::path folder;                  ///< where it works
  std::filesystem::path log;                     ///< takes its stdout and stderr; replaced
  double time_limit = 3600;                      ///< s of wall time
  std::map<std::string, std::string> variables;  ///< set in its environment; empty: taken away
};

/// End of a program.
struct ChildEnd {
  enum class How { exited, signalled, timed_out, not_found, not_started };
  How how = How::not_started;
  int code = 0;        ///< exit code, number of the signal, or errno of the start
  double seconds = 0;  ///< wall time

  bool succeeded() const { return how == How::exited && code == 0; }
  /// "ended with the exit code 3": what follows the program's name in a message.
  std::string text() const;
};

/// Runs the program to its end, in a process group of its own, and kills the group at the time
/// limit. If this program is told to end meanwhile (SIGINT, SIGTERM, SIGHUP), the group is killed
/// first; the signal takes effect where the innermost SignalPause ends, or here without one.
ChildEnd run_child(const ChildCommand& command);

/// While it lives, SIGINT, SIGTERM and SIGHUP wait, so that files can be tidied up before the
/// program ends: at its end they take effect. An ignored signal stays so. For one thread at a time.
class SignalPause {
 public:
  SignalPause();
  ~SignalPause();
  SignalPause(const SignalPause&) = delete;
  SignalPause& operator=(const SignalPause&) = delete;

  /// True if one of the signals has come.
  static bool interrupted();
};

/// A folder of its own name, for its owner alone, removed with its content at the end; or one that
/// stays. Throws FileError if it cannot be made.
class WorkFolder {
 public:
  WorkFolder();                                            ///< among the temporary files (TMPDIR)
  explicit WorkFolder(const std::filesystem::path& kept);  ///< made if it is not there; stays
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  bool removed_ = false;
};

}  // namespace ciliaval::support

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/synthetic.h"

namespace ciliaval::test {

/// How the program ended.
struct Outcome {
  int code = -1;  ///< −1: by a signal
  std::string out;
  std::string err;
};

/// Runs `ciliaval` in the folder as a user does; its stdout and stderr go to `out.txt` and
/// `err.txt` there, so neither is a terminal. `environment` is put before the command: "NAME=value
/// ".
inline Outcome run_program(const std::filesystem::path& folder, const std::string& arguments,
                           const std::string& environment = "") {
  const std::string command = "cd '" + folder.string() + "' && " + environment +
                              "'" CILIAVAL_PROGRAM "' " + arguments + " >out.txt 2>err.txt";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(folder / "out.txt"),
          read_text(folder / "err.txt")};
}

}  // namespace ciliaval::test

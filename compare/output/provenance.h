// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace ciliaval::compare::output {

/// Origin of a result.
struct Provenance {
  std::string version;                           ///< of CiliaVal
  std::string git;                               ///< `git describe` of the sources, or "unknown"
  std::map<std::string, std::string> libraries;  ///< name → version
  std::string command;                           ///< as it was called, quoted for a shell
  std::string date;                              ///< ISO 8601, UTC
};

/// This program's provenance, now. `command` is handed through.
Provenance provenance(const std::string& command);

/// "ciliaval 0.1.0 (git …)": this program, as results that are kept name it.
std::string version_line();

/// The "provenance" of a result file: version, git, libraries, command, date.
nlohmann::ordered_json to_json(const Provenance& provenance);

}  // namespace ciliaval::compare::output

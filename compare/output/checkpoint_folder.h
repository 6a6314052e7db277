// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <string>

namespace ciliaval::compare::output {

/// DIR/.NAME.checkpoint, in which the models of a case keep how far they have come
/// (docs/guide/restart.md).
std::filesystem::path checkpoint_path(const std::filesystem::path& directory,
                                      const std::string& name);

/// That folder, for one process alone. It outlives the process if there is anything in it.
class CheckpointFolder {
 public:
  /// Makes the folder if it is not there. Throws FileError if that cannot be done, or if another
  /// process has it.
  CheckpointFolder(const std::filesystem::path& directory, const std::string& name);
  /// Removes the folder if it is empty.
  ~CheckpointFolder();
  CheckpointFolder(const CheckpointFolder&) = delete;
  CheckpointFolder& operator=(const CheckpointFolder&) = delete;
  CheckpointFolder(CheckpointFolder&& other) noexcept;
  CheckpointFolder& operator=(CheckpointFolder&&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// Deletes what is in it. What a kill leaves of it is no checkpoint.
  void clear();

 private:
  void lock();

  std::filesystem::path path_;
  int descriptor_ = -1;  ///< of the folder, locked
};

}  // namespace ciliaval::compare::output

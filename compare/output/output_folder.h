// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ciliaval::compare::output {

/// The results of one case, never half-written: everything goes into the temporary folder
/// DIR/.NAME.HOST.PID.tmp, which commit() puts in the place of DIR/NAME. Whenever the program ends,
/// DIR/NAME holds either the old results or the new ones, complete. (If it is killed just between
/// the two renames that this takes, they have hidden names until the next run of the case.) What
/// the user has put there is never deleted: a run leaves the list of its own files in
/// DIR/NAME/.ciliaval.
class OutputFolder {
 public:
  /// Makes DIR and the temporary folder, and removes temporary folders of the same name that
  /// processes of this host which are no longer alive have left. Throws FileError with the path and
  /// the reason if they cannot be made and written, or if DIR/NAME is a file, a link or a folder
  /// that holds anything but a former run's files; InputError if one of the `inputs` lies in
  /// it.
  OutputFolder(const std::filesystem::path& directory, const std::string& name,
               const std::vector<std::filesystem::path>& inputs = {});
  /// Removes the temporary folder unless it was committed.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  OutputFolder(OutputFolder&& other) noexcept;
  OutputFolder& operator=(OutputFolder&&) = delete;

  /// Folder to write to.
  const std::filesystem::path& path() const { return temporary_; }
  /// DIR/NAME, where the results will be.
  const std::filesystem::path& target() const { return target_; }

  /// Puts the new results in the place of the old ones. Throws FileError if that cannot be done:
  /// the old ones are then untouched, and the new ones stay in a folder that the message names.
  void commit();

 private:
  void replace();

  std::filesystem::path target_;
  std::filesystem::path temporary_;  ///< empty once committed
};

}  // namespace ciliaval::compare::output

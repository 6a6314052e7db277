// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/checkpoint_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>
#include <vector>

#include "problem/error.h"

namespace ciliaval::compare::output {

namespace fs = std::filesystem;

fs::path checkpoint_path(const fs::path& directory, const std::string& name) {
  return directory / ("." + name + ".checkpoint");
}

CheckpointFolder::CheckpointFolder(const fs::path& directory, const std::string& name)
    : path_(checkpoint_path(directory, name)) {
  lock();
}

CheckpointFolder::CheckpointFolder(CheckpointFolder&& other) noexcept
    : path_(std::exchange(other.path_, {})), descriptor_(std::exchange(other.descriptor_, -1)) {}

CheckpointFolder::~CheckpointFolder() {
  if (!path_.empty()) rmdir(path_.c_str());  // fails, as it should, if there is anything in it
  if (descriptor_ >= 0) close(descriptor_);
}

void CheckpointFolder::lock() {
  const auto fail = [this](const std::string& reason) {
    throw FileError("cannot keep checkpoints in `" + path_.string() + "`: " + reason +
                    "; choose another folder with -o DIR");
  };
  while (true) {
    if (mkdir(path_.c_str(), 0777) != 0 && errno != EEXIST) fail(std::strerror(errno));
    descriptor_ = open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor_ < 0) fail(std::strerror(errno));
    // A file system without locks is used without.
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      close(std::exchange(descriptor_, -1));
      fail("another run of this case is writing there. Wait until it has ended");
    }
    // The run that had the lock may have removed the folder before it let go.
    struct stat locked {};
    struct stat there {};
    if (fstat(descriptor_, &locked) == 0 && stat(path_.c_str(), &there) == 0 &&
        locked.st_ino == there.st_ino)
      return;
    close(std::exchange(descriptor_, -1));
  }
}

void CheckpointFolder::clear() {
  try {
    // What a model starts from is the file of its own name: without it the others mean nothing.
    for (const bool first : {true, false}) {
      std::vector<fs::path> files;
      for (const fs::directory_entry& entry : fs::directory_iterator(path_))
        if (!first || !entry.path().has_extension()) files.push_back(entry.path());
      for (const fs::path& file : files) fs::remove_all(file);
    }
  } catch (const fs::filesystem_error& error) {
    throw FileError("cannot delete the checkpoint `" + path_.string() +
                    "`: " + error.code().message());
  }
}

}  // namespace ciliaval::compare::output

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/study/folder.h"

#include <fmt/core.h>

#include "problem/error.h"

namespace ciliaval::compare::study {

namespace fs = std::filesystem;

void make_folder(const fs::path& folder) {
  try {
    if (fs::is_symlink(folder))
      throw FileError(fmt::format(
          "`{}` is a link to `{}`, which may belong to something else: remove the link or choose "
          "another folder with -o DIR",
          folder.string(), fs::read_symlink(folder).string()));
    fs::create_directories(folder);
    if (!fs::exists(folder / store_name) && !fs::is_empty(folder))
      throw FileError(
          fmt::format("`{}` is not the folder of a study: it has other files in it; "
                      "move it away or choose another folder with -o DIR",
                      folder.string()));
  } catch (const fs::filesystem_error& error) {
    throw FileError(
        fmt::format("cannot write to the output folder `{}`: {}; choose another with "
                    "-o DIR",
                    folder.string(), error.code().message()));
  }
}

}  // namespace ciliaval::compare::study

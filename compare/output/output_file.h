// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <vector>

namespace ciliaval::compare::output {

/// Writes a text to a file. A regular file, or the one that a link leads to, is replaced at once or
/// not at all. Devices, FIFOs and the program's own standard output are written to as they are.
/// Throws FileError with the path and the reason, also if the disk is full.
void write_file(const std::filesystem::path& file, std::string_view text);

/// The same for a library that writes to a name: `write` gets the name of an empty temporary file
/// of the same extension. Only a regular file can be written so.
void write_file(const std::filesystem::path& file,
                const std::function<void(const std::filesystem::path&)>& write);

/// Takes away temporary files of write_file(), and of figures, that killed commands have left in a
/// folder. Only where no other process writes: of a study while its store is open.
void remove_unfinished(const std::filesystem::path& folder);

/// Checks the files that a command will write before it starts its work; absent ones are skipped.
/// Throws InputError if one is also an input, under any name, or the same as another; FileError if
/// one cannot be written.
void check_outputs(std::initializer_list<std::optional<std::filesystem::path>> outputs,
                   const std::vector<std::filesystem::path>& inputs);

}  // namespace ciliaval::compare::output

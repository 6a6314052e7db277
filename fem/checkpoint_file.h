// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace ciliaval::fem {

/// Files that are there as a whole or not at all, whenever the program or the machine stops. One
/// line says what they are, "ciliaval-checkpoint FORMAT CRC-32 BYTES"; the rest, of that many bytes
/// and with that checksum, is the program's name and the content (docs/guide/restart.md).

/// CRC-32 (ISO 3309, as zlib's) of some bytes.
std::uint32_t checksum(std::string_view bytes);

/// Writes the file: under a temporary name first, flushed to the disk, then renamed. Throws
/// CheckpointError with the path and the reason.
void write_checkpoint_file(const std::filesystem::path& path, std::string_view program,
                           std::string_view content);

/// The content; none if there is no such file. Throws CheckpointError, which says what is wrong
/// with the file and what to do, unless it is complete, undamaged and written by `program`.
std::optional<std::string> read_checkpoint_file(const std::filesystem::path& path,
                                                std::string_view program);

/// "the checkpoint `path` cannot be used: REASON; start anew with --fresh, which deletes it": what
/// the CheckpointErrors say.
std::string refusal(const std::filesystem::path& path, std::string_view reason);

}  // namespace ciliaval::fem

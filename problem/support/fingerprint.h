// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ciliaval::support {

/// Names and values of all that a result depends on, no name twice. A result kept under another
/// fingerprint is not used.
using Fingerprint = std::vector<std::pair<std::string, std::string>>;

/// CRC-32 (ISO 3309, as zlib's) of some bytes.
std::uint32_t checksum(std::string_view bytes);

/// The content of a file as a value of a fingerprint: its size and its checksum. A file that cannot
/// be read counts as empty.
std::string describe_content(const std::filesystem::path& file);

}  // namespace ciliaval::support

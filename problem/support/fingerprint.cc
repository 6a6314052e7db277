// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/support/fingerprint.h"

#include <boost/crc.hpp>
#include <cstdio>
#include <fstream>
#include <iterator>

namespace ciliaval::support {

std::uint32_t checksum(std::string_view bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

std::string describe_content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  char text[64];
  std::snprintf(text, sizeof text, "%zu bytes with the checksum %08x", bytes.size(),
                static_cast<unsigned int>(checksum(bytes)));
  return text;
}

}  // namespace ciliaval::support

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <toml++/toml.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace ciliaval::compare::input {

/// The text of a regular file of at most `largest` bytes, of a `kind` ("case", "study") that
/// messages name. Throws InputError.
std::string read_file(const std::filesystem::path& file, std::string_view kind,
                      std::uintmax_t largest);

/// The same of at most 1 MB.
inline std::string read_toml_file(const std::filesystem::path& file, std::string_view kind) {
  return read_file(file, kind, 1'000'000);
}

/// The TOML text as a table. Throws InputError `file:line:column: what is wrong` at the first fault
/// of its syntax, with an advice where the text tells what was meant; a dotted key of more than 32
/// parts is refused too.
toml::table parse_toml(std::string_view text, std::string_view file);

}  // namespace ciliaval::compare::input

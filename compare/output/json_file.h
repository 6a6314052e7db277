// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace ciliaval::compare::output {

/// Reads JSON from a regular file of at most 256 MiB, of a `kind` ("baseline") that
/// messages name. Throws InputError `file: what is wrong`.
nlohmann::ordered_json read_json(const std::filesystem::path& file, std::string_view kind);

/// Parses JSON; `name` is the file in messages. Throws InputError if the text is no JSON, an object
/// has a key twice, or values are nested more than 100 deep: copying and writing such values
/// recurses.
nlohmann::ordered_json parse_json(std::string_view text, std::string_view name);

/// The value, or null; nlohmann itself writes what is not finite as null.
nlohmann::ordered_json or_null(const std::optional<double>& value);
/// The text, or null if it is empty.
nlohmann::ordered_json or_null(const std::string& text);

/// The value from which or_null() made the JSON.
std::optional<double> number_or_none(const nlohmann::ordered_json& json);

/// The text of a result file. Bytes that are no UTF-8 become U+FFFD.
std::string to_text(const nlohmann::ordered_json& json);

}  // namespace ciliaval::compare::output

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <string_view>

namespace ciliaval::compare::study {

/// The file in the folder of a study's results that keeps what is solved.
inline constexpr const char* store_name = "points.sqlite";
inline constexpr std::string_view store_owner = "study";  ///< of its entries

/// Makes the folder of a study's results if it is not there. Throws FileError if something else
/// lies there.
void make_folder(const std::filesystem::path& folder);

}  // namespace ciliaval::compare::study

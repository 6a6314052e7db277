// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "compare/report/figures.h"

namespace ciliaval::compare::report {

/// The PNG files of a folder and of its `pictures/`, in the page itself, as long as they are not
/// larger than 4 MB each and 24 MB together; of larger ones the name. Empty if there are none. What
/// is no PNG is added to `damaged`.
std::string pictures_content(const std::filesystem::path& folder, Figures& figures,
                             std::vector<std::string>& damaged);

}  // namespace ciliaval::compare::report

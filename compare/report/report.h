// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "compare/output/provenance.h"
#include "compare/report/figures.h"

namespace ciliaval::compare::report {

/// The page of one case, made of summary.json and the files beside it. Throws FileError if they
/// are missing or damaged.
std::string case_page(const std::filesystem::path& folder, Figures& figures);

/// A page and what could not be shown in it.
struct Report {
  std::string html;
  std::vector<std::string> damaged;  ///< "file: what is wrong with it"
};

/// The page of everything found in a folder of results and in the folders in it: cases, studies
/// (those of the paper's Fig. 4 first), budgets, convergence, test benches, readings, claims,
/// regression checks, PNG pictures in it and in its `pictures/`. What each file is, is told from
/// its keys, not from its name. What is not there is named with the command that makes it; a file
/// that is damaged or no result is named in the page and in `damaged`, and the others are shown:
/// one bad file costs no other result. `maker` is the program's own provenance. Throws FileError
/// if the folder cannot be read or holds no result at all.
Report results_page(const std::filesystem::path& folder, const output::Provenance& maker,
                    Figures& figures);

}  // namespace ciliaval::compare::report

// SPDX-License-Identifier: LGPL-2.1-or-later
// The parts of a report, each made of a result file's JSON and of nothing else. They throw what
// nlohmann::json does where a file is not as `ciliaval` writes it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "compare/report/figures.h"
#include "compare/report/html.h"
#include "compare/report/values.h"

namespace ciliaval::compare::report {

/// summary.json and the files beside it in `folder`: what was run, the shapes of all models in one
/// drawing, B and ΔB over the load, the matrix of pairs, remarks, provenance. Throws FileError,
/// InputError if a file beside it is missing or damaged.
std::string case_content(const Json& summary, const std::filesystem::path& folder,
                         Figures& figures);
/// The tables of errors, a cell for each pair of models: of the shapes, of ΔB at sensor 0.
std::string pair_matrices(const Json& summary);
/// A row of the overview: steps, models, what did not converge, how the pairs were judged.
std::vector<Cell> case_row(const Json& summary);
std::vector<std::string> case_columns();

std::string study_content(const Json& study, Figures& figures);
std::string budget_content(const Json& budget, Figures& figures);
std::string convergence_content(const Json& studies, Figures& figures);
std::string claims_content(const Json& claims);
std::string bench_content(const Json& bench, Figures& figures);
std::string readings_content(const Json& sensing);
std::string check_content(const Json& check);

/// Version, git, date and command of a file's "provenance"; "not stated" where it has none.
std::vector<Cell> provenance_cells(const Json& json);
std::vector<std::string> provenance_columns();
/// The libraries of a "provenance": "deal.II 9.4.1, …"
std::string libraries_text(const Json& json);

}  // namespace ciliaval::compare::report

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compare/models/errors.h"
#include "compare/models/run.h"
#include "compare/output/provenance.h"

namespace ciliaval::compare::output {

/// "converged", "slipped_off", "pulled_in" or "failed".
std::string_view to_string(Status status);
/// "open", "stick" or "slip"; "rim", "mantle" or "surface".
std::string_view to_string(SurfaceContact::State state);
std::string_view to_string(SurfaceContact::Where where);

/// `elastica_0002.csv`: file of a series at a step.
std::string step_file(std::string_view series, std::size_t step, std::string_view extension);

/// The material points at which a centreline is written: 201 equidistant ones and its breaks, m.
std::vector<double> output_points(const Centreline& centreline);

/// summary.json as text: the contract of docs/guide/results.md, SI units, every double with the
/// digits that give it back, what is undefined or not finite as null. `validation` is the JSON of
/// compare/validation/report.h, or empty: then there is no such key.
std::string summary_json(const models::CaseResult& result,
                         const std::vector<models::Comparison>& comparisons,
                         const Provenance& provenance, std::string_view validation = {});

/// errors.csv as text: a header and one line for each comparison; what is undefined is empty. The
/// sensors have their names, or numbers where there are none.
std::string errors_csv(const std::vector<models::Comparison>& comparisons,
                       std::span<const std::string> sensors = {});

/// fields.csv as text: a row for each step, sensor and pair of models with the load's parameters,
/// B, ΔB, the numerical uncertainty of ΔB, the field model's own and its shape's, and the band of
/// ΔB (results::field_bands()); units in the comment line. Cells of undefined or unknown numbers
/// are empty.
std::string fields_csv(const models::CaseResult& result);

/// `S,x,y,z,theta,kappa` at output_points(), units in the comment line; at a break κ is that
/// of the upper piece.
std::string centreline_csv(const Centreline& centreline);

/// A file of results: its text is made when it is asked for.
struct ResultFile {
  std::string name;
  std::function<std::string()> text;
};

/// The centrelines of all converged steps, of a sweep sweep.csv, fields.csv of a
/// case with fields, errors.csv and summary.json. They refer to the result and the comparisons.
std::vector<ResultFile> result_files(const models::CaseResult& result,
                                     const std::vector<models::Comparison>& comparisons,
                                     const Provenance& provenance,
                                     std::string_view validation = {});
/// Writes them into a folder.
void write_results(const models::CaseResult& result,
                   const std::vector<models::Comparison>& comparisons, const Provenance& provenance,
                   const std::filesystem::path& folder, std::string_view validation = {});

}  // namespace ciliaval::compare::output

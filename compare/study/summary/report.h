// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compare/output/csv_writer.h"
#include "compare/output/provenance.h"
#include "compare/study/sweep.h"

namespace ciliaval::compare::study::summary {

/// "E1(MPa)", "|dB|(uT)", for a column of a table.
std::string heading(const Parameter& parameter);
std::string heading(Output output, const Study& study);
/// An output of a result in its unit for people, or what has become of it.
std::string cell(const Study& study, const PairResult& result, std::size_t output);

/// For a terminal: a table of the points, thinned to at most 25 of them, then those without a
/// result.
std::string text(const StudyResult& result);

/// study.csv: a header, a comment line with the units, a line for each point and pair in their
/// order, SI units; what is undefined is empty.
std::string csv(const StudyResult& result);

/// The header and the comment line of a CSV file of the study; `first` is its first column.
void add_csv_header(output::CsvWriter& csv, const Study& study,
                    const std::vector<Parameter>& parameters, std::string_view first);
/// A row of it.
void add_csv_row(output::CsvWriter& csv, std::string_view first, const std::vector<double>& values,
                 const models::ModelPair& pair, const PairResult& result);

/// A number, or null; without negative zero.
nlohmann::ordered_json number_json(const std::optional<double>& value);
/// {"path", "name", "unit", members of `values`, "shown_unit", "shown_unit_size", "logarithmic"}
nlohmann::ordered_json parameter_json(const Parameter& parameter,
                                      const nlohmann::ordered_json& values);
/// What a pair made of a point: {"status", "message", OUTPUT…, "dB_uncertainty",
/// "range_uncertainty" if known}, SI units.
nlohmann::ordered_json pair_json(const Study& study, const PairResult& result);

/// study.json (docs/guide/studies.md), SI units. Nothing in it says when or how often the program
/// ran.
nlohmann::ordered_json json(const StudyResult& result, const output::Provenance& provenance);

/// How an output of a pair runs along the only parameter (or those that are zipped).
struct Trend {
  enum class Kind { none, constant, rising, falling, peak, trough, other };
  Kind kind = Kind::none;   ///< none: fewer than three values
  double first = 0;         ///< value at the first point that has one
  double last = 0;          ///< … at the last
  double largest = 0;       ///< its extreme: of a peak or trough that of the parabola through
  double extreme_at = 0;    ///< … the three points around, and where it is (parameter, SI)
  double settled_at = 0;    ///< rising, falling: where 95 % of the change is done (parameter, SI)
  std::size_t missing = 0;  ///< points without a value
};
Trend trend(const StudyResult& result, std::size_t pair, std::size_t output);

/// What the tolerances do to one output y of one pair at the case with its fixed numbers.
struct Propagation {
  /// By one number p with the standard deviation σ_p.
  struct Share {
    std::optional<double> slope;  ///< ∂y/∂p = (4 D(h) − D(2h))/3, central differences, h = σ_p/4
    double error = 0;             ///< |∂y/∂p − D(h)|: its truncation, seen from below
    std::optional<double> spread;  ///< |∂y/∂p| σ_p
  };
  std::optional<double> nominal;  ///< y
  std::vector<Share> shares;      ///< in the order of the study's tolerances
  std::optional<double> deviation;  ///< σ_y = √Σ (∂y/∂p σ_p)²: first order, independent numbers;
                                    ///< none if a slope is missing
};
Propagation propagate(const StudyResult& result, std::size_t pair, std::size_t output);

/// For a terminal: for each pair a table of the spreads and their sum; empty without tolerances.
std::string tolerance_text(const StudyResult& result);

/// A line for each pair, output and number: path, deviation, slope, its error, spread; SI units.
std::string tolerance_csv(const StudyResult& result);

/// {"numbers": [{"path", "nominal", "deviation", "unit"}], "pairs": {PAIR: {OUTPUT: {"nominal",
/// "deviation", "slopes": […], "errors": […]}}}}, SI units.
nlohmann::ordered_json tolerance_json(const StudyResult& result);

}  // namespace ciliaval::compare::study::summary

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/output/provenance.h"
#include "compare/regression/quantities.h"

namespace ciliaval::compare::regression {

/// |a − b| ≤ max(ρ max(|a|, |b|), ε).
struct AllowedDeviation {
  double relative = 0;  ///< ρ
  double absolute = 0;  ///< ε, in the unit of the quantity

  double limit(double a, double b) const;
};

/// A value from outside: a closed form, a publication, another code.
struct Reference {
  std::string label;  ///< where it comes from
  double value = 0;
  AllowedDeviation allowed;
};

/// The accepted value of a quantity.
struct Expected {
  std::string id;
  std::string unit;
  double value = 0;
  AllowedDeviation allowed;
  std::optional<Reference> reference;
};

/// A quantity that changed when a candidate was made of a baseline; none: it was not there.
struct Change {
  std::string id;
  std::optional<double> old_value;
  std::optional<double> new_value;
};

/// The accepted results of a case: `NAME.baseline.json` beside NAME.toml.
struct Baseline {
  std::string case_name;
  std::vector<std::string> case_text;  ///< to_toml() of the case, line by line
  output::Provenance origin;           ///< of the run that was accepted
  std::vector<Change> changes;         ///< from the baseline before
  std::vector<Expected> quantities;
  std::vector<Outcome> outcomes;
};

/// `dir/fig3b.baseline.json` of `dir/fig3b.toml`.
std::filesystem::path baseline_path(const std::filesystem::path& case_file);

/// The case as a baseline keeps it: the same on every machine (a mesh file without its folder), and
/// without the options of models that it does not use, of which there will be more.
std::vector<std::string> case_text(const input::Case& problem);

/// Reads a baseline. Every key must be known and there, every number finite, every tolerance
/// positive, the relative ones at most 10 %, every id once. Throws InputError `file: what is
/// wrong`.
Baseline read_baseline(const std::filesystem::path& file);
Baseline read_baseline(std::string_view text, std::string_view file);

/// The baseline as JSON, a line for each quantity, so that a difference of two can be read.
std::string to_json(const Baseline& baseline);

/// The tolerance of a quantity in a new baseline, and the widest one that `check` accepts: the
/// accuracy class of its models, as a part of the quantity's group. It is above
/// the spread between machines, kernels and ranks (docs/evidence/regression.md).
AllowedDeviation allowed_deviation(const results::Observation& quantity);

/// A baseline of measurements. It keeps the references of `old`, and its values where they differ
/// by less than their tolerance; `changes` lists the others. Throws SolverError if something failed
/// or is not finite: that is no baseline.
Baseline make_baseline(const input::Case& problem, const Measurements& measured,
                       const output::Provenance& origin, const Baseline* old);

}  // namespace ciliaval::compare::regression

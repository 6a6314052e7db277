// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/budget/chain.h"
#include "compare/models/errors.h"
#include "compare/models/registry.h"

namespace ciliaval::compare::budget {

/// The effect of one change of model on one number: next − previous.
struct BudgetLink {
  std::string from;                   ///< the previous model
  std::string to;                     ///< the next one
  std::string physics;                ///< the assumption that changes
  double value = 0;                   ///< in the row's unit
  std::optional<double> uncertainty;  ///< numerical: of `value`, in the row's unit
  models::Verdict verdict = models::Verdict::inconclusive;
};

/// A number of one load step by the paper's model and by the best one, and the links between.
struct BudgetRow {
  std::size_t step = 0;
  std::optional<std::size_t> sensor;  ///< none: of the mechanics
  std::string quantity;               ///< "tip", "tip_angle", "B", "dB", "sensitivity"
  std::string component;              ///< "x", "y", "z" or none
  std::string unit;                   ///< "m", "rad", "T", "T/N", "T/(N/m)", "T/m"
  double paper = 0;                   ///< by the paper's model
  double best = 0;                    ///< by the best model
  BudgetLink total;                   ///< best − paper
  std::vector<BudgetLink> links;      ///< from the paper's model to the best one
  std::optional<BudgetLink> beside;   ///< a model that is not on the way, less the paper's
};

struct Budget {
  std::string case_name;
  LoadPath load_path;
  Chain chain;
  std::vector<BudgetRow> rows;
  std::vector<std::string> remarks;  ///< steps and numbers that have no row, and why
  bool failed = false;               ///< whether a model failed somewhere
  double seconds = 0;                ///< wall time

  /// Whether any link has a verdict.
  bool decided() const;
};

/// Splits the difference between the paper's model and the best one of make_chain() into its links:
/// tip and tip angle of the mechanics, B, ΔB and dB/dF at each sensor, at each load step. The
/// mechanics models are solved once, on the path with the loads around each step that dB/dF needs;
/// the case's own lists of models do not matter.
///
/// A link's uncertainty is that of the pair (combined_uncertainty()): of the same deformation only
/// the field models' count. dB/dF: the truncation error of the link's difference quotient, plus the
/// relative uncertainty of the link in ΔB. Where a stage has no value, the links before and after
/// it are one. A step that a mechanics model does not bear has no rows but a remark.
///
/// Throws InputError if `without` is not as make_chain() takes it or a model is not among the
/// entries.
Budget error_budget(const input::Case& problem, std::span<const models::MechanicsEntry> mechanics,
                    std::span<const models::FieldEntry> fields,
                    const std::vector<std::string>& without, const Progress& progress = {});

/// The fault of a row's links: they must lead from the paper's model to the best one and
/// add up to their difference to rounding. Empty if nothing is.
std::string fault(const BudgetRow& row);

}  // namespace ciliaval::compare::budget

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/input/case.h"
#include "compare/models/errors.h"
#include "compare/models/registry.h"

namespace ciliaval::compare::budget {

/// Change of the case by a stage.
enum class Around {
  all,       ///< the environment as the case states it
  nothing,   ///< no environment, as in the paper
  other_law  ///< the magnetic energy by the law that the case does not state
};

/// A pair of models on the way from the paper's to the best one.
struct Stage {
  std::string mechanics;                          ///< id
  std::string field;                              ///< id
  std::string mechanics_variant;                  ///< "joints corrected"; empty if it has none
  std::string field_variant;                      ///< "stacked"; empty if it has none
  std::function<void(input::ModelOptions&)> set;  ///< makes the variants
  std::string physics;                            ///< what changes from the stage before
  bool sensitivity = true;                        ///< whether dB/dF is computed here
  Around around = Around::all;

  /// The id with what is around it or changed in it: "elastica alone", "beam, joints corrected".
  std::string mechanics_name() const;
  std::string field_name() const {
    return field_variant.empty() ? field : field + ' ' + field_variant;
  }
  std::string name() const { return mechanics_name() + '/' + field_name(); }
};

/// The stages; from one to the next a single assumption changes.
struct Chain {
  std::vector<Stage> stages;         ///< elastica/line, the paper's, first
  std::optional<Stage> beside;       ///< elastica/dipole: a model of its own, not on the way
  std::vector<Stage> mechanics;      ///< those of the mechanics models, in their order
  std::vector<std::string> not_run;  ///< stages that are left out, each with the model it lacks

  /// The assumptions that change from one stage to a later one.
  std::string physics(std::size_t from, std::size_t to) const;
};

/// Stages by which the models' entries add to the models before them (Entry::budget_stages), one
/// assumption each: the mechanics with the field of the paper's pair, which is the first of each,
/// then the fields on the best mechanics. For the shipped models: elastica/line → beam/line → the
/// same with corrected joints, if the case has them in the beam → solid/line → solid/volume stacked
/// → solid/volume wedge → solid/mesh R → solid/mesh F → solid/potential mu_r = 1 → the same with
/// the case's μ_r, if it is another → with the case's plates, if it has any. In an environment the
/// first ones stand alone up to the first model that takes it, and in a field the best mechanics
/// has both magnetic energies. `without` names models to leave out, all but the paper's: without
/// the last body the fields go with the rod before, and those of a body are left out; "sensitivity"
/// leaves out dB/dF. Throws InputError if one is not one of these.
Chain make_chain(const input::Case& problem,
                 std::span<const models::MechanicsEntry> mechanics_entries,
                 std::span<const models::FieldEntry> field_entries,
                 const std::vector<std::string>& without);

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
  std::string quantity;   ///< of the mechanics results::Quantity::name; "B", "dB", "sensitivity"
  std::string component;  ///< "x", "y", "z" or none
  std::string unit;       ///< SI: "m", "rad", "T", "T/N", …
  double paper = 0;       ///< by the paper's model
  double best = 0;        ///< by the best model
  BudgetLink total;       ///< best − paper
  std::vector<BudgetLink> links;     ///< from the paper's model to the best one
  std::optional<BudgetLink> beside;  ///< a model that is not on the way, less the paper's
};

struct Budget {
  std::string case_name;
  std::vector<std::string> sensor_names;
  LoadPath load_path;
  Chain chain;
  std::vector<BudgetRow> rows;
  std::vector<std::string> remarks;  ///< steps and numbers that have no row, and why
  bool failed = false;               ///< whether a model failed somewhere
  double seconds = 0;                ///< wall time

  /// True if any link has a verdict.
  bool decided() const;
};

/// Splits the difference between the paper's model and the best one of make_chain() into its links:
/// what people look at first of the mechanics (results::Quantity), B, ΔB and dB/dF at each sensor,
/// at each load step. The
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

}  // namespace ciliaval::compare::budget

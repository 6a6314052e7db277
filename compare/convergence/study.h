// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "compare/convergence/extrapolation.h"
#include "compare/input/case.h"
#include "compare/output/provenance.h"
#include "compare/results/observation.h"
#include "problem/mechanics_model.h"

namespace ciliaval::compare::convergence {

/// A refinement of a model of a case, and the option that it sets.
struct ModelRefinement {
  std::string model;      ///< id of the mechanics model, or of the field model
  bool is_field = false;  ///< … which then runs on one of the case's mechanics models
  double rounding = 0;    ///< two computations agree to it, relative to the scale
  input::Option option;
  input::Refinement sequence;

  void set(input::ModelOptions& options, double value) const;
};

/// Refinements of the models that the case asks for, with the method that it asks for.
std::vector<ModelRefinement> refinements(const input::Case& problem);

/// A row of the table of results on all levels, finest first.
struct ConvergedQuantity {
  results::Observation finest;
  std::vector<RefinementLevel> levels;
  Extrapolation extrapolation;
};

struct RefinementStudy {
  std::string model;
  std::string option;
  std::string size_name;
  std::vector<double> settings;  ///< of the option, finest first
  double own_setting = 0;        ///< the case's
  std::vector<double> seconds;   ///< wall time of each
  std::vector<ConvergedQuantity> quantities;
  std::string failure;  ///< why there is no study; else empty
};

/// Runs a case with one of its mechanics models, and the fields on it, or with one field model on
/// the first mechanics model that serves it, on `count` ≥ 3 levels from the coarsest on, or on all
/// that there are, and extrapolates each quantity. Tolerances of a mechanics model are those of its
/// shape: fields are left out. A model that fails on a level leaves none with a study, a quantity
/// that a level lacks has none. Throws InputError if `count` is below 3.
RefinementStudy refinement_study(const input::Case& problem, const ModelRefinement& refinement,
                                 unsigned int count, const Progress& progress = {});

/// For people: a line for each model, how many numbers have an interval and the largest of these
/// over its scale, how far tip and dB by the case's own setting are from the limit, or a failure;
/// with `list` the tip, its angle and the field components with what
/// the levels say; then the verdict on all.
std::string study_text(const std::vector<RefinementStudy>& studies, bool list);
/// {"schema": 1, "case", "provenance", "studies": [{"model", "option", "size_name", "settings",
/// "seconds", "failure", "quantities": [{"id", "step", "mechanics", "field", "sensor", "quantity",
/// "component", "unit", "levels": [{"size", "value"}], "conclusive", "reason", "order", "limit",
/// "uncertainty", "safety"}]}]}
std::string study_json(const std::string& case_name, const std::vector<RefinementStudy>& studies,
                       const output::Provenance& provenance);
/// A row for each quantity: model, option, quantity, unit, conclusive, order, limit, uncertainty,
/// safety, reason, then size and value of each level, finest first.
std::string study_csv(const std::vector<RefinementStudy>& studies);

}  // namespace ciliaval::compare::convergence

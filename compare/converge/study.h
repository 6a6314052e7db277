// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compare/case.h"
#include "compare/converge/extrapolation.h"
#include "problem/mechanics_model.h"

namespace ciliaval::compare {

/// How a model is refined.
struct Refinement {
  std::string model;  ///< id of the mechanics model, or of the field model
  bool is_field;      ///< … which then runs on the first of the case's mechanics models
  std::string knob;   ///< of it, as in `[models.solid] refinement`
  std::function<void(ModelOptions&, unsigned int)> set;
  std::function<double(unsigned int)> size;  ///< h of a level
  std::string size_name;                     ///< what h is, for people
  unsigned int coarsest = 0;
  unsigned int finest = 0;  ///< the model has no finer one
  std::optional<double> formal_order;
};

/// The discretised models: the beam's elements, the meshes of CalculiX and the solid, the dipoles
/// of the paper's sums. The elastica is integrated to its tolerance and all other field models to
/// theirs: they have no levels.
const std::vector<Refinement>& refinements();

/// Those of the models that the case asks for, with the method that it asks for.
std::vector<Refinement> refinements(const Case& problem);

/// One quantity of a case on all levels, finest first: those of compare/check/quantities.h, and
/// made of them `…/tip/deflection`, the tip's horizontal distance √(x² + y²) from the base, and
/// `…/dB/SENSOR/norm`, |ΔB|.
struct ConvergedQuantity {
  std::string id;
  std::string unit;
  std::vector<Level> levels;
  Extrapolation extrapolation;
};

struct RefinementStudy {
  std::string model;
  std::string knob;
  std::string size_name;
  std::vector<unsigned int> settings;  ///< of the knob, finest first
  std::vector<double> seconds;         ///< wall time of each
  std::vector<ConvergedQuantity> quantities;
  std::string failure;  ///< why there is no study; else empty
};

/// Runs a case with one of its mechanics models, and the fields on it, or with one field model, on
/// the `count` ≥ 3 levels from the coarsest on and extrapolates each quantity. A model that fails
/// on a level leaves none with a study, a quantity that a level lacks has none. Throws InputError
/// if there are not so many levels.
RefinementStudy refinement_study(const Case& problem, const Refinement& refinement,
                                 unsigned int count, const Progress& progress = {});

/// Tables for people: of each model the tip, its angle and the field components, with what the
/// levels say.
std::string study_text(const std::vector<RefinementStudy>& studies);
/// {"schema": 1, "case", "studies": [{"model", "knob", "settings", "seconds", "failure",
/// "quantities": [{"id", "unit", "levels": [{"size", "value"}], "conclusive", "reason", "order",
/// "limit", "uncertainty", "safety"}]}]}
std::string study_json(const std::string& case_name, const std::vector<RefinementStudy>& studies);
/// A line for each quantity: model, id, unit, conclusive, order, limit, uncertainty, safety,
/// reason, then size and value of each level.
std::string study_csv(const std::vector<RefinementStudy>& studies);

}  // namespace ciliaval::compare

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

#include "compare/input/case.h"

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

/// Those of the models that the case asks for, with the method that it asks for.
std::vector<ModelRefinement> refinements(const input::Case& problem);

}  // namespace ciliaval::compare::convergence

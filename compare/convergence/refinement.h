// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compare/input/case.h"

namespace ciliaval::compare::convergence {

/// How a model is refined: a knob of it, and the values that the knob takes.
struct Refinement {
  enum class Law {
    power,     ///< the error is α h^p, or nearly: extrapolate()
    tolerance  ///< the model promises an error below h times the scale: kept_tolerances()
  };
  std::string model;           ///< id of the mechanics model, or of the field model
  bool is_field;               ///< … which then runs on one of the case's mechanics models
  std::string knob;            ///< as in `[models.solid] refinement`
  std::vector<double> values;  ///< of the knob, coarsest first
  std::function<void(input::ModelOptions&, double)> set;
  std::function<double(double)> size;  ///< h of a value
  std::string size_name;               ///< what h is, for people
  Law law = Law::power;
  std::optional<double> formal_order{};
};

/// All of them, the models in the order of the registry:
/// meshes of beam, CalculiX and solid; the degree of the beam's elements, with h = 2^-degree, so
/// that the order is the number of bits gained per degree; the dipoles of the paper's sums;
/// tolerances, of the elastica's integration, of the quadratures of `line`, `volume` and `mesh`,
/// and of the adaptive meshes of `potential`. `dipole` is a closed form.
const std::vector<Refinement>& refinements();

/// Those of the models that the case asks for, with the method that it asks for.
std::vector<Refinement> refinements(const input::Case& problem);

}  // namespace ciliaval::compare::convergence

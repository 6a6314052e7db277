// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compare/input/case.h"

namespace ciliaval::compare::budget {

/// A pair of models on the way from the paper's to the best one.
struct Stage {
  std::string mechanics;  ///< id
  std::string field;      ///< id
  std::string variant;    ///< of the field model: "stacked"; empty if it has none
  std::function<void(input::ModelOptions&)> set;  ///< makes the variant
  std::string physics;      ///< the assumption that changes from the stage before
  bool sensitivity = true;  ///< whether dB/dF is computed here

  std::string field_name() const { return variant.empty() ? field : field + ' ' + variant; }
  std::string name() const { return mechanics + '/' + field_name(); }
};

/// The stages; from one to the next a single assumption changes.
struct Chain {
  std::vector<Stage> stages;           ///< elastica/line, the paper's, first
  std::optional<Stage> beside;         ///< elastica/dipole: a model of its own, not on the way
  std::vector<std::string> mechanics;  ///< ids, in the order in which they come
  std::vector<std::string> not_run;    ///< stages that are left out, each with the model it lacks

  /// The assumptions that change from one stage to a later one.
  std::string physics(std::size_t from, std::size_t to) const;
};

/// elastica/line → beam/line → solid/line → solid/volume stacked → solid/volume wedge → solid/mesh
/// R → solid/mesh F → solid/potential mu_r = 1 → the same with the case's μ_r, if it is another →
/// with the case's plates, if it has any. The options are the case's but for those named; line and
/// potential push forward by F. `without` names models to leave out: beam, solid (its fields then
/// go with the beam, and mesh with it is left out), volume, mesh, potential, dipole; "sensitivity"
/// leaves out dB/dF. Throws InputError if one is not one of these.
Chain make_chain(const input::Case& problem, const std::vector<std::string>& without);

}  // namespace ciliaval::compare::budget

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/study/optimum/search.h"
#include "compare/study/sweep.h"

namespace ciliaval::compare::study::optimum {

/// A design with what the pairs make of it.
struct Design {
  std::string name;            ///< "start", "optimum 1", …
  std::vector<double> values;  ///< of the parameters, SI units
  std::vector<models::ModelPair> models;
  std::vector<PairResult> pairs;  ///< for each of `models`
};

/// The goal along one parameter through the best design, the others held there.
struct Slice {
  std::vector<double> at;                     ///< values of the parameter, SI units, ascending
  std::vector<std::optional<double>> values;  ///< of the goal; none where a design has none
  std::vector<bool> keeps;                    ///< whether the design keeps the limits
};

/// What an optimisation found.
struct Optimum {
  SearchResult search;          ///< in the unit box of the parameters' bounds
  std::vector<Slice> slices;    ///< one of each parameter, by the pair that searched
  std::vector<Design> designs;  ///< the start, then each of `search.optima`; by all pairs the start
                                ///< and the best, by the mechanics model that searched the others
  std::size_t evaluations = 0;  ///< distinct designs that the search has asked for

  bool found() const { return designs.size() > 1; }
};

/// The constraints of the search: the study's limits, and that a contact or probe does not slip off
/// under the design's own load.
std::vector<Limit> constraints_of(const Study& study);

/// The magnitude of an output of the study in a result.
std::optional<double> magnitude_of(const Study& study, const PairResult& result, Output output);

/// Searches with the study's first pair and confirms with all of them. The gain is ln|y| of the
/// goal y, a constraint ln(limit/|y|) or ln(|y|/limit), so that the multipliers are elasticities:
/// per cent of the goal for one per cent of the limit. A design without a goal, because it slips
/// off or the model fails, has a stand-in far below; how far it is from bearing its load is known
/// from its range all the same. The search asks for the same sequence of designs again and finds
/// those that are kept. Throws RankFailure, CheckpointError.
Optimum run_optimisation(const Study& study, Solutions& solutions,
                         std::span<const models::MechanicsEntry> mechanics_models,
                         std::span<const models::FieldEntry> field_models,
                         const Progress& progress = {});

/// For a terminal: the designs, what limits them, and what each pair makes of them.
std::string text(const Study& study, const Optimum& optimum);

/// optimum.csv: a line for each design and pair, as study.csv has it.
std::string csv(const Study& study, const Optimum& optimum);

/// The object `optimum` of study.json (docs/guide/studies.md), SI units.
nlohmann::ordered_json json(const Study& study, const Optimum& optimum);

}  // namespace ciliaval::compare::study::optimum

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "compare/study/evaluate.h"

namespace ciliaval::compare::study {

/// A number, or null; without negative zero.
nlohmann::ordered_json to_json(const std::optional<double>& value);

/// The results of a mechanics model's pairs as a journal keeps them: every number comes back as it
/// was. None for JSON of another form, or with another number of pairs or outputs; without pairs
/// too. Throws what nlohmann::json does.
nlohmann::ordered_json to_json(const std::vector<PairResult>& results);
std::optional<std::vector<PairResult>> results_from(const nlohmann::ordered_json& json,
                                                    std::size_t outputs, std::size_t pairs);

}  // namespace ciliaval::compare::study

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/output/provenance.h"

namespace ciliaval::compare::claims {

/// What one pair of models (or one measure) finds for a claim: a value, or the range of values over
/// the loads.
struct Finding {
  std::string models;  ///< "elastica/volume", or what was measured
  double low = 0;
  double high = 0;
  std::string unit;
  double uncertainty = 0;     ///< half-width that each end may be off by, where it is known
  std::optional<bool> holds;  ///< whether the claim does; none: the uncertainty decides nothing
};

/// A finding whose values must all lie in [at_least, at_most]: it holds if they do with their
/// uncertainty, fails if they do not even so, and is undecided between.
Finding in_range(std::string models, double low, double high, std::string unit, double at_least,
                 double at_most, double uncertainty = 0);
/// A finding that holds or not for a reason of its own.
Finding judged(std::string models, double low, double high, std::string unit, bool holds);

enum class ClaimVerdict { reproduced, not_reproduced, depends_on_the_model, not_checkable };
std::string_view to_string(ClaimVerdict verdict);

/// A quantitative statement of the paper.
struct Claim {
  std::string place;      ///< "3.3, Fig. 3d"
  std::string statement;  ///< in a few words, with the paper's figure
  std::vector<Finding> findings;
  std::string note;  ///< why it cannot be checked, or what one should know

  /// Reproduced if it holds in all findings that decide it, not reproduced if in none; not
  /// checkable if none decides.
  ClaimVerdict verdict() const;
};

/// A table for people.
std::string claims_text(const std::vector<Claim>& claims);
/// {"schema": 1, "provenance", "claims": [{"place", "statement", "verdict", "note", "findings":
/// [{"models", "low", "high", "unit", "uncertainty", "holds"}]}]}
std::string claims_json(const std::vector<Claim>& claims, const output::Provenance& provenance);

}  // namespace ciliaval::compare::claims

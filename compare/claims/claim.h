// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/output/provenance.h"
#include "problem/mechanics_model.h"

namespace ciliaval::compare::claims {

/// The range of some values.
struct Span {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  double uncertainty = 0;  ///< half-width that each end may be off by, where it is known

  void add(double value, double off = 0);
};

/// The value that one pair of models (or one measure) finds for a claim, or its range over the
/// loads.
struct Evidence {
  std::string models;  ///< "elastica/volume", or the measure
  Span values;
  std::string unit;
  std::optional<bool> holds;  ///< whether the claim does; none: the uncertainty decides nothing
};

/// Evidence whose values must all lie in [at_least, at_most]: the claim holds if they do with their
/// uncertainty, fails if they do not even so, and is undecided between.
Evidence in_range(std::string models, const Span& values, std::string unit, double at_least,
                  double at_most);

enum class ClaimVerdict { reproduced, not_reproduced, depends_on_the_model, not_checkable };
std::string_view to_string(ClaimVerdict verdict);

/// A quantitative statement of the paper.
struct Claim {
  std::string place;      ///< "3.3, Fig. 3d"
  std::string statement;  ///< in a few words, with the paper's figure
  std::string note;       ///< why it cannot be checked, or a remark
  std::vector<Evidence> evidence;

  /// Reproduced if all evidence that decides it speaks for it, not reproduced if none does; not
  /// checkable if none decides.
  ClaimVerdict verdict() const;
};

/// A table for people.
std::string claims_text(const std::vector<Claim>& claims);
/// {"schema": 1, "provenance", "claims": [{"place", "statement", "verdict", "note", "findings":
/// [{"models", "low", "high", "unit", "uncertainty", "holds"}]}]}
std::string claims_json(const std::vector<Claim>& claims, const output::Provenance& provenance);

/// Every quantitative statement of the paper that its text allows to be checked, and those that it
/// does not, in the paper's order, each with the findings of the models. `folder` is that of the
/// shipped cases (cases/paper/): fig3b.toml, fig3d.toml, fig5.toml, fig4*.study.toml,
/// fig5.sense.toml and fig6-*.toml. `with_solid`: also with the 3D solid, half a minute more.
/// Throws InputError and FileError if a file is missing or not as shipped, SolverError if a model
/// fails.
std::vector<Claim> claims(const std::filesystem::path& folder, bool with_solid,
                          const Progress& progress = {});

// Its parts, in the order of the paper's sections.

/// Sections 3.2, 3.3: shapes, the two dipole models, costs, misprints.
std::vector<Claim> model_claims(const std::filesystem::path& folder, bool with_solid,
                                const Progress& progress);
/// Section 3.4: the design studies.
std::vector<Claim> design_claims(const std::filesystem::path& folder, bool with_solid,
                                 const Progress& progress);
/// Section 3.5: the flow.
std::vector<Claim> flow_claims(const std::filesystem::path& folder, bool with_solid,
                               const Progress& progress);
/// Section 3.6: surfaces and textures, by the rods.
std::vector<Claim> sweep_claims(const std::filesystem::path& folder, bool with_solid,
                                const Progress& progress);

}  // namespace ciliaval::compare::claims

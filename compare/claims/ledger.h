// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "compare/claims/claim.h"
#include "problem/mechanics_model.h"

namespace ciliaval::compare::claims {

/// Every quantitative statement of the paper that its text allows to be checked, and those that it
/// does not, in the paper's order, each with the findings of the models. `folder` is that of the
/// shipped cases (cases/paper/): fig3b.toml, fig3d.toml, fig5.toml, fig4*.study.toml and
/// fig5.sense.toml. `with_solid`: also with the 3D solid, half a minute more. Throws InputError and
/// FileError if a file is missing or not as shipped, SolverError if a model fails.
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

}  // namespace ciliaval::compare::claims

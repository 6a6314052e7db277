// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "compare/models/run.h"
#include "compare/output/field_grid.h"
#include "compare/output/provenance.h"

namespace ciliaval::compare::output::vtk {

/// The steps of a path that are drawn: at most 200, evenly chosen, or all.
std::vector<std::size_t> drawn_steps(std::size_t steps, bool all);

/// Writes all that can be drawn into a folder, which it makes: for each converged step among
/// `drawn` the bodies, centrelines and dipoles of every mechanics model, the sensors and the field
/// on the grid; one `.pvd` for each series; `open.py`, which opens them in ParaView. Throws
/// FileError.
void write_vtk(const models::CaseResult& result, const std::optional<FieldGrid>& grid,
               const Provenance& provenance, const std::vector<std::size_t>& drawn,
               const std::filesystem::path& folder);

}  // namespace ciliaval::compare::output::vtk

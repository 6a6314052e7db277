// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <memory>

#include "problem/surroundings/surface.h"

namespace ciliaval::compare::input {
class Section;
}

/// The table [surface] of a case file.
namespace ciliaval::compare::input::sweep {

/// Surface as the table states it, and the surface made from it; null if there is a fault.
struct StatedAndMade {
  surroundings::StatedSurface stated;
  std::shared_ptr<const surroundings::Surface> made;
};

/// Reads the table; a file's name is that of a file in `folder`, unless absolute. The file's own
/// faults are thrown as an InputError that names it; all others are added.
StatedAndMade read_surface(Section& table, const std::filesystem::path& folder);

/// The profile in a CSV file, `x [mm], height [mm]`: x counts along the way that the tip goes over
/// the surface, x = s − (place over the base). Throws InputError with every fault and its place.
surroundings::SampledProfile read_profile(const std::filesystem::path& file);

}  // namespace ciliaval::compare::input::sweep

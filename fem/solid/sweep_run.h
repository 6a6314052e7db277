// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <memory>

#include "fem/solid/level.h"
#include "fem/solid/solid_options.h"
#include "problem/mechanics_model.h"

namespace ciliaval::fem::solid {

/// The level under the surface of a sweep, place by place. At the first one the cilium comes back
/// from far ahead, where a horizontal force holds it bent aside, until the surface holds it. Throws
/// InputError if the loads differ in azimuth or surface, or if a cilium bent down to 0.6 of its
/// length has no room under the surface. Collective.
MechanicsResult follow_sweep(std::unique_ptr<Level> level, const LoadPath& path,
                             const SolidOptions& options, const Progress& progress);

}  // namespace ciliaval::fem::solid

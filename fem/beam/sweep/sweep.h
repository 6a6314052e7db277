// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <vector>

#include "fem/beam/beam.h"

namespace ciliaval::fem::beam::sweep {

/// The steps of a path of SweepLoads, all with the same surface and azimuth. Where the path cannot
/// be followed any further the steps have the status failed. Throws InputError if the loads differ
/// in more than interference and travel, or if the beam has more unknowns than a dense matrix
/// bears.
std::vector<MechanicsStep> solve(const Cilium& cilium, const LoadPath& path,
                                 const BeamOptions& options, const Progress& progress);

/// Takes back the uncertainties of samples at which the result and a companion are on different
/// sides of a jump, or in contact and not, and says so in the steps' messages.
void forget_uncertainties_near_jumps(MechanicsResult& result);

}  // namespace ciliaval::fem::beam::sweep

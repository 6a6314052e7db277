// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "analytic/elastica/tip_contact.h"
#include "problem/mechanics_model.h"

namespace ciliaval::analytic::elastica {

/// The steps of a path of SweepLoads, all with the same surface and azimuth, to a relative
/// tolerance. Where the path cannot be followed any further the steps have the status failed.
/// Throws InputError if the loads differ in more than interference and travel.
MechanicsResult solve_sweep(const Cilium& cilium, const LoadPath& path, CiliumEnd end,
                            double tolerance, const Progress& progress);

}  // namespace ciliaval::analytic::elastica

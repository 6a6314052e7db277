// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>

#include "compare/input/external/external.h"
#include "problem/cilium.h"
#include "problem/load.h"

namespace ciliaval::compare::input::external {

/// Reads the files that the model names, which are as many centrelines as load steps or none, for
/// this cilium, path and number of sensors (docs/guide/referees.md): fills in centrelines, remarks,
/// undeformed and readings.
///
/// Centrelines are interpolated by cubic polynomials between the points; without a column S it is
/// the length along the points, scaled to the cilium's; without theta the sections are normal to
/// the curve. Of the readings B the background at the load's azimuth is taken off, that of the row
/// of this azimuth, or interpolated linearly on the circle.
///
/// Throws InputError with every fault found, a line each: `file:line:column: what is wrong`.
void read_external_files(ExternalModel& model, const Cilium& cilium, const LoadPath& path,
                         std::size_t sensors);

}  // namespace ciliaval::compare::input::external

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

#include "compare/models/errors.h"
#include "compare/models/run.h"

namespace ciliaval::compare::output {

/// A load in a line: "contact, force 1 mN at height 16 mm, azimuth 30 deg".
std::string describe(const Load& load);

/// The results for a terminal: for each step what every model gives and what separates it from its
/// reference, over the path the RRMSE, and a legend that says what is divided by what. Lengths in
/// mm, angles in degrees, forces in mN, B in mT and dB in uT, of the first sensor.
std::string table(const models::CaseResult& result,
                  const std::vector<models::Comparison>& comparisons);

}  // namespace ciliaval::compare::output

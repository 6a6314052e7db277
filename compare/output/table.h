// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compare/models/errors.h"
#include "compare/models/run.h"

namespace ciliaval::compare::output {

/// A load in a line: "contact, force 1 mN at height 16 mm, azimuth 30 deg", with the field around
/// it.
std::string describe(const Load& load);
/// A step that is done in a line: the load, the tip or what has become of it, the time.
std::string describe(const MechanicsStep& step);

enum class Footnotes { reference, text };

/// End of a table whose headings have footnotes (1), (2), …: the footnotes, or how to get them.
std::string footnotes(Footnotes which, std::string_view text);

enum class Steps { last, all };

/// The results for a terminal: what they mean, for the last step with a shape or all of them what
/// every model gives and what separates it from its reference, over the path the RRMSE; the
/// footnotes say what is divided by what. Lengths in mm, angles in degrees, forces in mN, B in mT
/// and dB in uT, of each sensor; of very many the first.
std::string table(const models::CaseResult& result,
                  const std::vector<models::Comparison>& comparisons, Footnotes which,
                  Steps steps = Steps::last);

}  // namespace ciliaval::compare::output

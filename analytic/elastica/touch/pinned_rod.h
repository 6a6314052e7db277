// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <memory>

#include "problem/pin/path.h"

namespace ciliaval::analytic::elastica::touch {

/// The elastica that the pin of a load touches, to the relative tolerance. Throws InputError.
std::unique_ptr<pin::Body> pinned_rod(const Cilium& cilium, const Load& load, double tolerance);

}  // namespace ciliaval::analytic::elastica::touch

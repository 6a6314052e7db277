// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "fem/solid/solid_options.h"
#include "problem/cilium.h"
#include "problem/load.h"
#include "problem/support/fingerprint.h"

namespace ciliaval::fem::solid {

/// Cilium, loads and options (of the user's mesh file the content, wherever it lies), but not
/// max_iterations and max_cutbacks: those may be raised to go on after a failure.
support::Fingerprint fingerprint(const Cilium& cilium, const LoadPath& path,
                                 const SolidOptions& options);

}  // namespace ciliaval::fem::solid

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>

#include "problem/cilium.h"
#include "problem/load.h"

namespace ciliaval::compare::models {

/// A line for people about what friction would do to a horizontal contact force: the force on a
/// probe that slides on the axis to the same place, by the elastica, without friction and with 0.6,
/// the range of dry rubber and prints (docs/theory/touch.md). Empty where the case states a touch
/// or has no contact, in an environment, and where it is 2 % or less.
std::string unstated_touch(const Cilium& cilium, const Load& load);

/// It takes the largest load of the path.
std::string unstated_touch(const Cilium& cilium, const LoadPath& path);

}  // namespace ciliaval::compare::models

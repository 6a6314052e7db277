// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "problem/description/field.h"
#include "problem/surroundings/environment.h"
#include "problem/surroundings/magnets/magnet.h"

namespace ciliaval::description {

/// [environment] without its magnets.
template <>
const Fields<surroundings::Environment>& fields<surroundings::Environment>();
/// [[environment.magnet]].
template <>
const Fields<surroundings::magnets::Magnet>& fields<surroundings::magnets::Magnet>();

}  // namespace ciliaval::description

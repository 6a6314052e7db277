// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>

#include "compare/input/model_entry.h"
#include "problem/load.h"

namespace ciliaval::compare::input::schema {

/// A commented case file to start from: the paper's cilium under a load of this type, a sensor, and
/// the quick models that take the load. Keys with a default are comments.
std::string starter_case(const std::string& name, const LoadType& load, const Models& models);

}  // namespace ciliaval::compare::input::schema

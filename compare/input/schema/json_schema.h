// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>

#include "compare/input/model_entry.h"

namespace ciliaval::compare::input::schema {

/// The JSON schema (draft-07) of case files, for editors: every key with its kind, choices, range
/// and meaning; no others. A condition on the values of two keys is left to read_case(), but for
/// the keys that go with a type of load or profile. A quantity is a number with any unit in it.
std::string json_schema(const Models& models);

}  // namespace ciliaval::compare::input::schema

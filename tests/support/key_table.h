// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>

#include "compare/input/model_entry.h"

namespace ciliaval::test {

/// Every key of a case file as a Markdown table: key, value, range, default, meaning. It is the
/// table in docs/guide/cases.md.
std::string key_table(const compare::input::Models& models);

}  // namespace ciliaval::test

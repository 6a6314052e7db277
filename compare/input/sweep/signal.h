// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>
#include <string>

#include "compare/signal/signal.h"
#include "problem/description/field.h"

namespace ciliaval::description {
template <>
const Fields<compare::signal::SignalOptions>& fields<compare::signal::SignalOptions>();
}

namespace ciliaval::compare::input {
class Section;
}

namespace ciliaval::compare::input::sweep {

/// Reads the table [signal]; none if there is none.
std::optional<signal::SignalOptions> read_signal(Section& root);

/// The table as TOML.
std::string to_toml(const signal::SignalOptions& options);

}  // namespace ciliaval::compare::input::sweep

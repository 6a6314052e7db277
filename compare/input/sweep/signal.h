// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compare/signal/signal.h"
#include "problem/parameter.h"

namespace ciliaval::compare::input {
class Section;
}

namespace ciliaval::compare::input::sweep {

/// The quantities of the table [signal]; it has `seed`, `order` and `phase` besides.
const std::vector<QuantityKey>& signal_keys();
std::vector<std::string_view> phase_names();

/// Reads the table [signal]; none if there is none.
std::optional<signal::SignalOptions> read_signal(Section& root);

/// The table as TOML.
std::string to_toml(const signal::SignalOptions& options);

}  // namespace ciliaval::compare::input::sweep

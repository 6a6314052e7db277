// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <span>
#include <string_view>

#include "compare/output/text_table.h"
#include "problem/load.h"
#include "problem/parameter.h"

namespace ciliaval::compare::study {

/// What a study computes for each pair of models at each point, SI units.
enum class Output {
  B_x,          ///< B at the sensor, T
  B_y,          ///< …
  B_z,          ///< …
  dB_x,         ///< ΔB at the sensor, T
  dB_y,         ///< …
  dB_z,         ///< …
  dB_norm,      ///< |ΔB|, T
  sensitivity,  ///< d|ΔB|/dF, F the load's magnitude: T/N, T m/N (force per length) or T/m (probe)
  range,        ///< the largest F: where the contact slips off, or the tip's rotation is `rotation`
  resolution    ///< the change of F that the sensor's noise hides: noise / |sensitivity|
};
std::span<const Output> all_outputs();

/// "dB_norm", as files say it.
std::string_view id(Output output);
/// "|dB|", as tables say it.
std::string_view symbol(Output output);
/// "|ΔB|", as the axis of a plot says it.
std::string_view title(Output output);

/// What an output is under this type of load, with its SI unit.
Quantity quantity_of(Output output, const Load& load);
/// The unit for people.
output::ShownUnit unit_of(Output output, const Load& load);

}  // namespace ciliaval::compare::study

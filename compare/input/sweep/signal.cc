// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/sweep/signal.h"

#include <fmt/format.h>

#include "compare/input/described.h"

namespace ciliaval::description {

template <>
const Fields<compare::input::sweep::SignalOptions>& fields<compare::input::sweep::SignalOptions>() {
  using compare::input::sweep::SignalOptions;
  constexpr double highest_order = 20;
  using Phase = SignalOptions::Phase;
  static constexpr Range frequency_range{1e-6, 1e9, false, unit_slip};
  const auto of_filter = [](Field<SignalOptions> field) {
    field.condition = [](const SignalOptions& options) { return options.cutoff > 0; };
    field.goes_with = "'cutoff'";
    return field;
  };
  static const Fields<SignalOptions> all{
      required(field(&SignalOptions::sampling_rate, "sampling_rate", quantity::frequency,
                     frequency_range,
                     "Of the sensor; the sweep's samples are joined by straight lines.")),
      falls_back_to(
          field(&SignalOptions::noise, "noise", quantity::flux_density, {0, 1, false, unit_slip},
                "Standard deviation of the sensor's noise, each component."),
          "0 uT"),
      optional(field(&SignalOptions::cutoff, "cutoff", quantity::frequency, frequency_range,
                     "Of a Butterworth high-pass filter; below half the sampling rate."),
               "no filter"),
      field(&SignalOptions::seed, "seed", {0, 4294967295.0, false, "a seed has 32 bits"},
            "Of the noise; each sensor has its own."),
      of_filter(
          falls_back_to(field(&SignalOptions::order, "order",
                              {1, highest_order, false, "higher filters are badly conditioned"},
                              "Of the filter."),
                        "4 (the paper's)")),
      of_filter(choice(&SignalOptions::phase, "phase",
                       {{"causal", Phase::causal}, {"zero_phase", Phase::zero}},
                       "A filter in the logger, or one of the whole record that shifts nothing."))};
  return all;
}

}  // namespace ciliaval::description

namespace ciliaval::compare::input::sweep {

std::optional<SignalOptions> read_signal(Section& root) {
  Section table = root.section("signal");
  if (!table.exists()) return std::nullopt;
  SignalOptions options;
  read(table, description::fields<SignalOptions>(), options);
  if (options.cutoff > 0 && options.sampling_rate > 0 &&
      !(options.cutoff < options.sampling_rate / 2))
    table.faults().add(place(*table.find("cutoff")),
                       fmt::format("'cutoff' is {:g} Hz, but must be below half the "
                                   "'sampling_rate', {:g} Hz",
                                   options.cutoff, options.sampling_rate / 2));
  table.finish();
  return options;
}

std::string to_toml(const SignalOptions& options) {
  return "\n[signal]\n" + lines(description::fields<SignalOptions>(), options);
}

}  // namespace ciliaval::compare::input::sweep

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/sweep/signal.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "compare/input/case_toml.h"
#include "compare/signal/butterworth.h"

namespace ciliaval::compare::input::sweep {
namespace {

using signal::SignalOptions;
using Phase = SignalOptions::Phase;

constexpr std::string_view table_name = "signal";
constexpr Range frequency_range{1e-6, 1e9, false, unit_slip};

constexpr std::array<std::pair<std::string_view, Phase>, 2> phases{
    {{"causal", Phase::causal}, {"zero_phase", Phase::zero}}};

/// The members of the quantities, in the order of signal_keys().
constexpr std::array members{&SignalOptions::sampling_rate, &SignalOptions::noise,
                             &SignalOptions::cutoff};

}  // namespace

const std::vector<QuantityKey>& signal_keys() {
  static const std::vector<QuantityKey> keys{
      {table_name, "sampling_rate", quantity::frequency, frequency_range, "",
       "Of the sensor; the sweep's samples are joined by straight lines."},
      {table_name,
       "noise",
       quantity::flux_density,
       {0, 1, false, unit_slip},
       "0 uT",
       "Standard deviation of the sensor's noise, each component."},
      {table_name, "cutoff", quantity::frequency, frequency_range, "no filter",
       "Of a Butterworth high-pass filter; below half the sampling rate."}};
  return keys;
}

std::vector<std::string_view> phase_names() {
  std::vector<std::string_view> names;
  for (const auto& [name, phase] : phases) names.push_back(name);
  return names;
}

std::optional<SignalOptions> read_signal(Section& root) {
  Section table = root.section(table_name);
  if (!table.exists()) return std::nullopt;
  Faults& faults = table.faults();
  SignalOptions options;
  for (std::size_t i = 0; i < members.size(); ++i)
    options.*members[i] = table.value(signal_keys()[i]).value_or(0);
  unsigned int seed = 1;
  table.read("seed", {0, 4294967295.0, false, "a seed has 32 bits"}, seed);
  options.seed = seed;
  const toml::node* cutoff = table.find("cutoff");
  if (cutoff != nullptr) options.order = 4;  // the paper's
  table.read("order",
             {1, compare::signal::highest_order, false, "higher filters are badly conditioned"},
             options.order);
  if (const toml::node* node = table.find("phase"))
    if (const auto name = read_choice(*node, "phase", phase_names(), faults))
      options.phase =
          std::ranges::find(phases, *name, &std::pair<std::string_view, Phase>::first)->second;
  if (cutoff == nullptr)
    for (const char* name : {"order", "phase"})
      if (const toml::node* node = table.find(name))
        faults.add(place(*node), fmt::format("'{}' goes with 'cutoff'", name));
  if (cutoff != nullptr && options.cutoff > 0 && options.sampling_rate > 0 &&
      !(options.cutoff < options.sampling_rate / 2))
    faults.add(place(*cutoff), fmt::format("'cutoff' is {:g} Hz, but must be below half the "
                                           "'sampling_rate', {:g} Hz",
                                           options.cutoff, options.sampling_rate / 2));
  table.finish();
  return options;
}

std::string to_toml(const SignalOptions& options) {
  std::string text = fmt::format("\n[{}]\n", table_name);
  for (std::size_t i = 0; i < members.size(); ++i)
    if (const QuantityKey& k = signal_keys()[i]; k.name != "cutoff" || options.order > 0)
      text +=
          fmt::format("{} = \"{}\"\n", k.name, format_quantity(options.*members[i], k.quantity));
  text += fmt::format("seed = {}\n", options.seed);
  if (options.order > 0)
    text += fmt::format(
        "order = {}\nphase = \"{}\"\n", options.order,
        std::ranges::find(phases, options.phase, &std::pair<std::string_view, Phase>::second)
            ->first);
  return text;
}

}  // namespace ciliaval::compare::input::sweep

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/study/output.h"

#include <array>
#include <cstddef>

namespace ciliaval::compare::study {
namespace {

struct Names {
  Output output;
  std::string_view id;
  std::string_view symbol;
  std::string_view title;
};
constexpr std::array<Names, 10> names{{
    {Output::B_x, "B_x", "B_x", "B_x"},
    {Output::B_y, "B_y", "B_y", "B_y"},
    {Output::B_z, "B_z", "B_z", "B_z"},
    {Output::dB_x, "dB_x", "dB_x", "ΔB_x"},
    {Output::dB_y, "dB_y", "dB_y", "ΔB_y"},
    {Output::dB_z, "dB_z", "dB_z", "ΔB_z"},
    {Output::dB_norm, "dB_norm", "|dB|", "|ΔB|"},
    {Output::sensitivity, "sensitivity", "d|dB|/dF", "sensitivity d|ΔB|/dF"},
    {Output::range, "range", "range", "range: largest load"},
    {Output::resolution, "resolution", "resolution", "resolution: smallest change of the load"},
}};
constexpr auto outputs = [] {
  std::array<Output, names.size()> all{};
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = names[i].output;
  return all;
}();
const Names& names_of(Output output) {
  return names[static_cast<std::size_t>(output)];  // in the order of the enumeration
}

}  // namespace

std::span<const Output> all_outputs() {
  return outputs;
}
std::string_view id(Output output) {
  return names_of(output).id;
}
std::string_view symbol(Output output) {
  return names_of(output).symbol;
}
std::string_view title(Output output) {
  return names_of(output).title;
}

Quantity quantity_of(Output output, const Load& load) {
  const Quantity& magnitude = load.type().parameters.front().key.quantity;
  if (output == Output::range || output == Output::resolution) return magnitude;
  if (output != Output::sensitivity) return quantity::flux_density;
  if (magnitude.unit == "N") return {"a", "flux density per force", "T/N", "50 uT/mN"};
  if (magnitude.unit == "m") return {"a", "flux density per length", "T/m", "50 uT/mm"};
  return {"a", "flux density per force per length", "T/(N/m)", "50 uT m/N"};
}

output::ShownUnit unit_of(Output output, const Load& load) {
  return output::shown_unit(quantity_of(output, load).unit);
}

}  // namespace ciliaval::compare::study

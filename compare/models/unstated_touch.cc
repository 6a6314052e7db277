// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/models/unstated_touch.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "analytic/elastica/elastica.h"
#include "problem/error.h"

namespace ciliaval::compare::models {
namespace {

constexpr std::array frictions{0.0, 0.6};
constexpr double least_change = 0.02;  ///< of the force, that is told

/// The force on a probe that slides, over the horizontal one at the same displacement; none
/// beyond an equilibrium.
std::optional<double> sliding_over_horizontal(const Cilium& cilium, const Load& load,
                                              double friction) {
  const analytic::elastica::Elastica elastica;
  Load slides = load;
  slides.set_touch({TouchLaw::Law::coulomb, friction});
  const MechanicsStep sliding = elastica.solve(cilium, {slides}).steps.front();
  if (!sliding.touch || !(sliding.applied_force > 0)) return std::nullopt;
  const ProbeLoad same{sliding.touch->displacement, contact_height(load).value(), azimuth(load)};
  const MechanicsStep horizontal = elastica.solve(cilium, {same}).steps.front();
  if (!(horizontal.applied_force > 0)) return std::nullopt;
  return sliding.applied_force / horizontal.applied_force;
}

}  // namespace

std::string unstated_touch(const Cilium& cilium, const Load& load) {
  if (!contact_height(load) || !load.touch().is_plain() ||
      !surroundings::is_empty(load.environment()) || !(magnitude(load) > 0))
    return {};
  std::array<std::optional<double>, 2> ratios;
  try {
    for (std::size_t i = 0; i < frictions.size(); ++i)
      ratios.at(i) = sliding_over_horizontal(cilium, load, frictions.at(i));
  } catch (const InputError&) {  // a load that the elastica does not take
    return {};
  }
  if (std::ranges::all_of(
          ratios, [](const auto& ratio) { return ratio && std::abs(*ratio - 1) <= least_change; }))
    return {};
  const auto change = [](const std::optional<double>& ratio) {
    return ratio ? fmt::format("{:+.0f} %", 100 * (*ratio - 1)) : "more than it bears";
  };
  return fmt::format(
      "the force is horizontal; of a probe that slides to the same place it is {} without friction "
      "and {} with a friction of {}: state [load.touch] if that matters",
      change(ratios[0]), change(ratios[1]), frictions[1]);
}

std::string unstated_touch(const Cilium& cilium, const LoadPath& path) {
  const auto largest = std::ranges::max_element(
      path, {}, [](const Load& load) { return contact_height(load) ? magnitude(load) : 0; });
  return largest == path.end() ? "" : unstated_touch(cilium, *largest);
}

}  // namespace ciliaval::compare::models

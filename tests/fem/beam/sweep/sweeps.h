// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "fem/beam/beam.h"

// Declarations that the tests of the beam's sweep share.
namespace sweeps {

inline constexpr double L = 20e-3;

inline ciliaval::Cilium paper() {
  return {3e-3, {{"base", 3e-3, 1e5, 0.49, 0}, {"magnet", 17e-3, 3e6, 0.49, 75e3}}};
}
inline ciliaval::Cilium uniform() {
  return {1e-3, {{"rod", L, 1e6, 0.49, 0}}};
}

/// A plateau of 1 mm, with flanks of 45 degrees.
inline ciliaval::surroundings::Surface step(double friction) {
  return {ciliaval::surroundings::TrapezoidProfile{
              .height = 1e-3, .top = 15e-3, .bottom = 15e-3, .flank = 1e-3, .radius = 0.5e-3},
          friction, 0};
}
inline ciliaval::surroundings::Surface flat(double friction) {
  return {ciliaval::surroundings::FlatProfile{}, friction, 0};
}

/// Interference and travel, m.
using Places = std::vector<std::pair<double, double>>;

inline ciliaval::LoadPath path(const ciliaval::surroundings::Surface& surface, const Places& places,
                               double azimuth = 0) {
  const auto shared = std::make_shared<const ciliaval::surroundings::Surface>(surface);
  ciliaval::LoadPath loads;
  for (const auto& [interference, travel] : places)
    loads.emplace_back(ciliaval::SweepLoad{interference, travel, 0.01, azimuth}, shared);
  return loads;
}

/// `samples` + 1 places of one interference over a travel.
inline Places straight_on(double interference, double travel, int samples) {
  Places places;
  for (int i = 0; i <= samples; ++i) places.emplace_back(interference, travel * i / samples);
  return places;
}

inline ciliaval::fem::beam::BeamOptions options(bool shear_rigid,
                                                ciliaval::fem::beam::TipShape tip) {
  ciliaval::fem::beam::BeamOptions result;
  result.shear_rigid = shear_rigid;
  result.tip = tip;
  result.error_estimate = false;
  return result;
}

inline std::vector<ciliaval::MechanicsStep> solved(const ciliaval::fem::beam::BeamOptions& options,
                                                   const ciliaval::Cilium& cilium,
                                                   const ciliaval::LoadPath& path) {
  return ciliaval::fem::beam::Beam(options).solve(cilium, path).steps;
}

/// Work of the surface − friction − losses − change of the elastic energy, J.
inline double imbalance(const std::vector<ciliaval::MechanicsStep>& steps) {
  double sum = 0;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const ciliaval::SurfaceContact& c = steps[i].contact.value();
    sum += c.surface_work - c.friction_work - c.energy_lost.value_or(0);
  }
  return sum - (steps.back().contact->elastic_energy - steps.front().contact->elastic_energy);
}
inline double total_work(const std::vector<ciliaval::MechanicsStep>& steps) {
  double sum = 0;
  for (std::size_t i = 1; i < steps.size(); ++i) sum += std::abs(steps[i].contact->surface_work);
  return sum;
}

inline std::vector<std::size_t> jumps(const std::vector<ciliaval::MechanicsStep>& steps) {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (steps[i].contact && steps[i].contact->energy_lost) result.push_back(i);
  return result;
}

}  // namespace sweeps

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/coverage/random_case.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <utility>

#include "analytic/elastica/elastica.h"
#include "problem/surroundings/surface.h"

namespace ciliaval::test {
namespace {

using std::numbers::pi;

class Draw {
 public:
  explicit Draw(std::uint32_t seed) : generator_(seed) {}
  double even(double low, double high) { return low + (high - low) * unit(); }
  double log_even(double low, double high) { return low * std::pow(high / low, unit()); }
  std::size_t choice(std::size_t n) {
    return std::min(n - 1, static_cast<std::size_t>(unit() * static_cast<double>(n)));
  }

 private:
  /// The same on every machine, as distributions of the standard library are not.
  double unit() { return (static_cast<double>(generator_()) + 0.5) / 4294967296.0; }
  std::mt19937 generator_;
};

Cilium random_cilium(Draw& draw) {
  Cilium cilium;
  cilium.diameter = draw.log_even(0.5e-3, 5e-3);  // m
  const double L = cilium.diameter * draw.log_even(4, 40);
  const std::size_t n = 1 + draw.choice(4);
  std::vector<double> parts;
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) sum += parts.emplace_back(draw.even(0.1, 1));
  double E = draw.log_even(0.05e6, 5e6);  // Pa
  for (std::size_t i = 0; i < n; ++i) {
    Segment segment;
    segment.name = "s" + std::to_string(i);
    segment.length = L * parts[i] / sum;
    segment.young_modulus = E;
    segment.poisson_ratio =
        draw.choice(2) == 0 ? draw.even(0.3, 0.49) : 0.5 - draw.log_even(1e-4, 0.02);
    // A/m; the tip is a magnet, each other segment every second time.
    segment.magnetization = i + 1 == n || draw.choice(2) == 0 ? draw.even(2e4, 1e5) : 0;
    cilium.segments.push_back(segment);
    E *= draw.log_even(0.05, 100);
  }
  return cilium;
}

Load shaped_load(Draw& draw, std::uint32_t turn, const Cilium& cilium) {
  const double L = cilium.length();
  const double phi = draw.even(0, 2 * pi);
  const double place = draw.even(0.35, 0.95) * L;
  switch (turn) {
    case 0:
      return ContactLoad{1, place, phi};
    case 1:
      return FlowLoad{1, phi};
    case 2:
      return SectionLoad{1, place, phi};
    case 3:
      return DeadLoad{1, phi};
    default:
      return ProbeLoad{1, place, phi};
  }
}

/// The elastica's tip angle, rad; infinite if it slips off.
double elastica_angle(const Cilium& cilium, const Load& load) {
  const MechanicsResult result = analytic::elastica::Elastica().solve(cilium, {load});
  const MechanicsStep& step = result.steps.front();
  if (step.status != Status::converged) return std::numeric_limits<double>::infinity();
  return step.deformation->centreline.at(cilium.length()).theta();
}

std::vector<Vector3> random_sensors(Draw& draw, const Cilium& cilium) {
  std::vector<Vector3> sensors;
  for (int i = 0; i < 4; ++i) {
    const double depth = draw.log_even(0.05 * cilium.radius(), 10 * cilium.length());
    const double aside = draw.even(0, 1) * std::max(depth, cilium.radius());
    const double phi = draw.even(0, 2 * pi);
    sensors.emplace_back(aside * std::cos(phi), aside * std::sin(phi), -depth);
  }
  return sensors;
}

surroundings::Profile random_profile(Draw& draw, std::uint32_t turn, const Cilium& cilium) {
  const double L = cilium.length();
  const double height = L * draw.log_even(0.002, 0.02);
  const double length = L * draw.log_even(0.3, 2);
  switch (turn) {
    case 0:
      return surroundings::FlatProfile{};
    case 1:
      return surroundings::SineProfile{height, length};
    default: {
      const double flank = height * draw.log_even(1, 5);
      // The arcs take a part of the flanks.
      const double room = std::hypot(height, flank) / 2 / std::tan(std::atan2(height, flank) / 2);
      return surroundings::TrapezoidProfile{.height = height,
                                            .top = length,
                                            .bottom = length,
                                            .flank = flank,
                                            .radius = draw.even(0.1, 0.9) * room};
    }
  }
}

/// A load that turns the elastica's tip by 2° to 60°.
void load(Draw& draw, std::uint32_t seed, RandomCase& result) {
  const double L = result.cilium.length();
  const Load shape = shaped_load(draw, seed % 5, result.cilium);
  result.tip_angle = draw.even(2, 60) * pi / 180;
  double softest = std::numeric_limits<double>::infinity();
  for (const Segment& segment : result.cilium.segments)
    softest = std::min(softest, segment.young_modulus);
  const double force = softest * result.cilium.second_moment() / (L * L);
  // So little that the tip turns by far less than 2 degrees: from here the load is doubled.
  double low = shape.is<ProbeLoad>() ? 1e-4 * L : 1e-4 * force;
  if (shape.is<FlowLoad>() || shape.is<DeadLoad>()) low /= L;
  double high = low;
  while (elastica_angle(result.cilium, with_magnitude(shape, high)) < result.tip_angle) high *= 2;
  low = high / 2;
  for (int i = 0; i < 30; ++i) {  // to 1e-9 of the load
    const double middle = (low + high) / 2;
    (elastica_angle(result.cilium, with_magnitude(shape, middle)) < result.tip_angle ? low : high) =
        middle;
  }
  result.load = with_magnitude(shape, low);
  result.tip_angle = elastica_angle(result.cilium, result.load);
  if (const auto h = contact_height(shape))
    result.kernel_width = std::min(result.kernel_width, std::min(*h, L - *h) / 3);
}

Cilium random_stub(Draw& draw) {
  Cilium cilium;
  const double d = draw.log_even(0.5e-3, 5e-3);  // m
  cilium.diameter = d;
  const auto poisson = [&] {
    return draw.choice(2) == 0 ? draw.even(0.3, 0.49) : 0.5 - draw.log_even(1e-4, 0.02);
  };
  const double E = draw.log_even(0.05e6, 1e6);  // Pa
  const double stiffer = draw.log_even(1, 100);
  cilium.segments.push_back({"base", d * draw.log_even(0.5, 8), E, poisson()});
  const std::size_t between = draw.choice(2) == 0 ? 0 : 1 + draw.choice(2);
  for (std::size_t i = 0; i < between; ++i)
    cilium.segments.push_back({"layer" + std::to_string(i), d * draw.log_even(0.5, 2),
                               E * std::pow(stiffer, draw.even(0, 1)), poisson()});
  cilium.segments.push_back(
      {"magnet", d * draw.log_even(2, 10), E * stiffer, poisson(), draw.even(2e4, 1e5)});
  return cilium;
}

}  // namespace

RandomCase random_case(std::uint32_t seed) {
  Draw draw(seed);
  RandomCase result;
  result.cilium = random_cilium(draw);
  load(draw, seed, result);
  result.sensors = random_sensors(draw, result.cilium);
  return result;
}

RandomCase random_design(std::uint32_t seed) {
  Draw draw(seed);
  RandomCase result;
  result.cilium = random_stub(draw);
  load(draw, seed, result);
  const double d = result.cilium.diameter;
  const double phi = draw.even(0, 2 * pi);
  const double aside = draw.even(0, 0.3) * d;
  result.sensors = {{aside * std::cos(phi), aside * std::sin(phi), -d * draw.even(0.3, 2)}};
  return result;
}

RandomCase random_sweep(std::uint32_t seed) {
  Draw draw(seed);
  RandomCase result;
  result.cilium = random_cilium(draw);
  const double L = result.cilium.length();
  auto surface = std::make_shared<const surroundings::Surface>(
      surroundings::Surface{random_profile(draw, seed % 3, result.cilium), draw.even(0, 0.6), 0});
  const double interference = draw.log_even(0.003, 0.1) * L;
  const double travel = draw.even(0, 2) * L;
  result.load = Load(SweepLoad{interference, travel, 0, draw.even(0, 2 * pi)}, std::move(surface));
  result.tip_angle = elastica_angle(result.cilium, result.load);
  result.sensors = random_sensors(draw, result.cilium);
  return result;
}

}  // namespace ciliaval::test

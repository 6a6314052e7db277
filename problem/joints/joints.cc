// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/joints/joints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "problem/error.h"
#include "problem/joints/shear_coefficient.h"
#include "problem/joints/table.h"
#include "problem/lagrange.h"

namespace ciliaval::joints {
namespace {

constexpr double half_ratio = 0.2;  // κ
/// Of the table between its nodes and of the end problem's elements, at most.
constexpr Entry table_error{1e-4, 1e-4, 1e-4, 3e-4};
/// Of the layers' bending law, relative.
constexpr double layer_error = 0.15;

double ratio_coordinate(double t) {
  return t * (1 + half_ratio) / (t + half_ratio);
}

/// Values of the nodes' Lagrange polynomials at x.
template <std::size_t n>
std::array<double, n> weights(const LagrangeBasis& basis, double x) {
  std::array<double, n> result{};
  basis.values(x, result);
  return result;
}

struct Bases {
  LagrangeBasis poisson{chebyshev_points(n_poisson, 0, largest_poisson_ratio)};
  LagrangeBasis ratio{chebyshev_points(n_ratio, 0, 1)};
  LagrangeBasis length{chebyshev_points(n_length, shortest, apart)};
};
const Bases& bases() {
  static const Bases result;
  return result;
}

void add(double factor, const Entry& entry, Entry& sum) {
  for (const auto component : components) sum.*component += factor * entry.*component;
}

/// Σ wᵢ wⱼ wₖ entry[i][j][k].
template <std::size_t I, std::size_t J, std::size_t K>
Entry interpolated(const Entry (&table)[I][J][K], const std::array<double, I>& wi,
                   const std::array<double, J>& wj, const std::array<double, K>& wk) {
  Entry result;
  for (std::size_t i = 0; i < I; ++i)
    for (std::size_t j = 0; j < J; ++j)
      for (std::size_t k = 0; k < K; ++k) add(wi[i] * wj[j] * wk[k], table[i][j][k], result);
  return result;
}

Entry joint_alone(double soft_poisson, double stiff_poisson, double t) {
  const Bases& b = bases();
  return interpolated(alone, weights<n_poisson>(b.poisson, soft_poisson),
                      weights<n_poisson>(b.poisson, stiff_poisson),
                      weights<n_ratio>(b.ratio, ratio_coordinate(t)));
}

/// Of a segment of so many diameters between bodies with the ratios t of its modulus to theirs.
Entry joints_together(double poisson, double t_below, double t_above, double length) {
  if (length >= apart || t_below >= 1 || t_above >= 1) return {};
  // The layers reach each other by way of both ends: the product of what the two reflect,
  // about (1 − t)/(1 + 3t) each, is that of one ratio with a rigid body. The test AShortSegmentIn-
  // TheMiddle says how well.
  const auto reflected = [](double t) { return (1 - t) / (1 + 3 * t); };
  const double product = reflected(t_below) * reflected(t_above);
  const double t = (1 - product) / (1 + 3 * product);
  const Bases& b = bases();
  Entry result = interpolated(together, weights<n_poisson>(b.poisson, poisson),
                              weights<n_ratio>(b.ratio, ratio_coordinate(t)),
                              weights<n_length>(b.length, length));
  if (t_below > t_above) result.coupling = -result.coupling;
  return result;
}

/// What a joint takes off the softer side's bending law, in diameters of it, for the ratio t of the
/// moduli: fits, to 15 %, of what the solid's bars of fem/end_problem/make_layers.cc show. `length`
/// in diameters is that between two joints, whose layers meet, or infinite.
struct Layer {
  double softening = 0;
  double lengthening = 0;
};

Layer layer(double poisson, double t, double length) {
  const double held = std::max((1 - t) * (1 + 0.15 * t - 1.46 * t * t), 0.0);
  const double apart = 1 - std::max(8.9 * poisson - 0.47, 0.0) * std::exp(-5.4 * length);
  return {held * (0.126 + 0.245 * poisson) * std::max(apart, 0.0),
          held * std::max(0.26 * poisson - 0.018, 0.0)};
}

BendingLaw less(const Layer& layer, double diameter, const BendingLaw& law) {
  return {-layer.lengthening * diameter * law.lengthening,
          -layer.softening * diameter * law.softening,
          -layer.softening * diameter * law.further_softening};
}

/// Units of an Entry for a material.
Joint scaled(const Entry& entry, double diameter, double young_modulus) {
  const double d = diameter;
  const double EA = young_modulus * std::numbers::pi * d * d / 4;
  const double EI = EA * d * d / 16;
  return {entry.rotation * d / EI,
          entry.coupling * d * d / EI,
          entry.displacement * d * d * d / EI,
          entry.extension * d / EA,
          {}};
}

/// Renton's shear compliance of the strain energy less Cowper's of mean displacements, per length:
/// the table goes with the former, the rods with the latter, and ∫ Q² dS = [−QM] between the ends.
double shear_difference(double diameter, const Segment& segment) {
  const double nu = segment.poisson_ratio;
  const double GA = segment.shear_modulus() * std::numbers::pi * diameter * diameter / 4;
  return (1 / energy_shear_coefficient(nu) - 1 / cowper_shear_coefficient(nu)) / GA;
}

void require_in_table(const Cilium& cilium) {
  const std::string what = "joints = \"corrected\": ";
  if (cilium.section.shape != CrossSection::Shape::circle)
    throw InputError(what + "the table is of circular sections; use joints = \"none\"");
  for (std::size_t i = 0; i < cilium.segments.size(); ++i) {
    const Segment& segment = cilium.segments[i];
    const std::string name = what + "segment '" + segment.name + "'";
    if (!(segment.poisson_ratio >= 0 && segment.poisson_ratio <= largest_poisson_ratio))
      throw InputError(name + " has a poisson_ratio outside of 0 ... 0.4999, where the table ends");
    const bool has_joints = i + 1 < cilium.segments.size();
    if (has_joints && segment.length < shortest * cilium.diameter)
      throw InputError(name +
                       " is shorter than 0.3 diameters, where the table ends; use the solid");
  }
}

}  // namespace

std::vector<double> poisson_nodes() {
  return bases().poisson.nodes();
}
std::vector<double> length_nodes() {
  return bases().length.nodes();
}
std::vector<double> ratio_nodes() {
  std::vector<double> nodes;
  for (const double s : bases().ratio.nodes())
    nodes.push_back(half_ratio * s / (1 + half_ratio - s));
  return nodes;
}

Joint& operator+=(Joint& a, const Joint& b) {
  a.rotation += b.rotation;
  a.coupling += b.coupling;
  a.displacement += b.displacement;
  a.extension += b.extension;
  a.beyond.lengthening += b.beyond.lengthening;
  a.beyond.softening += b.beyond.softening;
  a.beyond.further_softening += b.beyond.further_softening;
  return a;
}

BendingLaw bending_law(double diameter, const Segment& segment) {
  const double nu = segment.poisson_ratio;
  const double R = diameter / 2;
  const double EA = segment.young_modulus * std::numbers::pi * R * R;
  const double EI = EA * R * R / 4;
  const double y = 1 - 2 * nu;
  const double k = 1.06666 + nu * (-2.68563 + nu * (3.70549 - 2.30146 * nu));
  BendingLaw law;
  law.lengthening = (3 - y / 3 - 10 * y * y / 9) / (2 * EI * EA);
  law.softening = k * R * R / (EI * EI * EI);
  law.further_softening = 3 * law.softening * law.softening * EI;
  return law;
}

Corrections corrections(const Cilium& cilium) {
  require_in_table(cilium);
  const double d = cilium.diameter;
  const std::vector<Segment>& segments = cilium.segments;
  const std::size_t n = segments.size();
  Corrections result{std::vector<Joint>(n), std::vector<Joint>(n)};
  // t of the bodies below and above segment i, as it sees them.
  const auto ratio_below = [&](std::size_t i) {
    return i == 0 ? 0 : segments[i].young_modulus / segments[i - 1].young_modulus;
  };
  const auto ratio_above = [&](std::size_t i) {
    return segments[i].young_modulus / segments[i + 1].young_modulus;
  };
  for (std::size_t i = 0; i < n; ++i) {
    const double t = ratio_below(i);
    const bool soft_below = t > 1;
    const Segment& soft = soft_below ? segments[i - 1] : segments[i];
    const Segment& stiff = soft_below || i == 0 ? segments[i] : segments[i - 1];
    const double softer = soft_below ? 1 / t : t;
    Entry entry = joint_alone(soft.poisson_ratio, stiff.poisson_ratio, softer);
    if (!soft_below) entry.coupling = -entry.coupling;
    result.joints[i] = scaled(entry, d, soft.young_modulus);
    result.joints[i].coupling += shear_difference(d, segments[i]) / 2;
    if (i > 0) result.joints[i].coupling -= shear_difference(d, segments[i - 1]) / 2;
    result.uncertainties[i] = scaled(table_error, d, soft.young_modulus);
    const bool has_two_joints = soft_below || i + 1 < n;
    const double length =
        has_two_joints ? soft.length / d : std::numeric_limits<double>::infinity();
    const Layer held = layer(soft.poisson_ratio, softer, length);
    const BendingLaw law = bending_law(d, soft);
    result.joints[i].beyond = less(held, d, law);
    result.uncertainties[i].beyond =
        less({layer_error * held.softening, layer_error * held.lengthening}, d, law);
  }
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double length = segments[i].length / d;
    Entry half = joints_together(segments[i].poisson_ratio, ratio_below(i), ratio_above(i), length);
    // M² at the middle is the mean of M² at the ends less Q² L²/4.
    half.displacement -= half.rotation * length * length / 4;
    for (const auto component : components) half.*component /= 2;
    const Joint joint = scaled(half, d, segments[i].young_modulus);
    for (const std::size_t j : {i, i + 1}) result.joints[j] += joint;
  }
  return result;
}

}  // namespace ciliaval::joints

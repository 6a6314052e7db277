// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/joints/joints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "problem/error.h"
#include "problem/joints/shear_coefficient.h"
#include "problem/joints/table.h"
#include "problem/lagrange.h"

namespace ciliaval::joints {
namespace {

constexpr double half_ratio = 0.2;  // κ
/// Largest error of the table, from interpolation between its nodes and from the end problem's
/// elements.
constexpr Entry table_error{1e-4, 1e-4, 1e-4, 3e-4};
/// Relative error of the layers' part of the bending law, and of the law itself.
constexpr double layer_error = 0.15;
constexpr double law_error = 0.2;

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

/// Excess compliance of a segment beyond that of its two joints alone, for the ratios t of its
/// modulus to its neighbours'; length in diameters.
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

/// Reduction of the softer side's bending law by a joint, in diameters of that side, for the ratio
/// t of the moduli: fits, to 15 %, to the solid's bars of tools/end_problem/make_layers.cc.
/// `length` in diameters is the distance between two joints whose layers meet, or infinite.
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

BendingLaw& operator+=(BendingLaw& a, const BendingLaw& b) {
  a.lengthening += b.lengthening;
  a.softening += b.softening;
  a.further_softening += b.further_softening;
  return a;
}

BendingLaw scaled(const BendingLaw& law, double lengthening, double softening) {
  return {lengthening * law.lengthening, softening * law.softening,
          softening * law.further_softening};
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

/// Both sides of the joint below segment i.
struct Interface {
  const Segment* soft;
  const Segment* stiff;            ///< of a clamp, as it has no material: the soft one
  double ratio = 0;                ///< of their moduli, at most 1
  bool is_between_joints = false;  ///< the soft one

  Interface(const std::vector<Segment>& segments, std::size_t i)
      : soft(&segments[i]), stiff(i == 0 ? soft : &segments[i - 1]) {
    if (i > 0) ratio = soft->young_modulus / stiff->young_modulus;
    is_between_joints = i + 1 < segments.size();
    if (ratio <= 1) return;
    std::swap(soft, stiff);
    ratio = 1 / ratio;
    is_between_joints = true;
  }
  bool is_soft_below() const { return soft < stiff; }
  Layer layer(double diameter) const {
    return joints::layer(
        soft->poisson_ratio, ratio,
        is_between_joints ? soft->length / diameter : std::numeric_limits<double>::infinity());
  }
};

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
  a.beyond += b.beyond;
  return a;
}

Corrections& operator+=(Corrections& a, const Corrections& b) {
  for (std::size_t i = 0; i < a.joints.size(); ++i) a.joints[i] += b.joints[i];
  for (std::size_t i = 0; i < a.laws.size(); ++i) a.laws[i] += b.laws[i];
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
  Corrections result;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Interface at(segments, i);
    Entry entry = joint_alone(at.soft->poisson_ratio, at.stiff->poisson_ratio, at.ratio);
    if (!at.is_soft_below()) entry.coupling = -entry.coupling;
    Joint joint = scaled(entry, d, at.soft->young_modulus);
    joint.coupling += shear_difference(d, segments[i]) / 2;
    if (i > 0) joint.coupling -= shear_difference(d, segments[i - 1]) / 2;
    const Layer held = at.layer(d);
    joint.beyond = scaled(bending_law(d, *at.soft), -held.lengthening * d, -held.softening * d);
    result.joints.push_back(joint);
    result.laws.push_back(bending_law(d, segments[i]));
  }
  for (std::size_t i = 0; i + 1 < segments.size(); ++i) {
    const double length = segments[i].length / d;
    const double t_below = i == 0 ? 0 : segments[i].young_modulus / segments[i - 1].young_modulus;
    const double t_above = segments[i].young_modulus / segments[i + 1].young_modulus;
    Entry half = joints_together(segments[i].poisson_ratio, t_below, t_above, length);
    // M² at the middle is the mean of M² at the ends less Q² L²/4.
    half.displacement -= half.rotation * length * length / 4;
    for (const auto component : components) half.*component /= 2;
    const Joint joint = scaled(half, d, segments[i].young_modulus);
    for (const std::size_t j : {i, i + 1}) result.joints[j] += joint;
  }
  return result;
}

Corrections uncertainties(const Cilium& cilium) {
  const double d = cilium.diameter;
  Corrections result;
  for (std::size_t i = 0; i < cilium.segments.size(); ++i) {
    const Interface at(cilium.segments, i);
    Joint joint = scaled(table_error, d, at.soft->young_modulus);
    const Layer held = at.layer(d);
    joint.beyond = scaled(bending_law(d, *at.soft), layer_error * held.lengthening * d,
                          layer_error * held.softening * d);
    result.joints.push_back(joint);
    result.laws.push_back(scaled(bending_law(d, cilium.segments[i]), law_error, law_error));
  }
  return result;
}

}  // namespace ciliaval::joints

// SPDX-License-Identifier: LGPL-2.1-or-later
// Diameters of the bending law that a joint takes away (layer() in problem/joints/joints.cc): a bar
// between a clamp and a stiffer body of 10 diameters, bent by a force on a section of that, once by
// the solid and once by the beam. Differences at a small load, of the meshes, are taken off.
//   cmake --build build/release --target joint_layers && build/release/tools/joint_layers
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <vector>

#include "fem/beam/centreline.h"
#include "fem/beam/cilium_beam.h"
#include "fem/beam/newton.h"
#include "fem/solid/solid.h"
#include "problem/error.h"
#include "problem/joints/joints.h"

namespace {

using namespace ciliaval;

constexpr double d = 1e-3;             // m
constexpr double E = 1e5;              // Pa
constexpr double small = 0.02;         // strain at which all is linear
constexpr double above = 3 * d;        // where the body's pose is read, from the interface
using Layers = std::array<double, 2>;  // diameters, of softening and lengthening

struct Bar {
  double poisson, ratio, length;  // ratio of its modulus to the body's; length in diameters

  Cilium cilium() const {
    return {d, {{"bar", length * d, E, poisson}, {"body", 10 * d, E / ratio, poisson}}};
  }
  /// The force that bends the middle of the straight bar to a strain.
  SectionLoad load(double strain) const {
    const double EI = E * cilium().second_moment();
    return {strain * EI / (d / 2) / ((9 + length / 2) * d), (length + 9) * d, 0};
  }
};

CentrelinePoint pose(const Bar& bar, const Centreline& line) {
  return line.at(bar.length * d + above);
}

CentrelinePoint by_beam(const Bar& bar, double strain, const Layers& layers) {
  const Cilium cilium = bar.cilium();
  joints::Corrections corrections = joints::corrections(cilium);
  const joints::BendingLaw& law = corrections.laws[0];
  for (joints::Joint& joint : corrections.joints)
    joint.beyond = {-layers[1] * d * law.lengthening, -layers[0] * d * law.softening,
                    -layers[0] * d * law.further_softening};
  const fem::beam::BeamOptions options{.joints = joints::Correction::corrected};
  const Load load = bar.load(strain);
  fem::beam::CiliumBeam beam =
      fem::beam::cilium_beam(cilium, options, bar.load(strain).arclength, corrections);
  fem::beam::State state = beam.system.reference_state();
  const auto report =
      fem::beam::advance(beam.system, state, {}, fem::beam::loads(cilium, load, beam), {});
  if (!report.converged) throw SolverError(report.message);
  return pose(bar, fem::beam::centreline(beam.system, state));
}

/// The layers with which the beam turns and lengthens as the solid does.
Layers layers_of(const Bar& bar, double strain) {
  const MechanicsResult solid =
      fem::solid::Solid({.solver = fem::solid::solvers::SolverKind::direct})
          .solve(bar.cilium(), {bar.load(small), bar.load(strain)});
  const CentrelinePoint first = pose(bar, solid.steps.at(0).deformation.value().centreline);
  const CentrelinePoint bent = pose(bar, solid.steps.at(1).deformation.value().centreline);
  const CentrelinePoint linear = by_beam(bar, small, {});
  const double turn = first.theta() / linear.theta();
  const double way = first.position.x() / linear.position.x();
  const auto gap = [&](const Layers& layers) {
    const CentrelinePoint beam = by_beam(bar, strain, layers);
    const double S = bar.length * d + above;
    const double along = way * beam.position.x() - bent.position.x();
    const double sunk = way * way * (S - beam.position.z()) - (S - bent.position.z());
    return std::array{turn * beam.theta() - bent.theta(),
                      (along * std::sin(bent.theta()) - sunk * std::cos(bent.theta())) / d};
  };
  Layers layers{0.2, 0.1};
  for (int iteration = 0; iteration < 6; ++iteration) {
    constexpr double h = 1e-3;
    const auto [f, g] = gap(layers);
    const auto [f_0, g_0] = gap({layers[0] + h, layers[1]});
    const auto [f_1, g_1] = gap({layers[0], layers[1] + h});
    const double a = (f_0 - f) / h;
    const double b = (f_1 - f) / h;
    const double c = (g_0 - g) / h;
    const double e = (g_1 - g) / h;
    layers[0] -= (e * f - b * g) / (a * e - b * c);
    layers[1] -= (a * g - c * f) / (a * e - b * c);
  }
  return layers;
}

}  // namespace

int main() {
  try {
    fmt::print(
        "mean of the two joints, in diameters; in use: that of joints::corrections()\n"
        "{:>6} {:>7} {:>6} {:>7} {:>10} {:>7} {:>12} {:>7}\n",
        "nu", "E/E", "L/d", "strain", "softening", "in use", "lengthening", "in use");
    for (const double poisson : {0.3, 0.4, 0.49})
      for (const double ratio : {0.001, 1.0 / 30, 0.3})
        for (const double length : {0.5, 1.0, 2.0})
          for (const double strain : {0.15, 0.3}) {
            const Bar bar{poisson, ratio, length};
            const auto [softening, lengthening] = layers_of(bar, strain);
            const auto joints = joints::corrections(bar.cilium()).joints;
            const joints::BendingLaw law = joints::bending_law(d, bar.cilium().segments[0]);
            const auto in_use = [&](double joints::BendingLaw::*part) {
              return -(joints[0].beyond.*part + joints[1].beyond.*part) / (2 * d * law.*part);
            };
            fmt::print("{:6.2f} {:7.4f} {:6.2f} {:7.2f} {:10.3f} {:7.3f} {:12.3f} {:7.3f}\n",
                       poisson, ratio, length, strain, softening,
                       in_use(&joints::BendingLaw::softening), lengthening,
                       in_use(&joints::BendingLaw::lengthening));
            std::fflush(stdout);
          }
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "joint_layers: {}\n", error.what());
    return 1;
  }
}

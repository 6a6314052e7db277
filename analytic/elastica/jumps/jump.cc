// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/jumps/jump.h"

#include <cmath>
#include <limits>

#include "problem/continuation/root.h"
#include "problem/error.h"

namespace ciliaval::analytic::elastica::jumps {

PlanarState across(const PlanarJoint& joint, ForceLaw law, const PlanarState& state, Side from,
                   double part) {
  constexpr int most_iterations = 50;
  constexpr double largest_turn = 1;  // rad
  constexpr double enough = 4 * std::numeric_limits<double>::epsilon();
  const double half = from == Side::lower ? 0.5 : -0.5;
  const double a = part * joint.rotation;
  const double b = part * joint.coupling;
  const double c = part * joint.displacement;
  const double e = part * joint.extension;
  double theta = 0;
  double z = 0;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const double sine = std::sin(state.theta + half * theta);
    const double cosine = std::sin(state.phi - half * theta);
    const double H = law == ForceLaw::height ? state.force - half * z : state.force;
    const double M = state.moment - half * H * z;
    const double Q = H * cosine;
    const double N = H * sine;
    const double beyond = part * joint.law.of_rotation(M, N);
    const double turned = a * M + b * Q + beyond;
    const double along = b * M + c * Q;
    const double normal = e * N + part * joint.law.lengthening * M * M;
    const double rise = normal * cosine - along * sine;
    // To the rounding of the sums.
    const double turn_scale = std::abs(a * M) + std::abs(b * Q) + std::abs(beyond);
    const double way_scale = std::abs(b * M) + std::abs(c * Q) + std::abs(normal);
    if (std::abs(turned - theta) <= enough * turn_scale &&
        std::abs(rise - z) <= enough * way_scale) {
      if (std::abs(turned) > largest_turn) break;
      PlanarState other = state;
      other.theta += 2 * half * turned;
      other.phi -= 2 * half * turned;
      other.w += 2 * half * (along * cosine + normal * sine);
      other.z += 2 * half * rise;
      other.moment -= 2 * half * H * rise;
      if (law == ForceLaw::height) other.force -= 2 * half * rise;
      return other;
    }
    // Derivatives of turned and rise by theta and z, but for those of H and of the law.
    const double turned_theta = -half * b * N;
    const double turned_z = -half * a * H;
    const double rise_theta =
        half * (e * Q * cosine - normal * sine + c * N * sine - along * cosine);
    const double rise_z = half * b * H * sine;
    const double p = turned - theta;
    const double q = rise - z;
    const double determinant = (1 - turned_theta) * (1 - rise_z) - turned_z * rise_theta;
    theta += ((1 - rise_z) * p + turned_z * q) / determinant;
    z += (rise_theta * p + (1 - turned_theta) * q) / determinant;
  }
  throw SolverError("elastica: a joint turns by more than a radian, far outside of its domain");
}

PlanarState inside(const PlanarJoint& joint, const PlanarState& lower) {
  const auto moment = [&](double part) {
    return across(joint, ForceLaw::constant, lower, Side::lower, part).moment;
  };
  const double part = continuation::root(moment, 0, 1, lower.moment, moment(1));
  return across(joint, ForceLaw::constant, lower, Side::lower, part);
}

}  // namespace ciliaval::analytic::elastica::jumps

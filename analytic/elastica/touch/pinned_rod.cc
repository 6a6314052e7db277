// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/touch/pinned_rod.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "analytic/elastica/planar.h"
#include "analytic/elastica/tip_contact.h"
#include "analytic/elastica/touch/equilibrium.h"
#include "problem/types.h"

namespace ciliaval::analytic::elastica::touch {
namespace {

Problem problem_of(const Cilium& cilium, const Load& load) {
  const double L = cilium.length();
  const double B = tip_stiffness(cilium, azimuth(load));
  Problem problem;
  for (const double end : cilium.interfaces()) problem.ends.push_back(end / L);
  problem.ends.back() = 1;
  for (const Segment& segment : cilium.segments)
    problem.compliance.push_back(B / (segment.young_modulus * cilium.second_moment(azimuth(load))));
  problem.pin = pin::pin_of(cilium, load, L);
  return problem;
}

/// The shape under the forces of the contact, straight above it.
PlanarShape shape_of(const Problem& problem, const State& at) {
  const auto steps =
      std::make_shared<const std::vector<point_forces::Step>>(steps_along(problem, at));
  PlanarShape shape;
  shape.breaks.push_back(0);
  for (const point_forces::Step& step : *steps) shape.breaks.push_back(step.end());
  for (const double end : problem.ends)
    if (end > shape.breaks.back() + shortest_piece) shape.breaks.push_back(end);
  if (shape.breaks.back() < 1) shape.breaks.back() = 1;
  shape.contact = std::min(at.S(), 1.0);
  shape.state = [steps, problem, at](double S, std::size_t i) {
    PlanarState state;
    state.S = S;
    if (i >= steps->size()) {
      const double above = S - std::min(at.S(), 1.0);
      state.theta = at.theta;
      state.w = at.x + above * std::sin(at.theta);
      state.z = at.z + above * std::cos(at.theta);
    } else {
      const point_forces::Step& step = (*steps)[i];
      const point_forces::Section section = step.at(S);
      const double middle = std::midpoint(step.start(), step.end());
      std::size_t segment = 0;
      while (problem.ends[segment + 1] < middle) ++segment;
      state.theta = section.theta;
      state.w = section.x;
      state.z = section.z;
      state.curvature = section.curvature;
      state.moment = section.curvature / problem.compliance[segment];
      state.force = at.force();
      state.vertical = -at.vertical();
    }
    state.phi = std::numbers::pi / 2 - state.theta;
    return state;
  };
  return shape;
}

class PinnedRod : public pin::Body {
 public:
  PinnedRod(const Cilium& cilium, const Load& load, double tolerance)
      : problem_(problem_of(cilium, load)),
        units_{cilium.length(),
               tip_stiffness(cilium, azimuth(load)) / (cilium.length() * cilium.length())},
        direction_(direction(load)),
        tolerance_(tolerance) {}

  const pin::Pin& pin() const override { return problem_.pin; }
  double length() const override { return units_.length; }
  double force_unit() const override { return units_.force; }
  double tip() const override { return 1; }
  double rounding() const override { return 1e-13; }
  std::size_t n_unknowns() const override { return 4; }

  pin::Equilibrium untouched() override { return touch::untouched(problem_); }
  std::optional<pin::Equilibrium> solve(const pin::Condition& first, const pin::Condition& second,
                                        const pin::Equilibrium& guess) override {
    return touch::solve(problem_, first, second, std::any_cast<const State&>(guess.state));
  }
  Deformation deformation(const pin::Equilibrium& equilibrium) override {
    const auto& state = std::any_cast<const State&>(equilibrium.state);
    return {planar_centreline(shape_of(problem_, state), units_, direction_,
                              std::max(tolerance_ / 10, 1e-13)),
            nullptr};
  }

 private:
  Problem problem_;
  PlanarUnits units_;
  Vector3 direction_;
  double tolerance_;
};

}  // namespace

std::unique_ptr<pin::Body> pinned_rod(const Cilium& cilium, const Load& load, double tolerance) {
  return std::make_unique<PinnedRod>(cilium, load, tolerance);
}

}  // namespace ciliaval::analytic::elastica::touch

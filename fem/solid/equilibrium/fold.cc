// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/equilibrium/fold.h"

#include <algorithm>
#include <utility>

#include "fem/solid/discretisation/assembly.h"
#include "fem/solid/loads/external_forces.h"
#include "problem/continuation/turning_point.h"
#include "problem/error.h"

namespace ciliaval::fem::solid::equilibrium {
using namespace discretisation;
using namespace loads;
namespace {

/// Largest displacement in one step along the branch, over the cilium's length: a longer step may
/// end on another branch.
constexpr double largest_step = 0.25;

/// The same load with its environment as it acts: an EnvironmentLoad has a factor besides.
Load acting_alone(const Load& load) {
  if (!load.is<EnvironmentLoad>()) return load;
  return with_environment(EnvironmentLoad{1, azimuth(load)}, acting_environment(load));
}

}  // namespace

class FoldSearch::SolidBranch {
 public:
  SolidBranch(const FoldSearch& search, const Load& load)
      : search_(search), to_(acting_alone(load)) {
    now_.at = {0, {this->load(0), search.space_.undeformed(), 0}};
    set_tangent(now_, nullptr);
  }

  continuation::BranchPoint start() const { return {now_.at.fraction, now_.rate}; }
  const OnTheWay& accepted() const { return now_.at; }
  const OnTheWay& found() const { return found_.at; }
  void accept() { now_ = found_; }

  std::optional<continuation::BranchPoint> find(double s) {
    try {
      return corrected(s);
    } catch (const SolverError&) {  // inside a magnet, or a singular tangent
      return std::nullopt;
    }
  }

 private:
  struct Point {
    OnTheWay at;
    double rate = 0;  ///< dt/ds, 1/m
    Vector along;     ///< c
  };

  Load load(double t) const {
    const Load part = to_.is<EnvironmentLoad>() ? to_ : with_magnitude(to_, t * magnitude(to_));
    return with_environment(part, surroundings::scaled(to_.environment(), t));
  }
  ExternalForces forces(double t) const {
    return external_forces(search_.space_, search_.quadrature_, search_.cilium_, load(t),
                           search_.options_.kernel_width);
  }
  std::optional<continuation::BranchPoint> corrected(double s) {
    const SolidSpace& space = search_.space_;
    const SolidState& before = now_.at.equilibrium.state;
    Point trial = now_;
    SolidState& state = trial.at.equilibrium.state;
    const auto internal = internal_forces(space, before);
    if (!internal) return std::nullopt;
    Vector increment = now_.along;
    increment *= s;
    advance(space, *internal, increment, state);
    UnknownForce unknown;
    unknown.forces = [this](double t) { return forces(t); };
    unknown.amplitude = now_.at.fraction + s * now_.rate;
    unknown.condition = [&](const Vector& u, double /*t*/, Vector* gradient) {
      if (gradient != nullptr) gradient->add(1, now_.along);
      return now_.along * u - now_.along * before.displacement - s;
    };
    if (!search_.newton_.solve(unknown, state, search_.options_.newton).converged)
      return std::nullopt;
    Vector moved = state.displacement;
    moved -= before.displacement;
    if (moved.linfty_norm() > largest_step * search_.cilium_.length()) return std::nullopt;
    trial.at.fraction = unknown.amplitude;
    trial.at.equilibrium.load = load(unknown.amplitude);
    set_tangent(trial, &now_.along);
    found_ = std::move(trial);
    return continuation::BranchPoint{found_.at.fraction, found_.rate, now_.along * found_.along};
  }

  /// dt/ds and c at an equilibrium; the first goes the way of t, others that of `before`.
  void set_tangent(Point& point, const Vector* before) const {
    point.along =
        search_.newton_.response(forces(point.at.fraction), forces(1), point.at.equilibrium.state);
    const double sign = before != nullptr && *before * point.along < 0 ? -1 : 1;
    const double length = point.along.l2_norm();
    if (length == 0) throw SolverError("the solid stays where it is");
    point.rate = sign / length;
    point.along *= point.rate;
  }

  const FoldSearch& search_;
  Load to_;
  Point now_;
  Point found_;
};

std::vector<OnTheWay> FoldSearch::find(const Load& load) const {
  constexpr double first_part = 1.0 / 64;  // of the way
  try {
    SolidBranch branch(*this, load);
    std::vector<OnTheWay> way{branch.accepted()};
    const continuation::Branch steps{[&](double s) { return branch.find(s); },
                                     [&] {
                                       branch.accept();
                                       way.push_back(branch.accepted());
                                     }};
    if (!continuation::turning_point(steps, branch.start(), first_part)) return {};
    way.push_back(branch.found());
    return way;
  } catch (const SolverError&) {  // no statement
    return {};
  }
}

}  // namespace ciliaval::fem::solid::equilibrium

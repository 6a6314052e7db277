// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/continuation/slip_off.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "problem/error.h"

namespace ciliaval::continuation {
namespace {

constexpr double tolerance = 1e-11;  ///< of the largest load, relative
constexpr double difference = 1e-3;  ///< of the load, for the rate at which the rim sinks
constexpr std::uintmax_t patience = 100;

/// Half the extent of the section along the direction in which the tip leans, m.
double half_extent(const Cilium& cilium, const Load& load) {
  return cilium.is_rectangular() ? cilium.extent(azimuth(load)) / 2 : cilium.radius();
}

/// ε: how far the rim of an end face that leans by θ is in the contact when the force falls short.
double depth_of_shortfall(const Cilium& cilium, double R, double sin_theta, double w) {
  constexpr double B = 32.0 / 315;  // B(3/2, 4)
  const double pi2 = std::numbers::pi * std::numbers::pi;
  const double w3 = w * w * w;
  if (cilium.is_rectangular())
    return std::pow(force_shortfall * 96 * R * w3 * sin_theta / pi2, 1.0 / 4);
  return std::pow(force_shortfall * 6 * cilium.area() * w3 * std::pow(sin_theta, 1.5) /
                      (pi2 * std::sqrt(2 * R) * B),
                  1 / 4.5);
}

/// The largest load of one kind that a rod bears: its magnitude, with what goes with it.
struct Limit {
  double magnitude = 0;
  double force = 0;  ///< N
  std::optional<double> uncertainty;
};

class RimSearch {
 public:
  RimSearch(const MechanicsModel& rod, const Cilium& cilium, double half_width)
      : rod_(rod), cilium_(cilium), half_width_(half_width) {}

  /// Height of the rim above the place where the cilium slips off, m.
  double clearance(const MechanicsStep& step) const {
    const CentrelinePoint tip = step.deformation->centreline.at(cilium_.length());
    const double R = half_extent(cilium_, step.load);
    const double sin_theta = tip.normal().head<2>().norm();
    return tip.position.z() - R * sin_theta - edge(step.load) +
           depth_of_shortfall(cilium_, R, sin_theta, half_width_);
  }

  /// `step` is beyond the limit, or states the limit of the axis. Throws SolverError.
  Limit find(const MechanicsStep& step) {
    const Load& load = step.load;
    if (edge(load) >= cilium_.length())
      throw InputError(
          "slip_off = \"rim\": the contact's upper edge must lie below the tip of the cilium");
    // If the axis has come down there is no shape to look at, or hardly one.
    const bool is_below = step.status == Status::converged && clearance(step) < 0;
    const double beyond =
        is_below ? magnitude(load) : slip_off_limit(step).value_or(magnitude(load));
    const double at_beyond = is_below ? clearance(step) : clearance_of_no_shape();
    const auto clearance_at = [&](double m) { return clearance_under(load, m).first; };
    std::uintmax_t trials = patience;
    const auto [borne, fallen] = boost::math::tools::toms748_solve(
        clearance_at, 0.0, beyond, cilium_.length() - edge(load), at_beyond,
        [](double a, double b) { return b - a <= tolerance * b; }, trials);
    const auto [at_limit, state] = clearance_under(load, borne);
    const double rate = (at_limit - clearance_at(borne * (1 - difference))) / (borne * difference);
    Limit limit{borne, state.applied_force, {}};
    if (state.tip_uncertainty && state.tip_angle_uncertainty)
      limit.uncertainty =
          (*state.tip_uncertainty + cilium_.radius() * *state.tip_angle_uncertainty) /
              std::abs(rate) +
          tolerance * borne;
    return limit;
  }

 private:
  double edge(const Load& load) const { return contact_height(load).value() + half_width_; }

  /// Clearance assumed where even the axis has come down to the height: the rim is at most so far
  /// below the edge, m.
  double clearance_of_no_shape() const { return -half_width_ - cilium_.radius(); }

  std::pair<double, MechanicsStep> clearance_under(const Load& load, double m) const {
    MechanicsResult result = rod_.solve(cilium_, {with_magnitude(load, m)});
    MechanicsStep& step = result.steps.at(0);
    if (step.status == Status::failed)
      throw SolverError("the largest load that is borne is not known: " + step.message);
    const double value = step.deformation ? clearance(step) : clearance_of_no_shape();
    return {value, std::move(step)};
  }

  const MechanicsModel& rod_;
  const Cilium& cilium_;
  double half_width_;
};

std::string slipped_off(const Load& load, const Limit& limit) {
  std::ostringstream message;
  message << std::setprecision(8) << "the contact slips off: the largest "
          << (load.is<ProbeLoad>() ? "displacement in an equilibrium"
                                   : "force an equilibrium bears")
          << ", at which the rim of the end face sinks to the contact's upper edge, is ";
  if (load.is<ProbeLoad>()) message << 1e3 * limit.magnitude << " mm, under ";
  message << 1e3 * limit.force << " mN";
  return message.str();
}

/// The step of a load that the cilium does not bear.
void let_go(const Limit& limit, MechanicsStep& step) {
  MechanicsStep fallen;
  fallen.load = step.load;
  fallen.status = Status::slipped_off;
  fallen.message = slipped_off(step.load, limit);
  fallen.unknowns = step.unknowns;
  fallen.iterations = step.iterations;
  step = std::move(fallen);
}

}  // namespace

void let_go_at_rim(const MechanicsModel& rod, const Cilium& cilium, double half_width,
                   MechanicsResult& result) {
  RimSearch search(rod, cilium, half_width);
  std::vector<std::pair<Load, Limit>> found;  // the steps of a path mostly have one
  for (MechanicsStep& step : result.steps) {
    if (step.load.slip_off_point() != SlipOffPoint::rim || step.status == Status::failed ||
        step.status == Status::pulled_in)
      continue;
    const auto start = std::chrono::steady_clock::now();
    const double seconds = step.seconds;
    step.slip_off_point = SlipOffPoint::rim;
    const bool is_beyond = step.status == Status::slipped_off || search.clearance(step) < 0;
    if (!is_beyond && !slip_off_limit(step)) continue;
    try {
      const Load kind = with_magnitude(step.load, 0);
      auto known = std::ranges::find(found, kind, &std::pair<Load, Limit>::first);
      if (known == found.end()) known = found.insert(found.end(), {kind, search.find(step)});
      const Limit& limit = known->second;
      if (is_beyond) let_go(limit, step);
      step.slip_off_force = limit.force;
      if (step.load.is<ProbeLoad>()) step.slip_off_displacement = limit.magnitude;
      step.slip_off_uncertainty = limit.uncertainty;
    } catch (const SolverError& error) {
      step.slip_off_force.reset();
      step.slip_off_displacement.reset();
      step.slip_off_uncertainty.reset();
      step.message += (step.message.empty() ? "" : "; ") + std::string(error.what());
      if (is_beyond) step.status = Status::failed;
      if (is_beyond) step.deformation.reset();
    }
    step.slip_off_point = SlipOffPoint::rim;
    step.seconds =
        seconds + std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
}

}  // namespace ciliaval::continuation

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/results/quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <utility>

namespace ciliaval::compare::results {
namespace {

constexpr std::array<std::string_view, 4> places{"quarter", "middle", "three_quarters", "tip"};

Vector3 position_at(const Centreline& centreline, std::size_t place) {
  return centreline.at(centreline.length() * static_cast<double>(place + 1) / 4).position;
}

double tip_angle(const MechanicsStep& step) {
  const Centreline& centreline = step.deformation->centreline;
  return centreline.at(centreline.length()).theta();
}

std::vector<double> one_or_none(const std::optional<double>& value) {
  return value ? std::vector{*value} : std::vector<double>{};
}

/// The number that a member of a step is.
auto member(std::optional<double> MechanicsStep::*number) {
  return [=](const MechanicsStep& step) { return one_or_none(step.*number); };
}

/// Accessor like member(), but of a deformed cilium only.
auto of_deformation(std::optional<double> MechanicsStep::*number) {
  return [=](const MechanicsStep& step) {
    return step.deformation ? one_or_none(step.*number) : std::vector<double>{};
  };
}

Quantity position(std::size_t place) {
  const bool is_tip = places.at(place) == "tip";
  return {.name = places.at(place),
          .kind = ciliaval::quantity::length,
          .components = {"x", "y", "z"},
          .values = [place](const MechanicsStep& step) -> std::vector<double> {
            if (!step.deformation) return {};
            const Vector3 x = position_at(step.deformation->centreline, place);
            return {x.x(), x.y(), x.z()};
          },
          .uncertainty =
              [is_tip](const MechanicsStep& step) {
                return is_tip ? step.tip_uncertainty : std::nullopt;
              },
          .size =
              [](const Extent& extent, std::size_t component) {
                return Size{extent.length, component == 2 ? extent.length : extent.deflection};
              },
          .is_in_summary = is_tip,
          .is_looked_at = is_tip};
}

/// The tip's horizontal distance from the axis.
Quantity deflection() {
  return {.name = "tip/deflection",
          .kind = ciliaval::quantity::length,
          .values = [](const MechanicsStep& step) -> std::vector<double> {
            if (!step.deformation) return {};
            const Vector3 tip = position_at(step.deformation->centreline, places.size() - 1);
            return {std::hypot(tip.x(), tip.y())};
          },
          .uncertainty = [](const MechanicsStep& step) { return step.tip_uncertainty; },
          .size =
              [](const Extent& extent, std::size_t) {
                return Size{extent.length, extent.deflection};
              },
          .is_in_summary = false,
          .is_accepted = false,
          .is_looked_at = true};
}

Size length(const Extent& extent, std::size_t /*component*/) {
  return {extent.length, extent.length};
}
Size angle(const Extent& extent, std::size_t /*component*/) {
  return {1, extent.angle};
}
Size force(const Extent& extent, std::size_t /*component*/) {
  return {extent.force, extent.force};
}

/// The error of another quantity, as far as it is a number of the step.
Quantity estimate(std::string_view name, const ciliaval::Quantity& kind,
                  std::function<std::vector<double>(const MechanicsStep&)> values,
                  std::function<Size(const Extent&, std::size_t)> size) {
  return {.name = name,
          .kind = kind,
          .values = std::move(values),
          .size = std::move(size),
          .is_estimate = true,
          .is_accepted = false,
          .is_converged = false};
}

/// A number of a touch.
Quantity of_touch(std::string_view name, const ciliaval::Quantity& kind,
                  double ProbeContact::*number, std::string_view words) {
  return {.name = name,
          .kind = kind,
          .values =
              [number](const MechanicsStep& step) {
                return step.touch ? std::vector{step.touch.value().*number} : std::vector<double>{};
              },
          .is_compared =
              [number](const MechanicsStep& step) {
                return step.touch && step.touch.value().*number != 0;
              },
          .belongs = [](const MechanicsStep& step) { return step.touch.has_value(); },
          .words = words};
}

/// A force of a sweep's contact; summary.json has all of the contact as one table.
Quantity contact_force(std::string_view name, double SurfaceContact::*force) {
  return {.name = name,
          .kind = ciliaval::quantity::force,
          .values =
              [force](const MechanicsStep& step) {
                return step.contact ? std::vector{step.contact.value().*force}
                                    : std::vector<double>{};
              },
          .size =
              [](const Extent& extent, std::size_t) {
                return Size{extent.contact, extent.contact};
              },
          .is_in_summary = false};
}

std::vector<Quantity> own_quantities() {
  std::vector<Quantity> all;
  for (std::size_t place = 0; place < places.size(); ++place) all.push_back(position(place));
  all.push_back(deflection());
  all.push_back({.name = "tip_angle",
                 .kind = ciliaval::quantity::angle,
                 .values =
                     [](const MechanicsStep& step) {
                       return step.deformation ? std::vector{tip_angle(step)}
                                               : std::vector<double>{};
                     },
                 .uncertainty = results::tip_angle_uncertainty,
                 .size = angle,
                 .is_looked_at = true});
  all.push_back(
      {.name = "applied_force",
       .kind = ciliaval::quantity::force,
       .values =
           [](const MechanicsStep& step) {
             return step.deformation ? std::vector{step.applied_force} : std::vector<double>{};
           },
       .uncertainty = [](const MechanicsStep& step) { return step.applied_force_uncertainty; },
       .size = force,
       // Under an environment alone and under a couple it is nothing but rounding.
       .is_compared =
           [](const MechanicsStep& step) {
             return !step.load.is<EnvironmentLoad>() && !step.load.is<MomentLoad>();
           }});
  all.push_back({.name = "contact_arclength",
                 .kind = ciliaval::quantity::length,
                 .values = of_deformation(&MechanicsStep::contact_arclength),
                 .size = length});
  Quantity tip = estimate("tip_uncertainty", ciliaval::quantity::length,
                          of_deformation(&MechanicsStep::tip_uncertainty), length);
  tip.is_accepted = true;
  all.push_back(std::move(tip));
  all.push_back(estimate("tip_angle_uncertainty", ciliaval::quantity::angle,
                         of_deformation(&MechanicsStep::tip_angle_uncertainty), angle));
  all.push_back(estimate("applied_force_uncertainty", ciliaval::quantity::force,
                         of_deformation(&MechanicsStep::applied_force_uncertainty), force));
  const auto has_slipped_off = [](const MechanicsStep& step) {
    return step.status == Status::slipped_off;
  };
  // Under a probe it belongs to the displacement.
  const auto slip_off = [](bool of_probe) {
    return [of_probe](const MechanicsStep& step) {
      return step.load.is<ProbeLoad>() == of_probe ? step.slip_off_uncertainty : std::nullopt;
    };
  };
  all.push_back({.name = "slip_off_force",
                 .kind = ciliaval::quantity::force,
                 .values = member(&MechanicsStep::slip_off_force),
                 .uncertainty = slip_off(false),
                 .size = force,
                 .is_looked_at = true,
                 .words = "slips off above {}",
                 .is_said = has_slipped_off});
  all.push_back({.name = "slip_off_displacement",
                 .kind = ciliaval::quantity::length,
                 .values = member(&MechanicsStep::slip_off_displacement),
                 .uncertainty = slip_off(true),
                 .belongs = [](const MechanicsStep& step) { return step.load.is<ProbeLoad>(); },
                 .is_looked_at = true,
                 .words = "slips off beyond {}",
                 .is_said = has_slipped_off});
  all.push_back(estimate("slip_off_uncertainty", ciliaval::quantity::number,
                         member(&MechanicsStep::slip_off_uncertainty), {}));
  all.push_back(
      {.name = "smallest_eigenvalue",
       .values = member(&MechanicsStep::smallest_eigenvalue),
       .belongs = [](const MechanicsStep& step) { return step.smallest_eigenvalue.has_value(); },
       .is_accepted = false,
       .is_converged = false,
       .words = "smallest eigenvalue {} of that at rest"});
  all.push_back({.name = "pull_in_fraction",
                 .values =
                     [](const MechanicsStep& step) {
                       return step.pull_in ? std::vector{step.pull_in->fraction}
                                           : std::vector<double>{};
                     },
                 .size =
                     [](const Extent&, std::size_t) {
                       return Size{1, 1};
                     },
                 .is_in_summary = false});
  all.push_back(of_touch("vertical_force", ciliaval::quantity::force, &ProbeContact::vertical_force,
                         "pressed down by {}"));
  all.push_back(of_touch("base_moment", ciliaval::quantity::moment, &ProbeContact::base_moment,
                         "moment at the base {}"));
  all.push_back(of_touch("touch_displacement", ciliaval::quantity::length,
                         &ProbeContact::displacement, "probe gone by {}"));
  all.push_back(contact_force("contact/normal_force", &SurfaceContact::normal_force));
  all.push_back(contact_force("contact/friction_force", &SurfaceContact::friction_force));
  return all;
}

std::vector<Quantity>& all_quantities() {
  static std::vector<Quantity> all = own_quantities();
  return all;
}

}  // namespace

void raise(double& largest, double value) {
  if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
}

Extent::Extent(const MechanicsResult& result) {
  for (const MechanicsStep& step : result.steps) {
    raise(force, step.applied_force);
    raise(force, step.slip_off_force.value_or(0));
    if (step.contact) raise(contact, step.contact->normal_force);
    if (!step.deformation) continue;
    const Centreline& centreline = step.deformation->centreline;
    length = centreline.length();
    for (std::size_t place = 0; place < places.size(); ++place)
      raise(deflection, position_at(centreline, place).head<2>().norm());
    raise(angle, tip_angle(step));
  }
}

std::optional<double> tip_angle_uncertainty(const MechanicsStep& step) {
  constexpr double vanishing = 1e-9;  ///< in lengths of the cilium: rounding
  if (step.status != Status::converged || !step.deformation) return std::nullopt;
  if (step.tip_angle_uncertainty) return step.tip_angle_uncertainty;
  if (!step.tip_uncertainty || *step.tip_uncertainty == 0) return step.tip_uncertainty;
  const Centreline& centreline = step.deformation->centreline;
  const double L = centreline.length();
  const double displacement = (centreline.at(L).position - L * Vector3::UnitZ()).norm();
  if (!(displacement > vanishing * L)) return std::nullopt;
  return std::abs(tip_angle(step)) * (*step.tip_uncertainty / displacement);
}

ciliaval::Quantity flux_density_per(const ciliaval::Quantity& magnitude) {
  const ciliaval::Quantity& B = ciliaval::quantity::flux_density;
  if (magnitude.unit.empty())
    return {B.article, "flux density per factor on the load", B.unit, B.example};
  struct Texts {
    std::string name, unit, example;
  };
  static std::mutex mutex;
  static std::map<std::string, Texts, std::less<>> known;  // by unit, which the result refers to
  const std::lock_guard lock(mutex);
  auto found = known.find(magnitude.unit);
  if (found == known.end()) {
    const bool is_simple = magnitude.unit.find_first_of(" /*.") == std::string_view::npos;
    const std::string per =
        is_simple ? fmt::format("/{}", magnitude.unit) : fmt::format("/({})", magnitude.unit);
    found = known
                .emplace(magnitude.unit, Texts{fmt::format("{} per {}", B.name, magnitude.name),
                                               fmt::format("{}{}", B.unit, per),
                                               fmt::format("{}{}", B.example, per)})
                .first;
  }
  const Texts& texts = found->second;
  return {B.article, texts.name, texts.unit, texts.example};
}

const std::vector<Quantity>& quantities() {
  return all_quantities();
}

void add_quantity(Quantity quantity) {
  all_quantities().push_back(std::move(quantity));
}

}  // namespace ciliaval::compare::results

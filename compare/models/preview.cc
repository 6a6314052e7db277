// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/models/preview.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "analytic/elastica/elastica.h"
#include "analytic/elastica/environment/step.h"
#include "compare/models/model_part.h"
#include "compare/models/registry.h"
#include "compare/models/run.h"
#include "compare/models/unstated_touch.h"
#include "problem/cilium.h"

namespace ciliaval::compare::models {
namespace {

constexpr double least_slenderness = 3;  ///< L/d of a rod
constexpr double largest_strain = 0.3;   ///< from there on rubber's own law matters
constexpr double near_magnet = 0.1;      ///< distance of a sensor, in d
constexpr double least_signal = 0.1e-6;  ///< T: below what Hall sensors resolve
constexpr double largest_signal = 1;     ///< T
constexpr double largest_part = 0.02;    ///< of the tip's deflection, that a rod leaves out
constexpr double part_of_range = 0.8;    ///< of the largest load that is borne
constexpr double most_buckling = 20;     ///< buckling loads over the environment: more are not told

/// Usual range of a number of cilia and their rubbers.
struct Usual {
  const char* what;
  double low;
  double high;
  const char* range;
};
constexpr Usual length{"length", 10e-6, 0.1, "10 um to 100 mm"};
constexpr Usual modulus{"Young's modulus", 1e3, 50e6, "1 kPa to 50 MPa"};
constexpr Usual density{"density", 100, 1e4, "100 to 10000 kg/m^3"};
constexpr Usual magnetization{"magnetization", 1e3, 1.2e6, "1 kA/m to 1.2 MA/m"};

class Viewer {
 public:
  explicit Viewer(const input::Case& problem) : problem_(problem) {}

  Preview view() {
    look_at_cilium();
    look_at_sensors();
    look_at_signal();
    look_at_buckling();
    return std::move(preview_);
  }

 private:
  void warn(std::string text) { preview_.warnings.push_back(std::move(text)); }

  void look_at(const std::string& whose, double value, const char* unit, const Usual& usual) {
    if (std::abs(value) >= usual.low && std::abs(value) <= usual.high) return;
    warn(fmt::format("{}: a {} of {:.3g} {} is unusual ({}): is the unit right?", whose, usual.what,
                     value, unit, usual.range));
  }

  void look_at_cilium() {
    const Cilium& cilium = problem_.cilium;
    look_at("cilium", cilium.length(), "m", length);
    for (const Segment& segment : cilium.segments) {
      const std::string whose = "segment \"" + segment.name + "\"";
      look_at(whose, segment.young_modulus, "Pa", modulus);
      if (segment.density != 0) look_at(whose, segment.density, "kg/m^3", density);
      if (is_magnetic(segment))
        look_at(whose, ciliaval::magnetization(segment).norm(), "A/m", magnetization);
    }
    const double slenderness = cilium.length() / cilium.extent(azimuth(problem_.load_path.front()));
    if (slenderness < least_slenderness)
      warn(
          fmt::format("the cilium is only {:.2g} diameters long: rods (`elastica`, `beam`) are off "
                      "by much; trust the solid",
                      slenderness));
  }

  /// Distance of a point from the straight cilium, or its magnet alone, m; 0 inside.
  double distance_from_cilium(const Vector3& point, bool magnet_alone) const {
    const Cilium& cilium = problem_.cilium;
    const std::vector<double> ends = cilium.interfaces();
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < cilium.segments.size(); ++i) {
      if (magnet_alone && !is_magnetic(cilium.segments[i])) continue;
      const double along = std::max({ends[i] - point.z(), point.z() - ends[i + 1], 0.0});
      const double across = std::max(std::hypot(point.x(), point.y()) - cilium.radius(), 0.0);
      nearest = std::min(nearest, std::hypot(along, across));
    }
    return nearest;
  }

  void look_at_sensors() {
    for (std::size_t s = 0; s < problem_.sensors.size(); ++s) {
      const double distance = distance_from_cilium(problem_.sensors[s], true);
      if (distance > 0 && distance_from_cilium(problem_.sensors[s], false) == 0)
        warn(fmt::format("sensor {} lies inside the straight cilium",
                         input::sensor_name(problem_, s)));
      if (distance == 0)
        warn(fmt::format("sensor {} lies inside the straight magnet",
                         input::sensor_name(problem_, s)));
      else if (distance < near_magnet * problem_.cilium.thickness())
        warn(
            fmt::format("sensor {} is {:.3g} mm from the magnet: there the field depends on what "
                        "the magnet's edge really looks like",
                        input::sensor_name(problem_, s), 1e3 * distance));
    }
  }

  /// Warns of the error of plain rods of the case at the step that bends most.
  void look_at_joints(std::size_t step) {
    const MechanicsEntry* first = nullptr;
    std::string plain;
    for (const MechanicsEntry& entry : mechanics_models()) {
      if (!entry.correct || entry.is_corrected(problem_.options) ||
          std::ranges::find(problem_.mechanics, entry.id) == problem_.mechanics.end())
        continue;
      input::Case corrected = problem_;
      if (!correct(entry, corrected).empty()) continue;  // its corrections do not reach
      if (first == nullptr) first = &entry;
      plain += fmt::format("{}[models.{}]", plain.empty() ? "" : ", ", entry.id);
    }
    if (first == nullptr || !fault_of(*first, problem_).empty()) return;
    input::Case one = problem_;
    one.load_path = {problem_.load_path[step]};
    one.stated_by.clear();
    one.sensors.clear();
    one.fields.clear();
    CaseResult result{one, {run_mechanics(*first, one, field_models())}, {}};
    add_model_parts(result, mechanics_models(), field_models());
    const MechanicsRun& run = result.mechanics.front();
    const auto& part = run.model_parts.front().tip;
    if (!part) return;
    const Vector3 tip =
        run.result.steps.front().deformation->centreline.at(one.cilium.length()).position;
    const double deflection = std::hypot(tip.x(), tip.y());
    if (part->difference <= largest_part * deflection) return;
    warn(
        fmt::format("rods are off by about {:.2g} % here, because bonded ends are stiffer than "
                    "theirs: state joints = \"corrected\" in {}, unless you want the paper's",
                    100 * part->difference / deflection, plain));
  }

  /// Warns if a load is so near slip-off that axis and rim, by which rods and the solid judge it,
  /// differ.
  void look_at_slip_off(const MechanicsRun& run) {
    const auto asks_for = [&](bool has_body) {
      return std::ranges::any_of(mechanics_models(), [&](const MechanicsEntry& entry) {
        return entry.has_body == has_body &&
               std::ranges::find(problem_.mechanics, entry.id) != problem_.mechanics.end();
      });
    };
    const bool is_near = std::ranges::any_of(run.result.steps, [](const MechanicsStep& step) {
      const auto limit = slip_off_limit(step);
      return limit && step.load.slip_off_point() == SlipOffPoint::axis &&
             magnitude(step.load) > part_of_range * *limit;
    });
    if (is_near && asks_for(true) && asks_for(false))
      warn(
          "the largest load is near the end of the range, where rods let go by the tip of their "
          "axis and the solid by the rim of its end face, which comes down first: slip_off = "
          "\"rim\" in [load] has both judge by the rim");
  }

  void look_at_signal() {
    // The first one, so the simplest: the paper's elastica, out of its plane and beside magnets the
    // beam.
    const auto& entries = mechanics_models();
    const auto simplest = std::ranges::find_if(entries, [this](const MechanicsEntry& entry) {
      return entry.is_quick() && fault_of(entry, problem_).empty();
    });
    if (simplest == entries.end()) return;
    const std::string& mechanics = simplest->id;
    const MechanicsRun run = run_mechanics(*simplest, problem_, field_models());
    std::optional<std::size_t> largest;  // the step that bends most
    double deflection = -1;
    double strain = 0;
    const double half_thickness = problem_.cilium.extent(azimuth(problem_.load_path.front())) / 2;
    for (std::size_t i = 0; i < run.result.steps.size(); ++i) {
      const MechanicsStep& step = run.result.steps[i];
      if (!step.deformation) continue;
      const Centreline& centreline = step.deformation->centreline;
      for (const double S : centreline.breaks())
        strain = std::max(strain, half_thickness * centreline.at(S).bending_curvature());
      const Vector3 tip = centreline.at(centreline.length()).position;
      if (std::hypot(tip.x(), tip.y()) <= deflection) continue;
      deflection = std::hypot(tip.x(), tip.y());
      largest = i;
    }
    warn_of_steps(run);
    look_at_slip_off(run);
    if (!largest) return;
    const MechanicsStep& step = run.result.steps[*largest];
    if (!problem_.load_path.front().is<SweepLoad>()) look_at_joints(*largest);
    const double angle =
        step.deformation->centreline.at(problem_.cilium.length()).theta() * 180 / std::numbers::pi;
    preview_.signal.push_back(
        fmt::format("{}: the tip goes {:.3g} mm aside and turns by {:.3g} deg (step {} of {})",
                    mechanics, 1e3 * deflection, angle, *largest + 1, run.result.steps.size()));
    if (std::string touch = unstated_touch(problem_.cilium, problem_.load_path[*largest]);
        !touch.empty())
      preview_.signal.push_back(std::move(touch));
    if (strain > largest_strain)
      warn(
          fmt::format("the rubber is strained by {:.0f} %: its own stress-strain law matters "
                      "([models.solid] material)",
                      100 * strain));
    MechanicsRun alone = run;
    alone.result.steps = {step};
    look_at_field(alone);
  }

  /// Reports how many times gravity and field along the axis buckle the cilium, at the steps where
  /// they are extreme. A magnet across the axis has no straight state in a field.
  void look_at_buckling() {
    const auto extremes = [this](const auto& along) {
      const auto [low, high] = std::ranges::minmax_element(problem_.load_path, {}, along);
      return std::array{low, high};
    };
    std::optional<double> least;
    bool is_tilted = false;
    for (const auto& steps :
         {extremes([](const Load& load) { return acting_environment(load).uniform_field.z(); }),
          extremes([](const Load& load) { return acting_environment(load).gravity.z(); })})
      for (const auto step : steps) {
        surroundings::Environment along = acting_environment(*step);
        for (Vector3* vector : {&along.gravity, &along.uniform_field}) {
          is_tilted = is_tilted || !vector->head<2>().isZero(0);
          vector->head<2>().setZero();
        }
        along.magnets.clear();
        if (has_transverse_magnetization(problem_.cilium)) along.uniform_field.setZero();
        if (surroundings::is_empty(along)) continue;
        const std::optional<double> factor =
            analytic::elastica::environment::critical_factor(problem_.cilium, along, most_buckling);
        if (factor && (!least || *factor < *least)) least = factor;
      }
    if (!least) return;
    const std::string text = fmt::format(
        "weight and field along the axis buckle the straight cilium at {:.4g} times", *least);
    if (*least > 1)
      preview_.signal.push_back(text);
    else
      warn(text + (is_tilted ? " what they are: their part across the axis chooses the side"
                             : " what they are: state an imperfection, a slight tilt of gravity "
                               "or field, that chooses the side"));
  }

  void warn_of_steps(const MechanicsRun& run) {
    for (const MechanicsStep& step : run.result.steps) {
      if (step.status == Status::converged) continue;
      warn(fmt::format("{}: {}", run.model, step.message));
      return;  // the rest says the same
    }
  }

  void look_at_field(const MechanicsRun& run) {
    if (problem_.sensors.empty()) return;
    const FieldEntry& entry = quick_one(field_models());
    const FieldRun fields = run_field(entry.id, *entry.make(problem_.options), run, problem_);
    const auto& step = fields.steps.front();
    if (!step) return;
    if (!step->failure.empty()) warn(fmt::format("{}: {}", entry.id, step->failure));
    for (std::size_t s = 0; s < problem_.sensors.size(); ++s) {
      if (!step->dB[s]) continue;
      const double change = step->dB[s]->norm();
      preview_.signal.push_back(fmt::format("sensor {}: |B| {:.4g} mT, |dB| {:.4g} uT",
                                            input::sensor_name(problem_, s),
                                            1e3 * step->B[s]->norm(), 1e6 * change));
      if (change < least_signal || change > largest_signal)
        warn(fmt::format("sensor {} sees a change of {:.3g} uT: {}",
                         input::sensor_name(problem_, s), 1e6 * change,
                         change < least_signal ? "below what Hall sensors resolve (0.1 uT)"
                                               : "are M, the unit and the place right?"));
    }
  }

  const input::Case& problem_;
  Preview preview_;
};

}  // namespace

Preview preview(const input::Case& problem) {
  return Viewer(problem).view();
}

}  // namespace ciliaval::compare::models

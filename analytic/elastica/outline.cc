// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/outline.h"

#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace ciliaval::analytic::elastica {
using namespace surroundings;
using namespace point_forces;
namespace {

constexpr double samples_per_feature = 12;
constexpr double longest_spacing = 0.02;  ///< of the samples, in L
constexpr double shortest_spacing = 1e-3;
constexpr double reach = 1.2;  ///< of the cilium to both sides, in L
constexpr double most_height_samples = 1e5;
constexpr double angle_slack = 1e-11;
constexpr double pull_slack = 1e-12;
constexpr int minimum_bits = 30;  ///< of the place of a least gap

bool is_near(const Touch& a, const Touch& b, double spacing) {
  if (a.where != b.where) return false;
  if (a.where == TouchPoint::face) return std::abs(a.offset - b.offset) < spacing;
  return a.side == b.side && std::abs(a.S - b.S) < spacing;
}

}  // namespace

std::vector<Step> steps_along(const TipProblem& problem, const TipContact& contact) {
  std::vector<Step> steps;
  Section section;
  section.moment = contact.base_moment;
  Force force{contact.force_x, contact.force_z, {}, {}};
  std::vector<Touch> on_mantle;
  for (const Touch& touch : contact.touches)
    if (touch.where == TouchPoint::mantle && touch.S < 1) on_mantle.push_back(touch);
  std::ranges::sort(on_mantle, {}, &Touch::S);
  const Rod rod{problem.ends, problem.compliance};
  const auto keep = [&](const Step& step) { steps.push_back(step); };
  for (const Touch& touch : on_mantle) {
    integrate(rod, section, force, touch.S, keep);
    section.moment += touch.offset * (touch.force_x * std::sin(section.theta) +
                                      touch.force_z * std::cos(section.theta));
    force.x -= touch.force_x;
    force.z -= touch.force_z;
  }
  integrate(rod, section, force, 1, keep);
  return steps;
}

struct Outline::Sample {
  double parameter;
  OutlinePoint point;
};

struct Outline::Shape {
  std::vector<Step> steps;
  double theta;
  double x;
  double z;

  Section at(double S) const {
    auto step = std::ranges::lower_bound(steps, S, {}, &Step::end);
    if (step == steps.end()) --step;
    return step->at(S);
  }
};

Outline::Outline(const TipProblem& problem, const Surface& surface,
                 const std::vector<SurfacePlace>& places)
    : problem_(problem), surface_(surface) {
  const double feature = surface.finest_length() / problem.length / samples_per_feature;
  spacing_ = std::clamp(feature, shortest_spacing, longest_spacing);
  face_samples_ =
      static_cast<int>(std::ceil(2 * problem.rim / std::min(spacing_, problem.rim / 2)));
  if (problem.rim == 0 || places.empty()) return;
  const auto [first, last] = std::ranges::minmax(places, {}, &SurfacePlace::travel);
  const double low = -reach - last.travel;
  const double high = reach - first.travel;
  const double count = std::clamp((high - low) / feature, 1.0, most_height_samples);
  highest_ = -std::numeric_limits<double>::infinity();
  double lowest = -highest_;
  for (double i = 0; i <= count; ++i) {
    const double x = std::lerp(low, high, i / count) * problem.length;
    const double height = surface.extended(x).height / problem.length;
    highest_ = std::max(highest_, height);
    lowest = std::min(lowest, height);
  }
  highest_ += 0.05 * (highest_ - lowest);
}

double Outline::gap(const SurfacePlace& place, double x, double z) const {
  return place.height - z -
         surface_.extended((x - place.travel) * problem_.length).height / problem_.length;
}

OutlinePoint Outline::on_mantle(const SurfacePlace& place, const Section& section,
                                double side) const {
  OutlinePoint point;
  Touch& touch = point.touch;
  touch.where = TouchPoint::mantle;
  touch.side = side;
  touch.S = section.S;
  touch.offset = side * problem_.rim;
  touch.x = section.x + touch.offset * std::cos(section.theta);
  touch.z = section.z - touch.offset * std::sin(section.theta);
  const double under = place.height - highest_ - touch.z;
  point.gap = under > 0 ? under : gap(place, touch.x, touch.z);
  return point;
}

OutlinePoint Outline::at(const SurfacePlace& place, const Shape& shape, TouchPoint where,
                         double side, double parameter) const {
  if (where == TouchPoint::mantle) return on_mantle(place, shape.at(parameter), side);
  OutlinePoint point;
  Touch& touch = point.touch;
  touch.where = where;
  touch.side = side;
  touch.offset = where == TouchPoint::face ? parameter : side * problem_.rim;
  if (where == TouchPoint::tip) touch.offset = 0;
  touch.x = shape.x + touch.offset * std::cos(shape.theta);
  touch.z = shape.z - touch.offset * std::sin(shape.theta);
  point.gap = gap(place, touch.x, touch.z);
  return point;
}

OutlinePoint Outline::nearest(const SurfacePlace& place, const TipContact& contact) const {
  if (problem_.rim == 0) {
    const Shape shape{{}, contact.theta, contact.x, contact.z};
    return at(place, shape, TouchPoint::tip, -1, 0);
  }
  const Shape shape{steps_along(problem_, contact), contact.theta, contact.x, contact.z};
  OutlinePoint best;
  best.gap = std::numeric_limits<double>::infinity();
  const auto take = [&](const OutlinePoint& point) {
    if (point.gap < best.gap) best = point;
  };
  // The minima between samples along a part of the outline, in increasing order of the parameter.
  const auto refine = [&](TouchPoint where, double side, const std::vector<Sample>& samples) {
    for (const Sample& sample : samples) take(sample.point);
    for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
      const double before = samples[i - 1].point.gap - samples[i].point.gap;
      const double after = samples[i + 1].point.gap - samples[i].point.gap;
      if (before < 0 || after < 0 || samples[i].point.gap > std::max(before, after)) continue;
      const double from = samples[i - 1].parameter;
      const double to = samples[i + 1].parameter;
      if (std::ranges::any_of(contact.touches, [&](const Touch& touch) {
            return is_near(touch, samples[i].point.touch, 0.75 * (to - from));
          }))
        continue;
      const double parameter =
          boost::math::tools::brent_find_minima(
              [&](double value) { return at(place, shape, where, side, value).gap; }, from, to,
              minimum_bits)
              .first;
      take(at(place, shape, where, side, parameter));
    }
  };
  std::array<std::vector<Sample>, 2> mantle;
  // From the tip down. The outline rises by ΔS at most: what is far below the surface is left out.
  for (double S = 1 - 1e-9; S > 0;) {
    const Section section = shape.at(S);
    const double under = place.height - highest_ - section.z - problem_.rim;
    for (const double side : {-1.0, 1.0}) {
      Sample sample{S, {}};
      if (under > 0)
        sample.point.gap = under;
      else
        sample.point = on_mantle(place, section, side);
      mantle[side < 0 ? 0 : 1].push_back(sample);
    }
    S -= std::max(spacing_, under);
  }
  std::vector<Sample> face;
  for (int i = 0; i <= face_samples_; ++i) {
    const double end = problem_.rim * (1 - 1e-9);
    const double parameter = std::lerp(-end, end, static_cast<double>(i) / face_samples_);
    face.push_back({parameter, at(place, shape, TouchPoint::face, 1, parameter)});
  }
  for (const double side : {-1.0, 1.0}) {
    std::vector<Sample>& samples = mantle[side < 0 ? 0 : 1];
    std::ranges::reverse(samples);
    take(at(place, shape, TouchPoint::rim, side, 0));
    refine(TouchPoint::mantle, side, samples);
  }
  refine(TouchPoint::face, 1, face);
  return best;
}

std::vector<Touch> Outline::changed(const SurfacePlace& place, const TipContact& contact) const {
  if (problem_.rim == 0) return {};
  std::vector<Touch> touches = contact.touches;
  const double quarter = std::numbers::pi / 2;
  for (Touch& touch : touches) {
    const double turned = touch.side * (touch.inclination - contact.theta);
    if (touch.where == TouchPoint::rim && turned < -angle_slack) {
      touch.where = TouchPoint::face;
      return touches;
    }
    if (touch.where == TouchPoint::rim && turned > quarter + angle_slack) {
      touch.where = TouchPoint::mantle;
      return touches;
    }
    const bool beyond_face =
        touch.where == TouchPoint::face && std::abs(touch.offset) > problem_.rim;
    if (beyond_face || (touch.where == TouchPoint::mantle && touch.S > 1)) {
      if (beyond_face) touch.side = touch.offset < 0 ? -1 : 1;
      touch.where = TouchPoint::rim;
      touch.offset = touch.side * problem_.rim;
      touch.S = 1;
      return touches;
    }
  }
  if (touches.size() > 1) {
    const auto pulled = std::ranges::min_element(touches, {}, &Touch::normal_force);
    if (pulled->normal_force < -pull_slack) {
      touches.erase(pulled);
      return touches;
    }
  }
  const OutlinePoint deepest = nearest(place, contact);
  if (deepest.gap >= -deepest_gap) return {};
  if (std::ranges::any_of(touches,
                          [&](const Touch& touch) { return is_near(touch, deepest.touch, 1e-6); }))
    return {};  // there is one
  touches.push_back(deepest.touch);
  return touches;
}

}  // namespace ciliaval::analytic::elastica

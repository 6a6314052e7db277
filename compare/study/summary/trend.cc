// SPDX-License-Identifier: LGPL-2.1-or-later
#include <algorithm>
#include <cmath>
#include <vector>

#include "compare/study/summary/report.h"

namespace ciliaval::compare::study::summary {
namespace {

struct Sample {
  double x = 0;  ///< the parameter, or its logarithm
  double y = 0;
};

/// The vertex of the parabola through three points; the middle one if they lie on a line.
Sample vertex(const Sample& a, const Sample& b, const Sample& c) {
  const double left = (b.y - a.y) / (b.x - a.x);
  const double right = (c.y - b.y) / (c.x - b.x);
  const double curvature = (right - left) / (c.x - a.x);
  if (curvature == 0) return b;
  const double slope = left + curvature * (b.x - a.x);  // at b
  const double shift = -slope / (2 * curvature);
  return {b.x + shift, b.y + slope * shift + curvature * shift * shift};
}

/// Where a monotone sequence has done this part of its change, by linear interpolation.
double reached_at(const std::vector<Sample>& samples, double part) {
  const double goal = samples.front().y + part * (samples.back().y - samples.front().y);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const Sample& a = samples[i - 1];
    const Sample& b = samples[i];
    if ((a.y - goal) * (b.y - goal) <= 0 && a.y != b.y)
      return a.x + (b.x - a.x) * (goal - a.y) / (b.y - a.y);
  }
  return samples.back().x;
}

/// The kind of a sequence by the signs of its differences; `turn` is the sample at which it turns.
Trend::Kind kind_of(const std::vector<Sample>& samples, std::size_t& turn) {
  int turns = 0;
  int first = 0;
  int last = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double change = samples[i].y - samples[i - 1].y;
    const int sign = change > 0 ? 1 : change < 0 ? -1 : 0;
    if (sign == 0) continue;
    if (last != 0 && sign != last) {
      ++turns;
      turn = i - 1;
    }
    if (first == 0) first = sign;
    last = sign;
  }
  if (first == 0) return Trend::Kind::constant;
  if (turns == 0) return first > 0 ? Trend::Kind::rising : Trend::Kind::falling;
  if (turns > 1) return Trend::Kind::other;
  return first > 0 ? Trend::Kind::peak : Trend::Kind::trough;
}

}  // namespace

Trend trend(const StudyResult& result, std::size_t pair, std::size_t output) {
  const Parameter& parameter = result.study.parameters.front();
  Trend t;
  std::vector<Sample> samples;
  const bool logarithmic = parameter.is_logarithmic && parameter.values.front() > 0;
  for (std::size_t point = 0; point < result.study.point_count(); ++point) {
    const auto& value = result.points[point][pair].values[output];
    const double x = result.study.values_at(point).front();
    if (value)
      samples.push_back({logarithmic ? std::log(x) : x, *value});
    else
      ++t.missing;
  }
  if (samples.size() < 3) return t;
  std::sort(samples.begin(), samples.end(),
            [](const Sample& a, const Sample& b) { return a.x < b.x; });
  const auto parameter_at = [&](double x) { return logarithmic ? std::exp(x) : x; };
  std::size_t turn = 0;
  t.kind = kind_of(samples, turn);
  t.first = samples.front().y;
  t.last = samples.back().y;
  if (t.kind == Trend::Kind::rising || t.kind == Trend::Kind::falling)
    t.settled_at = parameter_at(reached_at(samples, 0.95));
  if (t.kind == Trend::Kind::peak || t.kind == Trend::Kind::trough) {
    const Sample best = vertex(samples[turn - 1], samples[turn], samples[turn + 1]);
    t.largest = best.y;
    t.extreme_at = parameter_at(best.x);
  }
  return t;
}

}  // namespace ciliaval::compare::study::summary

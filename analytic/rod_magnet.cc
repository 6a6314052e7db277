// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/rod_magnet.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <utility>

#include "problem/error.h"

namespace ciliaval::analytic {
namespace {

/// The stretches of one segment. Interfaces and breaks are sums of the same lengths, perhaps in
/// another order: what is shorter than their rounding error is no stretch.
void append_stretches(RodMagnet& magnet, std::size_t segment, double begin, double end, double M) {
  const std::vector<double>& breaks = magnet.centreline.breaks();
  const double rounding = 1e-12 * magnet.centreline.length();
  for (std::size_t piece = 0; piece + 1 < breaks.size(); ++piece) {
    const double low = std::max(begin, breaks[piece]);
    const double high = std::min(end, breaks[piece + 1]);
    if (high - low > rounding) magnet.stretches.push_back({low, high, piece, segment, M});
  }
}

/// Sections along the stretches first … last−1 of one segment, close enough that between two of
/// them (x − r)·d₃ changes its sign at most once.
std::vector<RodSample> samples(const RodMagnet& magnet, std::size_t first, std::size_t last) {
  std::vector<RodSample> line;
  for (std::size_t i = first; i < last; ++i) {
    const RodStretch& stretch = magnet.stretches[i];
    const std::size_t intervals = 2 * magnet.centreline.pieces()[stretch.piece].S.size();
    for (std::size_t k = i == first ? 0 : 1; k <= intervals; ++k) {
      const double t = static_cast<double>(k) / static_cast<double>(intervals);
      const double S = k == intervals ? stretch.end : std::lerp(stretch.begin, stretch.end, t);
      const CentrelinePoint point = at(magnet, stretch, S);
      const Vector3 d3 = point.normal();
      const double jacobian =
          d3.dot(point.derivative) - magnet.radius * point.curvature.cross(d3).norm();
      line.push_back({S, i, point.position, d3, jacobian});
    }
  }
  return line;
}

/// Ends with a jump. An interface's section is taken from the segment below; the sample above takes
/// it over, so that a point on the section is on the same side for the disc and for both segments.
void append_ends(RodMagnet& magnet) {
  for (std::size_t i = 0; i < magnet.lines.size(); ++i) {
    std::vector<RodSample>& line = magnet.lines[i];
    const double M = magnet.stretches[line.front().stretch].magnetization;
    const std::size_t segment = magnet.stretches[line.front().stretch].segment;
    double below = 0;
    if (i > 0) {
      const RodSample& previous = magnet.lines[i - 1].back();
      if (magnet.stretches[previous.stretch].segment + 1 == segment) {
        below = magnet.stretches[previous.stretch].magnetization;
        line.front().position = previous.position;
        line.front().normal = previous.normal;
        magnet.ends.pop_back();
      }
    }
    if (below != M)
      magnet.ends.push_back(
          {{line.front().position, line.front().normal, magnet.radius}, below - M});
    magnet.ends.push_back({{line.back().position, line.back().normal, magnet.radius}, M});
  }
}

/// (x − r)·d₃, the height of x above a section.
double height_above(const RodSample& sample, const Vector3& x) {
  return (x - sample.position).dot(sample.normal);
}

std::optional<Vector3> magnetization_between(const RodMagnet& magnet, const RodSample& low,
                                             const RodSample& high, const Vector3& x) {
  const double above_low = height_above(low, x);
  const double above_high = height_above(high, x);
  if (!(above_low >= 0 && above_high < 0)) return std::nullopt;
  // A point of the rod is within R of its section, whose centre is between the two samples.
  const double reach = magnet.radius + 2 * (high.position - low.position).norm();
  if ((x - low.position).norm() > reach) return std::nullopt;

  const RodStretch& stretch = magnet.stretches[high.stretch];
  double S = low.S;
  if (above_low > 0) {
    const auto height = [&](double s) {
      const CentrelinePoint point = at(magnet, stretch, s);
      return (x - point.position).dot(point.normal());
    };
    std::uintmax_t iterations = 100;
    const auto bracket = boost::math::tools::toms748_solve(
        height, low.S, high.S, above_low, above_high, boost::math::tools::eps_tolerance<double>(52),
        iterations);
    S = (bracket.first + bracket.second) / 2;
  }
  const CentrelinePoint point = at(magnet, stretch, S);
  if (!((x - point.position).norm() < magnet.radius)) return std::nullopt;
  const Vector3 carried = stretch_vector(point, x);
  return stretch.magnetization / point.normal().dot(carried) * carried;
}

/// Appends the parts of a stretch that are no longer than their distance; false if one would be
/// too short.
bool append_graded(const RodMagnet& magnet, const RodStretch& stretch,
                   const std::function<double(const CentrelinePoint&)>& distance, double shortest,
                   std::vector<RodStretch>& parts) {
  const double S = (stretch.begin + stretch.end) / 2;
  const CentrelinePoint middle = at(magnet, stretch, S);
  const double length = (stretch.end - stretch.begin) * middle.derivative.norm();
  if (length <= distance(middle)) {
    parts.push_back(stretch);
    return true;
  }
  if (!(length > shortest)) return false;
  RodStretch lower = stretch;
  lower.end = S;
  RodStretch upper = stretch;
  upper.begin = S;
  return append_graded(magnet, lower, distance, shortest, parts) &&
         append_graded(magnet, upper, distance, shortest, parts);
}

}  // namespace

RodMagnet rod_magnet(const Cilium& cilium, const Deformation& deformation) {
  if (cilium.segments.empty()) throw InputError("the field of a cilium without segments was asked");
  RodMagnet magnet;
  magnet.radius = cilium.radius();
  magnet.centreline = deformation.centreline;
  const std::vector<double> interfaces = cilium.interfaces();
  if (!(std::abs(magnet.centreline.length() - interfaces.back()) <= 1e-9 * interfaces.back()))
    throw InputError(
        "the centreline of the deformation is not as long as the cilium: take both "
        "from the same model");
  for (std::size_t i = 0; i < cilium.segments.size(); ++i) {
    const double M = cilium.segments[i].magnetization;
    if (M == 0) continue;
    const std::size_t first = magnet.stretches.size();
    append_stretches(magnet, i, interfaces[i], interfaces[i + 1], M);
    magnet.lines.push_back(samples(magnet, first, magnet.stretches.size()));
  }
  append_ends(magnet);
  return magnet;
}

CentrelinePoint at(const RodMagnet& magnet, const RodStretch& stretch, double S) {
  return magnet.centreline.at(S, stretch.piece);
}

Circle section(const RodMagnet& magnet, const CentrelinePoint& point) {
  return {point.position, point.normal(), magnet.radius};
}

Vector3 stretch_vector(const CentrelinePoint& point, const Vector3& x) {
  return point.derivative + point.curvature.cross(x - point.position);
}

std::optional<std::vector<RodStretch>> graded_stretches(
    const RodMagnet& magnet, const std::function<double(const CentrelinePoint&)>& distance,
    double shortest) {
  std::vector<RodStretch> parts;
  for (const RodStretch& stretch : magnet.stretches)
    if (!append_graded(magnet, stretch, distance, shortest, parts)) return std::nullopt;
  return parts;
}

void require_body(const RodMagnet& magnet) {
  for (const std::vector<RodSample>& line : magnet.lines)
    for (const RodSample& sample : line)
      if (!(sample.jacobian > 0))
        throw SolverError(
            "the magnet is bent more sharply than its radius, so that its sections "
            "cross and it has no volume: take the model `line`");
}

std::optional<Vector3> magnetization_at(const RodMagnet& magnet, const Vector3& x) {
  for (const std::vector<RodSample>& line : magnet.lines) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      if (auto m = magnetization_between(magnet, line[i], line[i + 1], x)) return m;
    }
  }
  return std::nullopt;
}

}  // namespace ciliaval::analytic

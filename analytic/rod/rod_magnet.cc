// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/rod/rod_magnet.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "analytic/sources/charged_rectangle.h"
#include "analytic/sources/dipole.h"
#include "problem/cilium.h"
#include "problem/error.h"
#include "problem/field_model.h"

namespace ciliaval::analytic::rod {
namespace {

/// The stretches of one segment. Interfaces and breaks may differ by rounding, which makes no
/// stretch.
void append_stretches(RodMagnet& magnet, std::size_t segment, double begin, double end,
                      const Vector3& M) {
  const std::vector<double>& breaks = magnet.centreline.breaks();
  const double rounding = 1e-12 * magnet.centreline.length();
  for (std::size_t piece = 0; piece + 1 < breaks.size(); ++piece) {
    const double low = std::max(begin, breaks[piece]);
    const double high = std::min(end, breaks[piece + 1]);
    if (high - low > rounding) magnet.stretches.push_back({low, high, piece, segment, M});
  }
}

/// Axes of a rectangle's sides and d₃.
Eigen::Matrix3d axes_of(const CrossSection& shape, const CentrelinePoint& point) {
  return point.rotation * Eigen::AngleAxisd(shape.orientation, Vector3::UnitZ()).toRotationMatrix();
}

RodEnd end_at(const RodMagnet& magnet, const RodStretch& stretch, double S, double jump) {
  const CentrelinePoint point = at(magnet, stretch, S);
  RodEnd end{section(magnet, point), jump};
  if (magnet.shape.shape == CrossSection::Shape::rectangle)
    end.rectangle = {axes_of(magnet.shape, point),
                     {magnet.shape.width / 2, magnet.shape.height / 2}};
  return end;
}

/// The holes of a tube.
void append_holes(RodMagnet& magnet) {
  if (magnet.shape.shape != CrossSection::Shape::tube) return;
  const std::size_t count = magnet.ends.size();
  for (std::size_t i = 0; i < count; ++i) {
    RodEnd hole = magnet.ends[i];
    hole.section.radius = magnet.shape.inner_diameter / 2;
    hole.magnetization_jump *= -1;
    magnet.ends.push_back(hole);
  }
}

/// True if the section at an interface has another pose on its two sides: a rod's joint.
bool has_joint(const RodMagnet& magnet, const RodStretch& below, const RodStretch& above) {
  const double rounding = 1e-12;
  const CentrelinePoint a = at(magnet, below, below.end);
  const CentrelinePoint b = at(magnet, above, above.begin);
  return (a.position - b.position).norm() > rounding * magnet.centreline.length() ||
         (a.normal() - b.normal()).norm() > rounding;
}

/// Ends with a jump. An interface's section is taken from the segment below, unless it is a joint.
void append_ends(RodMagnet& magnet) {
  const auto append = [&](const RodStretch& stretch, double S, double jump) {
    if (jump != 0) magnet.ends.push_back(end_at(magnet, stretch, S, jump));
  };
  const RodStretch* below = nullptr;
  for (std::size_t i = 0; i < magnet.stretches.size(); ++i) {
    const RodStretch& stretch = magnet.stretches[i];
    if (below == nullptr || below->segment != stretch.segment) {
      const bool is_joined = below != nullptr && below->segment + 1 == stretch.segment &&
                             !has_joint(magnet, *below, stretch);
      const double M = stretch.magnetization.z();
      if (below != nullptr && !is_joined) append(*below, below->end, below->magnetization.z());
      if (is_joined)
        append(*below, below->end, below->magnetization.z() - M);
      else
        append(stretch, stretch.begin, -M);
    }
    below = &stretch;
  }
  if (below != nullptr) append(*below, below->end, below->magnetization.z());
}

void append_segment_ends(RodMagnet& magnet) {
  for (std::size_t i = 0; i < magnet.stretches.size(); ++i) {
    const RodStretch& stretch = magnet.stretches[i];
    const auto is_same = [&](std::size_t other) {
      return other < magnet.stretches.size() && magnet.stretches[other].segment == stretch.segment;
    };
    const double M = stretch.magnetization.norm();
    if (i == 0 || !is_same(i - 1))
      magnet.segment_ends.push_back(end_at(magnet, stretch, stretch.begin, M));
    if (!is_same(i + 1)) magnet.segment_ends.push_back(end_at(magnet, stretch, stretch.end, M));
  }
}

/// The error (m) of an end's place along the rod.
double rounding_of_place(const RodMagnet& magnet, const RodEnd& end) {
  return 4 * epsilon * (end.section.centre.norm() + magnet.centreline.length());
}

/// Sum of the reciprocal distances (1/m) of x from the edges of a section.
double closeness_to_edges(const RodMagnet& magnet, const RodEnd& end, const Vector3& x) {
  if (end.rectangle)
    return 1 / sources::distance_from_edge(
                   end.rectangle->half, end.rectangle->axes.transpose() * (x - end.section.centre));
  const double outer = 1 / sources::distance_from_line(end.section, x);
  if (magnet.shape.shape != CrossSection::Shape::tube) return outer;
  sources::Circle hole = end.section;
  hole.radius = magnet.shape.inner_diameter / 2;
  return outer + 1 / sources::distance_from_line(hole, x);
}

/// Calls `visit(point)` at the nodes of the stretch and at its ends.
template <class Visit>
void for_each_node(const RodMagnet& magnet, const RodStretch& stretch, Visit visit) {
  const std::vector<double>& S = magnet.centreline.pieces()[stretch.piece].S;
  visit(at(magnet, stretch, stretch.begin));
  for (std::size_t i = 0; i < S.size(); ++i)
    if (S[i] > stretch.begin && S[i] < stretch.end) visit(magnet.centreline.node(stretch.piece, i));
  visit(at(magnet, stretch, stretch.end));
}

/// True if the section at the point holds x, which lies in its plane.
bool is_in_section(const RodMagnet& magnet, const CentrelinePoint& point, const Vector3& x) {
  const CrossSection& shape = magnet.shape;
  const double distance = (x - point.position).norm();
  if (shape.shape != CrossSection::Shape::rectangle)
    return distance < magnet.radius && !(distance < shape.inner_diameter / 2);
  const Vector3 local = axes_of(shape, point).transpose() * (x - point.position);
  return std::abs(local.x()) < shape.width / 2 && std::abs(local.y()) < shape.height / 2;
}

/// The most by which bending shortens ∂x/∂S·d₃ anywhere on the section.
double largest_shortening(const RodMagnet& magnet, const CentrelinePoint& point) {
  const Vector3 d3 = point.normal();
  const CrossSection& shape = magnet.shape;
  if (shape.shape != CrossSection::Shape::rectangle)
    return magnet.radius * point.curvature.cross(d3).norm();
  const Eigen::Matrix3d axes = axes_of(shape, point);
  return shape.width / 2 * std::abs(point.curvature.cross(axes.col(0)).dot(d3)) +
         shape.height / 2 * std::abs(point.curvature.cross(axes.col(1)).dot(d3));
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
  RodMagnet magnet{
      .radius = cilium.radius(), .area = cilium.area(), .centreline = deformation.centreline};
  magnet.shape = cilium.section;
  const std::vector<double> interfaces = cilium.interfaces();
  if (!(std::abs(magnet.centreline.length() - interfaces.back()) <= 1e-9 * interfaces.back()))
    throw InputError(
        "the centreline of the deformation is not as long as the cilium: take both "
        "from the same model");
  for (std::size_t i = 0; i < cilium.segments.size(); ++i) {
    if (is_magnetic(cilium.segments[i]))
      append_stretches(magnet, i, interfaces[i], interfaces[i + 1],
                       magnetization(cilium.segments[i]));
  }
  append_ends(magnet);
  append_holes(magnet);
  append_segment_ends(magnet);
  return magnet;
}

double pole_strength(const RodEnd& end) {
  const double area = end.rectangle ? 4 * end.rectangle->half[0] * end.rectangle->half[1]
                                    : std::numbers::pi * end.section.radius * end.section.radius;
  return area * end.magnetization_jump;
}

CentrelinePoint at(const RodMagnet& magnet, const RodStretch& stretch, double S) {
  return magnet.centreline.at(S, stretch.piece);
}

sources::Circle section(const RodMagnet& magnet, const CentrelinePoint& point) {
  return {point.position, point.normal(), magnet.radius};
}

double distance_from_section(const RodMagnet& magnet, const CentrelinePoint& point,
                             const Vector3& x) {
  if (magnet.shape.shape != CrossSection::Shape::rectangle)
    return sources::distance_from_disc(section(magnet, point), x);
  const Vector3 local = axes_of(magnet.shape, point).transpose() * (x - point.position);
  return std::hypot(std::max(std::abs(local.x()) - magnet.shape.width / 2, 0.0),
                    std::max(std::abs(local.y()) - magnet.shape.height / 2, 0.0), local.z());
}

double rounding_of_ends(const RodMagnet& magnet, const Vector3& x) {
  double sum = 0;
  for (const RodEnd& end : magnet.segment_ends) {
    const double a = (x - end.section.centre).norm();
    const double layer = a > 3 * magnet.radius ? magnet.area / (std::numbers::pi * a * a * a)
                                               : closeness_to_edges(magnet, end, x);
    sum += vacuum_permeability * end.magnetization_jump * rounding_of_place(magnet, end) * layer;
  }
  return sum;
}

double rounding_of_poles(const RodMagnet& magnet, const Vector3& x) {
  double sum = 0;
  for (const RodEnd& end : magnet.segment_ends)
    sum += sources::largest_dipole_field(
        magnet.area * end.magnetization_jump * rounding_of_place(magnet, end),
        (x - end.section.centre).norm());
  return sum;
}

Vector3 stretch_vector(const CentrelinePoint& point, const Vector3& x) {
  return point.derivative + point.curvature.cross(x - point.position);
}

Vector3 carried_magnetization(const RodStretch& stretch, const CentrelinePoint& point,
                              const Vector3& a) {
  const Vector3& M = stretch.magnetization;
  const Vector3 axial = M.z() * a;
  if (M.head<2>().isZero(0)) return axial;
  return point.rotation * Vector3(M.x(), M.y(), 0) + axial;
}

bool is_transverse(const RodMagnet& magnet) {
  return std::ranges::any_of(magnet.stretches, [](const RodStretch& stretch) {
    return !stretch.magnetization.head<2>().isZero(0);
  });
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
  for (const RodStretch& stretch : magnet.stretches)
    for_each_node(magnet, stretch, [&](const CentrelinePoint& point) {
      const Vector3 d3 = point.normal();
      const double smallest_jacobian = d3.dot(point.derivative) - largest_shortening(magnet, point);
      if (!(smallest_jacobian > 0))
        throw SolverError(
            "the magnet is bent more sharply than its radius, so that its sections "
            "cross and it has no volume: take the model `line`");
    });
}

RodInterior::RodInterior(const RodMagnet& magnet) : magnet_(magnet) {
  double spacing = 0;
  for (const RodStretch& stretch : magnet.stretches) {
    std::optional<Vector3> previous;
    for_each_node(magnet, stretch, [&](const CentrelinePoint& point) {
      box_.extend(point.position);
      if (previous) spacing = std::max(spacing, (point.position - *previous).norm());
      previous = point.position;
    });
  }
  // A point of the rod is within R of its section's centre, and that is half the spacing of the
  // nodes, or little more, from one of them.
  const Vector3 margin = Vector3::Constant(magnet.radius + spacing);
  if (!box_.isEmpty()) box_ = {box_.min() - margin, box_.max() + margin};
}

/// Close enough that between two of them (x − r)·d₃ changes its sign at most once.
void RodInterior::append_samples(std::size_t i, Line& line) const {
  const RodStretch& stretch = magnet_.stretches[i];
  const std::size_t intervals = 2 * magnet_.centreline.pieces()[stretch.piece].S.size();
  for (std::size_t k = line.empty() ? 0 : 1; k <= intervals; ++k) {
    const double t = static_cast<double>(k) / static_cast<double>(intervals);
    const double S = k == intervals ? stretch.end : std::lerp(stretch.begin, stretch.end, t);
    const CentrelinePoint point = at(magnet_, stretch, S);
    line.push_back({S, i, point.position, point.normal()});
  }
}

std::vector<RodInterior::Line> RodInterior::sample() const {
  std::vector<Line> lines;
  for (std::size_t i = 0; i < magnet_.stretches.size(); ++i) {
    const std::size_t segment = magnet_.stretches[i].segment;
    const bool continues = i > 0 && magnet_.stretches[i - 1].segment == segment;
    if (!continues) lines.emplace_back();
    append_samples(i, lines.back());
    if (i > 0 && magnet_.stretches[i - 1].segment + 1 == segment) {
      // An interface has the lower segment's section, so that a point on it is on the same side for
      // the disc and for both segments.
      const Sample& below = lines[lines.size() - 2].back();
      lines.back().front().position = below.position;
      lines.back().front().normal = below.normal;
    }
  }
  return lines;
}

std::optional<Vector3> RodInterior::magnetization_between(const Sample& low, const Sample& high,
                                                          double above_low, double above_high,
                                                          const Vector3& x) const {
  // A point of the rod is within R of its section, whose centre is between the two samples.
  const double reach = magnet_.radius + 2 * (high.position - low.position).norm();
  if ((x - low.position).norm() > reach) return std::nullopt;

  const RodStretch& stretch = magnet_.stretches[high.stretch];
  double S = low.S;
  if (above_low > 0) {
    const auto height = [&](double s) {
      const CentrelinePoint point = at(magnet_, stretch, s);
      return (x - point.position).dot(point.normal());
    };
    std::uintmax_t iterations = 100;
    const auto bracket = boost::math::tools::toms748_solve(
        height, low.S, high.S, above_low, above_high, boost::math::tools::eps_tolerance<double>(52),
        iterations);
    S = (bracket.first + bracket.second) / 2;
  }
  const CentrelinePoint point = at(magnet_, stretch, S);
  if (!is_in_section(magnet_, point, x)) return std::nullopt;
  const Vector3 tangent = stretch_vector(point, x);
  return carried_magnetization(stretch, point, tangent) / point.normal().dot(tangent);
}

std::optional<Vector3> RodInterior::magnetization_at(const Vector3& x) const {
  if (!box_.contains(x)) return std::nullopt;
  std::call_once(sampled_, [&] { lines_ = sample(); });
  const auto height_above = [&](const Sample& sample) {
    return (x - sample.position).dot(sample.normal);
  };
  for (const Line& line : lines_) {
    double above_low = height_above(line.front());
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const double above_high = height_above(line[i + 1]);
      if (above_low >= 0 && above_high < 0)
        if (auto m = magnetization_between(line[i], line[i + 1], above_low, above_high, x))
          return m;
      above_low = above_high;
    }
  }
  return std::nullopt;
}

}  // namespace ciliaval::analytic::rod

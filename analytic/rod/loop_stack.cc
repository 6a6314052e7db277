// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/rod/loop_stack.h"

#include <algorithm>
#include <array>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <mutex>
#include <numeric>
#include <span>

#include "analytic/sources/adaptive_order.h"
#include "analytic/sources/current_loop.h"
#include "problem/error.h"
#include "problem/types.h"

namespace ciliaval::analytic::rod {
namespace {

/// Lengths in radii.
struct Loop {
  Vector3 centre;  ///< from the middle of its part
  Vector3 normal;
  double strength;  ///< μ₀ M dS over the radius, T
};

/// Σ strength·H at the offset x (in radii) from the middle of the loops' part.
Vector3 field_of(std::span<const Loop> loops, const Vector3& x) {
  Vector3 B = Vector3::Zero();
  for (const Loop& loop : loops) {
    const Vector3 offset = x - loop.centre;
    const double zeta = offset.dot(loop.normal);
    const Vector3 radial = offset - zeta * loop.normal;
    const sources::LoopField H = sources::current_loop_field(radial.norm(), zeta);
    B += loop.strength * (H.radial_over_rho * radial + H.axial * loop.normal);
  }
  return B;
}

std::size_t level_of(std::size_t order) {
  return static_cast<std::size_t>(std::find(std::begin(sources::quadrature_orders),
                                            std::end(sources::quadrature_orders), order) -
                                  std::begin(sources::quadrature_orders));
}

}  // namespace

/// A part of a stretch: the whole, or a half of another part. Its sections are placed by their
/// distances ΔS from its middle, which keep their digits however short the part is.
class LoopStack::Part {
 public:
  /// The whole stretch.
  Part(const RodMagnet& magnet, const RodStretch& stretch)
      : Part(magnet, stretch, std::midpoint(stretch.begin, stretch.end),
             stretch.end - stretch.begin) {
    from_whole_ = middle_.position;
  }

  /// The lower (−1) or upper (1) half of a part.
  Part(const Part& whole, double side)
      : Part(whole.magnet_, whole.stretch_, whole.middle_S_ + side * whole.extent_ / 4,
             whole.extent_ / 2) {
    from_whole_ = whole.offset(side * whole.extent_ / 4);
  }

  const RodStretch& stretch() const { return stretch_; }
  double length() const { return extent_ * middle_.derivative.norm(); }
  /// r at the middle less r at the whole's middle; of a whole stretch, r itself.
  const Vector3& from_whole() const { return from_whole_; }

  /// The distance (m) of the middle section's edge from a point at the offset a from its centre.
  double distance(const Vector3& a) const {
    const double zeta = a.dot(normal_);
    const double rho = std::sqrt(std::max(a.squaredNorm() - zeta * zeta, 0.0));
    return std::hypot(rho - magnet_.radius, zeta);
  }

  /// The error (m) of the distance between a loop and a point at the offset a, as far as it differs
  /// from loop to loop.
  double rounding(const Vector3& a) const { return 2 * epsilon * (a.norm() + magnet_.radius); }

  const std::array<std::unique_ptr<Part>, 2>& halves() const {
    std::call_once(split_, [&] {
      halves_ = {std::make_unique<Part>(*this, -1), std::make_unique<Part>(*this, 1)};
    });
    return halves_;
  }

  /// The loops at the nodes of a rule.
  std::span<const Loop> loops(std::size_t order) const {
    const std::size_t level = level_of(order);
    std::call_once(made_[level], [&] { loops_[level] = make_loops(order); });
    return loops_[level];
  }

 private:
  Part(const RodMagnet& magnet, const RodStretch& stretch, double middle_S, double extent)
      : magnet_(magnet),
        stretch_(stretch),
        middle_S_(middle_S),
        extent_(extent),
        is_short_(extent < 0.01 * magnet.centreline.length()),
        middle_(at(magnet, stretch, middle_S)),
        normal_(middle_.normal()) {}

  /// r at ΔS from the middle, less r there, by integration of dr/dS: the loops beside a point close
  /// to the mantle must not shift against each other by rounding.
  Vector3 offset(double dS) const {
    const std::size_t nodes = magnet_.centreline.pieces()[stretch_.piece].S.size();
    const QuadratureRule& rule = sources::unit_gauss_legendre(nodes / 2 + 1);
    Vector3 sum = Vector3::Zero();
    for (std::size_t i = 0; i < rule.nodes.size(); ++i)
      sum += rule.weights[i] * at(magnet_, stretch_, middle_S_ + rule.nodes[i] * dS).derivative;
    return dS * sum;
  }

  std::vector<Loop> make_loops(std::size_t order) const {
    const QuadratureRule& rule = sources::unit_gauss_legendre(order);
    const double R = magnet_.radius;
    std::vector<Loop> loops;
    for (std::size_t i = 0; i < order; ++i) {
      const double dS = (rule.nodes[i] - 0.5) * extent_;
      const CentrelinePoint point = at(magnet_, stretch_, middle_S_ + dS);
      // The loops of a long part are too far from any point for the last bits of r to matter.
      const Vector3 centre = is_short_ ? offset(dS) : Vector3(point.position - middle_.position);
      loops.push_back(
          {centre / R, point.normal(),
           vacuum_permeability * stretch_.magnetization.z() * rule.weights[i] * extent_ / R});
    }
    return loops;
  }

  const RodMagnet& magnet_;
  RodStretch stretch_;
  double middle_S_;
  double extent_;  // in S, m
  bool is_short_;
  CentrelinePoint middle_;
  Vector3 normal_;  // at the middle
  Vector3 from_whole_ = Vector3::Zero();
  mutable std::once_flag split_;
  mutable std::array<std::unique_ptr<Part>, 2> halves_;
  mutable std::array<std::once_flag, std::size(sources::quadrature_orders)> made_;
  mutable std::array<std::vector<Loop>, std::size(sources::quadrature_orders)> loops_;
};

LoopStack::LoopStack(const RodMagnet& magnet) : magnet_(magnet) {
  for (const RodStretch& stretch : magnet.stretches)
    roots_.push_back(std::make_unique<Part>(magnet, stretch));
}

LoopStack::~LoopStack() = default;

/// Bound of |∇B|, T/m: μ₀σ/(distance from the rim) of each end within three radii, its charge's
/// μ₀σR²/a³ beyond.
double LoopStack::gradient_bound(const Vector3& x) const {
  double bound = 0;
  for (const RodEnd& end : magnet_.ends) {
    const double a = (x - end.section.centre).norm();
    const double R = end.section.radius;
    const double strength = vacuum_permeability * std::abs(end.magnetization_jump);
    bound += a > 3 * R ? strength * R * R / (a * a * a)
                       : strength / sources::distance_from_line(end.section, x);
  }
  return bound;
}

sources::FieldValue LoopStack::field(const Vector3& x, double tolerance) const {
  struct Near {
    const Part* part;
    Vector3 offset;   // of x from its middle
    double distance;  // of x from the middle section's edge
  };
  boost::container::small_vector<Near, 32> parts;
  const double shortest = 1e-9 * magnet_.radius;
  const auto grade = [&](const auto& self, const Part& part, const Vector3& offset) -> void {
    const double distance = part.distance(offset);
    if (part.length() <= distance) {
      parts.push_back({&part, offset, distance});
      return;
    }
    if (!(part.length() > shortest))
      throw SolverError("the field of the stacked slices was asked at " + sources::to_string(x) +
                        ", on the magnet's mantle, where it jumps: move the point off the mantle");
    for (const auto& half : part.halves()) self(self, *half, offset - half->from_whole());
  };
  for (const auto& root : roots_) grade(grade, *root, x - root->from_whole());

  const auto contribution = [&](const Near& near, std::size_t order) {
    return field_of(near.part->loops(order), near.offset / magnet_.radius);
  };
  // Gauss–Legendre on a length l converges like (q + √(1+q²))^(−2n) where the integrand's
  // singularity, the section's edge, is the distance q l/2 away.
  const auto first_level = [&](const Near& near) {
    const double q = 2 * near.distance / near.part->length();
    const double order = -std::log(tolerance) / (2 * std::asinh(q));
    std::size_t level = 1;
    while (level + 1 < std::size(sources::quadrature_orders) &&
           sources::quadrature_orders[level] < 54 &&
           static_cast<double>(sources::quadrature_orders[level - 1]) < order)
      ++level;
    return level;
  };
  const sources::AdaptiveOrder asked{tolerance, 54, "field of the stacked slices", x};
  sources::FieldValue value =
      sources::sum_adaptively(
          parts,
          [&](const Near& near, std::size_t order) {
            return sources::FieldValue{contribution(near, order), Vector3::Zero()};
          },
          asked, first_level)
          .value;
  // A rounding error δ that differs from loop to loop moves the field of a loop at the distance d
  // by up to I δ/(2πd²), and the integral by μ₀Mδ/(2 min d), on top of the rounding of its sum; far
  // away B by 4|B|δ/d.
  double rounding = 0;
  for (const Near& near : parts) {
    const double M = vacuum_permeability * std::abs(near.part->stretch().magnetization.z());
    const double delta = near.part->rounding(near.offset);
    const double bound = near.distance > 3 * magnet_.radius
                             ? 4 * contribution(near, 4).norm() * delta / near.distance
                             : M * (delta / (2 * near.distance) + 16 * epsilon);
    rounding = std::max(rounding, bound);
  }
  rounding += 40 * epsilon * value.B.norm();
  rounding += 4 * epsilon * (x.norm() + magnet_.centreline.length()) * gradient_bound(x);
  value.uncertainty += Vector3::Constant(rounding);
  return value;
}

}  // namespace ciliaval::analytic::rod

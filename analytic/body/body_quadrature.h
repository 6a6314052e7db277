// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "analytic/sources/adaptive_order.h"
#include "analytic/sources/dipole.h"
#include "analytic/sources/field_points.h"

namespace ciliaval::analytic::body {

/// A point of a patch and the strength of its source per dξ: a charge (double, A·m) or a moment
/// (Vector3, A·m²).
template <class Strength>
struct PatchPoint {
  Vector3 position;  ///< m
  Strength strength;
};

inline Vector3 source_field(double charge, const Vector3& offset) {
  return sources::pole_field(charge, offset);
}
inline Vector3 source_field(const Vector3& moment, const Vector3& offset) {
  return sources::dipole_field(moment, offset);
}

/// B of sources spread over smooth patches ξ ∈ [0,1]^dim, by tensor Gauss–Legendre quadrature.
/// A patch is halved as long as its middle is nearer to the field point than 1.5 times its
/// half-diameter; then each box has its adaptive order (`integrate_adaptively`). Points and
/// strengths of uncut patches are kept for the next field point, up to order 8. Several threads may
/// ask at once.
template <int dim, class Strength>
class PatchIntegral {
 public:
  using Coordinates = std::array<double, dim>;
  using Source = std::function<PatchPoint<Strength>(std::size_t patch, const Coordinates& xi)>;

  /// `name`: of the integral, in messages.
  PatchIntegral(std::size_t patches, Source source, std::string name)
      : source_(std::move(source)), name_(std::move(name)), kept_(patches) {
    for (std::size_t i = 0; i < patches; ++i) {
      Box whole{i, {}, {}};
      whole.size.fill(1);
      whole_.push_back(whole);
      balls_.push_back(ball_around(whole_.back()));
    }
  }

  /// `inside` (T, the μ₀m of a point in the magnet) plus B of the sources at x, its tolerance
  /// relative to |B|, as far as the orders bring it. Throws SolverError on or too near to a patch.
  sources::AdaptiveSum sum(const Vector3& x, const Vector3& inside, double tolerance) const {
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < whole_.size(); ++i) append_graded(whole_[i], balls_[i], x, boxes);
    return sources::sum_adaptively(
        boxes, [&](const Box& box, std::size_t order) { return field_of(box, order, x); },
        demand(x, inside, tolerance));
  }

  /// The sum's demand, for the message of an error.
  sources::AdaptiveOrder demand(const Vector3& x, const Vector3& inside, double tolerance) const {
    return {tolerance, dim == 2 ? 24U : 16U, name_, x, inside};
  }

 private:
  /// low + size·ξ of a patch, ξ ∈ [0,1]^dim.
  struct Box {
    std::size_t patch;
    Coordinates low;
    Coordinates size;

    Coordinates at(const Coordinates& xi) const {
      Coordinates point;
      for (std::size_t d = 0; d < dim; ++d) point[d] = low[d] + size[d] * xi[d];
      return point;
    }
    bool is_whole() const {
      return std::all_of(size.begin(), size.end(), [](double length) { return length == 1; });
    }
  };
  struct Ball {
    Vector3 centre;
    double radius;
  };

  /// Calls `visit(index)` for every index of a grid of n^dim.
  template <class Visit>
  static void for_each_index(std::size_t n, Visit visit) {
    std::array<std::size_t, dim> index{};
    while (true) {
      visit(index);
      std::size_t d = 0;
      while (d < dim && ++index[d] == n) index[d++] = 0;
      if (d == dim) return;
    }
  }

  static Coordinates middle() {
    Coordinates xi;
    xi.fill(0.5);
    return xi;
  }

  Vector3 position(const Box& box, const Coordinates& xi) const {
    return source_(box.patch, box.at(xi)).position;
  }

  /// A ball around the images of the box's corners and midpoints.
  Ball ball_around(const Box& box) const {
    Ball ball{position(box, middle()), 0};
    for_each_index(3, [&](const std::array<std::size_t, dim>& index) {
      Coordinates xi;
      for (std::size_t d = 0; d < dim; ++d) xi[d] = static_cast<double>(index[d]) / 2;
      ball.radius = std::max(ball.radius, (position(box, xi) - ball.centre).norm());
    });
    return ball;
  }

  /// The direction in which the box is longest in space.
  std::size_t longest_direction(const Box& box) const {
    std::size_t longest = 0;
    double largest = 0;
    for (std::size_t d = 0; d < dim; ++d) {
      Coordinates low = middle();
      Coordinates high = middle();
      low[d] = 0;
      high[d] = 1;
      const double length = (position(box, high) - position(box, low)).norm();
      if (length > largest) {
        largest = length;
        longest = d;
      }
    }
    return longest;
  }

  void append_graded(const Box& box, const Ball& ball, const Vector3& x,
                     std::vector<Box>& boxes) const {
    if ((x - ball.centre).norm() >= 1.5 * ball.radius) {
      boxes.push_back(box);
      return;
    }
    const std::size_t direction = longest_direction(box);
    if (box.size[direction] < 1e-7)
      throw SolverError("the " + name_ + " was asked at " + sources::to_string(x) +
                        ", on one of them or too near to it: move the point away");
    Box half = box;
    half.size[direction] /= 2;
    append_graded(half, ball_around(half), x, boxes);
    half.low[direction] += half.size[direction];
    append_graded(half, ball_around(half), x, boxes);
  }

  std::vector<PatchPoint<Strength>> points_of(const Box& box, std::size_t order) const {
    const QuadratureRule& rule = sources::unit_gauss_legendre(order);
    std::vector<PatchPoint<Strength>> points;
    for_each_index(order, [&](const std::array<std::size_t, dim>& index) {
      Coordinates xi;
      double weight = 1;
      for (std::size_t d = 0; d < dim; ++d) {
        xi[d] = rule.nodes[index[d]];
        weight *= box.size[d] * rule.weights[index[d]];
      }
      points.push_back(source_(box.patch, box.at(xi)));
      points.back().strength *= weight;
    });
    return points;
  }

  static sources::FieldValue field_of(const std::vector<PatchPoint<Strength>>& points,
                                      const Vector3& x) {
    sources::SourceSum sum(x);
    for (const PatchPoint<Strength>& point : points)
      sum.add(source_field(point.strength, x - point.position), point.position);
    return sum.value();
  }

  static constexpr std::size_t kept_orders = 3;  // 4, 6, 8
  struct Kept {
    std::array<std::once_flag, kept_orders> made;
    std::array<std::vector<PatchPoint<Strength>>, kept_orders> points;
  };

  sources::FieldValue field_of(const Box& box, std::size_t order, const Vector3& x) const {
    if (box.is_whole())
      for (std::size_t i = 0; i < kept_orders; ++i) {
        if (sources::quadrature_orders[i] != order) continue;
        Kept& kept = kept_[box.patch];
        std::call_once(kept.made[i], [&] { kept.points[i] = points_of(box, order); });
        return field_of(kept.points[i], x);
      }
    return field_of(points_of(box, order), x);
  }

  Source source_;
  std::string name_;
  std::vector<Box> whole_;
  std::vector<Ball> balls_;
  mutable std::vector<Kept> kept_;
};

}  // namespace ciliaval::analytic::body

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "problem/field_model.h"
#include "problem/support/interruption.h"

namespace ciliaval::analytic::sources {

/// B at one point and the estimate of its numerical error, T.
struct FieldValue {
  Vector3 B = Vector3::Zero();
  Vector3 uncertainty = Vector3::Zero();

  FieldValue& operator+=(const FieldValue& other) {
    B += other.B;
    uncertainty += other.uncertainty;
    return *this;
  }
};

/// "(x, y, z) m", for messages.
std::string to_string(const Vector3& x);

/// Throws InputError if the point is not finite.
void require_finite(const Vector3& x);
/// Throws SolverError if the value at x is not finite.
void require_finite(const FieldValue& value, const Vector3& x);

/// Calls `work(begin, end)` for ranges that make up [0, count), on the threads of TBB unless there
/// is but one range. If some throw, the exception of the lowest range is thrown on. Throws
/// Interrupted (problem/support/interruption.h).
void for_ranges(std::size_t count, std::size_t longest,
                const std::function<void(std::size_t begin, std::size_t end)>& work);

/// `field(x)`, a FieldValue, at each of the points, dealt out to threads `grain` (some 50 µs of
/// work) at a time; several threads call `field` at once. Throws InputError if a point is not
/// finite, SolverError if a result is not; of several errors the first point's.
template <class PointField>
Field field_at(std::span<const Vector3> points, std::size_t grain, const PointField& field) {
  Field result;
  result.B.resize(points.size());
  result.uncertainty.resize(points.size());
  for_ranges(points.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      support::check_interruption();
      require_finite(points[i]);
      const FieldValue value = field(points[i]);
      require_finite(value, points[i]);
      result.B[i] = value.B;
      result.uncertainty[i] = value.uncertainty;
    }
  });
  return result;
}

/// `gradient(x)`, a Matrix3 ∂B_i/∂x_j (T/m), at each of the points; errors as of `field_at`.
template <class PointGradient>
std::vector<Matrix3> gradient_at(std::span<const Vector3> points, const PointGradient& gradient) {
  std::vector<Matrix3> result;
  for (const Vector3& x : points) {
    support::check_interruption();
    require_finite(x);
    result.push_back(gradient(x));
    require_finite({result.back().rowwise().sum(), Vector3::Zero()}, x);
  }
  return result;
}

/// The error (m) that the rounding of two positions leaves in their difference: 4ε(|x| + |y|).
double rounding_of_offset(const Vector3& x, const Vector3& y);

/// B of a point source of strength proportional to `B` at the offset x − y: |B| to 8 ε, and the
/// rounding of the offset times the largest gradient 4|B|/a that a dipole's field has.
FieldValue with_rounding(const Vector3& B, const Vector3& x, const Vector3& y);

/// Sum of the fields B of point sources at y, seen from x, and its rounding: Σ|B| by the relative
/// error of with_rounding() for the nearest and the farthest source.
class SourceSum {
 public:
  explicit SourceSum(const Vector3& x) : x_(x) {}
  void add(const Vector3& B, const Vector3& y) {
    B_ += B;
    size_ += B.lpNorm<1>();
    nearest_ = std::min(nearest_, (x_ - y).squaredNorm());
    farthest_ = std::max(farthest_, y.squaredNorm());
  }
  FieldValue value() const;

 private:
  Vector3 x_;
  Vector3 B_ = Vector3::Zero();
  double size_ = 0;                                           // Σ|B|, T
  double nearest_ = std::numeric_limits<double>::infinity();  // distance from x squared, m²
  double farthest_ = 0;                                       // distance from 0 squared, m²
};

}  // namespace ciliaval::analytic::sources

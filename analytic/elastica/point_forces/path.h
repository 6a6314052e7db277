// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/LU>
#include <cmath>

#include "analytic/elastica/point_forces/equations.h"

namespace ciliaval::analytic::elastica::point_forces {

inline constexpr double force_scale = 30;
inline constexpr double path_tolerance = 1e-10;
inline constexpr int most_path_iterations = 8;
inline constexpr double largest_force = 2000;  ///< of a trial

/// A point on a path of equilibria: the unknowns (over their scales) and the slip.
class Path {
 public:
  Path(const TipProblem& problem, const surroundings::Surface& surface, const SurfacePlace& place,
       const TipContact& start)
      : contact_(start),
        layout_(contact_.touches),
        assembly_(problem, surface, place, law_, layout_, contact_),
        u_(unknowns_of(contact_, layout_)),
        scale_(Vector::Constant(layout_.size, force_scale)) {
    for (std::size_t i = 0; i < contact_.touches.size(); ++i)
      if (is_tangent(contact_.touches[i])) scale_[layout_.columns[i] + 2] = 1;
    system_ = assembly_.at(u_);
    tangent_ = Vector::Zero(layout_.size);
  }

  void set_direction(double direction) { slip_tangent_ = direction; }
  double slip() const { return slip_; }
  const TipContact& contact() const { return contact_; }
  double determinant() const { return system_.jacobian.partialPivLu().determinant(); }

  /// A step along the path; false if it does not converge.
  bool advance(double length) {
    if (!turn()) return false;
    const Vector u = u_;
    const double slip = slip_;
    u_ += length * tangent_.cwiseProduct(scale_);
    slip_ += length * slip_tangent_;
    for (int iteration = 0; iteration < most_path_iterations; ++iteration) {
      evaluate();
      Vector change(layout_.size);
      double slip_change = 0;
      if (!solve(-system_.residuals, 0, change, slip_change)) break;
      u_ += change.cwiseProduct(scale_);
      slip_ += slip_change;
      if (u_.cwiseAbs().maxCoeff() > largest_force) break;
      if (change.cwiseAbs().maxCoeff() + std::abs(slip_change) < path_tolerance) {
        evaluate();
        return true;
      }
    }
    u_ = u;
    slip_ = slip;
    evaluate();
    return false;
  }

 private:
  void evaluate() {
    law_ = {FrictionLaw::Kind::moved, slip_};
    system_ = assembly_.at(u_);
  }

  /// The Jacobian's rows with the slip's column, and the last tangent as the last row.
  bool solve(const Vector& residuals, double along, Vector& change, double& slip_change) const {
    const Eigen::Index size = layout_.size;
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_unknowns + 1, most_unknowns + 1>
        bordered = decltype(bordered)::Zero(size + 1, size + 1);
    bordered.topLeftCorner(size, size) = system_.jacobian * scale_.asDiagonal();
    bordered(system_.law, size) = -1;
    bordered.bottomLeftCorner(1, size) = tangent_.transpose();
    bordered(size, size) = slip_tangent_;
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_unknowns + 1, 1> right(size + 1);
    right << residuals, along;
    const auto solution = bordered.partialPivLu().solve(right).eval();
    if (!solution.allFinite()) return false;
    change = solution.head(size);
    slip_change = solution[size];
    return true;
  }

  /// The tangent here, turned the way of the last one.
  bool turn() {
    Vector tangent(layout_.size);
    double slip_tangent = 0;
    if (!solve(Vector::Zero(layout_.size), 1, tangent, slip_tangent)) return false;
    const double norm = std::hypot(tangent.norm(), slip_tangent);
    tangent_ = tangent / norm;
    slip_tangent_ = slip_tangent / norm;
    return true;
  }

  TipContact contact_;
  Layout layout_;
  FrictionLaw law_{FrictionLaw::Kind::moved, 0};
  Assembly assembly_;
  Vector u_;
  Vector scale_;
  System system_;
  double slip_ = 0;
  Vector tangent_;
  double slip_tangent_ = 1;
};

}  // namespace ciliaval::analytic::elastica::point_forces

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "compare/sensing/response.h"

namespace ciliaval::compare::sensing {

/// The components of a load, which are free in the least squares.
inline constexpr int load_components = 2;

/// A load found from one reading.
struct SensedLoad {
  Vector2 load = Vector2::Zero();                        ///< F, q or δ times its direction
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of it, from the noise alone
  double chi_squared = 0;  ///< (ΔB − reading)ᵀ V⁻¹ (ΔB − reading), 3·sensors − 2 degrees of freedom
  double misfit_probability = 1;   ///< of a larger χ² by noise alone
  double nothing_probability = 1;  ///< of a larger χ²(0) − χ² by noise alone, without a load
  bool beyond_range = false;       ///< |load| is larger than the largest load computed
  bool converged = false;

  double magnitude() const { return load.norm(); }
  double azimuth() const;  ///< rad, (−π, π]
  /// No load is seen: the region of 95 % of the load holds zero. The decrease of χ² from no load to
  /// the load found has as many degrees of freedom as the load has components; beyond 5.99 with
  /// two. (1.96 standard deviations of one component are passed by noise in 15 % of the readings.)
  bool is_nothing() const { return !(nothing_probability < 0.05); }
  /// Half-widths of the intervals that hold the magnitude, and the azimuth (rad; π: not known),
  /// with a probability of 95 %, to first order.
  double magnitude_interval() const;
  double azimuth_interval() const;
};

/// Covariance V of ΔB over σ² of a single reading: `variance` at each sensor, and `common` (sensors
/// × sensors), by which the sensors are correlated; empty: none. Each component has the same.
struct ReadingError {
  double variance = 1;
  Eigen::MatrixXd common = {};
};

/// The two-sided 95 % of the normal distribution, in standard deviations.
inline constexpr double two_sided_95 = 1.959963984540054;

/// The load whose ΔB is nearest to a reading: the least squares weighted by the noise, by
/// Levenberg and Marquardt's method (Eigen) from the nearest of a grid of loads over the
/// whole range. covariance = (Jᵀ V⁻¹ J)⁻¹.
class Inversion {
 public:
  /// The response must outlive it. `noise`: standard deviation of each component of each reading,
  /// T. Throws InputError if it is not positive.
  Inversion(const Response& response, const Vector3& noise);

  /// `change`: ΔB of all sensors one after the other, T. Throws InputError if they are not as many
  /// or not finite.
  SensedLoad operator()(const Eigen::VectorXd& change, const ReadingError& error = {}) const;

 private:
  const Response& response_;
  Eigen::VectorXd weights_;  ///< 1/σ
  std::vector<Vector2> starts_;
  Eigen::MatrixXd start_changes_;  ///< one column for each start
};

/// The paper's way (section 3.5): ΔB linear in the load, ΔB = A p, with A the least-squares fit to
/// the response over the whole range; then p = A⁺ ΔB.
class LinearFit {
 public:
  LinearFit(const Response& response, const Vector3& noise);
  Vector2 operator()(const Eigen::VectorXd& change) const { return inverse_ * change; }
  /// Root mean square of |ΔB − A p| over that of |ΔB|.
  double misfit() const { return misfit_; }

 private:
  Eigen::Matrix2Xd inverse_;
  double misfit_ = 0;
};

}  // namespace ciliaval::compare::sensing

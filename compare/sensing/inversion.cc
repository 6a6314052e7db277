// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/sensing/inversion.h"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/LevenbergMarquardt>

#include "compare/sensing/distributions.h"
#include "problem/error.h"

namespace ciliaval::compare::sensing {
namespace {

/// V^-1/2 of a reading: values times it have the covariance 1.
class Whitening {
 public:
  /// `weights`: 1/σ of each component.
  Whitening(const Eigen::VectorXd& weights, const ReadingError& error)
      : weights_(weights / (error.common.size() == 0 ? std::sqrt(error.variance) : 1)) {
    if (error.common.size() == 0) return;
    const Eigen::Index sensors = error.common.rows();
    factor_.compute(error.common + error.variance * Eigen::MatrixXd::Identity(sensors, sensors));
  }

  /// Of each column, the components of all sensors one after the other.
  Eigen::MatrixXd operator()(const Eigen::MatrixXd& values) const {
    Eigen::MatrixXd result = weights_.asDiagonal() * values;
    if (factor_.rows() == 0) return result;
    for (Eigen::Index j = 0; j < result.cols(); ++j) {
      Eigen::Map<Eigen::Matrix3Xd> by_sensor(result.col(j).data(), 3, factor_.rows());
      by_sensor = factor_.matrixL().solve(by_sensor.transpose()).transpose().eval();
    }
    return result;
  }

 private:
  Eigen::VectorXd weights_;
  Eigen::LLT<Eigen::MatrixXd> factor_;  ///< of V over σ²; empty: V is diagonal
};

/// V^-1/2 (ΔB(p) − reading) as a function of p over the largest load: the solver's tolerances mean
/// the same for newtons and metres.
struct Misfit : Eigen::DenseFunctor<double> {
  Misfit(const Response& r, const Whitening& w, const Eigen::VectorXd& read)
      : DenseFunctor(load_components, static_cast<int>(read.size())),
        response(r),
        whitened(w),
        reading(read) {}

  int operator()(const InputType& x, ValueType& residuals) const {
    residuals = whitened(response.change(response.largest() * x) - reading);
    return 0;
  }
  int df(const InputType& x, JacobianType& jacobian) const {
    const double scale = response.largest();
    jacobian = scale * whitened(response.derivative(scale * x));
    return 0;
  }

  const Response& response;
  const Whitening& whitened;
  const Eigen::VectorXd& reading;
};

/// The minimum of |misfit|² from x, which becomes it. False without convergence.
bool minimise(Misfit& misfit, Eigen::VectorXd& x) {
  Eigen::LevenbergMarquardt<Misfit> solver(misfit);
  solver.setFtol(1e-14);
  solver.setXtol(1e-12);
  solver.setGtol(1e-12);
  solver.setMaxfev(200);
  switch (solver.minimize(x)) {
    case Eigen::LevenbergMarquardtSpace::ImproperInputParameters:
    case Eigen::LevenbergMarquardtSpace::TooManyFunctionEvaluation:
      return false;
    default:  // also where rounding leaves no smaller step
      return x.allFinite();
  }
}

/// Loads over the whole range, the zero load first.
std::vector<Vector2> loads_over(double largest, int magnitudes, int azimuths) {
  std::vector<Vector2> loads{Vector2::Zero()};
  for (int k = 1; k <= magnitudes; ++k)
    for (int j = 0; j < azimuths; ++j)
      loads.push_back(polar(largest * k / magnitudes, 2 * std::numbers::pi * j / azimuths));
  return loads;
}

Eigen::VectorXd weights_of(const Vector3& noise, std::size_t sensors) {
  if (!(noise.minCoeff() > 0) || !noise.allFinite())
    throw InputError("the noise of a reading must be finite and positive");
  return noise.cwiseInverse().replicate(static_cast<Eigen::Index>(sensors), 1);
}

}  // namespace

double SensedLoad::azimuth() const {
  return std::atan2(load.y(), load.x());
}

double SensedLoad::magnitude_interval() const {
  const Vector2 along = magnitude() > 0 ? Vector2(load / magnitude()) : Vector2::UnitX();
  return two_sided_95 * std::sqrt(along.dot(covariance * along));
}

double SensedLoad::azimuth_interval() const {
  if (magnitude() == 0) return std::numbers::pi;
  const Vector2 across = Vector2(-load.y(), load.x()) / magnitude();
  const double angle = two_sided_95 * std::sqrt(across.dot(covariance * across)) / magnitude();
  return is_nothing() ? std::numbers::pi : std::min(angle, std::numbers::pi);
}

Inversion::Inversion(const Response& response, const Vector3& noise)
    : response_(response),
      weights_(weights_of(noise, response.sensors())),
      starts_(loads_over(response.largest(), 8, 16)),
      start_changes_(weights_.size(), static_cast<Eigen::Index>(starts_.size())) {
  for (std::size_t i = 0; i < starts_.size(); ++i)
    start_changes_.col(static_cast<Eigen::Index>(i)) = response.change(starts_[i]);
}

SensedLoad Inversion::operator()(const Eigen::VectorXd& change, const ReadingError& error) const {
  if (change.size() != weights_.size() || !change.allFinite())
    throw InputError(fmt::format("a reading has {} finite numbers", weights_.size()));
  const Whitening whitened(weights_, error);
  Eigen::Index nearest = 0;
  whitened(start_changes_.colwise() - change).colwise().squaredNorm().minCoeff(&nearest);
  Eigen::VectorXd x = starts_[static_cast<std::size_t>(nearest)] / response_.largest();
  Misfit misfit(response_, whitened, change);
  SensedLoad result;
  result.converged = minimise(misfit, x);
  result.load = x * response_.largest();
  result.beyond_range = result.magnitude() > response_.largest() * (1 + 1e-9);
  result.chi_squared = whitened(response_.change(result.load) - change).squaredNorm();
  const Eigen::MatrixXd J = whitened(response_.derivative(result.load));
  result.covariance = Eigen::Matrix2d(J.transpose() * J).inverse();
  const auto probability = [](double chi_squared, Eigen::Index freedom) {
    return chi_squared_above(std::max(0.0, chi_squared), static_cast<double>(freedom));
  };
  result.misfit_probability = probability(result.chi_squared, weights_.size() - load_components);
  result.nothing_probability =
      probability(whitened(change).squaredNorm() - result.chi_squared, load_components);
  return result;
}

LinearFit::LinearFit(const Response& response, const Vector3& noise) {
  const std::vector<Vector2> loads = loads_over(response.largest(), 8, 16);
  const auto n = static_cast<Eigen::Index>(loads.size());
  Eigen::MatrixX2d p(n, 2);
  Eigen::MatrixXd changes(n, static_cast<Eigen::Index>(3 * response.sensors()));
  for (Eigen::Index i = 0; i < n; ++i) {
    p.row(i) = loads[static_cast<std::size_t>(i)].transpose();
    changes.row(i) = response.change(loads[static_cast<std::size_t>(i)]).transpose();
  }
  const Eigen::MatrixX2d A = p.colPivHouseholderQr().solve(changes).transpose();
  misfit_ = (changes - p * A.transpose()).norm() / changes.norm();
  const Eigen::VectorXd weights = weights_of(noise, response.sensors());
  const Eigen::MatrixX2d weighted = weights.asDiagonal() * A;
  inverse_ =
      (weighted.transpose() * weighted).inverse() * weighted.transpose() * weights.asDiagonal();
}

}  // namespace ciliaval::compare::sensing

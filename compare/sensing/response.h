// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "compare/input/case.h"
#include "compare/models/model_pair.h"
#include "problem/deformation.h"
#include "problem/mechanics_model.h"

namespace ciliaval::compare::sensing {

using Vector2 = Eigen::Vector2d;

inline constexpr double degree = std::numbers::pi / 180;

inline Vector2 polar(double magnitude, double azimuth) {
  return {magnitude * std::cos(azimuth), magnitude * std::sin(azimuth)};
}

/// The pair that a text names. Throws InputError if it is none, or the models do not go together.
models::ModelPair parse_pair(const std::string& text);

/// A round cilium's shapes under one load of growing magnitude and azimuth 0.
struct Shapes {
  Deformation undeformed;
  std::vector<Deformation> nodes;       ///< at the Chebyshev–Lobatto magnitudes but 0
  std::vector<Deformation> checks;      ///< between some of them
  std::vector<double> node_magnitudes;  ///< F, q or δ, as the load's type has it
  std::vector<double> check_magnitudes;
  std::string limit;  ///< why they end below the largest load asked for; empty: they do not

  double largest() const { return node_magnitudes.back(); }
};

/// Throws InputError unless the case has loads that readings can tell: not of the type
/// `environment`, on a cilium and in one environment that are the same from all sides.
void require_load_to_sense(const input::Case& problem);

/// The shapes of the case's load up to the largest magnitude, by the mechanics model. Where the
/// cilium slips off below it, or the model has no shape for another reason, up to there. Throws
/// SolverError if there is none at all; InputError if the case's cilium is not the same from all
/// sides (a solid's mesh of the user), or its environment.
Shapes shapes_within(const input::Case& problem, const std::string& mechanics, double largest,
                     const Progress& progress = {});

/// The same up to the largest magnitude itself: throws SolverError if they end below it.
Shapes shapes_up_to(const input::Case& problem, const std::string& mechanics, double largest,
                    const Progress& progress = {});

/// ΔB at sensors as a function of the horizontal load vector p, |p| the magnitude (F, q or δ) and
/// its direction e, for one pair of models. The cilium is round and the field rotates with it, so
/// that with the sensor at (ρ, β, z)
///
///   ΔB(p) = Q(φ) b(|p|, β − φ),  b(F, β) = ΔB under the azimuth 0 at (ρ, β, z).
///
/// b is interpolated: polynomials in F through Chebyshev–Lobatto points, trigonometric ones in β.
/// Both converge exponentially; the error is measured between the nodes.
class Response {
 public:
  /// Throws InputError and SolverError as the models do; SolverError too if the interpolation is
  /// worse than 1e-3 of the largest |ΔB|.
  Response(const input::Case& problem, const std::string& field, const Shapes& shapes,
           std::span<const Vector3> sensors);

  std::size_t sensors() const { return tables_.size(); }
  double largest() const { return magnitudes_.back(); }
  /// The largest error found between the nodes, T, and the largest |ΔB|.
  double interpolation_error() const { return error_; }
  double largest_change() const { return largest_change_; }

  /// ΔB of all sensors one after the other, 3·sensors, T. Beyond largest() it goes on linearly.
  Eigen::VectorXd change(const Vector2& p) const;
  /// ∂ΔB/∂p, 3·sensors × 2.
  Eigen::MatrixX2d derivative(const Vector2& p) const;
  /// B of the undeformed cilium, 3·sensors, T.
  const Eigen::VectorXd& undeformed() const { return undeformed_; }

 private:
  /// The part of Σ_m z_m exp(imβ) that is real, z of each component at each magnitude.
  using Coefficients = std::vector<Eigen::Matrix3Xcd>;
  /// b of one sensor.
  struct Table {
    double beta = 0;  ///< of the sensor, rad
    Coefficients values;
    Coefficients slopes;  ///< ∂/∂F of them
  };
  struct Value {
    Vector3 b;         ///< T
    Vector3 by_force;  ///< ∂b/∂F
    Vector3 by_angle;  ///< ∂b/∂β
  };
  /// Derivatives at the magnitudes of the polynomials through values there.
  Coefficients slopes(const Coefficients& values) const;
  Value evaluate(const Table& table, double magnitude, double beta) const;

  std::vector<double> magnitudes_;  ///< 0 first
  std::vector<double> weights_;     ///< barycentric
  std::vector<Table> tables_;
  Eigen::VectorXd undeformed_;
  double error_ = 0;
  double largest_change_ = 0;
};

}  // namespace ciliaval::compare::sensing

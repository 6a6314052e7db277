// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/sensing/response.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>

#include "compare/models/evaluator.h"
#include "compare/models/registry.h"
#include "problem/cilium.h"
#include "problem/error.h"

namespace ciliaval::compare::sensing {
namespace {

constexpr std::size_t magnitude_intervals = 16;
constexpr std::size_t fewest_angles = 16;
constexpr std::size_t most_angles = 256;
constexpr double enough = 1e-9;          ///< error between the angles, of the largest |ΔB|
constexpr double too_much = 1e-3;        ///< … of the whole interpolation
constexpr std::size_t most_ranges = 16;  ///< of loads, each below the one before
constexpr std::size_t check_places[] = {1, 5, 10, 14};  ///< the intervals with a check

Matrix3 turn(double angle) {
  return Eigen::AngleAxisd(angle, Vector3::UnitZ()).toRotationMatrix();
}

/// ∂Q/∂φ.
Matrix3 turn_derivative(double angle) {
  Matrix3 result = Matrix3::Zero();
  result(0, 0) = result(1, 1) = -std::sin(angle);
  result(1, 0) = std::cos(angle);
  result(0, 1) = -result(1, 0);
  return result;
}

/// The points of a sensor's circle at equal angles from `first` on.
std::vector<Vector3> circle(const Vector3& sensor, std::size_t angles, double first) {
  const double rho = std::hypot(sensor.x(), sensor.y());
  std::vector<Vector3> points;
  for (std::size_t j = 0; j < angles; ++j) {
    const double beta =
        first + 2 * std::numbers::pi * static_cast<double>(j) / static_cast<double>(angles);
    points.emplace_back(rho * std::cos(beta), rho * std::sin(beta), sensor.z());
  }
  return points;
}

/// ΔB at points for a list of shapes: column j of entry k.
std::vector<Eigen::Matrix3Xd> changes(const FieldModel& field, const Cilium& cilium,
                                      const Deformation& undeformed,
                                      std::span<const Deformation> shapes,
                                      std::span<const Vector3> points) {
  const auto matrix = [&](const Deformation& shape) {
    const Field values = field.field(cilium, shape, points);
    Eigen::Matrix3Xd result(3, static_cast<Eigen::Index>(points.size()));
    for (std::size_t j = 0; j < points.size(); ++j)
      result.col(static_cast<Eigen::Index>(j)) = values.B.at(j);
    return result;
  };
  const Eigen::Matrix3Xd straight = matrix(undeformed);
  std::vector<Eigen::Matrix3Xd> result;
  for (const Deformation& shape : shapes) result.emplace_back(matrix(shape) - straight);
  return result;
}

/// z of Re Σ_m z_m exp(imβ) through the values at equal angles.
Eigen::Matrix3Xcd fourier(const Eigen::Matrix3Xd& values) {
  const Eigen::Index n = values.cols();
  Eigen::Matrix3Xcd result = Eigen::Matrix3Xcd::Zero(3, n / 2 + 1);
  for (Eigen::Index m = 0; m <= n / 2; ++m) {
    const double scale = (m == 0 || 2 * m == n ? 1.0 : 2.0) / static_cast<double>(n);
    for (Eigen::Index j = 0; j < n; ++j)
      result.col(m) += values.col(j) *
                       std::polar(scale, -2 * std::numbers::pi * static_cast<double>((m * j) % n) /
                                             static_cast<double>(n));
  }
  return result;
}

/// Magnitudes of loads in their order; whether each is a check or a node.
using MagnitudePath = std::vector<std::pair<double, bool>>;

/// The Chebyshev–Lobatto points of 0 … largest but 0, and checks between some of them.
MagnitudePath magnitudes_up_to(double largest) {
  const auto node = [&](std::size_t k) {
    return largest / 2 *
           (1 - std::cos(std::numbers::pi * static_cast<double>(k) / magnitude_intervals));
  };
  MagnitudePath path;
  for (std::size_t k = 1; k < magnitude_intervals; ++k) path.emplace_back(node(k), false);
  path.emplace_back(largest, false);
  for (const std::size_t k : check_places) path.emplace_back((node(k) + node(k + 1)) / 2, true);
  std::sort(path.begin(), path.end());
  return path;
}

Shapes shapes_of(const MechanicsResult& result, const MagnitudePath& path, std::string limit) {
  Shapes shapes;
  shapes.limit = std::move(limit);
  shapes.undeformed = result.undeformed;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const auto& [magnitude, is_check] = path[i];
    (is_check ? shapes.checks : shapes.nodes).push_back(result.steps.at(i).deformation.value());
    (is_check ? shapes.check_magnitudes : shapes.node_magnitudes).push_back(magnitude);
  }
  return shapes;
}

/// A range of loads below one without a shape: up to the slip-off, less what the model does not
/// know of it; where this is not known, up to the last load with a shape, or the first of all.
double range_below(const MechanicsStep& missing, double last) {
  constexpr double rounding = 1e-6;
  if (const auto limit = slip_off_limit(missing); limit && *limit > last) {
    const double known = *limit * (1 - rounding) - missing.slip_off_uncertainty.value_or(0);
    if (known > last && known < magnitude(missing.load)) return known;
  }
  return last > 0 ? last : magnitude(missing.load);
}

double largest_column(const Eigen::Matrix3Xd& values) {
  return values.cols() == 0 ? 0 : values.colwise().norm().maxCoeff();
}

}  // namespace

models::ModelPair parse_pair(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos)
    throw InputError("a pair of models is written mechanics/field, such as elastica/volume, not `" +
                     text + "`");
  models::ModelPair pair{text.substr(0, slash), text.substr(slash + 1)};
  if (!models::entry_of(models::mechanics_models(), pair.mechanics).has_body &&
      models::entry_of(models::field_models(), pair.field).has_body)
    throw InputError("`" + pair.field + "` needs the body of a solid; `" + pair.mechanics +
                     "` has none");
  return pair;
}

void require_load_to_sense(const input::Case& problem) {
  const LoadPath& path = problem.load_path;
  constexpr double vertical = 1e-9;
  if (path.front().is<EnvironmentLoad>())
    throw InputError("the load type 'environment' has no load to be found from readings");
  for (const Load& load : path) {
    if (load.environment() != path.front().environment())
      throw InputError("a load is found in one environment: list one 'uniform_field'");
    if (!load.environment().magnets.empty() ||
        surroundings::component(load.environment(), Vector3::UnitX()) > vertical ||
        surroundings::component(load.environment(), Vector3::UnitY()) > vertical)
      throw InputError(
          "a load is found by a response that is the same from all sides: an [environment] beside "
          "it points along z and has no magnets");
  }
  if (problem.cilium.is_rectangular() || has_transverse_magnetization(problem.cilium))
    throw InputError(
        "a load is found by a response that is the same from all sides: the cilium is round and "
        "magnetised along its axis");
}

Shapes shapes_within(const input::Case& problem, const std::string& mechanics, double largest,
                     const Progress& progress) {
  const models::MechanicsEntry& entry = models::entry_of(models::mechanics_models(), mechanics);
  for (const auto& [option, mesh] : input::user_meshes({{entry}, {}}, problem.options))
    throw InputError("a solid with a mesh of the user is not the same from all sides: leave out " +
                     option);
  require_load_to_sense(problem);
  if (!(largest > 0) || !std::isfinite(largest))
    throw InputError("the largest load must be finite and positive");
  const models::Evaluator model(entry, problem, models::field_models());
  std::string limit;
  double range = largest;
  for (std::size_t attempt = 0; attempt < most_ranges; ++attempt) {
    const MagnitudePath path = magnitudes_up_to(range);
    LoadPath loads;
    for (const auto& [magnitude, is_check] : path)
      loads.push_back(with_magnitude(with_azimuth(problem.load_path.front(), 0), magnitude));
    if (progress) progress({"starting", 0, loads.size()});
    const MechanicsResult result = model.solve(problem.cilium, loads, progress);
    const auto missing = std::ranges::find_if(
        result.steps, [](const MechanicsStep& step) { return !step.deformation; });
    if (missing == result.steps.end()) return shapes_of(result, path, std::move(limit));
    if (limit.empty()) limit = fmt::format("{}: {}", mechanics, missing->message);
    const double last = missing == result.steps.begin() ? 0 : magnitude((missing - 1)->load);
    range = range_below(*missing, last);
  }
  throw SolverError(fmt::format("no shape under {:g} {} or more: {}", range,
                                magnitude_unit(problem.load_path.front()), limit));
}

Shapes shapes_up_to(const input::Case& problem, const std::string& mechanics, double largest,
                    const Progress& progress) {
  Shapes shapes = shapes_within(problem, mechanics, largest, progress);
  if (!shapes.limit.empty()) {
    const std::string_view unit = magnitude_unit(problem.load_path.front());
    throw SolverError(
        fmt::format("no shape beyond {:g} {}, within the range of loads up to {:g} {} "
                    "that is asked for: {}",
                    shapes.largest(), unit, largest, unit, shapes.limit));
  }
  return shapes;
}

Response::Response(const input::Case& problem, const std::string& field, const Shapes& shapes,
                   std::span<const Vector3> sensors)
    : magnitudes_{0}, undeformed_(static_cast<Eigen::Index>(3 * sensors.size())) {
  magnitudes_.insert(magnitudes_.end(), shapes.node_magnitudes.begin(),
                     shapes.node_magnitudes.end());
  for (std::size_t k = 0; k < magnitudes_.size(); ++k) {
    const bool end = k == 0 || k + 1 == magnitudes_.size();
    weights_.push_back((k % 2 == 0 ? 1.0 : -1.0) * (end ? 0.5 : 1.0));
  }
  const auto model = models::entry_of(models::field_models(), field).make(problem.options);
  const Field straight = model->field(problem.cilium, shapes.undeformed, sensors);
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    undeformed_.segment<3>(static_cast<Eigen::Index>(3 * s)) = straight.B.at(s);
    Table table;
    table.beta = std::atan2(sensors[s].y(), sensors[s].x());
    for (std::size_t angles = fewest_angles;; angles *= 2) {
      const auto at = [&](std::span<const Deformation> of, double first) {
        return changes(*model, problem.cilium, shapes.undeformed, of,
                       circle(sensors[s], angles, first));
      };
      const std::vector<Eigen::Matrix3Xd> values = at(shapes.nodes, 0);
      table.values.assign(1, Eigen::Matrix3Xcd::Zero(3, static_cast<Eigen::Index>(angles / 2 + 1)));
      for (const Eigen::Matrix3Xd& value : values) {
        table.values.push_back(fourier(value));
        largest_change_ = std::max(largest_change_, largest_column(value));
      }
      table.slopes = slopes(table.values);
      // Between the angles, under the largest load; and between the magnitudes.
      const double half = std::numbers::pi / static_cast<double>(angles);
      const auto worst = [&](std::span<const Deformation> of, std::span<const double> magnitudes) {
        double error = 0;
        const std::vector<Eigen::Matrix3Xd> exact = at(of, half);
        for (std::size_t k = 0; k < exact.size(); ++k)
          for (Eigen::Index j = 0; j < exact[k].cols(); ++j) {
            const double beta = half * static_cast<double>(2 * j + 1);
            error =
                std::max(error, (evaluate(table, magnitudes[k], beta).b - exact[k].col(j)).norm());
          }
        return error;
      };
      const double of_angles = worst({&shapes.nodes.back(), 1}, {&magnitudes_.back(), 1});
      if (of_angles <= enough * largest_change_ || angles == most_angles) {
        error_ = std::max({error_, of_angles, worst(shapes.checks, shapes.check_magnitudes)});
        break;
      }
    }
    tables_.push_back(std::move(table));
  }
  if (!(largest_change_ > 0))
    throw InputError("no load changes the field at the sensors: has the cilium a magnet?");
  if (!(error_ <= too_much * largest_change_))
    throw SolverError(fmt::format(
        "the response up to {:g} is too steep to be interpolated: off by {:.2g} of {:.2g} T "
        "between the loads computed; choose a smaller range",
        largest(), error_, largest_change_));
}

Response::Coefficients Response::slopes(const Coefficients& values) const {
  const std::size_t n = magnitudes_.size();
  Coefficients result;
  for (std::size_t i = 0; i < n; ++i) {
    result.emplace_back(Eigen::Matrix3Xcd::Zero(3, values[i].cols()));
    for (std::size_t k = 0; k < n; ++k)
      if (k != i)
        result[i] +=
            weights_[k] / weights_[i] / (magnitudes_[i] - magnitudes_[k]) * (values[k] - values[i]);
  }
  return result;
}

Response::Value Response::evaluate(const Table& table, double magnitude, double beta) const {
  // Barycentric weights (Berrut & Trefethen, SIAM Review 46, 501, 2004, Eq. 4.2).
  const std::size_t n = magnitudes_.size();
  std::vector<double> value(n, 0.0);
  const auto node = std::find(magnitudes_.begin(), magnitudes_.end(), magnitude);
  if (node != magnitudes_.end()) {
    value[static_cast<std::size_t>(node - magnitudes_.begin())] = 1;
  } else {
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) {
      value[k] = weights_[k] / (magnitude - magnitudes_[k]);
      sum += value[k];
    }
    for (double& v : value) v /= sum;
  }
  const Eigen::Index modes = table.values.front().cols();
  Eigen::Matrix3Xcd z = Eigen::Matrix3Xcd::Zero(3, modes);
  Eigen::Matrix3Xcd dz = z;
  for (std::size_t k = 0; k < n; ++k) {
    z += value[k] * table.values[k];
    dz += value[k] * table.slopes[k];
  }
  Value result{Vector3::Zero(), Vector3::Zero(), Vector3::Zero()};
  for (Eigen::Index m = 0; m < modes; ++m) {
    const double order = static_cast<double>(m);
    const std::complex<double> wave = std::polar(1.0, order * beta);
    result.b += (wave * z.col(m)).real();
    result.by_force += (wave * dz.col(m)).real();
    result.by_angle -= order * (wave * z.col(m)).imag();
  }
  return result;
}

Eigen::VectorXd Response::change(const Vector2& p) const {
  const double magnitude = p.norm();
  const double inside = std::min(magnitude, largest());
  const double azimuth = std::atan2(p.y(), p.x());
  Eigen::VectorXd result(static_cast<Eigen::Index>(3 * sensors()));
  for (std::size_t s = 0; s < sensors(); ++s) {
    const Value value = evaluate(tables_[s], inside, tables_[s].beta - azimuth);
    result.segment<3>(static_cast<Eigen::Index>(3 * s)) =
        turn(azimuth) * (value.b + (magnitude - inside) * value.by_force);
  }
  return result;
}

Eigen::MatrixX2d Response::derivative(const Vector2& p) const {
  const double magnitude = p.norm();
  const double inside = std::min(magnitude, largest());
  Eigen::MatrixX2d result(static_cast<Eigen::Index>(3 * sensors()), 2);
  for (std::size_t s = 0; s < sensors(); ++s) {
    const Table& table = tables_[s];
    const auto rows = static_cast<Eigen::Index>(3 * s);
    if (magnitude < 1e-9 * largest()) {  // ∂/∂p_x and ∂/∂p_y are the slopes along x and y
      for (const int axis : {0, 1}) {
        const double azimuth = axis * std::numbers::pi / 2;
        result.block<3, 1>(rows, axis) =
            turn(azimuth) * evaluate(table, 0, table.beta - azimuth).by_force;
      }
      continue;
    }
    const double azimuth = std::atan2(p.y(), p.x());
    const Value value = evaluate(table, inside, table.beta - azimuth);
    const Vector3 radial = turn(azimuth) * value.by_force;
    // Beyond the range the mixed derivative is left out.
    const Vector3 around =
        (turn_derivative(azimuth) * (value.b + (magnitude - inside) * value.by_force) -
         turn(azimuth) * value.by_angle) /
        magnitude;
    result.block<3, 1>(rows, 0) = std::cos(azimuth) * radial - std::sin(azimuth) * around;
    result.block<3, 1>(rows, 1) = std::sin(azimuth) * radial + std::cos(azimuth) * around;
  }
  return result;
}

}  // namespace ciliaval::compare::sensing

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/potential/plates/charges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "problem/error.h"
#include "problem/lagrange.h"
#include "problem/support/interruption.h"

namespace ciliaval::fem::potential::plates {
namespace {

constexpr double over_4pi = 1 / (4 * std::numbers::pi);
/// Distance from an edge within which rectangles no longer shrink, over the box's least dimension
/// and the square of the step: σ goes with distance^(−1/3) there.
constexpr double edge_over_thickness = 0.05;
/// Points of Gauss's rule over a rectangle in each direction, far from a source and near to it, and
/// the distance of the centres over the rectangles' sizes from which it is far.
constexpr std::size_t far_points = 3;
constexpr std::size_t near_points = 6;
constexpr std::size_t most_points = near_points;
constexpr double far_distance = 2;
/// Inverse of the means of 1, ξ² and η² over a rectangle.
const Vector3 over_mass{1, 12, 12};

/// Where rectangles must be small: at a coordinate, and how far from it the face is.
struct Feature {
  double at = 0;
  double distance = 0;
};

/// Coordinates from the first to the last break, all breaks among them, in steps of `step` times
/// the distance from the nearest feature.
std::vector<double> graded(std::vector<double> breaks, std::span<const Feature> features,
                           double step) {
  std::ranges::sort(breaks);
  std::vector<double> result{breaks.front()};
  const auto density = [&](double x) {
    double size = 1e300;
    for (const Feature& f : features) size = std::min(size, std::abs(x - f.at) + f.distance);
    return 1 / (step * size);
  };
  for (std::size_t b = 0; b + 1 < breaks.size(); ++b) {
    const double from = breaks[b];
    const double to = breaks[b + 1];
    if (to - from <= 1e-9 * (breaks.back() - breaks.front())) continue;
    constexpr int samples = 4000;
    std::vector<double> count{0};  // ∫ of the density
    for (int i = 0; i < samples; ++i)
      count.push_back(count.back() +
                      density(std::lerp(from, to, (i + 0.5) / samples)) * (to - from) / samples);
    const int cells = std::max(1, static_cast<int>(std::ceil(count.back())));
    for (int k = 1, i = 0; k <= cells; ++k) {
      const double target = count.back() * k / cells;
      while (i + 1 < samples && count[static_cast<std::size_t>(i) + 1] < target) ++i;
      const double a = count[static_cast<std::size_t>(i)];
      const double part = (target - a) / (count[static_cast<std::size_t>(i) + 1] - a);
      result.push_back(k == cells ? to : std::lerp(from, to, (i + part) / samples));
    }
  }
  return result;
}

/// log(v + r), r² = v² + rest, without cancellation.
double log_sum(double v, double r, double rest) {
  return v >= 0 ? std::log(v + r) : std::log(std::max(rest, 1e-60) / (r - v));
}

std::array<int, 2> others(int normal) {
  return {(normal + 1) % 3, (normal + 2) % 3};
}

/// True if the boxes touch in more than an edge.
bool share_a_face(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) {
  const Vector3 common = a.intersection(b).sizes();
  const double negligible = 1e-9 * a.sizes().minCoeff();
  return common.minCoeff() >= -negligible && (common.array() > negligible).count() == 2;
}

/// Coefficients of the field of `source` along the normal of `at`, in the densities of `at`.
Matrix3 mean_normal_field(const ChargedRectangle& source, const ChargedRectangle& at) {
  Matrix3 result = Matrix3::Zero();
  if (source.normal == at.normal && source.lower[at.normal] == at.lower[at.normal]) return result;
  const double sizes = (at.upper - at.lower).maxCoeff() + (source.upper - source.lower).maxCoeff();
  const double distance = (source.lower + source.upper - at.lower - at.upper).norm() / 2;
  at.for_each_point(distance > far_distance * sizes ? far_points : near_points,
                    [&](const Vector3& x, double weight, const Vector3& densities) {
                      result += weight * over_mass.cwiseProduct(densities) *
                                source.field(x).row(at.normal);
                    });
  return result;
}

}  // namespace

double ChargedRectangle::area() const {
  const auto [u, v] = others(normal);
  return (upper[u] - lower[u]) * (upper[v] - lower[v]);
}

Matrix3 ChargedRectangle::field(const Vector3& x) const {
  const auto [u, v] = others(normal);
  const double h = x[normal] - lower[normal];
  Matrix3 H = Matrix3::Zero();  // of the densities 1, U and V, (U, V) from x
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      const double U = (i == 0 ? lower : upper)[u] - x[u];
      const double V = (j == 0 ? lower : upper)[v] - x[v];
      const double r = std::sqrt(U * U + V * V + h * h);
      const double log_V = log_sum(V, r, U * U + h * h);
      const double log_U = log_sum(U, r, V * V + h * h);
      const double angle = h == 0 ? 0 : std::atan(U * V / (h * r));
      const double sign = i == j ? over_4pi : -over_4pi;
      H(u, 0) += sign * log_V;
      H(v, 0) += sign * log_U;
      H(normal, 0) += sign * angle;
      H(u, 1) += sign * (h * angle - V * log_U);
      H(v, 1) += sign * r;
      H(normal, 1) -= sign * h * log_V;
      H(u, 2) += sign * r;
      H(v, 2) += sign * (h * angle - U * log_V);
      H(normal, 2) -= sign * h * log_U;
    }
  const Vector3 centre = (lower + upper) / 2;
  H.col(1) = (H.col(1) + (x[u] - centre[u]) * H.col(0)) / (upper[u] - lower[u]);
  H.col(2) = (H.col(2) + (x[v] - centre[v]) * H.col(0)) / (upper[v] - lower[v]);
  return H;
}

double ChargedRectangle::potential(const Vector3& x) const {
  const auto [u, v] = others(normal);
  const double h = x[normal] - lower[normal];
  double psi = 0;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      const double U = (i == 0 ? lower : upper)[u] - x[u];
      const double V = (j == 0 ? lower : upper)[v] - x[v];
      const double r = std::sqrt(U * U + V * V + h * h);
      double term = U * log_sum(V, r, U * U + h * h) + V * log_sum(U, r, V * V + h * h);
      if (h != 0) term -= h * std::atan(U * V / (h * r));
      psi += (i == j ? over_4pi : -over_4pi) * term;
    }
  return psi;
}

void ChargedRectangle::for_each_point(
    std::size_t n, const std::function<void(const Vector3&, double, const Vector3&)>& visit) const {
  static const auto rules = [] {
    std::array<QuadratureRule, most_points + 1> all;
    for (std::size_t k = 1; k <= most_points; ++k) all.at(k) = gauss_legendre(k, -0.5, 0.5);
    return all;
  }();
  const QuadratureRule& rule = rules.at(n);
  const auto [u, v] = others(normal);
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b) {
      Vector3 x = (lower + upper) / 2;
      x[u] += rule.nodes[a] * (upper[u] - lower[u]);
      x[v] += rule.nodes[b] * (upper[v] - lower[v]);
      visit(x, rule.weights[a] * rule.weights[b], {1, rule.nodes[a], rule.nodes[b]});
    }
}

Charges::Charges(std::vector<PermeableBox> boxes, std::span<const Vector3> points, double step)
    : boxes_(std::move(boxes)) {
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    bodies_.push_back(static_cast<int>(b));
    for (std::size_t a = 0; a < b; ++a)
      if (boxes_[a].relative_permeability == boxes_[b].relative_permeability &&
          share_a_face(boxes_[a].box, boxes_[b].box)) {
        const int own = bodies_[b];
        std::ranges::replace(bodies_, own, bodies_[a]);
      }
  }
  for (std::size_t b = 0; b < boxes_.size(); ++b)
    for (int normal = 0; normal < 3; ++normal)
      for (const bool upper : {false, true}) add_face(b, normal, upper, points, step);
  if (rectangles_.size() > most_rectangles)
    throw SolverError("the permeable plates take " + std::to_string(rectangles_.size()) +
                      " charged rectangles, more than " + std::to_string(most_rectangles) +
                      ": a thin plate of large extent, or points very near to it; state less of "
                      "the plate or a larger tolerance");
  const auto count = static_cast<Eigen::Index>(boxes_.size());
  Eigen::MatrixXd surfaces = Eigen::MatrixXd::Zero(count, count);
  for (std::size_t i = 0; i < rectangles_.size(); ++i) {
    const auto [below, above] = sides_[i];
    for (const int side : {below, above})
      if (side >= 0) surfaces(side, side) += rectangles_[i].area();
    if (below < 0 || above < 0) continue;
    surfaces(below, above) -= rectangles_[i].area();
    surfaces(above, below) -= rectangles_[i].area();
  }
  for (Eigen::Index body = 0; body < count; ++body)
    if (surfaces(body, body) == 0) surfaces(body, body) = 1;  // a number that is not of a body
  surfaces_.compute(surfaces);
  constexpr Eigen::Index m = ChargedRectangle::functions;
  const auto n = static_cast<Eigen::Index>(rectangles_.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(m * n, m * n);
  for (Eigen::Index j = 0; j < n; ++j) {
    support::check_interruption();
    const ChargedRectangle& source = rectangles_[static_cast<std::size_t>(j)];
    for (Eigen::Index i = 0; i < n; ++i)
      matrix.block<m, m>(m * i, m * j) =
          mean_normal_field(source, rectangles_[static_cast<std::size_t>(i)]);
    // A charge on a closed surface sends half of its flux out of it; ξ and η are no charge.
    Eigen::VectorXd wanted = Eigen::VectorXd::Zero(count);
    for (const int side : sides_[static_cast<std::size_t>(j)])
      if (side >= 0) wanted[side] = source.area() / 2;
    for (Eigen::Index f = 0; f < m; ++f) {
      balance_flux(wanted, matrix.col(m * j + f));
      wanted.setZero();
    }
  }
  for (Eigen::Index i = 0; i < n; ++i)
    matrix.middleRows<m>(m * i) *= -2 * lambda_[static_cast<std::size_t>(i)];
  matrix.diagonal().array() += 1;
  factors_.compute(matrix);
}

void Charges::add_face(std::size_t box, int normal, bool upper, std::span<const Vector3> points,
                       double step) {
  const Eigen::AlignedBox3d& own = boxes_[box].box;
  const double plane = upper ? (own.max)()[normal] : (own.min)()[normal];
  const double thickness = own.sizes().minCoeff();
  const auto axes = others(normal);
  Eigen::AlignedBox3d face = own;
  (face.min)()[normal] = (face.max)()[normal] = plane;
  std::array<std::vector<double>, 2> grid;
  for (std::size_t k = 0; k < 2; ++k) {
    const int axis = axes.at(k);
    std::vector<double> breaks{(own.min)()[axis], (own.max)()[axis]};
    for (const PermeableBox& other : boxes_)
      if (other.box.exteriorDistance(face) <= 1e-9 * thickness)
        for (const double at : {(other.box.min)()[axis], (other.box.max)()[axis]})
          if (at > (own.min)()[axis] && at < (own.max)()[axis]) breaks.push_back(at);
    std::vector<Feature> features;
    for (const double at : breaks)
      features.push_back({at, edge_over_thickness * step * step * thickness});
    for (const Vector3& point : points)
      features.push_back({point[axis], face.exteriorDistance(point)});
    grid.at(k) = graded(breaks, features, step);
  }
  const auto permeability_beyond = [&](Vector3 at) {
    at[normal] += (upper ? 1e-6 : -1e-6) * thickness;
    for (std::size_t b = 0; b < boxes_.size(); ++b)
      if (b != box && boxes_[b].box.contains(at))
        return std::pair(b, boxes_[b].relative_permeability);
    return std::pair(boxes_.size(), 1.0);
  };
  for (std::size_t i = 0; i + 1 < grid[0].size(); ++i)
    for (std::size_t j = 0; j + 1 < grid[1].size(); ++j) {
      ChargedRectangle r;
      r.normal = normal;
      r.lower[normal] = r.upper[normal] = plane;
      for (const auto& [axis, k, at] : {std::tuple(axes[0], 0, i), std::tuple(axes[1], 1, j)}) {
        r.lower[axis] = grid.at(static_cast<std::size_t>(k))[at];
        r.upper[axis] = grid.at(static_cast<std::size_t>(k))[at + 1];
      }
      const auto [other, beyond] = permeability_beyond((r.lower + r.upper) / 2);
      const double inside = boxes_[box].relative_permeability;
      if (other < box || beyond == inside) continue;  // the other box has it; or no face at all
      const double out_of_box = (inside - beyond) / (inside + beyond);
      rectangles_.push_back(r);
      lambda_.push_back(upper ? out_of_box : -out_of_box);
      const int body = bodies_[box];
      const int neighbour = other == boxes_.size() ? -1 : bodies_[other];
      sides_.push_back(upper ? std::array{body, neighbour} : std::array{neighbour, body});
    }
}

/// Flux out of each body.
Eigen::VectorXd Charges::flux(const Eigen::VectorXd& normal_field) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(boxes_.size()));
  for (std::size_t i = 0; i < rectangles_.size(); ++i) {
    const double part = rectangles_[i].area() *
                        normal_field[ChargedRectangle::functions * static_cast<Eigen::Index>(i)];
    const auto [below, above] = sides_[i];
    if (below >= 0) result[below] += part;
    if (above >= 0) result[above] -= part;
  }
  return result;
}

/// Adds a constant to the outward field of each body, with which the fluxes are as wanted.
void Charges::balance_flux(const Eigen::VectorXd& wanted,
                           Eigen::Ref<Eigen::VectorXd> normal_field) const {
  const Eigen::VectorXd constant = surfaces_.solve(wanted - flux(normal_field));
  for (std::size_t i = 0; i < rectangles_.size(); ++i) {
    double& mean = normal_field[ChargedRectangle::functions * static_cast<Eigen::Index>(i)];
    const auto [below, above] = sides_[i];
    if (below >= 0) mean += constant[below];
    if (above >= 0) mean -= constant[above];
  }
}

Eigen::VectorXd Charges::charges(const std::function<Vector3(const Vector3& x)>& H0) const {
  constexpr Eigen::Index m = ChargedRectangle::functions;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(m * static_cast<Eigen::Index>(rectangles_.size()));
  for (std::size_t i = 0; i < rectangles_.size(); ++i) {
    if (i % 64 == 0) support::check_interruption();
    rectangles_[i].for_each_point(
        far_points, [&](const Vector3& x, double weight, const Vector3& densities) {
          right.segment<m>(m * static_cast<Eigen::Index>(i)) +=
              weight * H0(x)[rectangles_[i].normal] * over_mass.cwiseProduct(densities);
        });
  }
  balance_flux(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(boxes_.size())), right);
  for (std::size_t i = 0; i < rectangles_.size(); ++i)
    right.segment<m>(m * static_cast<Eigen::Index>(i)) *= 2 * lambda_[i];
  return factors_.solve(right);
}

Vector3 Charges::field(const Eigen::VectorXd& charges, const Vector3& x) const {
  Vector3 H = Vector3::Zero();
  for (std::size_t j = 0; j < rectangles_.size(); ++j)
    H += rectangles_[j].field(x) * charges.segment<3>(3 * static_cast<Eigen::Index>(j));
  return H;
}

double Charges::potential(const Eigen::VectorXd& charges, const Vector3& x) const {
  double psi = 0;
  for (std::size_t j = 0; j < rectangles_.size(); ++j) {
    const ChargedRectangle& r = rectangles_[j];
    const double distance = (x - (r.lower + r.upper) / 2).norm();
    const bool is_far = distance > 4 * (r.upper - r.lower).maxCoeff();
    psi += charges[3 * static_cast<Eigen::Index>(j)] *
           (is_far ? over_4pi * r.area() / distance : r.potential(x));
  }
  return psi;
}

}  // namespace ciliaval::fem::potential::plates

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/potential/cut_cells.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "fem/potential/block_cut.h"
#include "problem/error.h"
#include "problem/support/interruption.h"

namespace ciliaval::fem::potential {
namespace {

LagrangeBasis gauss_points(std::size_t n) {
  return LagrangeBasis(gauss_legendre(n, 0, 1).nodes);
}

/// Values of a rule's Lagrange polynomials at a coordinate, on the stack.
class Weights {
 public:
  Weights(const LagrangeBasis& rule, double x) {
    rule.values(x, std::span(values_).first(rule.size()));
  }
  double operator[](std::size_t i) const { return values_[i]; }
  Eigen::Map<const Eigen::VectorXd> vector(Eigen::Index n) const { return {values_.data(), n}; }

 private:
  std::array<double, 16> values_;
};

/// One-dimensional products on a rule: row g holds f_i(x_g) f_j(x_g) for all i, j.
struct Products {
  Eigen::MatrixXd values;
  Eigen::MatrixXd derivatives;
};

Products products(const LagrangeBasis& rule, const LagrangeBasis& basis) {
  const auto n = static_cast<Eigen::Index>(basis.size());
  const auto points = static_cast<Eigen::Index>(rule.size());
  Products result{Eigen::MatrixXd(points, n * n), Eigen::MatrixXd(points, n * n)};
  std::vector<double> f(basis.size());
  std::vector<double> df(basis.size());
  for (Eigen::Index g = 0; g < points; ++g) {
    basis.values_and_derivatives(rule.nodes()[static_cast<std::size_t>(g)], f, df);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        const auto a = static_cast<std::size_t>(i);
        const auto b = static_cast<std::size_t>(j);
        result.values(g, i * n + j) = f[a] * f[b];
        result.derivatives(g, i * n + j) = df[a] * df[b];
      }
    }
  }
  return result;
}

/// Σ_g w_g X(g₁, a) Y(g₂, b) Z(g₃, c) as a matrix with rows (a, b), a fastest, and columns c.
Eigen::MatrixXd contract(const Eigen::VectorXd& weights, const Eigen::MatrixXd& X,
                         const Eigen::MatrixXd& Y, const Eigen::MatrixXd& Z) {
  const Eigen::Index g = X.rows();
  const Eigen::Index pairs = X.cols();
  const Eigen::Map<const Eigen::MatrixXd> w(weights.data(), g, g * g);
  const Eigen::MatrixXd along_x = X.transpose() * w;  // pairs × (g₂, g₃)
  Eigen::MatrixXd along_xy(pairs * pairs, g);
  for (Eigen::Index k = 0; k < g; ++k) {
    const Eigen::MatrixXd plane = along_x.middleCols(k * g, g) * Y;
    along_xy.col(k) = plane.reshaped();
  }
  return along_xy * Z;
}

}  // namespace

CutCells::CutCells(const Octree& octree, unsigned int max_degree)
    : octree_(octree),
      permeability_rule_(gauss_points(2 * max_degree + 1)),
      source_rule_(gauss_points(max_degree + 1)) {}

void CutCells::add_permeability(int cell, const Vector3& unit, double susceptibility,
                                double volume) {
  Moments& moments = moments_[cell];
  const auto n = static_cast<Eigen::Index>(permeability_rule_.size());
  if (moments.permeability.size() == 0) moments.permeability.setZero(n * n * n);
  moments.susceptibility = susceptibility;
  const Weights x(permeability_rule_, unit[0]);
  const Weights y(permeability_rule_, unit[1]);
  const Weights z(permeability_rule_, unit[2]);
  double* weight = moments.permeability.data();
  for (std::size_t k = 0; k < permeability_rule_.size(); ++k) {
    for (std::size_t j = 0; j < permeability_rule_.size(); ++j) {
      Eigen::Map<Eigen::VectorXd>(weight, n) += susceptibility * volume * z[k] * y[j] * x.vector(n);
      weight += n;
    }
  }
}

void CutCells::add_source(int cell, const Vector3& unit, const Vector3& moment) {
  auto& moments = moments_[cell].source;
  const auto n = static_cast<Eigen::Index>(source_rule_.size());
  if (moments.size() == 0) moments.setZero(3, n * n * n);
  const Weights x(source_rule_, unit[0]);
  const Weights y(source_rule_, unit[1]);
  const Weights z(source_rule_, unit[2]);
  Eigen::Index point = 0;
  for (std::size_t k = 0; k < source_rule_.size(); ++k)
    for (std::size_t j = 0; j < source_rule_.size(); ++j)
      for (std::size_t i = 0; i < source_rule_.size(); ++i)
        moments.col(point++) += x[i] * y[j] * z[k] * moment;
}

void CutCells::add(const Magnet& magnet, double relative_permeability, const Sampling& sampling) {
  const BlockCut block_cut(sampling.block_points, sampling.piece_points);
  std::vector<Magnet::Block> stack = magnet.blocks();
  std::vector<MagnetSample> gauss;
  std::vector<MagnetSample> points;
  double outside = 0;
  while (!stack.empty()) {
    support::check_interruption();
    const Magnet::Block block = stack.back();
    stack.pop_back();
    const Magnet::Extent extent = magnet.extent(block);
    if (!octree_.meets_own(extent.box)) continue;
    Eigen::Index longest = 0;
    const double leaf = octree_.smallest_size(extent.box);
    if (extent.lengths.maxCoeff(&longest) > leaf) {
      for (const Magnet::Block& half : halves(block, longest)) stack.push_back(half);
      continue;
    }
    gauss.clear();
    magnet.sample(block, sampling.block_points, gauss);
    points.clear();
    block_cut.cut(gauss, {octree_.root().lower, leaf}, points);
    for (const MagnetSample& point : points) {
      const Octree::Place place = octree_.locate(point.position, leaf);
      if (place.cell == Octree::outside) outside = 1;
      if (place.cell < 0) continue;
      ++samples_;
      add_source(place.cell, place.unit, point.moment);
      if (relative_permeability != 1)
        add_permeability(place.cell, place.unit, relative_permeability - 1, point.volume);
    }
  }
  if (dealii::Utilities::MPI::sum(outside, octree_.communicator()) != 0)
    throw InputError("the magnet reaches beyond the octree of the potential");
}

Eigen::VectorXd CutCells::source(int cell, const LagrangeBasis& basis) const {
  const auto found = moments_.find(cell);
  if (found == moments_.end() || found->second.source.size() == 0) return {};
  const double size = octree_.cubes()[static_cast<std::size_t>(cell)].size;
  const std::vector<double>& x = source_rule_.nodes();
  Eigen::VectorXd result;
  Eigen::Index point = 0;
  for (const double zeta : x) {
    for (const double eta : x) {
      for (const double xi : x) {
        const Eigen::VectorXd part =
            shape_gradients(basis, {xi, eta, zeta}) * found->second.source.col(point++) / size;
        if (result.size() == 0) result.setZero(part.size());
        result += part;
      }
    }
  }
  return result;
}

Eigen::MatrixXd CutCells::stiffness(int cell, const LagrangeBasis& basis) const {
  if (!has_permeability(cell)) return {};
  const Eigen::VectorXd& weights = moments_.at(cell).permeability;
  const double size = octree_.cubes()[static_cast<std::size_t>(cell)].size;
  const Products p = products(permeability_rule_, basis);
  const Eigen::MatrixXd sum = contract(weights, p.derivatives, p.values, p.values) +
                              contract(weights, p.values, p.derivatives, p.values) +
                              contract(weights, p.values, p.values, p.derivatives);
  const auto n = static_cast<Eigen::Index>(basis.size());
  Eigen::MatrixXd result(n * n * n, n * n * n);
  for (Eigen::Index i = 0; i < result.rows(); ++i) {
    for (Eigen::Index j = 0; j < result.cols(); ++j) {
      const Eigen::Index a = (i % n) * n + j % n;
      const Eigen::Index b = (i / n % n) * n + j / n % n;
      const Eigen::Index c = (i / (n * n)) * n + j / (n * n);
      result(i, j) = sum(a + n * n * b, c) / (size * size);
    }
  }
  return result;
}

std::vector<int> CutCells::cells() const {
  std::vector<int> result;
  result.reserve(moments_.size());
  for (const auto& [cell, moments] : moments_) result.push_back(cell);
  return result;
}

bool CutCells::has_permeability(int cell) const {
  const auto found = moments_.find(cell);
  return found != moments_.end() && found->second.permeability.size() != 0;
}

Vector3 CutCells::mean_magnetization(int cell) const {
  const auto found = moments_.find(cell);
  if (found == moments_.end() || found->second.source.size() == 0) return Vector3::Zero();
  return found->second.source.rowwise().sum() /
         std::pow(octree_.cubes()[static_cast<std::size_t>(cell)].size, 3);
}

double CutCells::mean_permeability(int cell) const {
  if (!has_permeability(cell)) return 1;
  return 1 + moments_.at(cell).permeability.sum() /
                 std::pow(octree_.cubes()[static_cast<std::size_t>(cell)].size, 3);
}

double CutCells::interface_indicator(int cell) const {
  if (!has_permeability(cell)) return 0;
  const Moments& moments = moments_.at(cell);
  const double chi = moments.susceptibility;
  const double volume = std::pow(octree_.cubes()[static_cast<std::size_t>(cell)].size, 3);
  const double part = std::clamp(moments.permeability.sum() / (chi * volume), 0.0, 1.0);
  return std::pow(chi / std::max(1 + chi, 1.0), 2) * part * (1 - part);
}

void CutCells::for_each_permeable_point(
    const PotentialSpace& space, const PotentialVector& complete,
    const std::function<void(const Vector3&, double, const Vector3&)>& act) const {
  Eigen::VectorXd u(space.nodes());
  const std::vector<double>& x = permeability_rule_.nodes();
  for (const auto& [cell, moments] : moments_) {
    if (moments.permeability.size() == 0) continue;
    const Cube& cube = octree_.cubes()[static_cast<std::size_t>(cell)];
    space.read(cell, complete, u);
    Eigen::Index point = 0;
    for (const double zeta : x) {
      for (const double eta : x) {
        for (const double xi : x) {
          const Vector3 unit(xi, eta, zeta);
          act(cube.lower + cube.size * unit, moments.permeability[point++],
              shape_gradients(space.basis(), unit).transpose() * u / cube.size);
        }
      }
    }
  }
}

}  // namespace ciliaval::fem::potential

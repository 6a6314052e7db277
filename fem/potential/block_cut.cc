// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/potential/block_cut.h"

#include <algorithm>
#include <array>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <span>

#include "problem/error.h"

namespace ciliaval::fem::potential {
namespace {

/// Thinner slices of a block are not cut off.
constexpr double thinnest = 1e-3;

}  // namespace

BlockCut::BlockCut(std::size_t n, std::size_t points)
    : nodes_(gauss_legendre(n, 0, 1).nodes),
      weights_(gauss_legendre(n, 0, 1).weights),
      piece_(gauss_legendre(points, 0, 1)) {
  if (n > most_points) throw InputError("a block that is cut has at most 6³ points");
  lower_ = shape(0);
  upper_ = shape(1);
}

BlockCut::Shape BlockCut::shape(double t) const {
  Shape result(static_cast<Eigen::Index>(nodes_.size()));
  nodes_.values(t, std::span(result.data(), nodes_.size()));
  return result;
}

void BlockCut::cut(const std::vector<MagnetSample>& gauss, const PlaneGrid& planes,
                   std::vector<MagnetSample>& pieces) const {
  std::array<double, components * most * most * most> values;
  double* value = values.data();
  std::size_t point = 0;
  for (const double a : weights_) {
    for (const double b : weights_) {
      for (const double c : weights_) {
        const MagnetSample& s = gauss[point++];
        const Vector3 moment = s.moment / (a * b * c);
        value = std::copy_n(s.position.data(), 3, value);
        *value++ = s.volume / (a * b * c);
        value = std::copy_n(moment.data(), 3, value);
      }
    }
  }
  cut(values.data(), 3, 1, planes, pieces);
}

/// `values` holds the components at the nodes of the `depth` coordinates that are left, the first
/// of them slowest.
void BlockCut::cut(const double* values, int depth, double weight, const PlaneGrid& planes,
                   std::vector<MagnetSample>& pieces) const {
  const auto n = static_cast<Eigen::Index>(nodes_.size());
  const Eigen::Index rows = components * (depth == 3 ? n * n : depth == 2 ? n : 1);
  const Eigen::Map<const Eigen::MatrixXd> block(values, rows, n);
  std::array<double, components * most * most> section;
  Eigen::Map<Eigen::VectorXd> at(section.data(), rows);
  const std::vector<double> ends = cuts(values, depth, planes);
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const double length = ends[i + 1] - ends[i];
    for (std::size_t g = 0; g < piece_.nodes.size(); ++g) {
      at.noalias() = block * shape(ends[i] + length * piece_.nodes[g]);
      const double w = weight * length * piece_.weights[g];
      if (depth == 1)
        pieces.push_back({at.head<3>(), w * at[3], w * at.tail<3>()});
      else
        cut(section.data(), depth - 1, w, planes, pieces);
    }
  }
}

/// 0, the places where an edge along the first coordinate meets a plane, and 1, in order.
std::vector<double> BlockCut::cuts(const double* values, int depth, const PlaneGrid& planes) const {
  const auto n = static_cast<Eigen::Index>(nodes_.size());
  const Eigen::Index inner = depth == 3 ? n * n : depth == 2 ? n : 1;
  std::vector<double> all{0};
  Line line(3, n);
  for (int edge = 0; edge < (1 << (depth - 1)); ++edge) {
    const Shape& b = (edge & 1) != 0 ? upper_ : lower_;
    const Shape& c = (edge & 2) != 0 ? upper_ : lower_;
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::Map<const Eigen::Matrix<double, components, Eigen::Dynamic>> at(
          values + i * components * inner, components, inner);
      if (depth == 1) line.col(i) = at.col(0).head<3>();
      if (depth == 2) line.col(i).noalias() = at.topRows<3>() * b;
      if (depth != 3) continue;
      line.col(i).setZero();
      for (Eigen::Index j = 0; j < n; ++j)
        line.col(i).noalias() += c[j] * (at.middleCols(j * n, n).topRows<3>() * b);
    }
    add_crossings(line, planes, all);
  }
  std::sort(all.begin(), all.end());
  std::vector<double> result{0};
  for (const double t : all)
    if (t > result.back() + thinnest && t < 1 - thinnest) result.push_back(t);
  result.push_back(1);
  return result;
}

/// A line that turns back within the block is not cut where it meets a plane twice.
void BlockCut::add_crossings(const Line& line, const PlaneGrid& planes,
                             std::vector<double>& cuts) const {
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Shape x = (line.row(i).transpose().array() - planes.origin[i]) / planes.spacing;
    const double first = x.dot(lower_);
    const double last = x.dot(upper_);
    const auto end = static_cast<std::int64_t>(std::ceil(std::max(first, last)));
    for (auto k = static_cast<std::int64_t>(std::ceil(std::min(first, last))); k < end; ++k) {
      const auto plane = static_cast<double>(k);
      if (plane == first || plane == last) continue;
      std::uintmax_t iterations = 50;
      const auto [below, above] = boost::math::tools::toms748_solve(
          [&](double t) { return x.dot(shape(t)) - plane; }, 0.0, 1.0, first - plane, last - plane,
          boost::math::tools::eps_tolerance<double>(40), iterations);
      cuts.push_back((below + above) / 2);
    }
  }
}

}  // namespace ciliaval::fem::potential

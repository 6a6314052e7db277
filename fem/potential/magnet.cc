// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/potential/magnet.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "problem/cilium.h"
#include "problem/error.h"
#include "problem/lagrange.h"
#include "problem/support/rotation.h"

namespace ciliaval::fem::potential {
namespace {

/// Vector from the centre of a rod's section to a point of it.
Vector3 on_section(const CentrelinePoint& section, double r, double phi) {
  return section.rotation * Vector3(r * std::cos(phi), r * std::sin(phi), 0);
}

Eigen::AlignedBox3d box_of(double a0, double a1, double b0, double b1, double c0, double c1) {
  return {Vector3(a0, b0, c0), Vector3(a1, b1, c1)};
}

}  // namespace

std::array<Magnet::Block, 2> halves(const Magnet::Block& block, Eigen::Index coordinate) {
  std::array<Magnet::Block, 2> result{block, block};
  const double middle = block.range.center()[coordinate];
  result[0].range.max()[coordinate] = middle;
  result[1].range.min()[coordinate] = middle;
  return result;
}

Magnet::Magnet(const Cilium& cilium, const Deformation& deformation, MagnetPushForward push_forward)
    : push_forward_(push_forward), radius_(cilium.radius()), centreline_(deformation.centreline) {
  if (!deformation.body && cilium.section.shape != CrossSection::Shape::circle)
    throw InputError("the potential takes a rod of circular section only");
  if (deformation.body) {
    *this = Magnet(deformation.body, push_forward);
    return;
  }
  const std::vector<double> ends = cilium.interfaces();
  for (std::size_t piece = 0; piece < centreline_.pieces().size(); ++piece) {
    const std::vector<double>& S = centreline_.pieces()[piece].S;
    for (std::size_t s = 0; s < cilium.segments.size(); ++s) {
      const Vector3 M = magnetization(cilium.segments[s]);
      const double lower = std::max(S.front(), ends[s]);
      const double upper = std::min(S.back(), ends[s + 1]);
      if (M.isZero(0) || !(upper - lower > 1e-12 * cilium.length())) continue;
      for (int quadrant = 0; quadrant < 4; ++quadrant)
        blocks_.push_back(
            {rod_.size(), box_of(lower, upper, 0, radius_, quadrant * std::numbers::pi / 2,
                                 (quadrant + 1) * std::numbers::pi / 2)});
      rod_.push_back({piece, M});
    }
  }
  require_usable();
}

Magnet::Magnet(std::shared_ptr<const SolidBody> body, MagnetPushForward push_forward)
    : push_forward_(push_forward), body_(std::move(body)) {
  for (std::size_t c = 0; c < body_->cells.size(); ++c) {
    if (body_->cells[c].magnetization.isZero(0)) continue;
    blocks_.push_back({cells_.size(), box_of(0, 1, 0, 1, 0, 1)});
    cells_.push_back(c);
  }
  require_usable();
}

void Magnet::require_usable() const {
  if (blocks_.empty())
    throw InputError("the potential needs a magnet: no segment of the cilium is magnetised");
  for (const Block& block : blocks_)
    if (!extent(block).lengths.allFinite())
      throw InputError("the deformation of the magnet is not finite");
}

/// ∂x/∂S = r' + κ × (x − r), J = d₃·∂x/∂S. Volume and moment per dS dr dφ: the section's element
/// is r dr dφ.
MagnetSample Magnet::on_rod(const RodPart& part, const CentrelinePoint& section, double r,
                            double phi) const {
  const Vector3 offset = on_section(section, r, phi);
  const Vector3 tangent = section.derivative + section.curvature.cross(offset);
  const Vector3 normal = section.normal();
  const double J = normal.dot(tangent);
  const Vector3& M = part.magnetization;
  const Vector3 moment =
      push_forward_ == MagnetPushForward::F
          ? Vector3(section.rotation * Vector3(M.x(), M.y(), 0) + M.z() * tangent)
          : Vector3(J * (section.rotation * M));
  return {section.position + offset, J * r, r * moment};
}

/// Volume and moment per dξ dη dζ.
MagnetSample Magnet::in_cell(const SolidCell& cell, const Vector3& xi) const {
  const SolidPoint point = evaluate(body_->nodes, cell, xi);
  const double reference_volume = std::abs(point.reference_gradient.determinant());
  const Matrix3& F = point.deformation_gradient;
  const double J = F.determinant();
  const Vector3 moment = push_forward_ == MagnetPushForward::F
                             ? Vector3(F * cell.magnetization)
                             : Vector3(J * (support::polar_rotation(F) * cell.magnetization));
  return {point.current, J * reference_volume, reference_volume * moment};
}

void Magnet::sample(const Block& block, std::size_t n, std::vector<MagnetSample>& samples) const {
  const auto rule = [&](Eigen::Index i) {
    return gauss_legendre(n, block.range.min()[i], block.range.max()[i]);
  };
  const QuadratureRule a = rule(0);
  const QuadratureRule b = rule(1);
  const QuadratureRule c = rule(2);
  for (std::size_t i = 0; i < n; ++i) {
    CentrelinePoint section;
    if (!body_) section = centreline_.at(a.nodes[i], rod_[block.part].piece);
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = 0; k < n; ++k) {
        MagnetSample s = body_ ? in_cell(body_->cells[cells_[block.part]],
                                         Vector3(a.nodes[i], b.nodes[j], c.nodes[k]))
                               : on_rod(rod_[block.part], section, b.nodes[j], c.nodes[k]);
        const double weight = a.weights[i] * b.weights[j] * c.weights[k];
        s.volume *= weight;
        s.moment *= weight;
        samples.push_back(s);
      }
    }
  }
}

/// Positions alone: a section is read once for all its points, and a cell's polynomial is taken at
/// the three coordinates of each direction in turn.
Magnet::Corners Magnet::corners(const Block& block) const {
  const auto coordinate = [&](std::size_t i, Eigen::Index d) {
    return block.range.min()[d] + static_cast<double>(i) / 2 * block.range.sizes()[d];
  };
  Corners x;
  if (!body_) {
    for (std::size_t i = 0; i < 3; ++i) {
      const CentrelinePoint section = centreline_.at(coordinate(i, 0), rod_[block.part].piece);
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t k = 0; k < 3; ++k)
          x[i][j][k] = section.position + on_section(section, coordinate(j, 1), coordinate(k, 2));
    }
    return x;
  }
  const std::vector<Vector3>& nodes = body_->cells[cells_[block.part]].current;
  const auto n = static_cast<Eigen::Index>(body_->nodes.size());
  std::array<Eigen::MatrixXd, 3> shape;
  for (Eigen::Index d = 0; d < 3; ++d) {
    Eigen::MatrixXd& s = shape[static_cast<std::size_t>(d)];
    s.resize(n, 3);
    for (Eigen::Index i = 0; i < 3; ++i)
      body_->nodes.values(coordinate(static_cast<std::size_t>(i), d),
                          std::span(s.col(i).data(), body_->nodes.size()));
  }
  const Eigen::Map<const Eigen::MatrixXd> all(nodes.front().data(), 3 * n * n, n);
  const Eigen::MatrixXd along_c = all * shape[2];  // (3, n, n) × 3
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::MatrixXd along_b =
        along_c.col(static_cast<Eigen::Index>(k)).reshaped(3 * n, n) * shape[1];
    for (std::size_t j = 0; j < 3; ++j) {
      const Eigen::MatrixXd along_a =
          along_b.col(static_cast<Eigen::Index>(j)).reshaped(3, n) * shape[0];
      for (std::size_t i = 0; i < 3; ++i) x[i][j][k] = along_a.col(static_cast<Eigen::Index>(i));
    }
  }
  return x;
}

Magnet::Extent Magnet::extent(const Block& block) const {
  const Corners x = corners(block);
  Extent result{Vector3::Zero(), {}};
  for (const auto& plane : x)
    for (const auto& row : plane)
      for (const Vector3& point : row) result.box.extend(point);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const auto length = [](const Vector3& p, const Vector3& q, const Vector3& r) {
        return (q - p).norm() + (r - q).norm();
      };
      const Vector3 lengths(length(x[0][i][j], x[1][i][j], x[2][i][j]),
                            length(x[i][0][j], x[i][1][j], x[i][2][j]),
                            length(x[i][j][0], x[i][j][1], x[i][j][2]));
      if (!lengths.allFinite()) {
        result.lengths = lengths;
        return result;
      }
      result.lengths = result.lengths.cwiseMax(lengths);
    }
  }
  const Vector3 margin = Vector3::Constant(result.box.sizes().maxCoeff() / 8);
  result.box.min() -= margin;
  result.box.max() += margin;
  return result;
}

bool Magnet::meets(const Eigen::AlignedBox3d& box) const {
  for (const Block& whole : blocks_) {
    const double resolution = extent(whole).lengths.minCoeff() / 100;
    std::vector<Block> stack{whole};
    while (!stack.empty()) {
      const Block block = stack.back();
      stack.pop_back();
      const Extent e = extent(block);
      if (!e.box.intersects(box)) continue;
      std::vector<MagnetSample> middle;
      sample(block, 1, middle);
      if (box.contains(middle.front().position)) return true;
      Eigen::Index longest = 0;
      if (e.lengths.maxCoeff(&longest) < resolution) continue;
      for (const Block& half : halves(block, longest)) stack.push_back(half);
    }
  }
  return false;
}

double Magnet::distance(const Vector3& point, double resolution) const {
  double nearest = std::numeric_limits<double>::infinity();
  // Depth first; a box that is small beside its distance gives it within 2 %.
  std::vector<Block> stack = blocks_;
  while (!stack.empty()) {
    const Block block = stack.back();
    stack.pop_back();
    const Extent e = extent(block);
    const double bound = e.box.exteriorDistance(point);
    if (bound >= nearest) continue;
    const double size = e.lengths.maxCoeff();
    if (size < 0.01 * bound || size < resolution) {
      nearest = bound;
      continue;
    }
    Eigen::Index longest = 0;
    e.lengths.maxCoeff(&longest);
    const auto [first, second] = halves(block, longest);
    // The nearer half on top.
    const bool second_is_nearer =
        extent(second).box.exteriorDistance(point) < extent(first).box.exteriorDistance(point);
    stack.push_back(second_is_nearer ? first : second);
    stack.push_back(second_is_nearer ? second : first);
  }
  return nearest;
}

}  // namespace ciliaval::fem::potential

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/analytic/oracles/cylinder_body.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "problem/lagrange.h"

namespace ciliaval::oracle {
namespace {

/// The blocks of the unit disc: 0 the square |x|, |y| ≤ 0.5, 1 … 4 around it.
Eigen::Vector2d disc_point(std::size_t block, double xi, double eta) {
  constexpr double half = 0.5;
  if (block == 0) return {half * (2 * xi - 1), half * (2 * eta - 1)};
  const double angle = (2 * eta - 1) * std::numbers::pi / 4;
  const Eigen::Vector2d inner(half, half * (2 * eta - 1));
  const Eigen::Vector2d outer(std::cos(angle), std::sin(angle));
  const Eigen::Rotation2Dd turn(std::numbers::pi / 2 * static_cast<double>(block - 1));
  return turn * ((1 - xi) * inner + xi * outer);
}

struct Patch {
  std::size_t block;
  std::size_t i;
  std::size_t j;
};

}  // namespace

std::shared_ptr<const SolidBody> CylinderBody::moved(const Map& map) const {
  auto body = std::make_shared<SolidBody>();
  const std::vector<double> nodes = chebyshev_points(degree + 1, 0, 1);
  body->nodes = LagrangeBasis(nodes);
  std::vector<Patch> patches;
  for (std::size_t block = 0; block < 5; ++block)
    for (std::size_t i = 0; i < cuts; ++i)
      for (std::size_t j = 0; j < cuts; ++j) patches.push_back({block, i, j});
  const auto point = [&](const Patch& patch, double xi, double eta, double z) {
    const auto n = static_cast<double>(cuts);
    const Eigen::Vector2d p = disc_point(patch.block, (static_cast<double>(patch.i) + xi) / n,
                                         (static_cast<double>(patch.j) + eta) / n);
    return Vector3(radius * p[0], radius * p[1], z);
  };
  for (const Patch& patch : patches) {
    for (std::size_t layer = 0; layer < layers; ++layer) {
      SolidCell cell;
      cell.magnetization = magnetization * Vector3::UnitZ();
      for (const double zeta : nodes)
        for (const double eta : nodes)
          for (const double xi : nodes)
            cell.reference.push_back(point(
                patch, xi, eta,
                std::lerp(bottom, top,
                          (static_cast<double>(layer) + zeta) / static_cast<double>(layers))));
      for (const Vector3& X : cell.reference) cell.current.push_back(map(X));
      body->cells.push_back(std::move(cell));
    }
    for (const bool upper : {false, true}) {
      ChargedFace face;
      face.magnetization_jump = magnetization * Vector3::UnitZ();
      for (const double second : nodes)
        for (const double first : nodes)  // ∂X/∂ξ × ∂X/∂η points outwards
          face.reference.push_back(upper ? point(patch, first, second, top)
                                         : point(patch, second, first, bottom));
      for (const Vector3& X : face.reference) face.current.push_back(map(X));
      body->charged_faces.push_back(std::move(face));
    }
  }
  return body;
}

Deformation deformation_of(const CylinderBody& cylinder, const Map& map) {
  return {Centreline(), cylinder.moved(map)};
}

}  // namespace ciliaval::oracle

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "bodies.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "problem/field_model.h"

namespace ciliaval::test {

std::shared_ptr<const SolidBody> ball(double radius, const Vector3& magnetization) {
  constexpr std::size_t nodes = 6;
  auto body = std::make_shared<SolidBody>();
  body->nodes = LagrangeBasis(chebyshev_points(nodes, 0, 1));
  const std::vector<double>& x = body->nodes.nodes();
  for (int octant = 0; octant < 8; ++octant) {
    const Vector3 lower(octant % 2 - 1, octant / 2 % 2 - 1, octant / 4 - 1);
    SolidCell cell;
    cell.magnetization = magnetization;
    for (std::size_t k = 0; k < nodes; ++k) {
      for (std::size_t j = 0; j < nodes; ++j) {
        for (std::size_t i = 0; i < nodes; ++i) {
          const Vector3 u = lower + Vector3(x[i], x[j], x[k]);
          const Vector3 s = u.cwiseProduct(u);
          const auto factor = [](double a, double b) {
            return std::sqrt(1 - a / 2 - b / 2 + a * b / 3);
          };
          cell.reference.push_back(
              radius *
              u.cwiseProduct(Vector3(factor(s[1], s[2]), factor(s[2], s[0]), factor(s[0], s[1]))));
        }
      }
    }
    cell.current = cell.reference;
    body->cells.push_back(std::move(cell));
  }
  return body;
}

Vector3 dipole_field(const Vector3& moment, const Vector3& x) {
  const double r = x.norm();
  return vacuum_permeability / (4 * std::numbers::pi) *
         (3 * moment.dot(x) / std::pow(r, 5) * x - moment / std::pow(r, 3));
}

Cilium paper_cilium() {
  Cilium cilium;
  cilium.diameter = 3e-3;
  cilium.segments = {{"base", 3e-3, 1e5, 0.49, 0}, {"magnet", 17e-3, 3e6, 0.49, 75e3}};
  return cilium;
}

Deformation arc(double curvature) {
  if (curvature == 0) return {straight_centreline({0, 3e-3, 20e-3}), nullptr};
  std::vector<Centreline::Piece> pieces;
  for (const auto& [lower, upper] : {std::pair{0.0, 3e-3}, std::pair{3e-3, 20e-3}}) {
    Centreline::Piece piece;
    piece.S = chebyshev_points(14, lower, upper);
    for (const double S : piece.S) {
      const double theta = curvature * S;
      SectionState state;
      state.position = {(1 - std::cos(theta)) / curvature, 0, std::sin(theta) / curvature};
      state.rotation = Quaternion(Eigen::AngleAxisd(theta, Vector3::UnitY()));
      state.curvature = {0, curvature, 0};
      piece.states.push_back(state);
    }
    pieces.push_back(std::move(piece));
  }
  return {Centreline(std::move(pieces)), nullptr};
}

}  // namespace ciliaval::test

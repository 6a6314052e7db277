// SPDX-License-Identifier: LGPL-2.1-or-later
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "analytic/body/body_quadrature.h"
#include "analytic/body/mesh_field.h"
#include "analytic/sources/dipole.h"
#include "analytic/sources/field_points.h"
#include "problem/error.h"
#include "problem/support/interruption.h"
#include "problem/support/rotation.h"

namespace ciliaval::analytic::body {
namespace {

/// The cells that carry magnetisation and the boxes around their nodes, a quarter larger than the
/// nodes need, because a polynomial may bulge beyond them.
struct MagneticCell {
  const SolidCell* cell;
  Eigen::AlignedBox3d box;
};

std::vector<MagneticCell> magnetic_cells(const SolidBody& body) {
  std::vector<MagneticCell> cells;
  for (const SolidCell& cell : body.cells) {
    if (cell.magnetization.isZero(0)) continue;
    Eigen::AlignedBox3d box;
    for (const Vector3& x : cell.current) box.extend(x);
    const Vector3 margin = Vector3::Constant(0.25 * box.diagonal().norm());
    cells.push_back({&cell, {box.min() - margin, box.max() + margin}});
  }
  return cells;
}

/// ξ with x(ξ) = x by Newton's method from the middle of the cell, if it is in the cell (its
/// surface included, to 1e-10 of its size).
std::optional<Vector3> locate(const LagrangeBasis& nodes, const SolidCell& cell, const Vector3& x) {
  Vector3 xi = Vector3::Constant(0.5);
  for (int iteration = 0; iteration < 50; ++iteration) {
    const SolidPoint point = evaluate(nodes, cell, xi);
    const Matrix3 gradient = point.deformation_gradient * point.reference_gradient;
    const Vector3 step = gradient.partialPivLu().solve(x - point.current);
    if (!step.allFinite()) return std::nullopt;
    xi = (xi + step).cwiseMax(-0.5).cwiseMin(1.5);
    if (step.norm() > 1e-13) continue;
    const bool inside = xi.minCoeff() >= -1e-10 && xi.maxCoeff() <= 1 + 1e-10;
    return inside ? std::optional(xi) : std::nullopt;
  }
  return std::nullopt;
}

/// m = F·M/J (A/m) if x is in a magnetised cell.
std::optional<Vector3> magnetization_at(const LagrangeBasis& nodes,
                                        const std::vector<MagneticCell>& cells, const Vector3& x) {
  for (const MagneticCell& magnetic : cells) {
    if (!magnetic.box.contains(x)) continue;
    const auto xi = locate(nodes, *magnetic.cell, x);
    if (!xi) continue;
    const Matrix3 F = evaluate(nodes, *magnetic.cell, *xi).deformation_gradient;
    return F * magnetic.cell->magnetization / F.determinant();
  }
  return std::nullopt;
}

/// The reference charge [M·N] dA₀ at a point of a deformed face.
PatchPoint<double> charge(const SolidBody& body, const ChargedFace& face,
                          const std::array<double, 2>& xi) {
  const FacePoint point = evaluate(body.nodes, face, xi[0], xi[1]);
  return {point.current, face.magnetization_jump.dot(point.reference_area)};
}

/// The moment F·M dV₀, or R·M J dV₀ with the rotation R of F = R·U, at a point of a cell.
PatchPoint<Vector3> moment(const LagrangeBasis& nodes, const SolidCell& cell,
                           const std::array<double, 3>& xi, sources::PushForward push_forward) {
  const SolidPoint point = evaluate(nodes, cell, Vector3(xi[0], xi[1], xi[2]));
  const Matrix3& F = point.deformation_gradient;
  const double volume = point.reference_gradient.determinant();
  if (push_forward == sources::PushForward::F)
    return {point.current, F * cell.magnetization * volume};
  const double J = F.determinant();
  if (!(J > 0))
    throw SolverError("det F is not positive in a cell of the magnet near " +
                      sources::to_string(point.current) +
                      ", so that F has no rotation: refine the solid model or lower the load");
  return {point.current, support::polar_rotation(F) * cell.magnetization * (J * volume)};
}

/// The dipoles of the magnetised cells. They are made at the first point that needs them; several
/// threads may ask at once.
class Dipoles {
 public:
  Dipoles(const SolidBody& body, sources::PushForward push_forward)
      : body_(body), push_forward_(push_forward) {}

  /// B at x outside of the magnet, as far as the orders bring it. To its uncertainty belongs the
  /// rounding of the nodes, 4ε|x|, which makes a layer of dipoles of each charged face.
  sources::AdaptiveSum sum(const Vector3& x, double tolerance) const {
    std::call_once(made_, [&] { make(); });
    sources::AdaptiveSum sum = integral_->sum(x, Vector3::Zero(), tolerance);
    for (const PatchPoint<double>& face : faces_)
      sum.value.uncertainty += Vector3::Constant(sources::largest_dipole_field(
          4 * epsilon * face.position.norm() * std::abs(face.strength),
          (x - face.position).norm()));
    return sum;
  }

 private:
  /// A cell's nodes from its first one: gradients of coordinates that are large beside a thin cell
  /// would lose their digits.
  struct Cell {
    SolidCell local;
    Vector3 reference;  ///< of the first node
    Vector3 current;
  };

  void make() const {
    for (const SolidCell& cell : body_.cells) {
      if (cell.magnetization.isZero(0)) continue;
      Cell own{{}, cell.reference.front(), cell.current.front()};
      own.local.magnetization = cell.magnetization;
      for (const Vector3& X : cell.reference) own.local.reference.emplace_back(X - own.reference);
      for (const Vector3& x : cell.current) own.local.current.emplace_back(x - own.current);
      cells_.push_back(std::move(own));
    }
    integral_.emplace(
        cells_.size(),
        [this](std::size_t i, const std::array<double, 3>& xi) {
          PatchPoint<Vector3> point = moment(body_.nodes, cells_[i].local, xi, push_forward_);
          point.position += cells_[i].current;
          return point;
        },
        "field of the dipoles of the mesh");
    for (const ChargedFace& face : body_.charged_faces)
      faces_.push_back(charge(body_, face, {0.5, 0.5}));
  }

  const SolidBody& body_;
  sources::PushForward push_forward_;
  mutable std::once_flag made_;
  mutable std::vector<Cell> cells_;
  mutable std::vector<PatchPoint<double>> faces_;  ///< each as one charge in its middle
  mutable std::optional<PatchIntegral<3, Vector3>> integral_;
};

/// B of the charged faces. Far from a thin magnet they cancel; there, where their rounding is above
/// the tolerance, B is that of the dipoles.
Field field_of_charges(const SolidBody& body, double tolerance, std::span<const Vector3> points) {
  const std::vector<MagneticCell> cells = magnetic_cells(body);
  const PatchIntegral<2, double> charges(
      body.charged_faces.size(),
      [&](std::size_t face, const std::array<double, 2>& xi) {
        return charge(body, body.charged_faces[face], xi);
      },
      "field of the charged faces of the mesh");
  const Dipoles dipoles(body, sources::PushForward::F);
  return sources::field_at(points, 1, [&](const Vector3& x) {
    const auto m = magnetization_at(body.nodes, cells, x);
    const Vector3 inside = m ? Vector3(vacuum_permeability * *m) : Vector3(Vector3::Zero());
    const sources::AdaptiveSum faces = charges.sum(x, inside, tolerance);
    if (sources::is_within(faces.value, tolerance)) return faces.value;
    if (!m) {
      const sources::AdaptiveSum cells_sum = dipoles.sum(x, tolerance);
      if (cells_sum.reached <= tolerance) return cells_sum.value;
    }
    sources::require_reached(faces, charges.demand(x, inside, tolerance));
    return faces.value;
  });
}

[[noreturn]] void throw_inside(const Vector3& x) {
  throw SolverError("the field inside the magnet was asked at " + sources::to_string(x) +
                    ": with the push-forward R it is not available, take F");
}

Field field_of_moments(const SolidBody& body, double tolerance, std::span<const Vector3> points) {
  const std::vector<MagneticCell> cells = magnetic_cells(body);
  const Dipoles dipoles(body, sources::PushForward::R);
  return sources::field_at(points, 1, [&](const Vector3& x) {
    if (magnetization_at(body.nodes, cells, x)) throw_inside(x);
    const sources::AdaptiveSum sum = dipoles.sum(x, tolerance);
    sources::require_reached(sum, {tolerance, 0, "field of the dipoles R·M of the mesh", x});
    return sum.value;
  });
}

void require_body(const Deformation& deformation) {
  if (!deformation.body)
    throw InputError(
        "the field model `mesh` was asked for a deformation without a body: only the "
        "solid model has one, take `line` or `volume`");
}

}  // namespace

Field MeshField::field(const Cilium&, const Deformation& deformation,
                       std::span<const Vector3> points) const {
  require_body(deformation);
  return options_.push_forward == sources::PushForward::F
             ? field_of_charges(*deformation.body, options_.tolerance, points)
             : field_of_moments(*deformation.body, options_.tolerance, points);
}

std::vector<Vector3> MeshField::magnetization(const Cilium&, const Deformation& deformation,
                                              std::span<const Vector3> points) const {
  require_body(deformation);
  const SolidBody& body = *deformation.body;
  const std::vector<MagneticCell> cells = magnetic_cells(body);
  std::vector<Vector3> result;
  for (const Vector3& x : points) {
    support::check_interruption();
    const auto m = magnetization_at(body.nodes, cells, x);
    if (m && options_.push_forward == sources::PushForward::R) throw_inside(x);
    result.push_back(m.value_or(Vector3::Zero()));
  }
  return result;
}

}  // namespace ciliaval::analytic::body

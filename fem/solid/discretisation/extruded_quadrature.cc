// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/discretisation/extruded_quadrature.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "problem/error.h"

namespace ciliaval::fem::solid::discretisation {
namespace {

/// The third local coordinate must run along Z: each triple of nodes above one another.
void require_straight(const SolidElement& element, const ExtrudedCell& cell) {
  for (Eigen::Index a = 0; a < element_nodes; ++a) {
    const Eigen::Index plane = a / 9;
    const double Z = cell.bottom + 0.5 * static_cast<double>(plane) * (cell.top - cell.bottom);
    const Vector3 offset = (element.nodes.row(a) - element.nodes.row(9 + a % 9)).transpose();
    if (!(std::hypot(offset.x(), offset.y(), element.nodes(a, 2) - Z) <= 1e-9 * element.size) ||
        !(cell.top > cell.bottom))
      throw InputError(
          "the loads of the solid need a mesh extruded along z: a cell's third local coordinate "
          "is not parallel to z");
  }
}

}  // namespace

Eigen::Vector3d quadratic_basis(double zeta) {
  return {(1 - zeta) * (1 - 2 * zeta), 4 * zeta * (1 - zeta), zeta * (2 * zeta - 1)};
}

Eigen::Vector3d quadratic_derivative(double zeta) {
  return {4 * zeta - 3, 4 - 8 * zeta, 4 * zeta - 1};
}

ExtrudedQuadrature::ExtrudedQuadrature(const SolidSpace& space, Extent extent) : extent_(extent) {
  const dealii::QGauss<2> section(section_points_1d);
  std::array<Eigen::Matrix<double, 9, section_points>, 2> derivatives;  // by ξ and η
  for (int q = 0; q < section_points; ++q) {
    const dealii::Point<2>& x = section.point(static_cast<unsigned int>(q));
    values_.col(q) = plane_product(quadratic_basis(x[0]), quadratic_basis(x[1]));
    derivatives[0].col(q) = plane_product(quadratic_derivative(x[0]), quadratic_basis(x[1]));
    derivatives[1].col(q) = plane_product(quadratic_basis(x[0]), quadratic_derivative(x[1]));
  }
  double volume = 0;
  double lowest = std::numeric_limits<double>::infinity();
  for (const SolidElement& element : space.elements()) {
    ExtrudedCell cell;
    cell.bottom = element.cell->vertex(0)[2];
    cell.top = element.cell->vertex(4)[2];
    require_straight(element, cell);
    const Eigen::Matrix<double, 9, 2> XY = element.nodes.block<9, 2>(9, 0);
    for (unsigned int q = 0; q < section_points; ++q) {
      const Eigen::Vector2d at = XY.transpose() * values_.col(q);
      const Eigen::Vector2d by_xi = XY.transpose() * derivatives[0].col(q);
      const Eigen::Vector2d by_eta = XY.transpose() * derivatives[1].col(q);
      cell.area[q] = section.weight(q) * (by_xi[0] * by_eta[1] - by_eta[0] * by_xi[1]);
      cell.X[q] = at[0];
      cell.Y[q] = at[1];
      if (cells_.size() < space.own_elements().size())
        volume += cell.area[q] * (cell.top - cell.bottom);
    }
    lowest = std::min(lowest, cell.bottom);
    height_ = std::max(height_, cell.top);
    cells_.push_back(cell);
  }
  volume = dealii::Utilities::MPI::sum(volume, space.communicator());
  lowest = dealii::Utilities::MPI::min(lowest, space.communicator());
  height_ = dealii::Utilities::MPI::max(height_, space.communicator());
  area_ = volume / (height_ - lowest) * (extent == Extent::half ? 2 : 1);
}

Vector3 whole_force(const ExtrudedQuadrature& quadrature, const Vector3& force_on_mesh) {
  if (quadrature.extent() == Extent::whole) return force_on_mesh;
  return {2 * force_on_mesh.x(), 0, 2 * force_on_mesh.z()};
}

}  // namespace ciliaval::fem::solid::discretisation

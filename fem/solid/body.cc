// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/body.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace ciliaval::fem {
namespace {

/// `values` must be initialised on the element at the patch's nodes.
SolidCell patch(const SolidSpace& space, const Cilium& cilium, const SolidElement& element,
                const PressureVector& pressure, const dealii::Vector<double>& displacement,
                const dealii::FEValues<3>& values) {
  const auto u = nodal_displacements(element, displacement);
  SolidCell cell;
  cell.segment = element.cell->material_id();
  cell.magnetization = cilium.segments[cell.segment].magnetization * Vector3::UnitZ();
  for (unsigned int q = 0; q < values.n_quadrature_points; ++q) {
    const dealii::Point<3>& point = values.quadrature_point(q);
    const Vector3 X(point[0], point[1], point[2]);
    Vector3 x = X;
    Matrix3 F = Matrix3::Identity();
    for (unsigned int a = 0; a < element_nodes; ++a) {
      const Vector3 u_a = u.row(static_cast<Eigen::Index>(space.lexicographic()[a])).transpose();
      const auto gradient = values.shape_grad(a, q);
      x += values.shape_value(a, q) * u_a;
      F += u_a * Vector3(gradient[0], gradient[1], gradient[2]).transpose();
    }
    cell.reference.push_back(X);
    cell.current.push_back(x);
    cell.jacobian.push_back(F.determinant());
    cell.cauchy_stress.push_back(
        cauchy_stress(element.material, F, pressure.dot(element.pressure_basis(X))));
  }
  return cell;
}

/// The face ζ = 0 (normal −Z) or ζ = 1 (normal +Z) of a patch with n nodes a side.
ChargedFace face(const SolidCell& cell, std::size_t n, bool top, double jump) {
  ChargedFace result;
  result.magnetization_jump = jump * Vector3::UnitZ();
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t node = top ? (n - 1) * n * n + j * n + i : i * n + j;
      result.reference.push_back(cell.reference[node]);
      result.current.push_back(cell.current[node]);
    }
  }
  return result;
}

Vector3 mirrored(const Vector3& x) {
  return {x.x(), -x.y(), x.z()};
}

Matrix3 mirrored(const Matrix3& stress) {
  const Vector3 mirror(1, -1, 1);
  return mirror.asDiagonal() * stress * mirror.asDiagonal();
}

/// The nodal values of the image in y = 0, each row of n nodes reversed: its first local coordinate
/// runs the other way, so that the cell stays right-handed and the face's normal outward.
template <typename Value, typename Mirror>
std::vector<Value> image(const std::vector<Value>& values, std::size_t n, const Mirror& mirror) {
  std::vector<Value> result;
  for (std::size_t row = 0; row < values.size(); row += n)
    for (std::size_t i = n; i-- > 0;) result.push_back(mirror(values[row + i]));
  return result;
}

/// Appends the image of a half body in y = 0.
void add_mirror_image(SolidBody& body) {
  const std::size_t n = body.nodes.size();
  const auto vector = [](const Vector3& x) { return mirrored(x); };
  const auto stress = [](const Matrix3& sigma) { return mirrored(sigma); };
  const auto scalar = [](double value) { return value; };
  const std::size_t cells = body.cells.size();
  for (std::size_t i = 0; i < cells; ++i) {
    const SolidCell& cell = body.cells[i];
    body.cells.push_back({cell.segment, cell.magnetization, image(cell.reference, n, vector),
                          image(cell.current, n, vector), image(cell.jacobian, n, scalar),
                          image(cell.cauchy_stress, n, stress)});
  }
  const std::size_t faces = body.charged_faces.size();
  for (std::size_t i = 0; i < faces; ++i) {
    const ChargedFace& face = body.charged_faces[i];
    body.charged_faces.push_back({face.magnetization_jump, image(face.reference, n, vector),
                                  image(face.current, n, vector)});
  }
}

}  // namespace

SolidBody solid_body(const SolidSpace& space, const Fibres& fibres, const Cilium& cilium,
                     const SolidState& state, unsigned int degree) {
  const std::size_t n = degree + 1;
  const dealii::QGaussLobatto<1> lobatto(degree + 1);
  std::vector<double> nodes;
  for (const auto& point : lobatto.get_points()) nodes.push_back(point[0]);
  nodes.front() = 0;
  nodes.back() = 1;
  SolidBody body{LagrangeBasis(nodes), {}, {}};

  std::vector<dealii::Point<3>> points;
  for (const double zeta : nodes)
    for (const double eta : nodes)
      for (const double xi : nodes) points.emplace_back(xi, eta, zeta);
  dealii::FEValues<3> values(
      space.mapping(), space.scalar_element(), dealii::Quadrature<3>(points),
      dealii::update_values | dealii::update_gradients | dealii::update_quadrature_points);
  const std::vector<double> interfaces = cilium.interfaces();
  const double tolerance = 1e-9 * fibres.height();
  for (std::size_t e = 0; e < space.elements().size(); ++e) {
    const SolidElement& element = space.elements()[e];
    values.reinit(element.cell);
    body.cells.push_back(
        patch(space, cilium, element, state.pressure[e], state.displacement, values));
    const SolidCell& cell = body.cells.back();
    const double inside = cell.magnetization.z();
    if (fibres.cells()[e].bottom < tolerance && inside != 0)
      body.charged_faces.push_back(face(cell, n, false, inside));
    if (std::abs(fibres.cells()[e].top - interfaces[cell.segment + 1]) > tolerance) continue;
    const bool last = cell.segment + 1 == cilium.segments.size();
    const double outside = last ? 0.0 : cilium.segments[cell.segment + 1].magnetization;
    if (inside != outside) body.charged_faces.push_back(face(cell, n, true, inside - outside));
  }
  if (fibres.extent() == Extent::half) add_mirror_image(body);
  return body;
}

}  // namespace ciliaval::fem

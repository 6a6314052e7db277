// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/loads/height_loads.h"

#include <deal.II/base/mpi.h>
#include <deal.II/lac/full_matrix.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "problem/error.h"
#include "problem/lagrange.h"
#include "problem/surroundings/magnets/field.h"

namespace ciliaval::fem::solid::loads {
using namespace discretisation;
namespace {

/// Roots in (0, 1) of the quadratic polynomial with the values z at 0, ½, 1, less `level`.
void append_roots(const Eigen::Vector3d& z, double level, std::vector<double>& roots) {
  const double c = z[0] - level;
  const double b = -3 * z[0] + 4 * z[1] - z[2];
  const double a = 2 * z[0] - 4 * z[1] + 2 * z[2];
  const double discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b)) / 2;
  for (const double root : {a != 0 ? q / a : -1.0, q != 0 ? c / q : -1.0})
    if (root > 0 && root < 1) roots.push_back(root);
}

/// Calls integrate(ζ, weight) for a Gauss rule on each part of the line, from ≤ ζ ≤ to, inside the
/// support.
template <typename Integrate>
void integrate_along(const Eigen::Vector3d& z, const HeightDensity& density,
                     const QuadratureRule& rule, const Integrate& integrate, double from = 0,
                     double to = 1) {
  std::vector<double> ends{0, 1};
  if (density.support) {
    const auto [low, high] = *density.support;
    // A quadratic stays within 1¼ times the spread of its values at 0, ½, 1.
    const double margin = (z.maxCoeff() - z.minCoeff()) / 4;
    if (z.maxCoeff() + margin < low || z.minCoeff() - margin > high) return;
    append_roots(z, low, ends);
    append_roots(z, high, ends);
    std::sort(ends.begin(), ends.end());
  }
  for (double& end : ends) end = std::clamp(end, from, to);
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const double width = ends[i + 1] - ends[i];
    if (!(width > 0)) continue;
    const double middle = quadratic_basis(ends[i] + width / 2).dot(z);
    if (density.support && !(middle > (*density.support)[0] && middle < (*density.support)[1]))
      continue;
    for (std::size_t m = 0; m < rule.nodes.size(); ++m)
      integrate(ends[i] + width * rule.nodes[m], width * rule.weights[m]);
  }
}

/// Forces f_a (per e) and derivatives ∂f_a/∂u_z,b of one cell.
struct HeightForceShare {
  Eigen::Matrix<double, element_nodes, 1> force;
  Eigen::Matrix<double, element_nodes, element_nodes> derivative;
};

HeightForceShare height_force_share(const ExtrudedQuadrature& quadrature, const ExtrudedCell& cell,
                                    const Eigen::Matrix<double, 9, 3>& u_z,
                                    const HeightDensity& density, const QuadratureRule& rule,
                                    bool with_derivative) {
  HeightForceShare share;
  share.force.setZero();
  share.derivative.setZero();
  const Eigen::Vector3d Z(cell.bottom, (cell.bottom + cell.top) / 2, cell.top);
  for (int q = 0; q < section_points; ++q) {
    const auto s = quadrature.section_values().col(q);
    const Eigen::Vector3d z = Z + u_z.transpose() * s;
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    Matrix3 derivative = Matrix3::Zero();
    integrate_along(z, density, rule, [&](double zeta, double weight) {
      const Eigen::Vector3d N = quadratic_basis(zeta);
      const Eigen::Vector3d dN = quadratic_derivative(zeta);
      const double g = density.value(N.dot(z));
      force += weight * g * dN.dot(z) * N;
      if (with_derivative)
        derivative +=
            weight * N * (density.derivative(N.dot(z)) * dN.dot(z) * N + g * dN).transpose();
    });
    if (force.isZero(0)) continue;
    const double area = cell.area[static_cast<std::size_t>(q)];
    for (int k = 0; k < 3; ++k) {
      share.force.segment<9>(Eigen::Index{9} * k) += area * force[k] * s;
      if (!with_derivative) continue;
      for (int l = 0; l < 3; ++l)
        share.derivative.block<9, 9>(Eigen::Index{9} * k, Eigen::Index{9} * l) +=
            (area * derivative(k, l) * s) * s.transpose();
    }
  }
  return share;
}

Eigen::Matrix<double, 9, 3> vertical_displacements(const SolidElement& element,
                                                   const Vector& displacement) {
  const Eigen::Matrix<double, element_nodes, 1> u_z =
      nodal_displacements(element, displacement).col(2);
  return u_z.reshaped<Eigen::ColMajor>(9, 3);
}

void subtract_derivative(const SolidElement& element, const HeightForceShare& share,
                         const Vector3& direction, TangentMatrix& tangent) {
  const Dofs dofs(element.dofs);
  dealii::FullMatrix<double> local(element_nodes, element_nodes);
  for (unsigned int c = 0; c < 2; ++c) {
    for (unsigned int a = 0; a < element_nodes; ++a)
      for (unsigned int b = 0; b < element_nodes; ++b)
        local(a, b) = -direction[c] * share.derivative(a, b);
    tangent.add(local, dofs.subspan(std::size_t{c} * element_nodes, element_nodes),
                dofs.subspan(std::size_t{2} * element_nodes, element_nodes));
  }
}

}  // namespace

HeightDensity contact_density(double force, double area, double height, double half_width) {
  const double w = half_width;
  const double g = force / area;
  using std::numbers::pi;
  return {[=](double z) { return g * (1 + std::cos(pi * (z - height) / w)) / (2 * w); },
          [=](double z) { return -g * pi * std::sin(pi * (z - height) / w) / (2 * w * w); },
          std::array{height - w, height + w}};
}

HeightDensity flow_density(double force_per_height, double area) {
  return {[=](double) { return force_per_height / area; }, [](double) { return 0.0; }, {}};
}

Vector3 SpreadLoad::pole(std::size_t segment, const Vector3& x) const {
  Vector3 result = poles[segment];
  if (!magnets.empty() && magnetization[segment] != 0)
    result += magnetization[segment] * surroundings::magnets::jet(magnets, x).B;
  return result;
}

void integrate_load(const SpreadLoad& load, const Eigen::Vector3d& z, double length, double from,
                    double to, const std::function<void(double zeta, double force)>& add) {
  static const QuadratureRule rule = gauss_legendre(10, 0, 1);
  if (load.per_volume != 0)
    for (std::size_t m = 0; m < rule.nodes.size(); ++m)
      add(from + (to - from) * rule.nodes[m],
          (to - from) * rule.weights[m] * load.per_volume * length);
  if (!load.per_height) return;
  integrate_along(
      z, *load.per_height, rule,
      [&](double zeta, double weight) {
        add(zeta, weight * load.per_height->value(quadratic_basis(zeta).dot(z)) *
                      quadratic_derivative(zeta).dot(z));
      },
      from, to);
}

void integrate_in_support(const Eigen::Vector3d& z, const HeightDensity& density,
                          const std::function<void(double zeta, double weight)>& visit) {
  static const QuadratureRule rule = gauss_legendre(10, 0, 1);
  integrate_along(z, density, rule, visit);
}

std::optional<std::array<double, 2>> loaded_part(const Eigen::Vector3d& z,
                                                 const HeightDensity& density) {
  std::optional<std::array<double, 2>> part;
  static const QuadratureRule ends{{0, 1}, {0.5, 0.5}};
  integrate_along(z, density, ends, [&part](double zeta, double) {
    if (!part) part = {zeta, zeta};
    part = {std::min((*part)[0], zeta), std::max((*part)[1], zeta)};
  });
  return part;
}

void add_height_forces(const SolidSpace& space, const ExtrudedQuadrature& quadrature,
                       const HeightDensity& density, const Vector3& direction,
                       const Vector& displacement, Vector& forces, TangentMatrix* tangent) {
  const QuadratureRule rule = gauss_legendre(density.support ? 10 : 3, 0, 1);
  displacement.update_ghost_values();
  const std::size_t own = space.own_elements().size();
  const std::size_t count = tangent != nullptr ? space.elements().size() : own;
  for (std::size_t e = 0; e < count; ++e) {
    const SolidElement& element = space.elements()[e];
    const HeightForceShare share = height_force_share(quadrature, quadrature.cells()[e],
                                                      vertical_displacements(element, displacement),
                                                      density, rule, tangent != nullptr);
    if (share.force.isZero(0)) continue;
    for (std::size_t c = 0; c < 2 && e < own; ++c)
      for (std::size_t a = 0; a < element_nodes; ++a)
        forces.local_element(element.dofs[c * element_nodes + a]) +=
            direction[static_cast<Eigen::Index>(c)] * share.force[static_cast<Eigen::Index>(a)];
    if (tangent != nullptr) subtract_derivative(element, share, direction, *tangent);
  }
}

Vector section_force(const SolidSpace& space, const ExtrudedQuadrature& quadrature, double force,
                     double arclength, const Vector3& direction) {
  Vector forces = space.vector();
  double area = 0;
  for (std::size_t e = 0; e < space.own_elements().size(); ++e) {
    const ExtrudedCell& cell = quadrature.cells()[e];
    if (std::abs(cell.top - arclength) > 2e-9 * quadrature.height()) continue;
    const auto& dofs = space.elements()[e].dofs;
    for (int q = 0; q < section_points; ++q) {
      const double dA = cell.area[static_cast<std::size_t>(q)];
      area += dA;
      for (std::size_t c = 0; c < 2; ++c)
        for (std::size_t a = 0; a < 9; ++a)
          forces.local_element(dofs[c * element_nodes + 18 + a]) +=
              force / quadrature.area() * dA * direction[static_cast<Eigen::Index>(c)] *
              quadrature.section_values()(static_cast<Eigen::Index>(a), q);
    }
  }
  forces.compress(dealii::VectorOperation::add);
  area = dealii::Utilities::MPI::sum(area, space.communicator());
  if (quadrature.extent() == Extent::half) area *= 2;
  if (std::abs(area - quadrature.area()) > 1e-9 * quadrature.area())
    throw InputError("the solid's mesh has no plane at the loaded section");
  return forces;
}

}  // namespace ciliaval::fem::solid::loads

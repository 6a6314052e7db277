// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/loads/probe.h"

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "fem/parallel.h"
#include "problem/error.h"

namespace ciliaval::fem::solid::loads {
using namespace discretisation;
namespace {

/// ∫ k z_ζ dζ and ∫ k z_ζ (u·e) dζ along extrusion lines, weighted with their areas, and their
/// derivatives by the element's nodal displacements along e and z.
struct KernelMeans {
  double weight = 0;        ///< D
  double displacement = 0;  ///< N
  Eigen::Matrix<double, element_nodes, 1> displacement_by_along =
      Eigen::Matrix<double, element_nodes, 1>::Zero();
  Eigen::Matrix<double, element_nodes, 1> displacement_by_z =
      Eigen::Matrix<double, element_nodes, 1>::Zero();
  Eigen::Matrix<double, element_nodes, 1> weight_by_z =
      Eigen::Matrix<double, element_nodes, 1>::Zero();
};

/// The share of one cell.
KernelMeans kernel_means(const ExtrudedQuadrature& quadrature, const ExtrudedCell& cell,
                         const HeightDensity& kernel, const Eigen::Matrix<double, 9, 3>& u_along,
                         const Eigen::Matrix<double, 9, 3>& u_z) {
  KernelMeans means;
  const Eigen::Vector3d Z(cell.bottom, (cell.bottom + cell.top) / 2, cell.top);
  for (int q = 0; q < section_points; ++q) {
    const auto s = quadrature.section_values().col(q);
    const double area = cell.area[static_cast<std::size_t>(q)];
    const Eigen::Vector3d z = Z + u_z.transpose() * s;
    const Eigen::Vector3d along = u_along.transpose() * s;
    Eigen::Vector3d by_along = Eigen::Vector3d::Zero();
    Eigen::Vector3d by_z = Eigen::Vector3d::Zero();
    Eigen::Vector3d weight_by_z = Eigen::Vector3d::Zero();
    integrate_in_support(z, kernel, [&](double zeta, double weight) {
      const Eigen::Vector3d N = quadratic_basis(zeta);
      const Eigen::Vector3d dN = quadratic_derivative(zeta);
      const double k = kernel.value(N.dot(z));
      const Eigen::Vector3d change =
          area * weight * (kernel.derivative(N.dot(z)) * dN.dot(z) * N + k * dN);
      by_along += area * weight * k * dN.dot(z) * N;
      by_z += N.dot(along) * change;
      weight_by_z += change;
    });
    means.weight += by_along.sum();
    means.displacement += by_along.dot(along);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Index first = Eigen::Index{9} * k;
      means.displacement_by_along.segment<9>(first) += by_along[k] * s;
      means.displacement_by_z.segment<9>(first) += by_z[k] * s;
      means.weight_by_z.segment<9>(first) += weight_by_z[k] * s;
    }
  }
  return means;
}

}  // namespace

double mean_displacement(const SolidSpace& space, const ExtrudedQuadrature& quadrature,
                         const HeightDensity& kernel, const Vector3& direction,
                         const Vector& displacement, Vector* gradient) {
  displacement.update_ghost_values();
  std::array<double, 2> sums{};
  auto& [weight, moment] = sums;
  std::vector<std::pair<std::size_t, KernelMeans>> shares;
  for (std::size_t e = 0; e < space.own_elements().size(); ++e) {
    const auto u = nodal_displacements(space.elements()[e], displacement);
    const Eigen::Matrix<double, element_nodes, 1> along = u * direction;
    const Eigen::Matrix<double, element_nodes, 1> u_z = u.col(2);
    const KernelMeans share =
        kernel_means(quadrature, quadrature.cells()[e], kernel,
                     along.reshaped<Eigen::ColMajor>(9, 3), u_z.reshaped<Eigen::ColMajor>(9, 3));
    if (share.weight == 0) continue;
    weight += share.weight;
    moment += share.displacement;
    shares.emplace_back(e, share);
  }
  sum_over_ranks(space.communicator(), sums);
  if (!(weight > 0))
    throw SolverError("no part of the solid is at the height of the probe: the cilium has let go");
  const double mean = moment / weight;
  if (gradient == nullptr) return mean;
  for (const auto& [e, share] : shares) {
    const auto& dofs = space.elements()[e].dofs;
    for (std::size_t a = 0; a < element_nodes; ++a) {
      const auto row = static_cast<Eigen::Index>(a);
      for (std::size_t c = 0; c < 2; ++c)
        gradient->local_element(dofs[c * element_nodes + a]) +=
            direction[static_cast<Eigen::Index>(c)] * share.displacement_by_along[row] / weight;
      gradient->local_element(dofs[2 * element_nodes + a]) +=
          (share.displacement_by_z[row] - mean * share.weight_by_z[row]) / weight;
    }
  }
  gradient->compress(dealii::VectorOperation::add);
  return mean;
}

UnknownForce probe_force(const SolidSpace& space, const ExtrudedQuadrature& quadrature,
                         const ProbeLoad& load, double kernel_width, double force) {
  const auto forces = [&space, &quadrature, load, kernel_width](double amplitude) {
    return load_forces(space, quadrature, ContactLoad{amplitude, load.height, load.azimuth},
                       kernel_width);
  };
  const HeightDensity kernel = contact_density(1, 1, load.height, kernel_width);
  const auto condition = [&space, &quadrature, kernel, load](const Vector& u, double /*force*/,
                                                             Vector* gradient) {
    return mean_displacement(space, quadrature, kernel, direction(load), u, gradient) -
           load.displacement;
  };
  return {forces, condition, force};
}

}  // namespace ciliaval::fem::solid::loads

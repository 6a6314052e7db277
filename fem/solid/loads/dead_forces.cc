// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/loads/dead_forces.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <utility>
#include <vector>

#include "fem/parallel.h"

namespace ciliaval::fem::solid::loads {
using namespace discretisation;

Vector body_force(const SolidSpace& space, const std::function<Vector3(const Vector3& X)>& b) {
  const dealii::QGauss<3> gauss(element_degree + 2);
  dealii::FEValues<3> values(
      space.mapping(), space.scalar_element(), gauss,
      dealii::update_values | dealii::update_JxW_values | dealii::update_quadrature_points);
  Vector forces = space.vector();
  for (const SolidElement& element : space.own_elements()) {
    values.reinit(element.cell);
    for (unsigned int q = 0; q < gauss.size(); ++q) {
      const dealii::Point<3>& X = values.quadrature_point(q);
      const Vector3 f = values.JxW(q) * b(Vector3(X[0], X[1], X[2]));
      for (unsigned int a = 0; a < element_nodes; ++a)
        for (unsigned int c = 0; c < 3; ++c)
          forces.local_element(element.dofs[c * element_nodes + space.lexicographic()[a]]) +=
              values.shape_value(a, q) * f[c];
    }
  }
  forces.compress(dealii::VectorOperation::add);
  return forces;
}

ExternalForces dead_forces(Vector forces) {
  return
      [dead = std::move(forces)](const Vector&, Vector& total, TangentMatrix*) { total += dead; };
}

Vector3 resultant(const SolidSpace& space, const Vector& forces) {
  std::vector<bool> seen(forces.locally_owned_size(), false);
  Vector3 sum = Vector3::Zero();
  for (const SolidElement& element : space.elements())
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t a = 0; a < element_nodes; ++a) {
        const auto dof = element.dofs[c * element_nodes + a];
        if (dof >= seen.size() || seen[dof]) continue;  // another rank's, or known
        sum[static_cast<Eigen::Index>(c)] += forces.local_element(dof);
        seen[dof] = true;
      }
  sum_over_ranks(space.communicator(), {sum.data(), 3});
  return sum;
}

}  // namespace ciliaval::fem::solid::loads

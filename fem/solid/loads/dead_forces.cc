// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/loads/dead_forces.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <utility>
#include <vector>

namespace ciliaval::fem::solid::loads {
using namespace discretisation;

dealii::Vector<double> body_force(const SolidSpace& space,
                                  const std::function<Vector3(const Vector3& X)>& b) {
  const dealii::QGauss<3> gauss(element_degree + 2);
  dealii::FEValues<3> values(
      space.mapping(), space.scalar_element(), gauss,
      dealii::update_values | dealii::update_JxW_values | dealii::update_quadrature_points);
  dealii::Vector<double> forces(space.unknowns());
  for (const SolidElement& element : space.elements()) {
    values.reinit(element.cell);
    for (unsigned int q = 0; q < gauss.size(); ++q) {
      const dealii::Point<3>& X = values.quadrature_point(q);
      const Vector3 f = values.JxW(q) * b(Vector3(X[0], X[1], X[2]));
      for (unsigned int a = 0; a < element_nodes; ++a)
        for (unsigned int c = 0; c < 3; ++c)
          forces[element.dofs[c * element_nodes + space.lexicographic()[a]]] +=
              values.shape_value(a, q) * f[c];
    }
  }
  return forces;
}

ExternalForces dead_forces(dealii::Vector<double> forces) {
  return [dead = std::move(forces)](const dealii::Vector<double>&, dealii::Vector<double>& total,
                                    TangentMatrix*) { total += dead; };
}

Vector3 resultant(const SolidSpace& space, const dealii::Vector<double>& forces) {
  std::vector<bool> seen(space.unknowns(), false);
  Vector3 sum = Vector3::Zero();
  for (const SolidElement& element : space.elements())
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t a = 0; a < element_nodes; ++a) {
        const auto dof = element.dofs[c * element_nodes + a];
        if (!seen[dof]) sum[static_cast<Eigen::Index>(c)] += forces[dof];
        seen[dof] = true;
      }
  return sum;
}

}  // namespace ciliaval::fem::solid::loads

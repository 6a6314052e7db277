// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/loads/environment_forces.h"

#include <deal.II/lac/full_matrix.h>

#include <Eigen/LU>
#include <functional>
#include <vector>

#include "fem/parallel.h"
#include "fem/solid/loads/dead_forces.h"
#include "problem/cilium.h"
#include "problem/support/rotation.h"

namespace ciliaval::fem::solid::loads {
using namespace discretisation;
using surroundings::Environment;
using surroundings::MagneticEnergy;
using surroundings::magnets::FieldJet;
namespace {

Matrix3 cross_matrix(const Vector3& v) {
  return Matrix3{{0, -v[2], v[1]}, {v[2], 0, -v[0]}, {-v[1], v[0], 0}};
}

const Segment& segment_of(const SolidElement& element, const Cilium& cilium) {
  return cilium.segments.at(element.cell->material_id());
}

/// F at a Gauss point of an element.
Matrix3 deformation_gradient(const ShapeGradients& gradients,
                             const Eigen::Matrix<double, element_nodes, 3>& u, int q) {
  return Matrix3::Identity() + u.transpose() * gradients.middleCols<3>(Eigen::Index{3} * q);
}

/// Weight, and the field by the law F, P = −B₀ ⊗ M.
Vector dead_part(const SolidSpace& space, const Cilium& cilium, const Environment& environment) {
  Vector forces = space.vector();
  const bool has_poles = environment.magnetic_energy == MagneticEnergy::F;
  for (const SolidElement& element : space.own_elements()) {
    const Segment& segment = segment_of(element, cilium);
    const Vector3 weight = surroundings::weight_per_volume(environment, segment);
    const Vector3 M = has_poles ? magnetization(segment) : Vector3(Vector3::Zero());
    const GaussPoints points = element.gauss_points();
    const ShapeGradients gradients = points.gradients();
    Eigen::Matrix<double, element_nodes, 3> f =
        (unit_values() * points.weights) * weight.transpose();
    for (int q = 0; q < element_points; ++q)
      f += points.weights[q] * gradients.middleCols<3>(Eigen::Index{3} * q) * M *
           environment.uniform_field.transpose();
    for (unsigned int a = 0; a < element_nodes; ++a)
      for (unsigned int c = 0; c < 3; ++c)
        forces.local_element(element.dofs[c * element_nodes + a]) += f(a, c);
  }
  forces.compress(dealii::VectorOperation::add);
  return forces;
}

/// B₀ and its derivatives at a point x.
using Field = std::function<FieldJet(const Vector3& x)>;

/// Adds the forces ∂(work)/∂u of an element's magnet in a field and minus their derivative, each if
/// asked for.
void add_magnet(const SolidElement& element, const Vector3& M, const Field& field,
                MagneticEnergy law, const Vector& displacement, Vector* forces,
                TangentMatrix* tangent) {
  const auto u = nodal_displacements(element, displacement);
  Eigen::Matrix<double, element_nodes, 3> f = Eigen::Matrix<double, element_nodes, 3>::Zero();
  const GaussPoints points = element.gauss_points();
  const ShapeGradients gradients = points.gradients();
  dealii::FullMatrix<double> K(element_dofs, element_dofs);
  for (int q = 0; q < element_points; ++q) {
    const Eigen::Matrix<double, element_nodes, 3> dN = gradients.middleCols<3>(Eigen::Index{3} * q);
    const Eigen::Matrix<double, element_nodes, 1> N = unit_values().col(q);
    const Vector3 x = (element.nodes + u).transpose() * N;
    const MagnetInField e =
        magnet_in_field(deformation_gradient(gradients, u, q), M, field(x), law);
    const double w = points.weights[q];
    f += w * (dN * e.by_F.transpose() + N * e.by_x.transpose());
    if (tangent == nullptr) continue;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) {
        Matrix3 T;  // over J and L
        for (int J = 0; J < 3; ++J)
          for (int L = 0; L < 3; ++L) T(J, L) = e.FF(3 * J + i, 3 * L + k);
        const Eigen::Matrix<double, element_nodes, 1> left =
            dN * e.Fx[static_cast<std::size_t>(k)].row(i).transpose();
        const Eigen::Matrix<double, element_nodes, 1> right =
            dN * e.Fx[static_cast<std::size_t>(i)].row(k).transpose();
        const Eigen::Matrix<double, element_nodes, element_nodes> block =
            w * (dN * T * dN.transpose() + left * N.transpose() + N * right.transpose() +
                 e.xx(i, k) * N * N.transpose());
        for (int a = 0; a < element_nodes; ++a)
          for (int b = 0; b < element_nodes; ++b)
            K(static_cast<unsigned int>(i * element_nodes + a),
              static_cast<unsigned int>(k * element_nodes + b)) -= block(a, b);
      }
  }
  for (unsigned int a = 0; a < element_nodes && forces != nullptr; ++a)
    for (unsigned int c = 0; c < 3; ++c)
      forces->local_element(element.dofs[c * element_nodes + a]) += f(a, c);
  if (tangent != nullptr) tangent->add(K, element.dofs);
}

/// The field that acts on a deformed magnet other than by dead forces: that of the magnets and, by
/// the law R, the uniform one.
Field live_field(const Environment& environment) {
  return [environment](const Vector3& x) {
    FieldJet jet = surroundings::field_of_magnets(environment, x);
    if (environment.magnetic_energy == MagneticEnergy::R) jet.B += environment.uniform_field;
    return jet;
  };
}

}  // namespace

TurnedMagnet turned_magnet(const Matrix3& F, const Vector3& magnetization, const Vector3& field) {
  const Matrix3 R = support::polar_rotation(F);
  const Matrix3 U = R.transpose() * F;
  const Matrix3 inverse = (U.trace() * Matrix3::Identity() - U).inverse();
  const Vector3 b = R.transpose() * field;
  const Vector3 y = inverse * magnetization.cross(b);
  const Matrix3 Y = cross_matrix(y);
  TurnedMagnet result;
  result.energy = b.dot(magnetization);
  result.first = R * Y;
  result.direction = R * magnetization;
  for (int k = 0; k < 3; ++k)
    result.by_field[static_cast<std::size_t>(k)] =
        R * cross_matrix(inverse * magnetization.cross(Vector3(R.row(k).transpose())));
  for (int l = 0; l < 3; ++l)
    for (int k = 0; k < 3; ++k) {
      Matrix3 dF = Matrix3::Zero();
      dF(k, l) = 1;
      const Matrix3 H = R.transpose() * dF;
      const Matrix3 A = H - H.transpose();
      const Vector3 omega = inverse * Vector3(A(2, 1), A(0, 2), A(1, 0));
      const Matrix3 Omega = cross_matrix(omega);
      const Matrix3 dU = H - Omega * U;
      const Vector3 dy = inverse * (-magnetization.cross(omega.cross(b)) -
                                    (dU.trace() * Matrix3::Identity() - dU) * y);
      const Matrix3 derivative = R * (Omega * Y + cross_matrix(dy));
      result.second.col(3 * l + k) = derivative.reshaped();
    }
  return result;
}

MagnetInField magnet_in_field(const Matrix3& F, const Vector3& magnetization, const FieldJet& field,
                              MagneticEnergy law) {
  MagnetInField result;
  Vector3 m;
  if (law == MagneticEnergy::F) {
    m = F * magnetization;
    result.by_F = field.B * magnetization.transpose();
    result.FF.setZero();
    for (int k = 0; k < 3; ++k)
      result.Fx[static_cast<std::size_t>(k)] = field.gradient.col(k) * magnetization.transpose();
  } else {
    const TurnedMagnet turned = turned_magnet(F, magnetization, field.B);
    m = turned.direction;
    result.by_F = turned.first;
    result.FF = turned.second;
    for (int k = 0; k < 3; ++k) {
      Matrix3& Fx = result.Fx[static_cast<std::size_t>(k)];
      Fx.setZero();
      for (int j = 0; j < 3; ++j)
        Fx += field.gradient(j, k) * turned.by_field[static_cast<std::size_t>(j)];
    }
  }
  result.work = m.dot(field.B);
  result.by_x = field.gradient.transpose() * m;
  for (int k = 0; k < 3; ++k)
    result.xx.row(k) = m.transpose() * field.second[static_cast<std::size_t>(k)];
  return result;
}

ExternalForces environment_forces(const SolidSpace& space, const Cilium& cilium,
                                  const Environment& environment) {
  const ExternalForces dead = dead_forces(dead_part(space, cilium, environment));
  const bool turns =
      environment.magnetic_energy == MagneticEnergy::R && !environment.uniform_field.isZero(0);
  if (!turns && environment.magnets.empty()) return dead;
  return
      [&space, &cilium, dead, field = live_field(environment), law = environment.magnetic_energy](
          const Vector& displacement, Vector& forces, TangentMatrix* tangent) {
        dead(displacement, forces, tangent);
        displacement.update_ghost_values();
        const std::size_t own = space.own_elements().size();
        const std::size_t count = tangent != nullptr ? space.elements().size() : own;
        for (std::size_t e = 0; e < count; ++e) {
          const SolidElement& element = space.elements()[e];
          const Vector3 M = magnetization(segment_of(element, cilium));
          if (!M.isZero(0))
            add_magnet(element, M, field, law, displacement, e < own ? &forces : nullptr, tangent);
        }
      };
}

Vector3 force_of_magnets(const SolidSpace& space, const Cilium& cilium,
                         const Environment& environment, const Vector& displacement) {
  if (environment.magnets.empty()) return Vector3::Zero();
  Environment magnets;
  magnets.magnets = environment.magnets;
  magnets.magnetic_energy = environment.magnetic_energy;
  return resultant(space,
                   forces_at(displacement, space, environment_forces(space, cilium, magnets)));
}

Vector3 weight_of(const SolidSpace& space, const Cilium& cilium, const Environment& environment) {
  Vector3 sum = Vector3::Zero();
  for (const SolidElement& element : space.own_elements())
    sum += element.gauss_points().weights.sum() *
           surroundings::weight_per_volume(environment, segment_of(element, cilium));
  sum_over_ranks(space.communicator(), {sum.data(), 3});
  return sum;
}

}  // namespace ciliaval::fem::solid::loads

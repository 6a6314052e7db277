// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/postprocessing/mantle.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "meshes/boundary_ids.h"

namespace ciliaval::fem::solid::postprocessing {
using namespace discretisation;
namespace {

constexpr double rim = 0.1;           ///< left out at each end of a segment, diameters
constexpr double rim_of_short = 0.2;  ///< at most, of the segment's length

MantleCompression compression(const Matrix3& F, const Vector3& normal, double height) {
  Eigen::Matrix<double, 3, 2> tangents;
  tangents.col(0) = normal.unitOrthogonal();
  tangents.col(1) = normal.cross(tangents.col(0));
  const Eigen::Matrix<double, 3, 2> along = F * tangents;
  const Eigen::Matrix2d C = along.transpose() * along;
  const double J = F.determinant();
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(C).eigenvalues()[0];
  if (!(J > 0 && least > 0))  // turned inside out
    return {std::numeric_limits<double>::infinity(), 0, height};
  const double smallest = std::sqrt(least);
  return {J / std::sqrt(C.determinant()) / smallest, smallest, height};
}

}  // namespace

MantleCompression mantle_compression(const SolidSpace& space, const Cilium& cilium,
                                     const SolidState& state) {
  const dealii::QGauss<2> points(2);
  dealii::FEFaceValues<3> face_values(
      space.mapping(), space.dof_handler().get_fe(), points,
      dealii::update_gradients | dealii::update_normal_vectors | dealii::update_quadrature_points);
  std::vector<dealii::Tensor<2, 3>> gradients(points.size());
  const std::vector<double> interfaces = cilium.interfaces();
  MantleCompression largest;
  state.displacement.update_ghost_values();
  for (const auto& cell : space.dof_handler().active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    const double bottom = interfaces.at(cell->material_id());
    const double top = interfaces.at(cell->material_id() + 1);
    const double margin = std::min(rim * cilium.thickness(), rim_of_short * (top - bottom));
    for (const unsigned int f : cell->face_indices()) {
      if (!cell->at_boundary(f) || cell->face(f)->boundary_id() != meshes::mantle_id) continue;
      face_values.reinit(cell, f);
      face_values[dealii::FEValuesExtractors::Vector(0)].get_function_gradients(state.displacement,
                                                                                gradients);
      for (const unsigned int q : face_values.quadrature_point_indices()) {
        const double Z = face_values.quadrature_point(q)[2];
        if (Z < bottom + margin || Z > top - margin) continue;
        Matrix3 F = Matrix3::Identity();
        Vector3 normal;
        for (unsigned int i = 0; i < 3; ++i) {
          normal[i] = face_values.normal_vector(q)[i];
          for (unsigned int j = 0; j < 3; ++j) F(i, j) += gradients[q][i][j];
        }
        const MantleCompression here = compression(F, normal, Z);
        if (here.ratio > largest.ratio) largest = here;
      }
    }
  }
  using Values = std::array<double, 3>;
  for (const auto& [ratio, stretch, height] : dealii::Utilities::MPI::all_gather(
           space.communicator(), Values{largest.ratio, largest.stretch, largest.height}))
    if (ratio > largest.ratio) largest = {ratio, stretch, height};
  return largest;
}

}  // namespace ciliaval::fem::solid::postprocessing

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/section.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "problem/error.h"
#include "problem/lagrange.h"

namespace ciliaval::fem {
namespace {

constexpr std::size_t stations = 4;
constexpr std::size_t gauss_planes = 2;

/// ζ of the stations: Gauss–Lobatto points.
const std::array<double, stations> station_zeta{0, (1 - 1 / std::sqrt(5.0)) / 2,
                                                (1 + 1 / std::sqrt(5.0)) / 2, 1};
const std::array<double, gauss_planes> gauss_zeta{(1 - 1 / std::sqrt(3.0)) / 2,
                                                  (1 + 1 / std::sqrt(3.0)) / 2};

/// Integrals over the section in one plane.
struct PlaneIntegrals {
  Vector3 x = Vector3::Zero();                                           ///< ∫ x dA
  Eigen::Matrix<double, 3, 2> xX = Eigen::Matrix<double, 3, 2>::Zero();  ///< ∫ x (X, Y) dA
  Vector3 traction = Vector3::Zero();                                    ///< ∫ P e_z dA
  Vector3 moment = Vector3::Zero();                                      ///< ∫ x × P e_z dA
};

struct LayerIntegrals {
  double top = 0;
  double area = 0;                               ///< ∫ dA
  Eigen::Vector2d XY = Eigen::Vector2d::Zero();  ///< ∫ (X, Y) dA
  std::array<PlaneIntegrals, stations> station;
  std::array<PlaneIntegrals, gauss_planes> gauss;
};

/// x at section point q and height ζ.
Vector3 position(const Fibres& fibres, const FibreCell& cell,
                 const Eigen::Matrix<double, element_nodes, 3>& u, int q, double zeta) {
  const auto i = static_cast<std::size_t>(q);
  const Eigen::Vector3d N = quadratic_basis(zeta);
  Vector3 x(cell.X[i], cell.Y[i], cell.bottom + zeta * (cell.top - cell.bottom));
  for (int k = 0; k < 3; ++k)
    x += N[k] * u.middleRows<9>(Eigen::Index{9} * k).transpose() * fibres.section_values().col(q);
  return x;
}

void add_positions(const Fibres& fibres, const FibreCell& cell,
                   const Eigen::Matrix<double, element_nodes, 3>& u, LayerIntegrals& layer) {
  for (int q = 0; q < section_points; ++q) {
    const auto i = static_cast<std::size_t>(q);
    const Eigen::Vector2d XY(cell.X[i], cell.Y[i]);
    layer.area += cell.area[i];
    layer.XY += cell.area[i] * XY;
    for (std::size_t s = 0; s < stations; ++s) {
      const Vector3 x = position(fibres, cell, u, q, station_zeta[s]);
      layer.station[s].x += cell.area[i] * x;
      layer.station[s].xX += cell.area[i] * x * XY.transpose();
    }
  }
}

/// `values` must be initialised on the element, its points (section point, Gauss plane), the plane
/// fastest.
void add_forces(const SolidSpace& space, const Fibres& fibres, const SolidElement& element,
                const FibreCell& cell, const Eigen::Matrix<double, element_nodes, 3>& u,
                const PressureVector& pressure, const dealii::FEValues<3>& values,
                LayerIntegrals& layer) {
  for (int q = 0; q < section_points; ++q) {
    for (std::size_t s = 0; s < gauss_planes; ++s) {
      const auto point = static_cast<unsigned int>(gauss_planes * static_cast<std::size_t>(q) + s);
      Matrix3 F = Matrix3::Identity();
      for (unsigned int a = 0; a < element_nodes; ++a) {
        const auto gradient = values.shape_grad(a, point);
        F += u.row(static_cast<Eigen::Index>(space.lexicographic()[a])).transpose() *
             Vector3(gradient[0], gradient[1], gradient[2]).transpose();
      }
      const dealii::Point<3>& X = values.quadrature_point(point);
      const double p = pressure.dot(element.pressure_basis(Vector3(X[0], X[1], X[2])));
      const double dA = cell.area[static_cast<std::size_t>(q)];
      const Vector3 force = dA * first_piola_stress(element.material, F, p).col(2);
      const Vector3 x = position(fibres, cell, u, q, gauss_zeta[s]);
      layer.gauss[s].x += dA * x;
      layer.gauss[s].traction += force;
      layer.gauss[s].moment += x.cross(force);
    }
  }
}

/// The integrals of all layers, keyed by the Z of their lower planes.
std::map<double, LayerIntegrals> integrate_layers(const SolidSpace& space, const Fibres& fibres,
                                                  const SolidState& state) {
  std::vector<dealii::Point<3>> points;
  for (int q = 0; q < section_points; ++q)
    for (const double zeta : gauss_zeta)
      points.emplace_back(fibres.section_coordinates()(q, 0), fibres.section_coordinates()(q, 1),
                          zeta);
  dealii::FEValues<3> values(space.mapping(), space.scalar_element(), dealii::Quadrature<3>(points),
                             dealii::update_gradients | dealii::update_quadrature_points);
  std::map<double, LayerIntegrals> layers;
  for (std::size_t e = 0; e < space.elements().size(); ++e) {
    const SolidElement& element = space.elements()[e];
    const FibreCell& cell = fibres.cells()[e];
    LayerIntegrals& layer = layers[cell.bottom];
    layer.top = cell.top;
    const auto u = nodal_displacements(element, state.displacement);
    values.reinit(element.cell);
    add_positions(fibres, cell, u, layer);
    add_forces(space, fibres, element, cell, u, state.pressure[e], values, layer);
  }
  return layers;
}

/// κ = 2 vec(q′ q̄) at the stations, from the interpolation of their quaternions.
void differentiate_rotation(const std::vector<double>& S, std::vector<SectionState>& states) {
  for (std::size_t i = 1; i < states.size(); ++i) {
    Quaternion& q = states[i].rotation;
    if (q.dot(states[i - 1].rotation) < 0) q.coeffs() = -q.coeffs();
  }
  const LagrangeBasis basis(S);
  std::vector<double> values(S.size());
  std::vector<double> derivatives(S.size());
  for (std::size_t i = 0; i < S.size(); ++i) {
    basis.values_and_derivatives(S[i], values, derivatives);
    Quaternion derivative(0, 0, 0, 0);
    for (std::size_t j = 0; j < S.size(); ++j)
      derivative.coeffs() += derivatives[j] * states[j].rotation.coeffs();
    states[i].curvature = 2 * (derivative * states[i].rotation.conjugate()).vec();
  }
}

Centreline::Piece piece(double bottom, const LayerIntegrals& layer) {
  const double height = layer.top - bottom;
  Centreline::Piece piece;
  std::array<SectionForces, gauss_planes> forces;
  for (std::size_t g = 0; g < gauss_planes; ++g) {
    forces[g].force = layer.gauss[g].traction;
    forces[g].moment =
        layer.gauss[g].moment - (layer.gauss[g].x / layer.area).cross(forces[g].force);
  }
  for (std::size_t s = 0; s < stations; ++s) {
    SectionState state;
    state.position = layer.station[s].x / layer.area;
    state.rotation = section_rotation(layer.station[s].xX - state.position * layer.XY.transpose());
    const double t = (station_zeta[s] - gauss_zeta[0]) / (gauss_zeta[1] - gauss_zeta[0]);
    state.forces.force = (1 - t) * forces[0].force + t * forces[1].force;
    state.forces.moment = (1 - t) * forces[0].moment + t * forces[1].moment;
    piece.S.push_back(bottom + station_zeta[s] * height);
    piece.states.push_back(state);
  }
  piece.S.front() = bottom;
  piece.S.back() = layer.top;
  differentiate_rotation(piece.S, piece.states);
  return piece;
}

}  // namespace

Quaternion section_rotation(const Eigen::Matrix<double, 3, 2>& B) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(B.transpose() * B);
  if (!(eigen.eigenvalues()[0] > 0))
    throw SolverError("a section of the solid has degenerated: its rotation is not defined");
  const Eigen::Matrix<double, 3, 2> D = B * eigen.operatorInverseSqrt();
  Matrix3 rotation;
  rotation << D, D.col(0).cross(D.col(1));
  return Quaternion(rotation).normalized();
}

Centreline centreline(const SolidSpace& space, const Fibres& fibres, const SolidState& state) {
  std::vector<Centreline::Piece> pieces;
  for (const auto& [bottom, layer] : integrate_layers(space, fibres, state))
    pieces.push_back(piece(bottom, layer));
  // Both sides of a break integrate the same plane in another order: make them equal to the bit.
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    pieces[i].S.front() = pieces[i - 1].S.back();
    pieces[i].states.front().position = pieces[i - 1].states.back().position;
    pieces[i].states.front().rotation = pieces[i - 1].states.back().rotation;
  }
  return Centreline(std::move(pieces));
}

}  // namespace ciliaval::fem

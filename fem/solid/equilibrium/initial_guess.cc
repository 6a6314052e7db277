// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/equilibrium/initial_guess.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "problem/error.h"

namespace ciliaval::fem::solid::equilibrium {
using namespace discretisation;
namespace {

using PlaneNodes = Eigen::Matrix<double, 2, 9>;

/// Values and derivatives of the nine plane polynomials at (ξ, η).
struct PlaneBasis {
  Eigen::Matrix<double, 9, 1> values;
  Eigen::Matrix<double, 9, 2> derivatives;

  explicit PlaneBasis(const Eigen::Vector2d& at) {
    const Eigen::Vector3d a = quadratic_basis(at[0]);
    const Eigen::Vector3d b = quadratic_basis(at[1]);
    values = plane_product(a, b);
    derivatives.col(0) = plane_product(quadratic_derivative(at[0]), b);
    derivatives.col(1) = plane_product(a, quadratic_derivative(at[1]));
  }
};

/// Finds points in the elements of an extruded mesh: the layer by Z, the cell by (X, Y).
class Locator {
 public:
  Locator(const SolidSpace& space, const ExtrudedQuadrature& quadrature) {
    for (std::size_t e = 0; e < quadrature.cells().size(); ++e) {
      Layer& layer = layers_[quadrature.cells()[e].bottom];
      layer.top = quadrature.cells()[e].top;
      layer.elements.push_back(e);
      layer.sections.emplace_back(space.elements()[e].nodes.topLeftCorner<9, 2>().transpose());
    }
  }

  /// The element that holds X (the nearest one for points slightly outside) and (ξ, η, ζ) there.
  std::pair<std::size_t, Vector3> find(const Vector3& X) const {
    auto next = layers_.upper_bound(X.z());
    if (next != layers_.begin()) --next;
    const auto& [bottom, layer] = *next;
    const double zeta = (X.z() - bottom) / (layer.top - bottom);
    const auto [cell, at] = find_in(layer, X.head<2>());
    if (!(zeta > -1e-6 && zeta < 1 + 1e-6))
      throw InputError("a state was asked for at a height outside its mesh");
    return {layer.elements[cell], Vector3(at[0], at[1], zeta)};
  }

 private:
  struct Layer {
    double top = 0;
    std::vector<std::size_t> elements;
    std::vector<PlaneNodes> sections;
  };

  /// The cell of the section, and (ξ, η) there.
  static std::pair<std::size_t, Eigen::Vector2d> find_in(const Layer& layer,
                                                         const Eigen::Vector2d& XY) {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < layer.sections.size(); ++i)
      order.emplace_back((layer.sections[i].col(4) - XY).squaredNorm(), i);
    std::sort(order.begin(), order.end());
    std::pair<std::size_t, Eigen::Vector2d> best;
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [distance, i] : order) {
      const Eigen::Vector2d at = local(layer.sections[i], XY);
      const double outside = (at.array() - 0.5).abs().maxCoeff() - 0.5;
      if (outside < least) {
        least = outside;
        best = {i, at};
      }
      if (outside < 1e-9) break;
    }
    constexpr double farthest = 0.5;  // of a cell
    if (!(least < farthest)) throw InputError("a state was asked for at a point outside its mesh");
    return best;
  }

  /// Newton's method for X(ξ, η) = XY; far points end in NaN or far outside the unit square.
  static Eigen::Vector2d local(const PlaneNodes& nodes, const Eigen::Vector2d& XY) {
    Eigen::Vector2d at(0.5, 0.5);
    for (int i = 0; i < 20; ++i) {
      const PlaneBasis basis(at);
      const Eigen::Vector2d step =
          (nodes * basis.derivatives).inverse() * (XY - nodes * basis.values);
      at += step;
      if (!(step.norm() > 1e-14) || at.norm() > 10) break;
    }
    return at.allFinite() ? at : Eigen::Vector2d::Constant(1e9);
  }

  std::map<double, Layer> layers_;  ///< by the Z of their lower planes
};

/// displacement(X, segment) at the nodes, pressure(X, segment) projected on each element's linear
/// functions; `segment` is the element's.
template <typename Displacement, typename Pressure>
SolidState filled(const SolidSpace& space, const Displacement& displacement,
                  const Pressure& pressure) {
  SolidState state = space.undeformed();
  for (std::size_t e = 0; e < space.elements().size(); ++e) {
    const SolidElement& element = space.elements()[e];
    const std::size_t segment = element.cell->material_id();
    for (unsigned int a = 0; a < element_nodes; ++a) {
      const Vector3 u = displacement(element.nodes.row(a).transpose(), segment);
      for (std::size_t c = 0; c < 3; ++c)
        state.displacement[element.dofs[c * element_nodes + a]] = u[static_cast<Eigen::Index>(c)];
    }
    const Eigen::Matrix<double, element_points, 3> points =
        space.shape_values().transpose() * element.nodes;
    PressureVector moment = PressureVector::Zero();
    for (unsigned int q = 0; q < element_points; ++q)
      moment += element.weights[q] * element.pressure_values.col(q) *
                pressure(points.row(q).transpose(), segment);
    state.pressure[e] = element.inverse_compliance * moment / element.material.bulk_modulus;
  }
  return state;
}

/// The section of a rod at S, deformed by uniaxial stress.
struct RodSection {
  CentrelinePoint point;
  Eigen::Vector2d curvature;  ///< about d₁, d₂, 1/m
  double extension = 0;       ///< |r′| − 1

  RodSection(const Centreline& rod, double S) : point(rod.at(S)) {
    const Vector3 material = point.rotation.conjugate() * point.curvature;
    curvature = material.head<2>();
    extension = point.derivative.norm() - 1;
  }
  double strain(const Vector3& X) const {
    return curvature[0] * X.y() - curvature[1] * X.x() + extension;
  }
  Vector3 position(const Vector3& X, double contraction) const {
    const double XY = X.x() * X.y();
    const double difference = (X.x() * X.x() - X.y() * X.y()) / 2;
    const auto [k1, k2] = std::pair(curvature[0], curvature[1]);
    const Vector3 offset(X.x() + contraction * (k2 * difference - k1 * XY - extension * X.x()),
                         X.y() + contraction * (k2 * XY + k1 * difference - extension * X.y()), 0);
    return point.position + point.rotation * offset;
  }
};

}  // namespace

SolidState interpolated(const SolidSpace& from, const ExtrudedQuadrature& quadrature,
                        const SolidState& state, const SolidSpace& to) {
  const Locator locator(from, quadrature);
  const auto displacement = [&](const Vector3& X, std::size_t) -> Vector3 {
    const auto [e, local] = locator.find(X);
    const auto u = nodal_displacements(from.elements()[e], state.displacement);
    const Eigen::Matrix<double, 9, 1> section = PlaneBasis(local.head<2>()).values;
    const Eigen::Vector3d along = quadratic_basis(local.z());
    Vector3 result = Vector3::Zero();
    for (int k = 0; k < 3; ++k)
      result += along[k] * u.middleRows<9>(Eigen::Index{9} * k).transpose() * section;
    return result;
  };
  const auto pressure = [&](const Vector3& X, std::size_t) {
    const std::size_t e = locator.find(X).first;
    return state.pressure[e].dot(from.elements()[e].pressure_basis(X));
  };
  return filled(to, displacement, pressure);
}

SolidState rod_guess(const Centreline& rod, const Cilium& cilium, const SolidSpace& to) {
  std::map<double, RodSection> sections;  // one for each height of nodes or Gauss points
  const auto section = [&](double Z) -> const RodSection& {
    return sections.try_emplace(Z, rod, Z).first->second;
  };
  const double fade = cilium.thickness() / 4;
  const auto displacement = [&](const Vector3& X, std::size_t) -> Vector3 {
    if (X.z() <= 0) return Vector3::Zero();
    // At an interface the nodes take the upper segment's curvature, on both sides of it.
    const double nu = cilium.segments[cilium.segment_at(X.z())].poisson_ratio;
    return section(X.z()).position(X, nu * (1 - std::exp(-X.z() / fade))) - X;
  };
  const auto pressure = [&](const Vector3& X, std::size_t segment) {
    return cilium.segments[segment].young_modulus * section(X.z()).strain(X) / 3;
  };
  return filled(to, displacement, pressure);
}

}  // namespace ciliaval::fem::solid::equilibrium

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/equilibrium/initial_guess.h"

#include <deal.II/base/mpi.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <boost/serialization/array.hpp>
#include <boost/serialization/vector.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "fem/parallel.h"
#include "problem/error.h"

namespace ciliaval::fem::solid::equilibrium {
using namespace discretisation;
namespace {

using PlaneNodes = Eigen::Matrix<double, 2, 9>;

// Distances of a point outside of a section's cell, in cells, up to which it is taken.
constexpr double inside = 1e-9;   ///< as one that lies in it
constexpr double farthest = 0.5;  ///< at all

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

  struct Place {
    double outside = std::numeric_limits<double>::infinity();  ///< of the section's cell, in cells
    std::size_t element = 0;
    Vector3 local = Vector3::Zero();  ///< (ξ, η, ζ)
  };
  /// The element that holds X, or the nearest one for points slightly outside.
  Place find(const Vector3& X) const {
    auto next = layers_.upper_bound(X.z());
    if (next != layers_.begin()) --next;
    if (next == layers_.end()) return {};
    const auto& [bottom, layer] = *next;
    const double zeta = (X.z() - bottom) / (layer.top - bottom);
    if (!(zeta > -1e-6 && zeta < 1 + 1e-6)) return {};
    const auto [outside, cell, at] = find_in(layer, X.head<2>());
    return {outside, layer.elements[cell], Vector3(at[0], at[1], zeta)};
  }

 private:
  struct Layer {
    double top = 0;
    std::vector<std::size_t> elements;
    std::vector<PlaneNodes> sections;
  };

  struct InSection {
    double outside = std::numeric_limits<double>::infinity();
    std::size_t cell = 0;
    Eigen::Vector2d at = Eigen::Vector2d::Zero();
  };
  static InSection find_in(const Layer& layer, const Eigen::Vector2d& XY) {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < layer.sections.size(); ++i)
      order.emplace_back((layer.sections[i].col(4) - XY).squaredNorm(), i);
    std::sort(order.begin(), order.end());
    InSection best;
    for (const auto& [distance, i] : order) {
      const Eigen::Vector2d at = local(layer.sections[i], XY);
      const double outside = (at.array() - 0.5).abs().maxCoeff() - 0.5;
      if (outside < best.outside) best = {outside, i, at};
      if (outside < inside) break;
    }
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

/// u and p at a point, and how far that lies outside the cell whose polynomials they are.
struct PointValue {
  double outside = std::numeric_limits<double>::infinity();
  Vector3 displacement = Vector3::Zero();
  double pressure = 0;
};

/// Values of a state anywhere on the cells that this rank has.
class Interpolant {
 public:
  Interpolant(const SolidSpace& space, const ExtrudedQuadrature& quadrature,
              const SolidState& state)
      : space_(space), state_(state), locator_(space, quadrature) {}

  PointValue at(const Vector3& X) const {
    const auto [outside, e, local] = locator_.find(X);
    if (std::isinf(outside)) return {};
    const SolidElement& element = space_.elements()[e];
    const auto u = nodal_displacements(element, state_.displacement);
    const Eigen::Matrix<double, 9, 1> section = PlaneBasis(local.head<2>()).values;
    const Eigen::Vector3d along = quadratic_basis(local.z());
    PointValue result{outside, Vector3::Zero(), state_.pressure[e].dot(element.pressure_basis(X))};
    for (int k = 0; k < 3; ++k)
      result.displacement += along[k] * u.middleRows<9>(Eigen::Index{9} * k).transpose() * section;
    return result;
  }

 private:
  const SolidSpace& space_;
  const SolidState& state_;
  Locator locator_;
};

/// Replaces values by those of a rank in whose cells the points lie, or nearer to them. Ranks ask
/// those whose cells reach the point's height. Collective.
void ask_others(const Interpolant& own, const SolidSpace& from, const std::vector<Vector3>& points,
                std::vector<PointValue>& values) {
  using Points = std::vector<std::array<double, 3>>;
  using Values = std::vector<std::array<double, 5>>;
  const MPI_Comm communicator = from.communicator();
  std::array<double, 2> reach{std::numeric_limits<double>::infinity(), 0};
  for (const SolidElement& element : from.own_elements())
    reach = {std::min(reach[0], element.nodes.col(2).minCoeff()),
             std::max(reach[1], element.nodes.col(2).maxCoeff())};
  const auto reaches = dealii::Utilities::MPI::all_gather(communicator, reach);
  std::map<unsigned int, Points> asked;
  std::map<unsigned int, std::vector<std::size_t>> places;
  const auto self = static_cast<unsigned int>(rank(communicator));
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (values[i].outside < inside) continue;
    const Vector3& X = points[i];
    for (unsigned int other = 0; other < reaches.size(); ++other) {
      const auto& [low, high] = reaches[other];
      const double slack = 1e-6 * (high - low);
      if (other == self || X.z() < low - slack || X.z() > high + slack) continue;
      asked[other].push_back({X.x(), X.y(), X.z()});
      places[other].push_back(i);
    }
  }
  std::map<unsigned int, Values> answers;
  for (const auto& [other, list] : dealii::Utilities::MPI::some_to_some(communicator, asked))
    for (const auto& [x, y, z] : list) {
      const PointValue value = own.at(Vector3(x, y, z));
      const Vector3& u = value.displacement;
      answers[other].push_back({value.outside, u.x(), u.y(), u.z(), value.pressure});
    }
  for (const auto& [other, list] : dealii::Utilities::MPI::some_to_some(communicator, answers))
    for (std::size_t i = 0; i < list.size(); ++i) {
      const auto& [outside, x, y, z, pressure] = list[i];
      PointValue& value = values[places.at(other)[i]];
      if (outside < value.outside) value = {outside, Vector3(x, y, z), pressure};
    }
}

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
        state.displacement.local_element(element.dofs[c * element_nodes + a]) =
            u[static_cast<Eigen::Index>(c)];
    }
    const GaussPoints points = element.gauss_points();
    const Eigen::Matrix<double, 3, element_points> positions =
        element.nodes.transpose() * unit_values();
    PressureVector moment = PressureVector::Zero();
    for (unsigned int q = 0; q < element_points; ++q)
      moment +=
          points.weights[q] * points.pressure_values.col(q) * pressure(positions.col(q), segment);
    state.pressure[e] = element.inverse_compliance * moment / element.material.bulk_modulus;
  }
  state.displacement.update_ghost_values();
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
  state.displacement.update_ghost_values();
  const Interpolant own(from, quadrature, state);
  std::vector<Vector3> points;
  std::vector<PointValue> values;
  // filled() asks for the same points in the same order each time.
  const auto add = [&](const Vector3& X, std::size_t) -> const PointValue& {
    points.push_back(X);
    return values.emplace_back(own.at(X));
  };
  filled(
      to, [&](const Vector3& X, std::size_t e) { return add(X, e).displacement; },
      [&](const Vector3& X, std::size_t e) { return add(X, e).pressure; });
  if (rank_count(from.communicator()) > 1) ask_others(own, from, points, values);
  for (const PointValue& value : values)
    if (!(value.outside < farthest))
      throw InputError("a state was asked for at a point outside its mesh");
  auto value = values.begin();
  return filled(
      to, [&](const Vector3&, std::size_t) { return value++->displacement; },
      [&](const Vector3&, std::size_t) { return value++->pressure; });
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

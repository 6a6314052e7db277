// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/postprocessing/centreline.h"

#include <deal.II/base/mpi.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "fem/parallel.h"
#include "fem/solid/discretisation/assembly.h"
#include "problem/error.h"
#include "problem/lagrange.h"
#include "problem/surroundings/magnets/field.h"

namespace ciliaval::fem::solid::postprocessing {
using namespace discretisation;
using namespace loads;
namespace {

constexpr std::size_t stations = 4;
/// Stations of a piece from 0 to 1: Gauss–Lobatto points.
const std::array<double, stations> station_points{0, (1 - 1 / std::sqrt(5.0)) / 2,
                                                  (1 + 1 / std::sqrt(5.0)) / 2, 1};

/// A force and its moment about the origin.
struct Wrench {
  Vector3 force = Vector3::Zero();
  Vector3 moment = Vector3::Zero();
  void add(const Vector3& at, const Vector3& f) {
    force += f;
    moment += at.cross(f);
  }
  /// Adds the image in the plane y = 0; the moment is an axial vector.
  void add_mirror_image() {
    force = Vector3(2 * force.x(), 0, 2 * force.z());
    moment = Vector3(0, 2 * moment.y(), 0);
  }
};

/// An extrusion line of a cell, deformed.
struct DeformedLine {
  Matrix3 x;  ///< at ζ = 0, ½, 1: columns
  double area = 0;
  Eigen::Vector2d XY = Eigen::Vector2d::Zero();
};

/// The cells between two planes of the mesh.
struct Layer {
  double bottom = 0;
  double top = 0;
  std::size_t segment = 0;
  std::vector<std::size_t> cells;   ///< indices of the elements
  std::vector<DeformedLine> lines;  ///< of all of them
  Wrench across{};                  ///< of the fields on M across the axis
};

/// Section integrals in one plane, and the load between it and the top of its layer.
struct Station {
  double area = 0;                                                       ///< ∫ dA
  Eigen::Vector2d XY = Eigen::Vector2d::Zero();                          ///< ∫ (X, Y) dA
  Vector3 x = Vector3::Zero();                                           ///< ∫ x dA
  Eigen::Matrix<double, 3, 2> xX = Eigen::Matrix<double, 3, 2>::Zero();  ///< ∫ x (X, Y) dA
  Wrench load;
  Wrench poles;  ///< ∫ M B₀ dA, the field's stress (law F)
  std::array<std::span<double>, 8> parts() {
    const auto of = [](auto& matrix) {
      return std::span(matrix.data(), static_cast<std::size_t>(matrix.size()));
    };
    return {std::span(&area, 1), of(XY),          of(x),           of(xX),
            of(load.force),      of(load.moment), of(poles.force), of(poles.moment)};
  }
  /// Adds the image in the plane y = 0.
  void add_mirror_image() {
    area *= 2;
    XY = Eigen::Vector2d(2 * XY.x(), 0);
    x = Vector3(2 * x.x(), 0, 2 * x.z());
    xX = 2 * Eigen::Matrix<double, 3, 2>{{xX(0, 0), 0}, {0, xX(1, 1)}, {xX(2, 0), 0}};
    load.add_mirror_image();
    poles.add_mirror_image();
  }
};

/// A plane of a layer.
struct Cut {
  std::size_t layer = 0;
  double zeta = 0;
};

/// Each rank has the cells of its own in each layer.
struct Extraction {
  const SolidSpace& space;
  const ExtrudedQuadrature& quadrature;
  const SolidState& state;
  const SpreadLoad& load;

  // All are collective.
  /// The layers of the mesh from base to tip.
  std::vector<Layer> layers() const;
  std::vector<Station> stations(const std::vector<Layer>& layers,
                                const std::vector<Cut>& cuts) const;
  std::vector<Wrench> top_wrenches(const std::vector<Layer>& layers) const;
  /// ζ of the ends of the layers' pieces. Where a contact kernel meets a line, pieces are at most
  /// half its height; below and above it n is constant.
  std::vector<std::vector<double>> breaks(const std::vector<Layer>& layers) const;

 private:
  // The share of this rank's cells.
  Station station(const Layer& layer, double zeta) const;
  Wrench top_wrench(const Layer& layer) const;
  /// Least and largest ζ at which the kernel meets a line; 1 and 0 if there is none.
  std::array<double, 2> loaded(const Layer& layer) const;

  void add_cell(Layer& layer, std::size_t index) const;
  /// Adds the forces of the fields on M across the axis, by the law F, at the nodes of a cell from
  /// the given one on.
  void add_across(std::size_t index, Eigen::Index first, Wrench& wrench) const;
  /// Adds weight and field of the part of a line above ζ: a magnet of constant M is pulled by
  /// M dA B₀ at its upper end and by −M dA B₀ at its lower one (law F).
  void add_environment(const Layer& layer, const Matrix3& x, double dA, double zeta,
                       Wrench& wrench) const;
};

void Extraction::add_cell(Layer& layer, std::size_t index) const {
  const ExtrudedCell& cell = quadrature.cells()[index];
  layer.bottom = cell.bottom;
  layer.top = cell.top;
  layer.segment = space.elements()[index].cell->material_id();
  layer.cells.push_back(index);
  const auto u = nodal_displacements(space.elements()[index], state.displacement);
  for (std::size_t i = 0; i < section_points; ++i) {
    DeformedLine line;
    line.area = cell.area[i];
    line.XY = Eigen::Vector2d(cell.X[i], cell.Y[i]);
    for (int k = 0; k < 3; ++k)
      line.x.col(k) =
          Vector3(cell.X[i], cell.Y[i], cell.bottom + 0.5 * k * (cell.top - cell.bottom)) +
          u.middleRows<9>(Eigen::Index{9} * k).transpose() *
              quadrature.section_values().col(static_cast<Eigen::Index>(i));
    layer.lines.push_back(line);
  }
}

void Extraction::add_across(std::size_t index, Eigen::Index first, Wrench& wrench) const {
  if (load.transverse_magnetization.empty()) return;
  const SolidElement& element = space.elements()[index];
  const Vector3& M = load.transverse_magnetization.at(element.cell->material_id());
  if (M.isZero(0)) return;
  const Eigen::Matrix<double, element_nodes, 3> x =
      element.nodes + nodal_displacements(element, state.displacement);
  const GaussPoints points = element.gauss_points();
  const ShapeGradients gradients = points.gradients();
  for (int q = 0; q < element_points; ++q) {
    const Eigen::Matrix<double, element_nodes, 1> along_M =
        gradients.middleCols<3>(Eigen::Index{3} * q) * M;
    const Eigen::Matrix<double, element_nodes, 1> N = unit_values().col(q);
    const auto jet = surroundings::magnets::jet(load.magnets, x.transpose() * N);
    const Vector3 B = load.uniform_field + jet.B;
    const Vector3 force = jet.gradient.transpose() * (x.transpose() * along_M);
    for (Eigen::Index a = first; a < element_nodes; ++a)
      wrench.add(x.row(a).transpose(), points.weights[q] * (along_M[a] * B + N[a] * force));
  }
}

std::vector<Layer> Extraction::layers() const {
  std::map<double, Layer> by_bottom;
  std::vector<std::array<double, 2>> own;  // bottom and top
  for (std::size_t e = 0; e < space.own_elements().size(); ++e)
    if (own.empty() || own.back()[0] != quadrature.cells()[e].bottom)
      own.push_back({quadrature.cells()[e].bottom, quadrature.cells()[e].top});
  for (const auto& ranks_own : dealii::Utilities::MPI::all_gather(space.communicator(), own))
    for (const auto& [bottom, top] : ranks_own) {
      by_bottom[bottom].bottom = bottom;
      by_bottom[bottom].top = top;
    }
  for (std::size_t e = 0; e < space.own_elements().size(); ++e)
    add_cell(by_bottom[quadrature.cells()[e].bottom], e);
  for (auto& [bottom, layer] : by_bottom)
    for (const std::size_t e : layer.cells) add_across(e, 0, layer.across);
  std::vector<Layer> result;
  result.reserve(by_bottom.size());
  for (auto& [bottom, layer] : by_bottom) result.push_back(std::move(layer));
  return result;
}

Station Extraction::station(const Layer& layer, double zeta) const {
  Station result;
  const Eigen::Vector3d basis = quadratic_basis(zeta);
  for (const auto& [x, dA, XY] : layer.lines) {
    const Vector3 here = x * basis;
    result.area += dA;
    result.XY += dA * XY;
    result.x += dA * here;
    result.xX += dA * here * XY.transpose();
    integrate_load(load, x.row(2).transpose(), layer.top - layer.bottom, zeta, 1,
                   [&, &x = x, &dA = dA](double at, double force) {
                     result.load.add(x * quadratic_basis(at), dA * force * load.direction);
                   });
    add_environment(layer, x, dA, zeta, result.load);
    if (!load.poles.empty()) result.poles.add(here, dA * load.pole(layer.segment, here));
  }
  result.load.force += (1 - zeta) * layer.across.force;
  result.load.moment += (1 - zeta) * layer.across.moment;
  return result;
}

std::vector<Station> Extraction::stations(const std::vector<Layer>& layers,
                                          const std::vector<Cut>& cuts) const {
  std::vector<Station> result;
  std::vector<double> values;
  for (const auto& [layer, zeta] : cuts)
    for (const auto part : result.emplace_back(station(layers[layer], zeta)).parts())
      values.insert(values.end(), part.begin(), part.end());
  sum_over_ranks(space.communicator(), values);
  const double* value = values.data();
  for (Station& station : result) {
    for (const auto part : station.parts())
      for (double& number : part) number = *value++;
    if (quadrature.extent() == Extent::half) station.add_mirror_image();
  }
  return result;
}

void Extraction::add_environment(const Layer& layer, const Matrix3& x, double dA, double zeta,
                                 Wrench& wrench) const {
  if (load.weight.empty()) return;
  static const QuadratureRule rule = gauss_legendre(2, 0, 1);  // x is quadratic
  for (std::size_t m = 0; m < rule.nodes.size(); ++m)
    wrench.add(x * quadratic_basis(zeta + (1 - zeta) * rule.nodes[m]),
               (1 - zeta) * rule.weights[m] * dA * (layer.top - layer.bottom) *
                   load.weight[layer.segment]);
  const Vector3 low = x * quadratic_basis(zeta);
  const Vector3 high = x.col(2);
  wrench.add(high, dA * load.pole(layer.segment, high));
  wrench.add(low, -dA * load.pole(layer.segment, low));
}

/// Force and moment that the part above exerts on the layer: at the nodes a of its upper plane,
/// Σ (f_a − ∫ N_a b dV) over the layer's own cells. In equilibrium they balance the load to the
/// solver's tolerance, since rigid motions are in the element's space.
Wrench Extraction::top_wrench(const Layer& layer) const {
  Wrench result;
  for (const std::size_t e : layer.cells) {
    const SolidElement& element = space.elements()[e];
    const auto f = element_forces(element, state, e);
    const auto u = nodal_displacements(element, state.displacement);
    for (Eigen::Index a = 18; a < element_nodes; ++a)
      result.add((element.nodes.row(a) + u.row(a)).transpose(), f.row(a).transpose());
  }
  for (const auto& [x, dA, XY] : layer.lines)
    integrate_load(load, x.row(2).transpose(), layer.top - layer.bottom, 0, 1,
                   [&, &x = x, &dA = dA](double at, double force) {
                     result.add(x.col(2), -dA * force * quadratic_basis(at)[2] * load.direction);
                   });
  if (!load.weight.empty())
    for (const auto& [x, dA, XY] : layer.lines)
      // ∫ N₂ dζ = 1/6, ∫ dN₂/dζ dζ = 1 for the node at ζ = 1
      result.add(x.col(2), -dA * (load.weight[layer.segment] * (layer.top - layer.bottom) / 6 +
                                  load.pole(layer.segment, x.col(2))));
  Wrench across;
  for (const std::size_t e : layer.cells) add_across(e, 18, across);
  result.force -= across.force;
  result.moment -= across.moment;
  return result;
}

std::vector<Wrench> Extraction::top_wrenches(const std::vector<Layer>& layers) const {
  std::vector<Wrench> result;
  std::vector<double> values;
  for (const Layer& layer : layers) {
    const Wrench& wrench = result.emplace_back(top_wrench(layer));
    values.insert(values.end(), wrench.force.begin(), wrench.force.end());
    values.insert(values.end(), wrench.moment.begin(), wrench.moment.end());
  }
  sum_over_ranks(space.communicator(), values);
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = {Vector3(values.data() + 6 * i), Vector3(values.data() + 6 * i + 3)};
    if (quadrature.extent() == Extent::half) result[i].add_mirror_image();
  }
  return result;
}

std::array<double, 2> Extraction::loaded(const Layer& layer) const {
  double low = 1;
  double high = 0;
  for (const DeformedLine& line : layer.lines) {
    const auto part = loaded_part(line.x.row(2).transpose(), *load.per_height);
    if (!part) continue;
    low = std::min(low, (*part)[0]);
    high = std::max(high, (*part)[1]);
  }
  return {low, high};
}

std::vector<std::vector<double>> Extraction::breaks(const std::vector<Layer>& layers) const {
  std::vector<std::vector<double>> result(layers.size(), {0, 1});
  if (!load.per_height || !load.per_height->support) return result;
  std::vector<double> ends;  // low and −high
  for (const Layer& layer : layers) {
    const auto [low, high] = loaded(layer);
    ends.insert(ends.end(), {low, -high});
  }
  dealii::Utilities::MPI::min(ends, space.communicator(), ends);
  for (std::size_t l = 0; l < layers.size(); ++l) {
    double low = ends[2 * l];
    double high = -ends[2 * l + 1];
    constexpr double shortest = 1e-3;  // a piece shorter than that is not worth its own
    if (!(high - low > shortest)) continue;
    if (low < shortest) low = 0;
    if (high > 1 - shortest) high = 1;
    const auto [lower, upper] = *load.per_height->support;
    const double length = (high - low) * (layers[l].top - layers[l].bottom);
    const auto count = static_cast<int>(std::ceil(length / ((upper - lower) / 2)));
    for (int i = 0; i < count; ++i) result[l].push_back(low + (high - low) * i / count);
    result[l].push_back(high);
    std::sort(result[l].begin(), result[l].end());
    result[l].erase(std::unique(result[l].begin(), result[l].end()), result[l].end());
  }
  return result;
}

/// The piece through its stations and their cuts.
Centreline::Piece piece(const Layer& layer, const Wrench& top, const Cut* cut,
                        const Station* stations_of_piece) {
  const double bottom = layer.bottom;
  Centreline::Piece piece;
  for (std::size_t i = 0; i < stations; ++i) {
    const double zeta = cut[i].zeta;
    const Station& station = stations_of_piece[i];
    SectionState state;
    state.position = station.x / station.area;
    state.rotation = section_rotation(station.xX - state.position * station.XY.transpose());
    // The field's stress −B₀ ⊗ M is no part of n, which is that of the strain.
    state.forces.force = top.force + station.load.force + station.poles.force;
    state.forces.moment = top.moment + station.load.moment + station.poles.moment -
                          state.position.cross(state.forces.force);
    piece.S.push_back(zeta == 1 ? layer.top : bottom + zeta * (layer.top - bottom));
    piece.states.push_back(state);
  }
  differentiate_rotation(piece);
  return piece;
}

/// The centreline, given force and moment on the upper plane of each layer.
Centreline centreline(const Extraction& extraction, const std::vector<Layer>& layers,
                      const std::vector<Wrench>& tops) {
  const auto breaks = extraction.breaks(layers);
  std::vector<Cut> cuts;
  for (std::size_t l = 0; l < layers.size(); ++l)
    for (std::size_t i = 0; i + 1 < breaks[l].size(); ++i)
      for (const double t : station_points) {
        const auto [from, to] = std::pair(breaks[l][i], breaks[l][i + 1]);
        cuts.push_back({l, t == 1 ? to : from + t * (to - from)});
      }
  const std::vector<Station> at = extraction.stations(layers, cuts);
  std::vector<Centreline::Piece> pieces;
  for (std::size_t i = 0; i < cuts.size(); i += stations)
    pieces.push_back(
        piece(layers[cuts[i].layer], tops[cuts[i].layer], cuts.data() + i, at.data() + i));
  // Both sides of a break integrate the same plane in another order: make them equal to the bit.
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    pieces[i].S.front() = pieces[i - 1].S.back();
    pieces[i].states.front().position = pieces[i - 1].states.back().position;
    pieces[i].states.front().rotation = pieces[i - 1].states.back().rotation;
  }
  return Centreline(std::move(pieces));
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

Centreline centreline(const SolidSpace& space, const ExtrudedQuadrature& quadrature,
                      const SolidState& state, const SpreadLoad& load) {
  state.displacement.update_ghost_values();
  const Extraction extraction{space, quadrature, state, load};
  const std::vector<Layer> layers = extraction.layers();
  return centreline(extraction, layers, extraction.top_wrenches(layers));
}

Vector3 tip_position(const SolidSpace& space, const ExtrudedQuadrature& quadrature,
                     const SolidState& state) {
  const SpreadLoad none;
  state.displacement.update_ghost_values();
  const Extraction extraction{space, quadrature, state, none};
  const std::vector<Layer> layers = extraction.layers();
  const Station tip = extraction.stations(layers, {{layers.size() - 1, 1}}).front();
  return tip.x / tip.area;
}

Centreline centreline_by_statics(const SolidSpace& space, const ExtrudedQuadrature& quadrature,
                                 const SolidState& state, const SpreadLoad& load,
                                 const std::optional<PlaneForce>& plane) {
  state.displacement.update_ghost_values();
  const Extraction extraction{space, quadrature, state, load};
  const std::vector<Layer> layers = extraction.layers();
  std::vector<Wrench> tops(layers.size());
  Wrench above;
  std::vector<Cut> cuts;
  for (std::size_t i = 0; i < layers.size(); ++i) cuts.insert(cuts.end(), {{i, 0}, {i, 1}});
  const std::vector<Station> stations = extraction.stations(layers, cuts);
  for (std::size_t i = layers.size(); i-- > 0;) {
    if (plane && std::abs(layers[i].top - plane->arclength) <= 1e-9 * quadrature.height()) {
      const Station& station = stations[2 * i + 1];
      above.add(station.x / station.area, plane->force);
    }
    tops[i] = above;
    const Wrench& load_of_layer = stations[2 * i].load;
    above.force += load_of_layer.force;
    above.moment += load_of_layer.moment;
  }
  return centreline(extraction, layers, tops);
}

}  // namespace ciliaval::fem::solid::postprocessing

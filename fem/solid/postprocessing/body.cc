// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/postprocessing/body.h"

#include <deal.II/base/mpi.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "meshes/boundary_ids.h"
#include "problem/cilium.h"

namespace ciliaval::fem::solid::postprocessing {
using namespace discretisation;
namespace {

/// Nodes along an edge of an element.
constexpr std::size_t edge_nodes = element_degree + 1;

using NodalVectors = Eigen::Matrix<double, element_nodes, 3>;

/// ∂v/∂ξ at a node, from the nodal values v: column j is the derivative by ξ_j, to
/// which only the three nodes of a line contribute.
Matrix3 local_gradient(const NodalVectors& v, Eigen::Index node) {
  Matrix3 result;
  Eigen::Index stride = 1;
  for (int j = 0; j < 3; ++j, stride *= 3) {
    const Eigen::Index position = node / stride % 3;
    const Eigen::Vector3d slope = quadratic_derivative(0.5 * static_cast<double>(position));
    const Eigen::Index first = node - position * stride;
    result.col(j) = (slope[0] * v.row(first) + slope[1] * v.row(first + stride) +
                     slope[2] * v.row(first + 2 * stride))
                        .transpose();
  }
  return result;
}

SolidCell patch(const Cilium& cilium, const SolidElement& element, const PressureVector& pressure,
                const Vector& displacement) {
  const NodalVectors u = nodal_displacements(element, displacement);
  SolidCell cell;
  cell.segment = element.cell->material_id();
  cell.magnetization = magnetization(cilium.segments[cell.segment]);
  cell.reference.reserve(element_nodes);
  cell.current.reserve(element_nodes);
  cell.jacobian.reserve(element_nodes);
  cell.cauchy_stress.reserve(element_nodes);
  for (Eigen::Index a = 0; a < element_nodes; ++a) {
    const Vector3 X = element.nodes.row(a).transpose();
    const Matrix3 F =
        Matrix3::Identity() + local_gradient(u, a) * local_gradient(element.nodes, a).inverse();
    cell.reference.push_back(X);
    cell.current.emplace_back(X + u.row(a).transpose());
    cell.jacobian.push_back(F.determinant());
    cell.cauchy_stress.push_back(
        cauchy_stress(element.material, F, pressure.dot(element.pressure_basis(X))));
  }
  return cell;
}

/// A face of a patch by deal.II's number: 2d of the lower end of the local direction d, 2d + 1 of
/// the upper one. Its first local coordinate is that after d, of a lower end that before d.
ChargedFace face(const SolidCell& cell, unsigned int number, const Vector3& jump) {
  constexpr std::size_t n = edge_nodes;
  constexpr std::array<std::size_t, 3> strides{1, n, n * n};
  const unsigned int d = number / 2;
  const bool is_upper = number % 2 == 1;
  const std::size_t first = strides.at((d + (is_upper ? 1 : 2)) % 3);
  const std::size_t second = strides.at((d + (is_upper ? 2 : 1)) % 3);
  const std::size_t origin = is_upper ? (n - 1) * strides.at(d) : 0;
  ChargedFace result;
  result.magnetization_jump = jump;
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t node = origin + i * first + j * second;
      result.reference.push_back(cell.reference[node]);
      result.current.push_back(cell.current[node]);
    }
  }
  return result;
}

/// The sides of an element on the mantle, if the charge M·N on them is not zero.
void append_mantle(const SolidElement& element, const SolidCell& cell,
                   std::vector<ChargedFace>& faces) {
  if (cell.magnetization.head<2>().isZero(0)) return;
  for (unsigned int f = 0; f < 4; ++f)
    if (element.cell->at_boundary(f) && element.cell->face(f)->boundary_id() == meshes::mantle_id)
      faces.push_back(face(cell, f, cell.magnetization));
}

/// Numbers one after the other, and the same taken off again.
class Pack {
 public:
  Pack() = default;
  explicit Pack(std::vector<double> values) : values_(std::move(values)) {}
  const std::vector<double>& values() const { return values_; }
  bool at_end() const { return read_ == values_.size(); }

  void put(double value) { values_.push_back(value); }
  void put(const auto& matrix) { values_.insert(values_.end(), matrix.begin(), matrix.end()); }
  template <class Value>
  void put_all(const std::vector<Value>& list) {
    for (const Value& value : list) put(value.reshaped());
  }
  double take() { return values_[read_++]; }
  template <class Value>
  std::vector<Value> take_all(std::size_t count) {
    std::vector<Value> list(count);
    for (Value& value : list) {
      value = Eigen::Map<const Value>(values_.data() + read_);
      read_ += static_cast<std::size_t>(value.size());
    }
    return list;
  }

 private:
  std::vector<double> values_;
  std::size_t read_ = 0;
};

/// The parts of all ranks, on each of them.
SolidBody gathered(const SolidBody& own, const Cilium& cilium, MPI_Comm communicator) {
  Pack cells;
  for (const SolidCell& cell : own.cells) {
    cells.put(static_cast<double>(cell.segment));
    cells.put_all(cell.reference);
    cells.put_all(cell.current);
    cells.put(cell.jacobian);
    cells.put_all(cell.cauchy_stress);
  }
  Pack faces;
  for (const ChargedFace& face : own.charged_faces) {
    faces.put_all(std::vector{face.magnetization_jump});
    faces.put_all(face.reference);
    faces.put_all(face.current);
  }
  using dealii::Utilities::MPI::all_gather;
  SolidBody body{own.nodes, {}, {}};
  for (auto& values : all_gather(communicator, cells.values()))
    for (Pack pack(std::move(values)); !pack.at_end();) {
      SolidCell& cell = body.cells.emplace_back();
      cell.segment = static_cast<std::size_t>(pack.take());
      cell.magnetization = magnetization(cilium.segments[cell.segment]);
      cell.reference = pack.take_all<Vector3>(element_nodes);
      cell.current = pack.take_all<Vector3>(element_nodes);
      for (int a = 0; a < element_nodes; ++a) cell.jacobian.push_back(pack.take());
      cell.cauchy_stress = pack.take_all<Matrix3>(element_nodes);
    }
  for (auto& values : all_gather(communicator, faces.values()))
    for (Pack pack(std::move(values)); !pack.at_end();) {
      const Vector3 jump = pack.take_all<Vector3>(1).front();
      auto reference = pack.take_all<Vector3>(edge_nodes * edge_nodes);
      auto current = pack.take_all<Vector3>(edge_nodes * edge_nodes);
      body.charged_faces.push_back({jump, std::move(reference), std::move(current)});
    }
  return body;
}

Vector3 mirrored(const Vector3& x) {
  return {x.x(), -x.y(), x.z()};
}

Matrix3 mirrored(const Matrix3& stress) {
  const Vector3 mirror(1, -1, 1);
  return mirror.asDiagonal() * stress * mirror.asDiagonal();
}

/// The nodal values of the image in y = 0, each row of nodes reversed: its first local coordinate
/// runs the other way, so that the cell stays right-handed and the face's normal outward.
template <typename Value, typename Mirror>
std::vector<Value> image(const std::vector<Value>& values, const Mirror& mirror) {
  std::vector<Value> result;
  result.reserve(values.size());
  for (std::size_t row = 0; row < values.size(); row += edge_nodes)
    for (std::size_t i = edge_nodes; i-- > 0;) result.push_back(mirror(values[row + i]));
  return result;
}

/// Appends the image of a half body in y = 0.
void add_mirror_image(SolidBody& body) {
  const auto vector = [](const Vector3& x) { return mirrored(x); };
  const auto stress = [](const Matrix3& sigma) { return mirrored(sigma); };
  const auto scalar = [](double value) { return value; };
  const std::size_t cells = body.cells.size();
  body.cells.reserve(2 * cells);
  for (std::size_t i = 0; i < cells; ++i) {
    const SolidCell& cell = body.cells[i];
    body.cells.push_back({cell.segment, cell.magnetization, image(cell.reference, vector),
                          image(cell.current, vector), image(cell.jacobian, scalar),
                          image(cell.cauchy_stress, stress)});
  }
  const std::size_t faces = body.charged_faces.size();
  body.charged_faces.reserve(2 * faces);
  for (std::size_t i = 0; i < faces; ++i) {
    const ChargedFace& face = body.charged_faces[i];
    body.charged_faces.push_back(
        {face.magnetization_jump, image(face.reference, vector), image(face.current, vector)});
  }
}

}  // namespace

SolidBody solid_body(const SolidSpace& space, const ExtrudedQuadrature& quadrature,
                     const Cilium& cilium, const SolidState& state) {
  SolidBody body{LagrangeBasis({0, 0.5, 1}), {}, {}};
  const std::vector<double> interfaces = cilium.interfaces();
  const double tolerance = 1e-9 * quadrature.height();
  state.displacement.update_ghost_values();
  for (std::size_t e = 0; e < space.own_elements().size(); ++e) {
    const SolidElement& element = space.elements()[e];
    body.cells.push_back(patch(cilium, element, state.pressure[e], state.displacement));
    const SolidCell& cell = body.cells.back();
    const auto add_axial = [&](unsigned int number, double jump) {
      if (jump != 0) body.charged_faces.push_back(face(cell, number, jump * Vector3::UnitZ()));
    };
    const double inside = cell.magnetization.z();
    append_mantle(element, cell, body.charged_faces);
    if (quadrature.cells()[e].bottom < tolerance) add_axial(4, inside);
    if (std::abs(quadrature.cells()[e].top - interfaces[cell.segment + 1]) > tolerance) continue;
    const bool last = cell.segment + 1 == cilium.segments.size();
    const double outside = last ? 0.0 : cilium.segments[cell.segment + 1].magnetization;
    add_axial(5, inside - outside);
  }
  if (dealii::Utilities::MPI::n_mpi_processes(space.communicator()) > 1)
    body = gathered(body, cilium, space.communicator());
  if (quadrature.extent() == Extent::half) add_mirror_image(body);
  return body;
}

}  // namespace ciliaval::fem::solid::postprocessing

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/system.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_dgq.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "fem/beam/band_matrix.h"
#include "fem/beam/kinematics.h"
#include "problem/error.h"

namespace ciliaval::fem::beam {
namespace {

using Eigen::Index;

/// Nodes of FE_Q in increasing order: its own numbering puts the two vertices first.
std::vector<unsigned int> increasing_order(const dealii::FE_Q<1, 3>& fe) {
  std::vector<unsigned int> order(fe.n_dofs_per_cell());
  for (unsigned int i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&fe](unsigned int i, unsigned int j) {
    return fe.unit_support_point(i)[0] < fe.unit_support_point(j)[0];
  });
  return order;
}

ReferenceElement tabulate(const dealii::FE_Q<1, 3>& fe, const dealii::QGauss<1>& gauss) {
  const std::vector<unsigned int> order = increasing_order(fe);
  ReferenceElement element;
  const auto n_nodes = static_cast<Index>(order.size());
  const auto n_points = static_cast<Index>(gauss.size());
  element.values.resize(n_points, n_nodes);
  element.derivatives.resize(n_points, n_nodes);
  for (const unsigned int i : order) element.nodes.push_back(fe.unit_support_point(i)[0]);
  for (unsigned int g = 0; g < gauss.size(); ++g) {
    element.points.push_back(gauss.point(g)[0]);
    element.weights.push_back(gauss.weight(g));
    for (std::size_t a = 0; a < order.size(); ++a) {
      const auto column = static_cast<Index>(a);
      element.values(g, column) = fe.shape_value(order[a], gauss.point(g));
      element.derivatives(g, column) = fe.shape_grad(order[a], gauss.point(g))[0];
    }
  }
  return element;
}

void require_valid(const Mesh& mesh) {
  if (mesh.degree < 1) throw InputError("the degree of a beam element must be at least 1");
  if (mesh.n_elements() == 0 || mesh.vertices.size() != mesh.n_elements() + 1)
    throw InputError("a beam of N >= 1 elements needs N sections and N + 1 vertices");
  if (!std::is_sorted(mesh.vertices.begin(), mesh.vertices.end()) ||
      !(mesh.vertices.back() > mesh.vertices.front()))
    throw InputError("the vertices of a beam must increase");
  if (!mesh.velocities.empty() && mesh.velocities.size() != mesh.vertices.size())
    throw InputError("a moving mesh needs a velocity for every vertex");
}

/// Where the mesh moves, the length derivative of the residual takes Γ₀ = e₃ and K₀ = 0 for
/// granted.
void require_straight_where_moving(const Mesh& mesh, const ReferenceCurve& curve) {
  for (std::size_t e = 0; e < mesh.n_elements() && !mesh.velocities.empty(); ++e) {
    if (mesh.velocities[e] == mesh.velocities[e + 1] && mesh.velocities[e] == 0) continue;
    const Pose a = curve(mesh.vertices[e]);
    const Pose b = curve(mesh.vertices[e + 1]);
    const double h = mesh.vertices[e + 1] - mesh.vertices[e];
    const Vector3 gap = b.position - a.position - h * (a.rotation * Vector3::UnitZ());
    if (gap.norm() > 1e-12 * mesh.vertices.back() || a.rotation.angularDistance(b.rotation) > 1e-12)
      throw InputError("a beam mesh can only move where its reference curve is straight");
  }
}

}  // namespace

Pose straight_curve(double S) {
  return {S * Vector3::UnitZ(), Quaternion::Identity()};
}

Loads combine(double a, const Loads& x, double b, const Loads& y) {
  Loads sum;
  for (const auto& [factor, loads] : {std::pair(a, &x), std::pair(b, &y)}) {
    for (const PointLoad& load : loads->points)
      sum.points.push_back({load.vertex, factor * load.force, factor * load.moment});
    for (const PrescribedDisplacement& end : loads->displacements)
      sum.displacements.push_back({end.vertex, factor * end.displacement, factor * end.rotation});
    sum.force_per_height += factor * loads->force_per_height;
    if (sum.force_per_length.size() < loads->force_per_length.size())
      sum.force_per_length.resize(loads->force_per_length.size(), Vector3::Zero());
    for (std::size_t e = 0; e < loads->force_per_length.size(); ++e)
      sum.force_per_length[e] += factor * loads->force_per_length[e];
  }
  return sum;
}

struct System::DofSpace {
  dealii::Triangulation<1, 3> triangulation;
  dealii::FESystem<1, 3> fe;
  dealii::DoFHandler<1, 3> dof_handler;
  /// Global unknowns of each element in the order of ReferenceElement.
  std::vector<std::vector<dealii::types::global_dof_index>> unknowns;
  BandMatrix matrix;

  explicit DofSpace(unsigned int degree)
      : fe(dealii::FE_Q<1, 3>(degree), 6,
           dealii::FE_DGQArbitraryNodes<1, 3>(dealii::QGauss<1>(degree)), 6),
        dof_handler(triangulation) {}

  /// One cell for each element, in order. Only the topology matters: the element knows its own
  /// lengths, since vertices may move along the curve and coincide.
  void create(std::size_t n_elements, const ReferenceElement& reference) {
    std::vector<dealii::Point<3>> points;
    std::vector<dealii::CellData<1>> cells(n_elements);
    for (std::size_t i = 0; i <= n_elements; ++i)
      points.emplace_back(0.0, 0.0, static_cast<double>(i));
    for (std::size_t e = 0; e < n_elements; ++e)
      cells[e].vertices = {static_cast<unsigned int>(e), static_cast<unsigned int>(e + 1)};
    triangulation.create_triangulation(points, cells, dealii::SubCellData());
    dof_handler.distribute_dofs(fe);
    for (const auto& cell : dof_handler.active_cell_iterators()) number(cell, reference);
    number_along_the_beam(reference);
    matrix = BandMatrix(dof_handler.n_dofs(), unknowns.front().size() - 1);
  }

  template <class Cell>
  void number(const Cell& cell, const ReferenceElement& reference) {
    const std::size_t n_nodes = reference.n_nodes();
    std::vector<dealii::types::global_dof_index> global(fe.n_dofs_per_cell());
    cell->get_dof_indices(global);
    const std::vector<unsigned int> order =
        increasing_order(dynamic_cast<const dealii::FE_Q<1, 3>&>(fe.base_element(0)));
    std::vector<std::size_t> position(order.size());
    for (std::size_t a = 0; a < order.size(); ++a) position[order[a]] = a;
    std::vector<dealii::types::global_dof_index> ordered(global.size());
    for (unsigned int i = 0; i < fe.n_dofs_per_cell(); ++i) {
      const auto [component, index] = fe.system_to_component_index(i);
      const std::size_t row =
          component < 6 ? 6 * position[index] + component : 6 * (n_nodes + index) + (component - 6);
      ordered[row] = global[i];
    }
    unknowns.push_back(std::move(ordered));
  }

  /// First vertex, interior nodes, Gauss points, second vertex, which is the first of the next
  /// element: the unknowns of an element are then consecutive.
  void number_along_the_beam(const ReferenceElement& reference) {
    const std::size_t last_node = 6 * (reference.n_nodes() - 1);
    const std::size_t points = 6 * reference.n_points();
    std::vector<dealii::types::global_dof_index> numbers(dof_handler.n_dofs());
    for (std::size_t e = 0; e < unknowns.size(); ++e)
      for (std::size_t row = 0; row < unknowns[e].size(); ++row) {
        std::size_t place = row;
        if (row >= last_node) place = row < last_node + 6 ? row + points : row - 6;
        numbers[unknowns[e][row]] =
            static_cast<dealii::types::global_dof_index>(e * (last_node + points) + place);
      }
    dof_handler.renumber_dofs(numbers);
    for (auto& element : unknowns)
      for (auto& unknown : element) unknown = numbers[unknown];
  }
};

System::System(ReferenceCurve curve, Mesh mesh, std::vector<Support> supports)
    : curve_(std::move(curve)), mesh_(std::move(mesh)), supports_(std::move(supports)) {
  require_valid(mesh_);
  require_straight_where_moving(mesh_, curve_);
  double compliance = 0;
  for (const Section& section : mesh_.sections)
    compliance = std::max(compliance, section.moment_compliance.head<2>().maxCoeff());
  if (!(compliance > 0 && std::isfinite(compliance)))
    throw InputError("a beam needs a section that can bend");
  length_scale_ = mesh_.vertices.back() - mesh_.vertices.front();
  force_scale_ = 1 / (compliance * length_scale_ * length_scale_);

  reference_ = tabulate(dealii::FE_Q<1, 3>(mesh_.degree), dealii::QGauss<1>(mesh_.degree));
  space_ = std::make_unique<DofSpace>(mesh_.degree);
  space_->create(mesh_.n_elements(), reference_);
  supported_.assign(n_unknowns(), false);
  for (const Support& support : supports_) {
    if (support.vertex > mesh_.n_elements())
      throw InputError("a support of a beam refers to a vertex that does not exist");
    for (std::size_t c = 0; c < 3; ++c) {
      if (support.position) supported_[node_unknown(vertex_node(support.vertex), c)] = true;
      if (support.rotation) supported_[node_unknown(vertex_node(support.vertex), 3 + c)] = true;
    }
  }
}

System::~System() = default;
System::System(System&&) noexcept = default;
System& System::operator=(System&&) noexcept = default;

std::size_t System::n_unknowns() const {
  return space_->dof_handler.n_dofs();
}

std::size_t System::node_unknown(std::size_t node, std::size_t c) const {
  const std::size_t p = mesh_.degree;
  const std::size_t element = std::min(node / p, mesh_.n_elements() - 1);
  return space_->unknowns[element][6 * (node - element * p) + c];
}

std::size_t System::point_unknown(std::size_t point, std::size_t c) const {
  const std::size_t p = mesh_.degree;
  return space_->unknowns[point / p][6 * (reference_.n_nodes() + point % p) + c];
}

double System::vertex_arclength(const State& state, std::size_t i) const {
  return mesh_.velocities.empty() ? mesh_.vertices[i]
                                  : mesh_.vertices[i] + state.shift * mesh_.velocities[i];
}

double System::node_arclength(const State& state, std::size_t j) const {
  const std::size_t element = std::min(j / mesh_.degree, mesh_.n_elements() - 1);
  const double a = vertex_arclength(state, element);
  const double b = vertex_arclength(state, element + 1);
  return std::lerp(a, b, reference_.nodes[j - element * mesh_.degree]);
}

State System::reference_state(double shift) const {
  const std::size_t p = mesh_.degree;
  State state;
  state.shift = shift;
  for (std::size_t j = 0; j <= p * mesh_.n_elements(); ++j) {
    const Pose pose = curve_(node_arclength(state, j));
    state.position.push_back(pose.position);
    state.rotation.push_back(pose.rotation);
    Quaternion& q = state.rotation.back();
    if (j > 0 && q.dot(state.rotation[j - 1]) < 0) q.coeffs() = -q.coeffs();
  }
  state.force.assign(p * mesh_.n_elements(), Vector3::Zero());
  state.moment = state.force;
  return state;
}

ElementData System::element_data(const State& state, const Loads& loads,
                                 std::size_t element) const {
  ElementData data;
  data.length = vertex_arclength(state, element + 1) - vertex_arclength(state, element);
  data.section = mesh_.sections[element];
  data.force_per_height = loads.force_per_height;
  if (!loads.force_per_length.empty()) data.force_per_length = loads.force_per_length.at(element);
  std::vector<Vector3> position;
  std::vector<Quaternion> rotation;
  for (std::size_t a = 0; a < reference_.n_nodes(); ++a) {
    const Pose pose = curve_(node_arclength(state, element * mesh_.degree + a));
    position.push_back(pose.position);
    rotation.push_back(pose.rotation);
    if (a > 0 && rotation[a].dot(rotation[a - 1]) < 0) rotation[a].coeffs() = -rotation[a].coeffs();
  }
  set_reference_strains(reference_, position, rotation, data);
  return data;
}

ElementState System::element_state(const State& state, std::size_t element) const {
  const std::size_t p = mesh_.degree;
  return {std::span(state.position).subspan(element * p, p + 1),
          std::span(state.rotation).subspan(element * p, p + 1),
          std::span(state.force).subspan(element * p, p),
          std::span(state.moment).subspan(element * p, p)};
}

Eigen::VectorXd System::element_scales() const {
  Eigen::VectorXd scales(reference_.n_unknowns());
  const double L = length_scale_;
  for (Index block = 0; block < scales.size() / 6; ++block) {
    const bool node = block < static_cast<Index>(reference_.n_nodes());
    scales.segment<3>(6 * block).setConstant(node ? L : force_scale_);
    scales.segment<3>(6 * block + 3).setConstant(node ? 1 : force_scale_ * L);
  }
  return scales;
}

double System::potential_energy(const State& state, const Loads& loads) const {
  double energy = 0;
  for (std::size_t e = 0; e < mesh_.n_elements(); ++e)
    energy += element_energy(reference_, element_data(state, loads, e), element_state(state, e));
  for (const PointLoad& load : loads.points)
    energy -= load.force.dot(state.position[vertex_node(load.vertex)]);
  return energy;
}

void System::add_point_loads(const Loads& loads, double factor, Eigen::VectorXd& residual) const {
  for (const PointLoad& load : loads.points) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto i = static_cast<Index>(c);
      const std::size_t node = vertex_node(load.vertex);
      residual[static_cast<Index>(node_unknown(node, c))] -= factor * load.force[i] / force_scale_;
      residual[static_cast<Index>(node_unknown(node, 3 + c))] -=
          factor * load.moment[i] / (force_scale_ * length_scale_);
    }
  }
}

Eigen::VectorXd System::residual(const State& state, const Loads& loads) const {
  Eigen::VectorXd residual = Eigen::VectorXd::Zero(static_cast<Index>(n_unknowns()));
  const Eigen::VectorXd scales = element_scales() / (force_scale_ * length_scale_);
  Eigen::VectorXd local;
  for (std::size_t e = 0; e < mesh_.n_elements(); ++e) {
    element_residual(reference_, element_data(state, loads, e), element_state(state, e), local,
                     nullptr);
    for (Index i = 0; i < local.size(); ++i)
      residual[static_cast<Index>(space_->unknowns[e][static_cast<std::size_t>(i)])] +=
          scales[i] * local[i];
  }
  add_point_loads(loads, state.load_factor, residual);
  return residual;
}

template <class Visit>
void System::for_each_stiffness(const State& state, const Loads& loads, const Visit& visit) const {
  const Eigen::VectorXd scales = element_scales();
  Eigen::VectorXd residual;
  Eigen::MatrixXd local;
  for (std::size_t e = 0; e < mesh_.n_elements(); ++e) {
    element_residual(reference_, element_data(state, loads, e), element_state(state, e), residual,
                     &local);
    const auto& unknowns = space_->unknowns[e];
    for (Index j = 0; j < local.cols(); ++j)
      for (Index i = 0; i < local.rows(); ++i)
        visit(unknowns[static_cast<std::size_t>(i)], unknowns[static_cast<std::size_t>(j)],
              scales[i] * local(i, j) * scales[j] / (force_scale_ * length_scale_));
  }
}

Eigen::MatrixXd System::tangent(const State& state, const Loads& loads) const {
  const auto n = static_cast<Index>(n_unknowns());
  Eigen::MatrixXd tangent = Eigen::MatrixXd::Zero(n, n);
  for_each_stiffness(state, loads, [&](std::size_t i, std::size_t j, double value) {
    tangent(static_cast<Index>(i), static_cast<Index>(j)) += value;
  });
  return tangent;
}

Eigen::VectorXd System::shift_derivative(const State& state, const Loads& loads) const {
  Eigen::VectorXd derivative = Eigen::VectorXd::Zero(static_cast<Index>(n_unknowns()));
  const Eigen::VectorXd scales = element_scales() / force_scale_;
  for (std::size_t e = 0; e < mesh_.n_elements() && !mesh_.velocities.empty(); ++e) {
    const double rate = mesh_.velocities[e + 1] - mesh_.velocities[e];
    if (rate == 0) continue;
    const Eigen::VectorXd local = element_length_derivative(
        reference_, element_data(state, loads, e), element_state(state, e));
    for (Index i = 0; i < local.size(); ++i)
      derivative[static_cast<Index>(space_->unknowns[e][static_cast<std::size_t>(i)])] +=
          rate * scales[i] * local[i];
  }
  return derivative;
}

Eigen::VectorXd System::point_load_derivative(const Loads& loads) const {
  Eigen::VectorXd derivative = Eigen::VectorXd::Zero(static_cast<Index>(n_unknowns()));
  add_point_loads(loads, 1, derivative);
  return derivative;
}

void System::factorize(const State& state, const Loads& loads) {
  BandMatrix& matrix = space_->matrix;
  matrix.set_zero();
  for_each_stiffness(state, loads, [&](std::size_t i, std::size_t j, double value) {
    if (!supported_[i] && !supported_[j]) matrix.add(i, j, value);
  });
  for (std::size_t i = 0; i < n_unknowns(); ++i)
    if (supported_[i]) matrix.add(i, i, 1);
  if (!matrix.is_finite()) throw SolverError("the tangent of the beam is not a number");
  if (!matrix.factorize()) throw SolverError("the tangent of the beam is singular");
}

Eigen::VectorXd System::solve(const Eigen::VectorXd& right_hand_side) const {
  Eigen::VectorXd solution = right_hand_side;
  for (std::size_t i = 0; i < n_unknowns(); ++i)
    if (supported_[i]) solution[static_cast<Index>(i)] = 0;
  space_->matrix.solve(solution);
  return solution;
}

void System::update(State& state, const Eigen::VectorXd& increment) const {
  const auto block = [&](std::size_t first) {
    return [&increment, first](const auto& unknown) {
      Vector3 values;
      for (std::size_t c = 0; c < 3; ++c)
        values[static_cast<Index>(c)] = increment[static_cast<Index>(unknown(first + c))];
      return values;
    };
  };
  for (std::size_t j = 0; j < state.position.size(); ++j) {
    const auto unknown = [&](std::size_t c) { return node_unknown(j, c); };
    state.position[j] += length_scale_ * block(0)(unknown);
    state.rotation[j] = (exponential(block(3)(unknown)) * state.rotation[j]).normalized();
  }
  for (std::size_t k = 0; k < state.force.size(); ++k) {
    const auto unknown = [&](std::size_t c) { return point_unknown(k, c); };
    state.force[k] += force_scale_ * block(0)(unknown);
    state.moment[k] += force_scale_ * length_scale_ * block(3)(unknown);
  }
}

void System::prescribe(State& state, const Loads& loads) const {
  for (const Support& support : supports_) {
    const std::size_t node = vertex_node(support.vertex);
    Vector3 displacement = Vector3::Zero();
    Vector3 rotation = Vector3::Zero();
    for (const PrescribedDisplacement& end : loads.displacements) {
      if (end.vertex != support.vertex) continue;
      displacement += end.displacement;
      rotation += end.rotation;
    }
    const Pose pose = curve_(vertex_arclength(state, support.vertex));
    if (support.position) state.position[node] = pose.position + displacement;
    if (support.rotation) {
      Quaternion& q = state.rotation[node];
      const Quaternion before = q;
      q = exponential(rotation) * pose.rotation;
      if (q.dot(before) < 0) q.coeffs() = -q.coeffs();
    }
  }
}

Vector3 System::reaction(const Eigen::VectorXd& residual, std::size_t vertex) const {
  Vector3 force;
  for (std::size_t c = 0; c < 3; ++c)
    force[static_cast<Index>(c)] =
        force_scale_ * residual[static_cast<Index>(node_unknown(vertex_node(vertex), c))];
  return force;
}

}  // namespace ciliaval::fem::beam

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/system.h"

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <cmath>

#include "fem/beam/kinematics.h"
#include "problem/error.h"
#include "problem/lagrange.h"
#include "problem/support/interruption.h"

namespace ciliaval::fem::beam {
namespace {

using Eigen::Index;

ReferenceElement tabulate(unsigned int degree) {
  ReferenceElement element;
  const dealii::QGaussLobatto<1> lobatto(degree + 1);
  for (const dealii::Point<1>& node : lobatto.get_points()) element.nodes.push_back(node[0]);
  QuadratureRule gauss = gauss_legendre(degree, 0, 1);
  element.points = std::move(gauss.nodes);
  element.weights = std::move(gauss.weights);
  const LagrangeBasis basis(element.nodes);
  std::vector<double> N(degree + 1);
  std::vector<double> D(degree + 1);
  element.values.resize(degree, degree + 1);
  element.derivatives.resize(degree, degree + 1);
  for (unsigned int g = 0; g < degree; ++g) {
    basis.values_and_derivatives(element.points[g], N, D);
    for (unsigned int a = 0; a <= degree; ++a) {
      element.values(g, a) = N[a];
      element.derivatives(g, a) = D[a];
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

/// element_length_derivative() holds for Γ₀ = e₃ and K₀ = 0 only.
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

/// sum += factor · of_elements; an empty one is zero.
template <class Force>
void add(double factor, const std::vector<Force>& of_elements, std::vector<Force>& sum) {
  if (sum.size() < of_elements.size()) sum.resize(of_elements.size(), Force::Zero());
  for (std::size_t e = 0; e < of_elements.size(); ++e) sum[e] += factor * of_elements[e];
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
    add(factor, loads->force_per_length, sum.force_per_length);
    add(factor, loads->magnetic_force, sum.magnetic_force);
    add(factor, loads->transverse_force, sum.transverse_force);
    if (!loads->magnetic_force.empty()) sum.magnetic_energy = loads->magnetic_energy;
    if (!loads->magnetic_charge.empty()) sum.magnetic_charge = loads->magnetic_charge;
    if (!loads->transverse_charge.empty()) sum.transverse_charge = loads->transverse_charge;
    if (loads->pin) sum.pin = loads->pin;
  }
  sum.magnets = surroundings::magnets::superposed(a, x.magnets, b, y.magnets);
  return sum;
}

System::System(ReferenceCurve curve, Mesh mesh, std::vector<Support> supports)
    : curve_(std::move(curve)), mesh_(std::move(mesh)), supports_(std::move(supports)) {
  require_valid(mesh_);
  require_straight_where_moving(mesh_, curve_);
  double compliance = 0;
  for (const Section& section : mesh_.sections)
    if (!section.is_joint)
      compliance = std::max(compliance, section.moment_compliance.head<2>().maxCoeff());
  if (!(compliance > 0 && std::isfinite(compliance)))
    throw InputError("a beam needs a section that can bend");
  length_scale_ = mesh_.vertices.back() - mesh_.vertices.front();
  force_scale_ = 1 / (compliance * length_scale_ * length_scale_);

  reference_ = tabulate(mesh_.degree);
  matrix_ = BandMatrix(n_unknowns(), static_cast<std::size_t>(reference_.n_unknowns()) - 1);
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

std::size_t System::element_unknown(std::size_t element, Index row) const {
  const std::size_t p = mesh_.degree;
  const auto local = static_cast<std::size_t>(row);
  const std::size_t nodal = 6 * (p + 1);
  return local < nodal ? node_unknown(element * p + local / 6, local % 6)
                       : point_unknown(element * p + (local - nodal) / 6, local % 6);
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
  if (!loads.magnetic_force.empty()) data.magnetic_force = loads.magnetic_force.at(element);
  data.magnetic_energy = loads.magnetic_energy;
  if (!loads.transverse_force.empty()) data.transverse_force = loads.transverse_force.at(element);
  if (!loads.magnetic_charge.empty()) data.magnetic_charge = loads.magnetic_charge.at(element);
  if (!loads.transverse_charge.empty())
    data.transverse_charge = loads.transverse_charge.at(element);
  data.magnets = loads.magnets;
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

template <class Visit>
void System::for_each_pole(const Loads& loads, const Visit& visit) const {
  if (loads.magnets.empty() || loads.magnetic_charge.empty() ||
      loads.magnetic_energy != surroundings::MagneticEnergy::F)
    return;
  double below = 0;
  for (std::size_t e = 0; e <= mesh_.n_elements(); ++e) {
    const double above = e < mesh_.n_elements() ? loads.magnetic_charge[e] : 0;
    if (below != above) visit(e, below - above);
    below = above;
  }
}

void System::add_poles(const State& state, const Loads& loads, Eigen::VectorXd& residual) const {
  for_each_pole(loads, [&](std::size_t vertex, double charge) {
    const std::size_t node = vertex_node(vertex);
    residual.segment<3>(static_cast<Index>(node_unknown(node, 0))) -=
        charge / force_scale_ * surroundings::magnets::jet(loads.magnets, state.position[node]).B;
  });
}

Vector3 System::force_of_magnets(const State& state, const Loads& loads) const {
  Loads without = loads;
  without.magnets.clear();
  const Eigen::VectorXd difference = residual(state, without) - residual(state, loads);
  Vector3 force = Vector3::Zero();
  for (std::size_t j = 0; j < state.position.size(); ++j)
    force += force_scale_ * difference.segment<3>(static_cast<Index>(node_unknown(j, 0)));
  return force;
}

void System::add_point_loads(const Loads& loads, double factor, Eigen::VectorXd& residual) const {
  for (const PointLoad& load : loads.points) {
    const auto row = static_cast<Index>(node_unknown(vertex_node(load.vertex), 0));
    residual.segment<3>(row) -= factor * load.force / force_scale_;
    residual.segment<3>(row + 3) -= factor * load.moment / (force_scale_ * length_scale_);
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
      residual[static_cast<Index>(element_unknown(e, i))] += scales[i] * local[i];
  }
  add_point_loads(loads, state.load_factor, residual);
  if (loads.pin) {
    const std::size_t node = vertex_node(loads.pin->vertex);
    const touch::PinForce pin = touch::pin_force(*loads.pin, state.rotation[node], state.pin);
    const auto row = static_cast<Index>(node_unknown(node, 0));
    residual.segment<3>(row) -= pin.force.value / force_scale_;
    residual.segment<3>(row + 3) -= pin.couple.value / (force_scale_ * length_scale_);
  }
  add_poles(state, loads, residual);
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
    for (Index j = 0; j < local.cols(); ++j)
      for (Index i = 0; i < local.rows(); ++i)
        visit(element_unknown(e, i), element_unknown(e, j),
              scales[i] * local(i, j) * scales[j] / (force_scale_ * length_scale_));
  }
  for_each_pole(loads, [&](std::size_t vertex, double charge) {
    const std::size_t node = vertex_node(vertex);
    const Matrix3 K = -charge * length_scale_ / force_scale_ *
                      surroundings::magnets::jet(loads.magnets, state.position[node]).gradient;
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t i = 0; i < 3; ++i)
        visit(node_unknown(node, i), node_unknown(node, j),
              K(static_cast<Index>(i), static_cast<Index>(j)));
  });
  if (!loads.pin) return;
  const std::size_t node = vertex_node(loads.pin->vertex);
  const touch::PinForce pin = touch::pin_force(*loads.pin, state.rotation[node], state.pin);
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto r = static_cast<Index>(i);
      const auto c = static_cast<Index>(j);
      visit(node_unknown(node, i), node_unknown(node, 3 + j),
            -pin.force.by_spin(r, c) / force_scale_);
      visit(node_unknown(node, 3 + i), node_unknown(node, 3 + j),
            -pin.couple.by_spin(r, c) / (force_scale_ * length_scale_));
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
      derivative[static_cast<Index>(element_unknown(e, i))] += rate * scales[i] * local[i];
  }
  return derivative;
}

Eigen::VectorXd System::point_load_derivative(const Loads& loads) const {
  Eigen::VectorXd derivative = Eigen::VectorXd::Zero(static_cast<Index>(n_unknowns()));
  add_point_loads(loads, 1, derivative);
  return derivative;
}

Eigen::VectorXd System::pin_derivative(const State& state, const Loads& loads,
                                       Index component) const {
  Eigen::VectorXd derivative = Eigen::VectorXd::Zero(static_cast<Index>(n_unknowns()));
  const std::size_t node = vertex_node(loads.pin->vertex);
  const touch::PinForce pin = touch::pin_force(*loads.pin, state.rotation[node], state.pin);
  const auto row = static_cast<Index>(node_unknown(node, 0));
  derivative.segment<3>(row) = -pin.force_by.col(component);
  derivative.segment<3>(row + 3) = -pin.couple_by.col(component) / length_scale_;
  return derivative;
}

void System::factorize(const State& state, const Loads& loads) {
  support::check_interruption();
  matrix_.set_zero();
  for_each_stiffness(state, loads, [&](std::size_t i, std::size_t j, double value) {
    if (!supported_[i] && !supported_[j]) matrix_.add(i, j, value);
  });
  for (std::size_t i = 0; i < n_unknowns(); ++i)
    if (supported_[i]) matrix_.add(i, i, 1);
  if (!matrix_.is_finite()) throw SolverError("the tangent of the beam is not a number");
  if (!matrix_.factorize()) throw SolverError("the tangent of the beam is singular");
}

Eigen::VectorXd System::solve(const Eigen::VectorXd& right_hand_side) const {
  Eigen::VectorXd solution = right_hand_side;
  for (std::size_t i = 0; i < n_unknowns(); ++i)
    if (supported_[i]) solution[static_cast<Index>(i)] = 0;
  matrix_.solve(solution);
  return solution;
}

void System::update(State& state, const Eigen::VectorXd& increment) const {
  for (std::size_t j = 0; j < state.position.size(); ++j) {
    const auto row = static_cast<Index>(node_unknown(j, 0));
    state.position[j] += length_scale_ * increment.segment<3>(row);
    state.rotation[j] =
        (exponential(increment.segment<3>(row + 3)) * state.rotation[j]).normalized();
  }
  for (std::size_t k = 0; k < state.force.size(); ++k) {
    const auto row = static_cast<Index>(point_unknown(k, 0));
    state.force[k] += force_scale_ * increment.segment<3>(row);
    state.moment[k] += force_scale_ * length_scale_ * increment.segment<3>(row + 3);
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
  return force_scale_ *
         residual.segment<3>(static_cast<Index>(node_unknown(vertex_node(vertex), 0)));
}

}  // namespace ciliaval::fem::beam

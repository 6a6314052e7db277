// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "fem/beam/band_matrix.h"
#include "fem/beam/element.h"
#include "fem/beam/touch/pin_force.h"

namespace ciliaval::fem::beam {

/// Position and rotation of a cross-section: r and the directors d_i = Λ e_i.
struct Pose {
  Vector3 position = Vector3::Zero();
  Quaternion rotation = Quaternion::Identity();
};

/// The stress-free reference curve as a function of its arc length S (m); d₃ is its unit tangent.
using ReferenceCurve = std::function<Pose(double S)>;

/// r = S e_z, d_i = e_i.
Pose straight_curve(double S);

/// Elements between vertices S₀ ≤ S₁ ≤ … of the reference curve.
struct Mesh {
  std::vector<double> vertices;   ///< S_i, m; equal neighbours make an element of zero length
  std::vector<Section> sections;  ///< one for each element
  unsigned int degree = 3;        ///< p, of r and q; the section forces have p − 1
  /// ∂S_i/∂s of a mesh that moves with one scalar s (m); empty: it does not move. Where it moves,
  /// the reference curve must be straight and the section uniform.
  std::vector<double> velocities;

  std::size_t n_elements() const { return sections.size(); }
};

/// Degrees of freedom of a vertex that are prescribed (Loads::displacements; zero by default).
struct Support {
  std::size_t vertex = 0;
  bool position = true;  ///< all three components of r
  bool rotation = true;  ///< Λ
};

/// Dead force (N) and dead moment (N·m) on a vertex, spatial components.
struct PointLoad {
  std::size_t vertex = 0;
  Vector3 force = Vector3::Zero();
  Vector3 moment = Vector3::Zero();
};

/// Displacement u (m) and rotation vector (rad, from the reference) of a supported vertex.
struct PrescribedDisplacement {
  std::size_t vertex = 0;
  Vector3 displacement = Vector3::Zero();
  Vector3 rotation = Vector3::Zero();
};

/// The loads of the beam, which can be ramped.
struct Loads {
  std::vector<PointLoad> points;               ///< several on one vertex add up
  std::vector<Vector3> force_per_length;       ///< dead, N/m, one for each element; empty: none
  Vector3 force_per_height = Vector3::Zero();  ///< per unit of current height z, N/m
  std::vector<Vector3> magnetic_force;         ///< c of each element (ElementData), N; empty: none
  surroundings::MagneticEnergy magnetic_energy = surroundings::MagneticEnergy::F;
  std::vector<Matrix32> transverse_force;              ///< C of each element, N; empty: none
  std::vector<double> magnetic_charge;                 ///< M A of each element, A·m; empty: none
  std::vector<Eigen::Vector2d> transverse_charge;      ///< A (M₁, M₂), A·m; empty: none
  std::vector<surroundings::magnets::Magnet> magnets;  ///< beside the beam
  std::vector<PrescribedDisplacement> displacements;
  std::optional<touch::Pin> pin;  ///< its force is of the state and not ramped
};

/// a·x + b·y in every load; of magnets in their fields.
Loads combine(double a, const Loads& x, double b, const Loads& y);

/// State of the beam. Node e·p + a is node a of element e; Gauss point e·p + g its point g.
struct State {
  std::vector<Vector3> position;     ///< r, m
  std::vector<Quaternion> rotation;  ///< q
  std::vector<Vector3> force;        ///< n, material components, N
  std::vector<Vector3> moment;       ///< m, material components, N·m
  double shift = 0;        ///< s: vertices are at S_i + s ∂S_i/∂s, m (moving meshes only)
  double load_factor = 1;  ///< multiplies the point loads that Newton's method finds a factor for
  Eigen::Vector2d pin = Eigen::Vector2d::Zero();  ///< N, T of Loads::pin, N
};

/// The discrete beam: residual, tangent and their scaling. All vectors of unknowns are
/// dimensionless: lengths by L, forces by P = B/L², moments by B/L with B the softest bending
/// stiffness, so that the direct solver sees a well-scaled matrix at any slenderness.
class System {
 public:
  /// Throws InputError if the mesh, the supports and the curve do not fit together.
  System(ReferenceCurve curve, Mesh mesh, std::vector<Support> supports);

  const Mesh& mesh() const { return mesh_; }
  const ReferenceElement& reference_element() const { return reference_; }
  std::size_t n_unknowns() const { return 12 * mesh_.degree * mesh_.n_elements() + 6; }
  double length_scale() const { return length_scale_; }  ///< L, m
  double force_scale() const { return force_scale_; }    ///< P, N

  /// Arc length of vertex i, node j or Gauss point k at the state's shift, m.
  double vertex_arclength(const State& state, std::size_t i) const;
  double node_arclength(const State& state, std::size_t j) const;

  State reference_state(double shift = 0) const;
  /// hK₀ and h of an element at the state's shift: for the total material curvature K + K₀.
  ElementData element_data(const State& state, const Loads& loads, std::size_t element) const;

  /// Π(state) less the work of the dead loads, J; force_per_height has no potential, and that of
  /// magnets by the law F is left out.
  double potential_energy(const State& state, const Loads& loads) const;
  /// Dimensionless residual; the rows of supports hold the reactions (+ on the beam).
  Eigen::VectorXd residual(const State& state, const Loads& loads) const;
  /// Dimensionless tangent without supports, dense: for tests and small systems.
  Eigen::MatrixXd tangent(const State& state, const Loads& loads) const;
  /// ∂(residual)/∂(s/L) at fixed nodal state.
  Eigen::VectorXd shift_derivative(const State& state, const Loads& loads) const;
  /// Force of the magnets on the beam, N.
  Vector3 force_of_magnets(const State& state, const Loads& loads) const;
  /// Derivative of the residual by a factor on the point loads.
  Eigen::VectorXd point_load_derivative(const Loads& loads) const;
  /// The same by N/P (component 0) or T/P (1) of the pin.
  Eigen::VectorXd pin_derivative(const State& state, const Loads& loads,
                                 Eigen::Index component) const;

  /// Factorises the tangent with the supports held. Throws SolverError if it is singular.
  void factorize(const State& state, const Loads& loads);
  /// Solves with the last factors; supported unknowns are zero.
  Eigen::VectorXd solve(const Eigen::VectorXd& right_hand_side) const;

  /// r ← r + L δ, q ← exp(δ) q, n ← n + P δ, m ← m + P L δ.
  void update(State& state, const Eigen::VectorXd& increment) const;
  /// Sets the supported vertices to their prescribed displacements.
  void prescribe(State& state, const Loads& loads) const;
  /// True for each unknown that a support holds.
  const std::vector<bool>& supported() const { return supported_; }

  /// Index of component c of the position (c = 0..2) or spin (3..5) of a node, of the force or
  /// moment of a Gauss point. Numbered along the beam: an element's first vertex, interior nodes
  /// and Gauss points, then the next element's, so that the tangent is a band.
  std::size_t node_unknown(std::size_t node, std::size_t c) const {
    const std::size_t p = mesh_.degree;
    return 12 * p * (node / p) + 6 * (node % p) + c;
  }
  std::size_t point_unknown(std::size_t point, std::size_t c) const {
    const std::size_t p = mesh_.degree;
    return 12 * p * (point / p) + 6 * (p + point % p) + c;
  }
  std::size_t vertex_node(std::size_t vertex) const { return vertex * mesh_.degree; }
  /// Force (N) that the support of a vertex exerts on the beam, from the residual.
  Vector3 reaction(const Eigen::VectorXd& residual, std::size_t vertex) const;

 private:
  /// Global unknown of an element's row, in the order of ReferenceElement.
  std::size_t element_unknown(std::size_t element, Eigen::Index row) const;
  ElementState element_state(const State& state, std::size_t element) const;
  /// visit(i, j, value) for each entry of the elements' dimensionless tangents.
  template <class Visit>
  void for_each_stiffness(const State& state, const Loads& loads, const Visit& visit) const;
  /// visit(vertex, q) for the magnetic poles of the law F, q in A·m, if there are magnets.
  template <class Visit>
  void for_each_pole(const Loads& loads, const Visit& visit) const;
  void add_poles(const State& state, const Loads& loads, Eigen::VectorXd& residual) const;
  void add_point_loads(const Loads& loads, double factor, Eigen::VectorXd& residual) const;
  Eigen::VectorXd element_scales() const;

  ReferenceCurve curve_;
  Mesh mesh_;
  std::vector<Support> supports_;
  double length_scale_ = 1;
  double force_scale_ = 1;
  ReferenceElement reference_;
  BandMatrix matrix_;
  std::vector<bool> supported_;
};

}  // namespace ciliaval::fem::beam

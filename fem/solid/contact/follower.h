// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fem/solid/contact/nodal_contact.h"
#include "fem/solid/discretisation/extruded_quadrature.h"
#include "fem/solid/equilibrium/newton.h"
#include "problem/mechanics_model.h"
#include "problem/surroundings/surface.h"

namespace ciliaval::fem::solid::contact {

/// Place of the surface, and what else holds the tip on the way to the first place.
struct SweepPlace {
  double interference = 0;  ///< δ, m: H is the surface's own less this
  double travel = 0;        ///< s, m: beyond the surface's own
  double hold = 0;          ///< dead force along e on the tip's section, N
};

/// An equilibrium of the body under the surface. Energy and forces are those of the whole body.
struct ContactState {
  SweepPlace place;
  discretisation::SolidState solid;
  std::vector<NodeMemory> memory;
  std::vector<NodeForce> forces;
  double energy = 0;                ///< elastic, J
  Vector3 force = Vector3::Zero();  ///< of the surface on the body, N
};

/// State from which a follower goes on.
struct FollowerState {
  ContactState now;
  std::optional<ContactState> before;  ///< for the prediction of the next one
  double step = 0;                     ///< the next one of the surface, m
};

struct FollowerOptions {
  equilibrium::NewtonOptions newton;
  double young_modulus = 0;  ///< of what touches, Pa; the augmented Lagrangian's stiffness is this
                             ///< times the diameter and 10³
  double diameter = 0;       ///< d, m
  double length = 0;         ///< L, m
  double tip_stiffness = 0;  ///< 3EI/L³ of a slender cilium of the softest segment, N/m
};

/// Outcome of the way to a place; works in J.
struct FollowerOutcome {
  bool converged = false;
  std::string trouble;
  double surface_work = 0;
  double friction_work = 0;
  std::optional<double> energy_lost;
  int iterations = 0;
};

/// Quasi-static equilibria of the body under a rigid surface on its way (docs/theory/sweep.md).
///
/// A step is accepted if Newton's method converges and the energies balance: the change of the
/// elastic energy is the surface's work less the friction's, both by the trapezoidal rule. Else it
/// is cut. Below the shortest step the body has jumped: the node that bears most slides on over the
/// surface, held back, to where friction alone holds it. If it lifts off, or if it did not slide,
/// the way to the next equilibrium is that of a body with a damping in proportion to its mass,
/// without inertia.
class Follower {
 public:
  /// The space, the quadrature, the solver and the surface's profile must outlive it.
  Follower(const discretisation::SolidSpace& space,
           const discretisation::ExtrudedQuadrature& quadrature, equilibrium::Newton& newton,
           const RigidSurface& surface, const FollowerOptions& options);

  /// The free body at a place: straight, if it does not touch there; else a horizontal force bends
  /// it aside, the less the better, to where the surface is out of its way. Throws InputError if
  /// there is no room under the surface for a tip at 0.6 of the length, SolverError if Newton's
  /// method fails.
  void start(SweepPlace place);

  /// Goes on a straight line. The state stays at the last equilibrium if it does not get there.
  FollowerOutcome go(const SweepPlace& target, const Progress& progress = {});

  const ContactState& current() const { return state_.now; }
  const FollowerState& state() const { return state_; }
  void restore(FollowerState state) { state_ = std::move(state); }
  const std::vector<ContactNode>& nodes() const { return nodes_; }
  /// Largest depth of the body in the surface between its nodes, m.
  double penetration() const {
    return penetration_between(nodes_, faces_, surface_at(current().place),
                               current().solid.displacement);
  }
  RigidSurface surface_at(const SweepPlace& place) const;
  /// Copies of the mesh in the whole body: 1, or 2 of a half.
  double copies() const { return copies_; }

 private:
  struct Work {
    double surface = 0;   ///< done by the surface, J
    double friction = 0;  ///< spent on it, J
    void add(const Work& other) {
      surface += other.surface;
      friction += other.friction;
    }
  };
  /// Forces and supports that hold the body back on its way to the next equilibrium.
  struct Brake {
    double damping = 0;  ///< α of a force −α m (u − u₀), m the node's volume, N/m⁴
    std::optional<std::size_t> driver{};  ///< a node that sticks at its place, whatever it takes
  };
  /// The equilibrium at a place, from a state near it. The nodes remember `from`. Empty if Newton's
  /// method fails, or if the driver is drawn away from the surface.
  std::optional<ContactState> attempt(const SweepPlace& place, const ContactState& from,
                                      const discretisation::SolidState& start, const Brake& brake,
                                      int& iterations);
  bool is_free(const SweepPlace& place) const;
  discretisation::SolidState predicted(const SweepPlace& place) const;
  Work work(const ContactState& from, const ContactState& to) const;
  /// Error of the balance of energy of a step to the state, over what is allowed.
  double imbalance(const ContactState& to) const;
  void accept(ContactState&& state, FollowerOutcome& outcome);
  /// At the place, from the current state to the next stable equilibrium.
  bool jump(const SweepPlace& place, FollowerOutcome& outcome, const Progress& progress);
  /// The node that bears most is led over the surface, the way it slides, up to where friction
  /// holds it. False if it lifts off before.
  bool walk(const SweepPlace& place, ContactState& state, Work& spent, int& iterations);
  /// Damped in proportion to the mass, without inertia.
  bool relax(const SweepPlace& place, ContactState& state, Work& spent, int& iterations,
             const Progress& progress);

  const discretisation::SolidSpace& space_;
  equilibrium::Newton& newton_;
  RigidSurface surface_;
  FollowerOptions options_;
  std::vector<ContactNode> nodes_;
  std::vector<ContactFace> faces_;
  ContactLaw law_;
  discretisation::Vector volumes_;  ///< of the nodes, m³
  discretisation::Vector hold_;     ///< nodal forces of a unit holding force
  double copies_;
  double volume_;
  double longest_;  ///< step of the surface, m
  FollowerState state_;
};

}  // namespace ciliaval::fem::solid::contact

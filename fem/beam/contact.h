// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <map>
#include <optional>
#include <string>

#include "fem/beam/cilium_beam.h"

namespace ciliaval::fem::beam {

/// What came of one load of a path, before it is turned into a MechanicsStep.
struct BeamStep {
  Status status = Status::failed;
  std::string message;
  std::optional<double> slip_off_force;     ///< N, if it slipped off
  std::optional<double> contact_arclength;  ///< m
  int iterations = 0;
};

/// Horizontal force that stays at height h while the cilium slides under it. The point of contact
/// is a vertex that moves along the cilium: its height is h, and its arc length s_c is the unknown
/// that goes with that equation in Newton's method. The vertex starts in the segment that holds h.
/// Where it comes to the end of its segment, the force with which that end is at h is found, and
/// the same equilibrium goes on with the vertex at the lower end of the next segment. Of the last
/// segment that is the slip-off force.
class ContactSolver {
 public:
  ContactSolver(Cilium cilium, BeamOptions options)
      : cilium_(std::move(cilium)), options_(options) {}

  BeamStep solve(const ContactLoad& load, const PathProgress& progress);

  /// The beam, its state and its loads after a converged step.
  const CiliumBeam& beam() const { return *beam_; }
  const State& state() const { return state_; }
  const Loads& applied() const { return applied_; }

 private:
  enum class Leg { load_reached, end_reached, failed };

  /// The unloaded cilium with the vertex at S = h.
  void stand_straight(const ContactLoad& load);
  /// Raises or lowers the force to that of `load` or to that at the segment's end.
  Leg follow(const ContactLoad& load, BeamStep& step, const PathProgress& progress);
  /// Newton's method with s_c for the unknown; false if it fails.
  bool find_arclength(State& state, double force, BeamStep& step, const PathProgress& progress);
  /// Newton's method with the force for the unknown and s_c given by state.shift. The force is the
  /// first guess and the result; false if it fails.
  bool find_force(State& state, double& force, BeamStep& step);
  /// From the upper end of the segment to the lower end of the next, the same point.
  void enter_next_segment();
  double host_length() const { return cilium_.segments[host_].length; }

  Cilium cilium_;
  BeamOptions options_;
  std::map<double, double> slip_off_forces_;  ///< by height
  std::optional<CiliumBeam> beam_;
  State state_;
  Loads applied_;
  std::optional<ContactLoad> last_;  ///< that state_ is in equilibrium with
  std::size_t host_ = 0;             ///< segment of the vertex
  double entry_force_ = 0;           ///< with which s_c is at the lower end of the host, N
};

}  // namespace ciliaval::fem::beam

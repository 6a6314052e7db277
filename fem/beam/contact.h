// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>
#include <utility>

#include "fem/beam/cilium_beam.h"

namespace ciliaval::fem::beam {

/// Horizontal force that stays at height h while the cilium slides under it. The point of contact
/// is a vertex that moves along the cilium: z = h is one more equation of Newton's method, and its
/// arc length s_c one more unknown. A contact load gives the force; a probe gives the deflection δ
/// of the vertex, and the force is a second unknown. The vertex starts in the segment that holds h.
/// At the end of its segment the force is found with which that end is at h, and the vertex goes on
/// at the lower end of the next segment, above the joint if there is one. At the end of the last
/// segment the contact slips off.
class ContactSolver {
 public:
  ContactSolver(Cilium cilium, BeamOptions options, joints::Corrections corrections)
      : cilium_(std::move(cilium)), options_(options), corrections_(std::move(corrections)) {}

  /// From the cilium that the environment alone bends; nothing of an earlier load is kept. The load
  /// is a ContactLoad or a ProbeLoad.
  MechanicsStep solve(const Load& load, const PathProgress& progress);

  /// The beam, its state and its loads after a converged step.
  const CiliumBeam& beam() const { return *beam_; }
  const State& state() const { return current_.state; }
  const Loads& applied() const { return applied_; }

 private:
  enum class Leg { load_reached, end_reached, failed };
  /// Force and displacement at which the tip sinks to the contact height.
  struct SlipOff {
    double force = 0;         ///< N
    double displacement = 0;  ///< m
  };
  /// An equilibrium: the state and the force that goes with it.
  struct Loaded {
    State state;
    double force = 0;  ///< N
  };

  /// The cilium that no force touches, with the vertex at z = h: straight, or bent by the
  /// environment. False if that bends it below h, or if no equilibrium is found.
  bool stand_untouched(const Load& load, MechanicsStep& step);
  /// S of the material point at z = h of the cilium that the environment bends.
  std::optional<double> untouched_arclength(const Load& load, MechanicsStep& step) const;
  /// Raises or lowers the magnitude to the load's, or to its value at the segment's end.
  Leg follow(const Load& load, MechanicsStep& step, const PathProgress& progress);
  /// Newton's method with s_c for the unknown, and of a probe the force; false if it fails.
  bool find_arclength(Loaded& trial, double magnitude, MechanicsStep& step,
                      const PathProgress& progress);
  /// Newton's method with the force for the unknown, which is also the guess, and s_c given by the
  /// state's shift; false if it fails.
  bool find_force(Loaded& trial, MechanicsStep& step);
  /// The same at the end of the host; false if it fails or the magnitude is not between `from` and
  /// `aim`.
  bool go_to_end(Loaded crossing, double from, double aim, MechanicsStep& step);
  /// First increment of the magnitude from the straight cilium.
  double first_increment() const;
  /// The force or the displacement of an equilibrium, whichever the load prescribes.
  double magnitude_of(const Loaded& trial) const;
  double displacement_of(const State& state) const;
  Loads force_at_vertex(double force) const;
  /// From the upper end of the segment to the lower end of the next: the same point, or the other
  /// side of a joint, which the force then loads. False if there is no equilibrium or if the load
  /// is between those of the two sides.
  bool enter_next_segment(const Load& load, MechanicsStep& step);
  double host_length() const { return cilium_.segments[host_].length; }

  Cilium cilium_;
  BeamOptions options_;
  joints::Corrections corrections_;
  std::optional<CiliumBeam> beam_;
  Loaded current_;
  Loads applied_;
  std::optional<Load> last_;  ///< that current_ is in equilibrium with
  std::size_t host_ = 0;      ///< segment of the vertex
};

}  // namespace ciliaval::fem::beam

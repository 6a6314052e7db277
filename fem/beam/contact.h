// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fem/beam/cilium_beam.h"

namespace ciliaval::fem::beam {

/// What came of one load of a path, before it is turned into a MechanicsStep.
struct BeamStep {
  Status status = Status::failed;
  std::string message;
  std::optional<double> slip_off_force;     ///< N
  std::optional<double> contact_arclength;  ///< m
  int iterations = 0;
};

/// Horizontal force that stays at height h while the cilium slides under it. The point of contact
/// is a vertex that moves along the cilium: its height is h, and its arc length s_c is the unknown
/// that goes with that equation in Newton's method. The segment that holds s_c follows from the
/// forces at which the segments' upper ends are at h; that of the tip is the slip-off force.
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
  /// Forces (N) with which the upper end of each segment is at height h; 0 if it starts below h.
  const std::vector<double>& limit_forces(double height, int& iterations);
  PathReport follow(const ContactLoad& load, std::size_t host, const std::vector<double>& limits,
                    const PathProgress& progress);

  Cilium cilium_;
  BeamOptions options_;
  std::map<double, std::vector<double>> limits_;
  std::optional<CiliumBeam> beam_;
  State state_;
  Loads applied_;
  std::optional<ContactLoad> last_;  ///< that state_ is in equilibrium with
  std::size_t host_ = 0;
};

/// Force (N) along +x on the loaded vertex with which this vertex sinks to height h (m). Throws
/// SolverError if it is not found.
double force_to_sink(CiliumBeam& beam, double height, const NewtonOptions& options,
                     int& iterations);

}  // namespace ciliaval::fem::beam

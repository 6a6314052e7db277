// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "problem/cilium.h"
#include "problem/continuation/pull_in.h"
#include "problem/deformation.h"
#include "problem/load.h"

namespace ciliaval {

enum class Status {
  converged,
  slipped_off,  ///< the contact force (or the probe's displacement) is larger than in any
                ///< equilibrium: a result, not an error
  pulled_in,    ///< a magnet pulls the cilium in: the equilibrium vanishes in a fold before the
                ///< load is reached: a result, not an error
  failed        ///< the solver did not converge
};

/// Contact of the cilium with the surface of a sweep.
struct SurfaceContact {
  enum class State { open, stick, slip };
  enum class Where { rim, mantle, surface };  ///< of a rod's end disc; of its side; of a solid
  State state = State::open;
  Where where = Where::rim;
  double normal_force = 0;    ///< N ≥ 0, N; of a solid the sum over the surface
  double friction_force = 0;  ///< T, N, positive where it pulls along e
  Vector3 point{0, 0, 0};     ///< where it touches, m; of a solid the centre of pressure
  double elastic_energy = 0;  ///< of the cilium, J
  // Since the step before, J:
  double surface_work = 0;            ///< done by the surface on the cilium
  double friction_work = 0;           ///< spent where the cilium slides on the surface
  std::optional<double> energy_lost;  ///< at jumps from one equilibrium to the next; none: none
};

/// Result of one step of a load path.
struct MechanicsStep {
  Load load;
  Status status = Status::failed;
  std::string message;                     ///< why, if not converged; otherwise empty or a remark
  std::optional<Deformation> deformation;  ///< there if converged
  double applied_force = 0;  ///< the horizontal force along e that the model really applied, N
  std::optional<double> slip_off_force;  ///< contact, probe: the largest force an equilibrium
                                         ///< bears, N, if the model found it
  std::optional<double> slip_off_displacement;  ///< probe: the largest displacement of the contact
                                                ///< point, m, if the model found it
  std::optional<double> slip_off_uncertainty;   ///< of the slip-off force, N, or of a probe's
                                                ///< displacement, m, if the model knows it
  SlipOffPoint slip_off_point = SlipOffPoint::axis;  ///< by which the model judges it
  std::optional<double> contact_arclength;  ///< contact, probe: S of the material point at z = h, m
  std::optional<ProbeContact> touch;        ///< contact, probe with a TouchLaw
  std::optional<SurfaceContact> contact;    ///< sweep
  // Estimates of the numerical error, if the model has one.
  std::optional<double> tip_uncertainty;            ///< of the tip's position, m
  std::optional<double> tip_angle_uncertainty;      ///< rad
  std::optional<double> applied_force_uncertainty;  ///< N
  // Stability, if the model looked: the second variation of the energy at the equilibrium.
  std::optional<int> unstable_modes;  ///< ways in which the energy decreases; 0: stable
  /// Smallest eigenvalue of the second variation over that of the straight cilium without loads.
  std::optional<double> smallest_eigenvalue;
  std::optional<continuation::PullIn> pull_in;  ///< there if pulled in, or if it jumps on the way
  std::size_t unknowns = 0;                     ///< of the largest system solved
  int iterations = 0;                           ///< nonlinear iterations, all cutbacks included
  double seconds = 0;                           ///< wall time
};

/// The largest magnitude that an equilibrium bears, of a contact N, of a probe m, if it is known.
inline std::optional<double> slip_off_limit(const MechanicsStep& step) {
  return step.load.is<ProbeLoad>() ? step.slip_off_displacement : step.slip_off_force;
}

/// A part of the estimate of the discretisation error: how far two solutions of the same load path
/// are apart. They are the result itself, 0, or one of its companions, i for the companion i − 1.
struct ErrorPart {
  std::string direction;  ///< what is finer in the one of them
  std::size_t finer = 0;
  std::size_t coarser = 0;
  double factor = 1;  ///< error of the result over their difference
};

struct MechanicsResult {
  Deformation undeformed;            ///< the straight cilium in this model's own discretisation
  std::vector<MechanicsStep> steps;  ///< one for each load of the path
  /// The same path by other discretisations, from which the error of any quantity is estimated
  /// (problem/error_estimate.h). Their own errors are not.
  std::vector<MechanicsResult> companions{};
  std::vector<ErrorPart> error_parts{};  ///< none: the model has no such estimate
  /// Error of the solution of the discrete equations: of lengths over L, of angles in rad, of
  /// forces over the applied one.
  double algebraic_error = 0;
};

/// Progress of a long solution.
struct ProgressReport {
  std::string text;       ///< a short line, "step 2/4, load 0.5, iteration 3, residual 1e-4"
  std::size_t done = 0;   ///< equal parts of the work that are done, such as steps …
  std::size_t parts = 0;  ///< … of so many; 0: the report does not say
  const MechanicsStep* step = nullptr;  ///< of a mechanics model: the step that is just done

  ProgressReport(std::string line) : text(std::move(line)) {}  // NOLINT: a text is a report
  ProgressReport(const char* line) : text(line) {}             // NOLINT
  ProgressReport(std::string line, std::size_t parts_done, std::size_t all_parts)
      : text(std::move(line)), done(parts_done), parts(all_parts) {}
};

/// The remark on an equilibrium whose energy decreases in so many ways.
inline std::string not_stable(int modes) {
  return "this equilibrium is not stable: it buckles in " + std::to_string(modes) +
         (modes == 1 ? " mode" : " modes");
}

/// Called with reports while a long solution goes on.
using Progress = std::function<void(const ProgressReport&)>;

/// The same with a text in front of each line. `progress` must outlive it.
inline Progress with_prefix(const Progress& progress, std::string prefix) {
  if (!progress) return {};
  return [&progress, prefix = std::move(prefix)](ProgressReport report) {
    report.text = prefix + report.text;
    progress(report);
  };
}

/// The same for a piece of the work: its own parts and steps are not those of the whole.
inline Progress of_a_piece(const Progress& progress, std::string prefix) {
  if (!progress) return {};
  return [&progress, prefix = std::move(prefix)](const ProgressReport& report) {
    progress(prefix + report.text);
  };
}

/// Reports the last of the steps, which is just done, of a path of so many.
inline void report_step(const Progress& progress, const std::vector<MechanicsStep>& steps,
                        std::size_t path) {
  if (!progress) return;
  ProgressReport report("step " + std::to_string(steps.size()) + "/" + std::to_string(path),
                        steps.size(), path);
  report.step = &steps.back();
  progress(report);
}

/// State of a solution along a load path, from which a model resumes: bytes in the model's own
/// format under names. The n-th finished step has the name n, from 1. (A refined model's checkpoint
/// has parts, by prefixes of the names.)
struct Checkpoint {
  using Entries = std::map<std::string, std::string>;
  Entries kept;  ///< by an earlier run; empty: start from the straight cilium
  /// Adds entries or replaces those of the same names, all or none. Throws CheckpointError. Empty:
  /// nothing is kept.
  std::function<void(const Entries&)> save;

  std::size_t finished_steps() const {
    std::size_t n = 0;
    while (kept.contains(std::to_string(n + 1))) ++n;
    return n;
  }
};

/// A model of the bending cilium: load path in, states out. How it steps from load to load is its
/// own affair.
class MechanicsModel {
 public:
  virtual ~MechanicsModel() = default;

  /// Solves the path from the straight cilium. A step that slips off or does not converge is marked
  /// so and the rest goes on where it can. Throws InputError if the cilium or a load is not valid.
  virtual MechanicsResult solve(const Cilium& cilium, const LoadPath& path,
                                const Progress& progress = {}) const = 0;

  /// solve() that goes on from the checkpoint and keeps it up to date; the steps are those of
  /// solve(). Steps from the first failed one on are not kept: they are solved again. Among several
  /// ranks the first alone has a checkpoint. Throws CheckpointError, besides the interface's
  /// errors.
  virtual MechanicsResult solve_from(const Cilium& cilium, const LoadPath& path,
                                     const Checkpoint& /*checkpoint*/,
                                     const Progress& progress = {}) const {
    return solve(cilium, path, progress);
  }
};

}  // namespace ciliaval

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/path_run.h"

#include <fmt/format.h>

#include <chrono>
#include <functional>
#include <optional>
#include <utility>

#include "fem/parallel.h"
#include "fem/solid/archive.h"
#include "fem/solid/checkpoint.h"
#include "problem/error.h"
#include "problem/error_estimate.h"

namespace ciliaval::fem::solid {
using namespace discretisation;
using namespace equilibrium;
namespace {

using Clock = std::chrono::steady_clock;

/// Name of a checkpoint's entry with the levels' states, from which the next step goes on.
constexpr const char* state_name = "states";

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Azimuth of the mesh's x axis: the load's direction; a user's mesh stays as it is.
double mesh_azimuth(const SolidOptions& options, const Load& load) {
  return options.mesh.empty() ? azimuth(load) : 0;
}

/// The load in the frame of the mesh.
Load in_mesh_frame(const SolidOptions& options, const Load& load) {
  return turned(load, -mesh_azimuth(options, load));
}

/// S of the centreline's lowest point at z = h; empty if there is none.
std::optional<double> contact_arclength(const Centreline& centreline, double height) {
  for (std::size_t i = 0; i < centreline.pieces().size(); ++i) {
    double low = centreline.breaks()[i];
    double high = centreline.breaks()[i + 1];
    if (!(centreline.at(low, i).position.z() <= height &&
          centreline.at(high, i).position.z() >= height))
      continue;
    while (true) {
      const double middle = low + (high - low) / 2;
      if (!(middle > low && middle < high)) return middle;
      (centreline.at(middle, i).position.z() < height ? low : high) = middle;
    }
  }
  return std::nullopt;
}

/// True if the level is in equilibrium with the load.
bool is_at(const Level& level, const Load& load) {
  return level.state() != nullptr && level.state()->current.load == load;
}

/// λₙ/λ₁ on the mantle beyond which the error is not known: two thirds of that of creases. Not far
/// beyond, finer meshes are no longer nearer to one another (docs/evidence/solid.md).
constexpr double largest_compression = 1.6;

/// The step of a companion: failed if it has no equilibrium with the load.
MechanicsStep companion_step(const Level& level, const Equilibrium* equilibrium, const Load& load,
                             double mesh_azimuth) {
  MechanicsStep step;
  step.load = load;
  if (equilibrium == nullptr) return step;
  step.message =
      failure_of([&] { step.deformation = level.deformation(*equilibrium, mesh_azimuth); });
  if (!step.message.empty()) return step;
  step.status = Status::converged;
  step.unknowns = level.unknowns();
  step.applied_force = equilibrium->applied_force;
  return step;
}

/// The result of a step that the finest mesh has ended with.
MechanicsStep finished(const LoadPathOutcome& outcome, const Load& load, double mesh_azimuth,
                       const Level& finest) {
  MechanicsStep step;
  step.load = load;
  step.status = outcome.status;
  step.message = outcome.message;
  step.slip_off_force = outcome.slip_off_force;
  step.slip_off_displacement = outcome.slip_off_displacement;
  step.slip_off_point = SlipOffPoint::rim;
  step.iterations = outcome.iterations;
  step.unknowns = finest.unknowns();
  if (outcome.status != Status::converged) return step;
  step.deformation = finest.deformation(mesh_azimuth);
  step.applied_force = finest.applied_force();
  if (const auto height = contact_height(load))
    step.contact_arclength = contact_arclength(step.deformation->centreline, *height);
  return step;
}

/// Adds a remark to a step.
void remark(MechanicsStep& step, const std::string& text) {
  step.message += (step.message.empty() ? "" : "; ") + text;
}

/// States the stability of the level's equilibrium, which the step has ended with.
void judge(Level& level, MechanicsStep& step) {
  try {
    const auto variation = level.second_variation();
    if (!variation) return;
    step.unstable_modes = variation->unstable_modes;
    step.smallest_eigenvalue = variation->smallest_eigenvalue;
  } catch (const SolverError& error) {
    return remark(step,
                  "whether this equilibrium is stable is not known: " + std::string(error.what()));
  }
  if (*step.unstable_modes > 0) remark(step, not_stable(*step.unstable_modes));
}

/// States where a magnet pulls the cilium in.
void state_pull_in(Level& level, const LoadPathOutcome& outcome, double mesh_azimuth,
                   MechanicsStep& step) {
  try {
    step.pull_in = level.pull_in(outcome, mesh_azimuth);
    step.message = continuation::pulled_in(*step.pull_in);
  } catch (const SolverError& error) {
    step.status = Status::failed;
    step.message = error.what();
  }
}

}  // namespace

std::optional<std::string> fold_remark(const postprocessing::MantleCompression& compression) {
  if (compression.ratio <= largest_compression) return std::nullopt;
  return fmt::format(
      "the mantle at Z = {:.3g} mm is compressed to {:.2f} of its length (ratio of stretches "
      "{:.2f}): near this rubber folds, and the numerical error is not known "
      "(docs/theory/solid.md)",
      compression.height * 1e3, compression.stretch, compression.ratio);
}

std::string failure_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const RankFailure&) {
    throw;
  } catch (const Error& error) {
    require_failure_of_all_ranks(error.what());
    return error.what();
  }
  return {};
}

PathRun::PathRun(Levels levels, const LoadPath& path, const SolidOptions& options,
                 const Checkpoint& checkpoint, const Progress& progress, MPI_Comm communicator)
    : levels_(std::move(levels)),
      path_(path),
      options_(options),
      checkpoint_(checkpoint),
      progress_(progress),
      communicator_(communicator),
      result_{} {
  const double turn = path.empty() ? 0 : mesh_azimuth(options, path.front());
  result_.undeformed = finest().undeformed(turn);
  for (std::size_t i = 0; i < levels_.companions.size(); ++i)
    result_.companions.push_back({companion(i).undeformed(turn), {}});
  result_.error_parts = levels_.error_parts;
  result_.algebraic_error = options.newton_tolerance;
}

MechanicsResult PathRun::follow() {
  go_on_from_checkpoint();
  bool failed = false;
  while (result_.steps.size() < path_.size()) {
    MechanicsStep step = solve(result_.steps.size());
    failed = failed || step.status == Status::failed;
    if (!failed) save(step);
    add(std::move(step));
  }
  estimate_errors(result_);
  return std::move(result_);
}

void PathRun::add(MechanicsStep step) {
  const bool converged = step.status == Status::converged;
  const double turn = mesh_azimuth(options_, step.load);
  for (std::size_t i = 0; i < levels_.companions.size(); ++i)
    result_.companions[i].steps.push_back(
        companion_step(companion(i),
                       converged && is_at(companion(i), in_mesh_frame(options_, step.load))
                           ? &companion(i).state()->current
                           : nullptr,
                       step.load, turn));
  result_.steps.push_back(std::move(step));
  report_step(progress_, result_.steps, path_.size());
}

void PathRun::go_on_from_checkpoint() {
  const Checkpoint::Entries kept = kept_entries(checkpoint_, state_name, communicator_);
  if (kept.empty()) return;
  for (std::size_t i = 1; kept.contains(std::to_string(i)); ++i) {
    MechanicsStep step;
    std::vector<std::optional<Equilibrium>> companions;
    std::optional<SolidState> state;
    support::deserialize(kept.at(std::to_string(i)), step, state, companions);
    const double turn = mesh_azimuth(options_, step.load);
    if (state)
      step.deformation =
          finest().deformation({in_mesh_frame(options_, step.load),
                                finest().restored(std::move(*state)), step.applied_force},
                               turn);
    for (std::size_t c = 0; c < companions.size(); ++c) {
      if (companions[c]) companions[c] = companion(c).restored(std::move(*companions[c]));
      result_.companions.at(c).steps.push_back(
          companion_step(companion(c), companions[c] ? &*companions[c] : nullptr, step.load, turn));
    }
    result_.steps.push_back(std::move(step));
  }
  std::vector<std::optional<LoadPathState>> states;
  support::deserialize(kept.at(state_name), states);
  for (std::size_t i = 0; i < states.size(); ++i) levels_.all.at(i)->restore(std::move(states[i]));
}

void PathRun::save(const MechanicsStep& finished) const {
  save_entries(checkpoint_, communicator_, [&] {
    std::vector<std::optional<LoadPathState>> states;
    for (const auto& level : levels_.all)
      states.push_back(level->state() != nullptr ? std::optional(level->to_keep(*level->state()))
                                                 : std::nullopt);
    std::optional<SolidState> state;
    std::vector<std::optional<Equilibrium>> companions(levels_.companions.size());
    if (finished.status == Status::converged) {
      state = finest().to_keep(finest().state()->current.state);
      for (std::size_t i = 0; i < companions.size(); ++i)
        if (is_at(companion(i), in_mesh_frame(options_, finished.load)))
          companions[i] = companion(i).to_keep(companion(i).state()->current);
    }
    return Checkpoint::Entries{{state_name, support::serialized(states)},
                               {std::to_string(result_.steps.size() + 1),
                                support::serialized(finished, state, companions)}};
  });
}

std::string PathRun::advance_companions(const Load& load, const Progress& progress) {
  // The coarser levels are there already, unless the finest has left them behind.
  Level& section = *levels_.all.back();
  std::string reason;
  if (is_at(*levels_.all.front(), load)) {
    LoadPathOutcome outcome;
    reason = failure_of([&] { outcome = section.advance(load, progress); });
    if (!reason.empty()) section.restore(std::nullopt);  // it may have stopped between two states
    if (reason.empty()) reason = outcome.message;
  }
  for (std::size_t i = 0; i < levels_.companions.size(); ++i) {
    if (is_at(companion(i), load)) continue;
    std::string text = fmt::format("no equilibrium with this load on the mesh of {} unknowns",
                                   companion(i).unknowns());
    if (&companion(i) == &section && !reason.empty()) text += ": " + reason;
    return text;
  }
  return {};
}

MechanicsStep PathRun::solve(std::size_t i) {
  const auto start = Clock::now();
  const Progress shown = with_prefix(progress_, label(i));
  const Load load = in_mesh_frame(options_, path_[i]);
  const LoadPathOutcome outcome = finest().advance(load, shown);
  MechanicsStep step = finished(outcome, path_[i], mesh_azimuth(options_, path_[i]), finest());
  const std::optional<std::string> fold = fold_remark(finest().mantle_compression());
  if (step.status == Status::converged) {
    Progress of_companions;
    if (shown) of_companions = with_prefix(shown, "error estimate, ");
    if (!surroundings::is_empty(acting_environment(load))) judge(finest(), step);
    const bool has_companions = levels_.all.size() > levels_.finest + 1;
    if (fold) {
      remark(step, *fold);
      // Without this companion there is no estimate.
      if (has_companions) levels_.all.back()->restore(std::nullopt);
    } else if (has_companions) {
      const std::string missing = advance_companions(load, of_companions);
      if (!missing.empty()) remark(step, error_is_not_known(missing));
    }
  } else if (fold) {
    step.message += "; at the last load before, " + *fold;
  }
  if (step.status == Status::slipped_off && levels_.finest > 0 && !fold) {
    // The bracket, and how far that of the next coarser level, which has slipped off too, is away.
    LoadPathOutcome coarser;
    Level& next = *levels_.all[levels_.finest - 1];
    const std::string failure = failure_of([&] { coarser = next.advance(load, {}); });
    if (!failure.empty()) {
      next.restore(std::nullopt);
      remark(step, error_is_not_known(failure));
    }
    const auto own = slip_off_limit(step);
    const auto other =
        load.is<ProbeLoad>() ? coarser.slip_off_displacement : coarser.slip_off_force;
    if (own && other)
      step.slip_off_uncertainty = outcome.slip_off_bracket + std::abs(*own - *other);
  }
  if (step.status == Status::pulled_in)
    state_pull_in(finest(), outcome, mesh_azimuth(options_, path_[i]), step);
  if (step.status == Status::failed) step.message = label(i) + step.message;
  step.seconds = seconds_since(start);
  return step;
}

std::string PathRun::label(std::size_t i) const {
  return "step " + std::to_string(i + 1) + "/" + std::to_string(path_.size()) + ", ";
}

}  // namespace ciliaval::fem::solid

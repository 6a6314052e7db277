// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/path_run.h"

#include <deal.II/base/mpi.h>

#include <boost/serialization/map.hpp>
#include <chrono>
#include <functional>
#include <optional>
#include <utility>

#include "fem/parallel.h"
#include "fem/solid/archive.h"
#include "problem/error.h"

namespace ciliaval::fem::solid {
using namespace discretisation;
using namespace equilibrium;
namespace {

using Clock = std::chrono::steady_clock;
using dealii::Utilities::MPI::broadcast;

/// Of the entry of a checkpoint with the levels' states, from which the next step goes on.
constexpr const char* state_name = "state";

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Azimuth of the mesh's x axis: the load's direction; a user's mesh stays as it is.
double mesh_azimuth(const SolidOptions& options, const Load& load) {
  return options.mesh.empty() ? azimuth(load) : 0;
}

/// The load in the frame of the mesh.
Load in_mesh_frame(const SolidOptions& options, const Load& load) {
  return with_azimuth(load, azimuth(load) - mesh_azimuth(options, load));
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

/// The result of a step that the finest mesh has ended with.
MechanicsStep finished(const LoadPathOutcome& outcome, const Load& load, double mesh_azimuth,
                       const Level& finest) {
  MechanicsStep step;
  step.load = load;
  step.status = outcome.status;
  step.message = outcome.message;
  step.slip_off_force = outcome.slip_off_force;
  step.slip_off_displacement = outcome.slip_off_displacement;
  step.iterations = outcome.iterations;
  step.unknowns = finest.unknowns();
  if (outcome.status != Status::converged) return step;
  step.deformation = finest.deformation(mesh_azimuth);
  step.applied_force = finest.applied_force();
  step.tip_uncertainty = finest.tip_uncertainty();
  if (const auto height = contact_height(load))
    step.contact_arclength = contact_arclength(step.deformation->centreline, *height);
  return step;
}

}  // namespace

PathRun::PathRun(std::vector<std::unique_ptr<Level>> levels, const LoadPath& path,
                 const SolidOptions& options, const Checkpoint& checkpoint,
                 const Progress& progress, MPI_Comm communicator)
    : levels_(std::move(levels)),
      path_(path),
      options_(options),
      checkpoint_(checkpoint),
      progress_(progress),
      communicator_(communicator),
      result_{finest().undeformed(path.empty() ? 0 : mesh_azimuth(options, path.front())), {}} {}

MechanicsResult PathRun::follow() {
  go_on_from_checkpoint();
  bool failed = false;
  while (result_.steps.size() < path_.size()) {
    MechanicsStep step = solve(result_.steps.size(), !failed);
    failed = failed || step.status == Status::failed;
    if (!failed) save(&step);
    result_.steps.push_back(std::move(step));
  }
  return std::move(result_);
}

void PathRun::go_on_from_checkpoint() {
  const Checkpoint::Entries kept = broadcast(communicator_, checkpoint_.kept);
  if (kept.empty()) return;
  std::vector<std::optional<LoadPathState>> states;
  deserialize(kept.at(state_name), states);
  for (std::size_t i = 0; i < states.size(); ++i) levels_.at(i)->restore(std::move(states[i]));
  for (std::size_t i = 1; kept.contains(std::to_string(i)); ++i) {
    MechanicsStep step;
    std::optional<SolidState> state;
    deserialize(kept.at(std::to_string(i)), step, state);
    if (state)
      step.deformation =
          finest().deformation({in_mesh_frame(options_, step.load), *state, step.applied_force},
                               mesh_azimuth(options_, step.load));
    result_.steps.push_back(std::move(step));
  }
}

void PathRun::save(const MechanicsStep* finished) const {
  std::string failure;
  if (rank(communicator_) == 0 && checkpoint_.save) {
    std::vector<std::optional<LoadPathState>> states;
    for (const auto& level : levels_)
      states.push_back(level->state() != nullptr ? std::optional(*level->state()) : std::nullopt);
    Checkpoint::Entries entries{{state_name, serialized(states)}};
    if (finished != nullptr) {
      std::optional<SolidState> state;
      if (finished->status == Status::converged) state = finest().state()->current.state;
      entries.emplace(std::to_string(result_.steps.size() + 1), serialized(*finished, state));
    }
    try {
      checkpoint_.save(entries);
    } catch (const CheckpointError& error) {
      failure = error.what();
    }
  }
  failure = broadcast(communicator_, failure);
  if (!failure.empty()) throw CheckpointError(failure);
}

MechanicsStep PathRun::solve(std::size_t i, bool keep) {
  const auto start = Clock::now();
  Progress shown;
  if (progress_) shown = [this, i](const std::string& text) { progress_(label(i) + text); };
  std::function<void()> on_equilibrium;
  if (keep) on_equilibrium = [this] { save(nullptr); };
  const LoadPathOutcome outcome =
      levels_.back()->advance(in_mesh_frame(options_, path_[i]), shown, on_equilibrium);
  MechanicsStep step = finished(outcome, path_[i], mesh_azimuth(options_, path_[i]), finest());
  if (step.status == Status::failed) step.message = label(i) + step.message;
  step.seconds = seconds_since(start);
  return step;
}

std::string PathRun::label(std::size_t i) const {
  return "step " + std::to_string(i + 1) + "/" + std::to_string(path_.size()) + ", ";
}

}  // namespace ciliaval::fem::solid

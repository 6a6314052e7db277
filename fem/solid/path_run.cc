// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/path_run.h"

#include <chrono>
#include <functional>
#include <utility>
#include <variant>

namespace ciliaval::fem::solid {
using namespace discretisation;
using namespace equilibrium;
namespace {

using Clock = std::chrono::steady_clock;

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
                 const SolidOptions& options, const Progress& progress)
    : levels_(std::move(levels)),
      path_(path),
      options_(options),
      progress_(progress),
      result_{finest().undeformed(path.empty() ? 0 : mesh_azimuth(options, path.front())), {}} {}

MechanicsResult PathRun::follow(SolidCheckpoint& saved) {
  go_on_from(saved);
  follow_path(saved);
  return std::move(result_);
}

void PathRun::go_on_from(SolidCheckpoint& saved) {
  std::vector<std::optional<LoadPathState>> states = saved.read();
  for (std::size_t i = 0; i < states.size(); ++i) levels_.at(i)->restore(std::move(states[i]));
  for (std::size_t i = 0; i < saved.steps().size(); ++i) {
    MechanicsStep step = saved.steps()[i];
    if (step.status == Status::converged) add_deformation(step, saved.finished_state(i));
    result_.steps.push_back(std::move(step));
  }
}

void PathRun::follow_path(SolidCheckpoint& saved) {
  bool failed = false;
  while (result_.steps.size() < path_.size()) {
    MechanicsStep step = solve(result_.steps.size(), saved, !failed);
    failed = failed || step.status == Status::failed;
    if (!failed) {
      add_to(saved, step);
      saved.save(states());
    }
    result_.steps.push_back(std::move(step));
  }
}

MechanicsStep PathRun::solve(std::size_t i, SolidCheckpoint& saved, bool keep) {
  const auto start = Clock::now();
  const auto save = [&] { saved.save(states()); };
  Progress shown;
  if (progress_) shown = [this, i](const std::string& text) { progress_(label(i) + text); };
  const LoadPathOutcome outcome = levels_.back()->advance(
      in_mesh_frame(options_, path_[i]), shown, keep ? std::function<void()>(save) : nullptr);
  MechanicsStep step = finished(outcome, path_[i], mesh_azimuth(options_, path_[i]), finest());
  if (step.status == Status::failed) {
    step.message = label(i) + step.message;
    if (saved.file())
      step.message +=
          "; what converged up to the first failure is kept in `" + saved.file()->string() + "`";
  }
  step.seconds = seconds_since(start);
  return step;
}

std::string PathRun::label(std::size_t i) const {
  return "step " + std::to_string(i + 1) + "/" + std::to_string(path_.size()) + ", ";
}

void PathRun::add_to(SolidCheckpoint& saved, const MechanicsStep& step) const {
  saved.add(step, step.status == Status::converged ? &finest().state()->current.state : nullptr);
}

void PathRun::add_deformation(MechanicsStep& step, const SolidState& state) const {
  step.deformation =
      finest().deformation({in_mesh_frame(options_, step.load), state, step.applied_force},
                           mesh_azimuth(options_, step.load));
}

std::vector<const LoadPathState*> PathRun::states() const {
  std::vector<const LoadPathState*> result;
  for (const auto& level : levels_) result.push_back(level->state());
  return result;
}

}  // namespace ciliaval::fem::solid

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/path_run.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <utility>
#include <variant>

#include "fem/parallel.h"
#include "fem/solid/shared_tasks.h"
#include "fem/solid/solo_step.h"
#include "problem/error.h"

namespace ciliaval::fem {
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
Load in_mesh_frame(const SolidOptions& options, Load load) {
  const double turn = mesh_azimuth(options, load);
  std::visit([turn](auto& l) { l.azimuth -= turn; }, load);
  return load;
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

/// What is made of a step that the finest mesh has ended with; its deformation too if there is none
/// yet.
MechanicsStep finished(const LoadPathOutcome& outcome, const Load& load, double mesh_azimuth,
                       const Level& finest, std::optional<Deformation> deformation = {}) {
  MechanicsStep step;
  step.load = load;
  step.status = outcome.status;
  step.message = outcome.message;
  step.slip_off_force = outcome.slip_off_force;
  step.slip_off_displacement = outcome.slip_off_displacement;
  step.iterations = outcome.iterations;
  step.unknowns = finest.unknowns();
  if (outcome.status != Status::converged) return step;
  step.deformation = deformation ? std::move(deformation) : finest.deformation(mesh_azimuth);
  step.applied_force = finest.applied_force();
  step.tip_uncertainty = finest.tip_uncertainty();
  if (const auto height = contact_height(load))
    step.contact_arclength = contact_arclength(step.deformation->centreline, *height);
  return step;
}

/// Whether the ranks work alone, on levels and steps of their own, in place of sharing all of them:
/// where there are at least as many steps as ranks, each with a load and a guess of its own, and LU
/// solves them, which gains less by sharing.
bool is_for_ranks_apart(const LoadPath& path, const SolidOptions& options, const Level& finest) {
  return rank_count() > 1 && static_cast<std::size_t>(rank_count()) <= path.size() &&
         std::none_of(path.begin(), path.end(),
                      [](const Load& load) { return magnitude(load) == 0; }) &&
         options.initial_guess == InitialGuess::beam && finest.solved_directly();
}

/// Whether all levels have the step's equilibrium.
bool is_solved(const SharedTasks& tasks, std::size_t step, std::size_t levels) {
  for (std::size_t level = 0; level < levels; ++level) {
    const TaskResult* result = tasks.result(step, level);
    if (result == nullptr || !result->equilibrium) return false;
  }
  return true;
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
  if (is_for_ranks_apart(path_, options_, finest()))
    follow_apart(saved);
  else
    follow_together(saved);
  return std::move(result_);
}

void PathRun::go_on_from(SolidCheckpoint& saved) {
  restore(saved.read());
  for (std::size_t i = 0; i < saved.steps().size(); ++i) {
    MechanicsStep step = saved.steps()[i];
    if (step.status == Status::converged) add_deformation(step, saved.finished_state(i));
    result_.steps.push_back(std::move(step));
  }
}

void PathRun::follow_together(SolidCheckpoint& saved) {
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

void PathRun::follow_apart(SolidCheckpoint& saved) {
  bool failed = false;
  bool guesses_fail = false;
  bool again = false;  // the next step has been tried in a block
  while (result_.steps.size() < path_.size()) {
    // After what does not converge the next steps are solved as on one rank, up to one that does.
    const bool alone = again || guesses_fail ||
                       (!result_.steps.empty() && result_.steps.back().status != Status::converged);
    const std::size_t count = alone ? 1 : block_size();
    if (count > 1) {
      again = solve_block(count, failed ? nullptr : &saved) < count;
      continue;
    }
    solve_alone(saved, !failed);
    const Status status = result_.steps.back().status;
    failed = failed || status == Status::failed;
    guesses_fail = guesses_fail || (again && status == Status::converged);
    again = false;
  }
}

bool PathRun::corrections_are_known(const Load& load) const {
  const LoadPathState* state = finest().state();
  return state != nullptr && same_place(state->current.load, load) &&
         magnitude(state->current.load) != 0;
}

bool PathRun::has_slipped(const Load& load) const {
  return std::any_of(levels_.begin(), levels_.end(), [&load](const auto& level) {
    const LoadPathState* state = level->state();
    return state != nullptr && state->slipped && same_place(*state->slipped, load) &&
           magnitude(load) >= magnitude(*state->slipped);
  });
}

std::size_t PathRun::block_size() const {
  const bool on_the_way = std::any_of(levels_.begin(), levels_.end(), [](const auto& level) {
    return level->state() != nullptr && level->state()->ramp;
  });
  if (on_the_way) return 1;
  const auto next = path_.begin() + static_cast<std::ptrdiff_t>(result_.steps.size());
  const auto end = std::find_if(next, path_.end(), [this](const Load& load) {
    return has_slipped(in_mesh_frame(options_, load));
  });
  const auto left = std::max<std::size_t>(1, static_cast<std::size_t>(end - next));
  const auto ranks = static_cast<std::size_t>(rank_count());
  const std::size_t count =
      std::min(left, corrections_are_known(in_mesh_frame(options_, *next)) ? ranks : 2 * ranks);
  return left - count < ranks ? left : count;
}

Corrections PathRun::corrections(std::size_t count) const {
  const auto first = path_.begin() + static_cast<std::ptrdiff_t>(result_.steps.size());
  const Load load = in_mesh_frame(options_, *first);
  const bool one_place = std::all_of(
      first, first + static_cast<std::ptrdiff_t>(count),
      [&](const Load& other) { return same_place(load, in_mesh_frame(options_, other)); });
  if (!one_place) return Corrections::none;
  return corrections_are_known(load) ? Corrections::before : Corrections::within;
}

std::size_t PathRun::solve_block(std::size_t count, SolidCheckpoint* saved) {
  const std::size_t first = result_.steps.size();
  std::vector<std::size_t> unknowns;
  for (const auto& level : levels_) unknowns.push_back(level->unknowns());
  SharedTasks tasks(schedule(unknowns, count, rank_count(), corrections(count)), count,
                    levels_.size());
  const std::vector<std::optional<LoadPathState>> before = copied_states();
  const Progress progress = shown_as(label(first, count));
  tasks.run(
      [&](const SolidTask& task) { return solve_task(task, tasks, before, first, progress); });
  std::size_t solved = 0;
  for (; solved < count && is_solved(tasks, solved, levels_.size()); ++solved) {
    add(tasks, solved);
    if (saved != nullptr) add_to(*saved, result_.steps.back());
  }
  // What goes on from what is saved makes the same blocks: the step that ended this one is on its
  // way, by itself.
  if (solved < count) levels_.back()->set_out(in_mesh_frame(options_, path_[first + solved]));
  if (saved != nullptr && solved > 0) saved->save(states());
  return solved;
}

TaskResult PathRun::solve_task(const SolidTask& task, const SharedTasks& tasks,
                               const std::vector<std::optional<LoadPathState>>& before,
                               std::size_t first, const Progress& progress) {
  if (task.level == levels_.size()) return make_deformation(task, tasks, first);
  const auto start = Clock::now();
  Level& level = *levels_[task.level];
  const Load load = in_mesh_frame(options_, path_[first + task.step]);
  Guess guess;
  if (task.level == 0) {
    guess = level.guess(load);
  } else {
    const auto state = [&before](std::size_t i) { return before[i] ? &*before[i] : nullptr; };
    std::vector<EquilibriumPair> behind;
    for (const std::size_t step : task.corrected_by)
      behind.push_back({&*tasks.result(step, task.level)->equilibrium,
                        &*tasks.result(step, task.level - 1)->equilibrium});
    if (behind.empty()) behind = pairs(state(task.level), state(task.level - 1));
    guess = level.guess(load, *tasks.result(task.step, task.level - 1)->equilibrium, behind);
  }
  TaskResult result;
  const Progress report = [&](const std::string& text) {
    tasks.move_mail();
    if (progress) progress((task.level + 1 < levels_.size() ? "coarser mesh, " : "") + text);
  };
  result.equilibrium = level.solve(load, std::move(guess), result.iterations, report);
  result.seconds = seconds_since(start);
  return result;
}

TaskResult PathRun::make_deformation(const SolidTask& task, const SharedTasks& tasks,
                                     std::size_t first) const {
  TaskResult result;
  result.deformation = finest().deformation(*tasks.result(task.step, task.level - 1)->equilibrium,
                                            mesh_azimuth(options_, path_[first + task.step]));
  return result;
}

void PathRun::add(const SharedTasks& tasks, std::size_t step) {
  LoadPathOutcome outcome;
  outcome.status = Status::converged;
  double seconds = 0;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const TaskResult& result = *tasks.result(step, i);
    levels_[i]->go_to(*result.equilibrium);
    outcome.iterations = result.iterations;
    seconds += result.seconds;
  }
  const Load& load = path_[result_.steps.size()];
  result_.steps.push_back(finished(outcome, load, mesh_azimuth(options_, load), finest(),
                                   tasks.result(step, levels_.size())->deformation));
  result_.steps.back().seconds = seconds;
}

void PathRun::solve_alone(SolidCheckpoint& saved, bool keep) {
  SolvedStep solved = solve_on_first_rank([&] {
    MechanicsStep step = solve(result_.steps.size(), saved, keep);
    return SolvedStep{std::move(step), copied_states()};
  });
  MechanicsStep& step = solved.step;
  if (rank() != 0) {
    restore(std::move(solved.levels));
    if (step.status == Status::converged) add_deformation(step, finest().state()->current.state);
  }
  if (keep && step.status != Status::failed) {
    add_to(saved, step);
    saved.save(states());
  }
  result_.steps.push_back(std::move(step));
}

MechanicsStep PathRun::solve(std::size_t i, SolidCheckpoint& saved, bool keep) {
  const auto start = Clock::now();
  const auto save = [&] { saved.save(states()); };
  const LoadPathOutcome outcome =
      levels_.back()->advance(in_mesh_frame(options_, path_[i]), shown_as(label(i, 1)),
                              keep ? std::function<void()>(save) : nullptr);
  MechanicsStep step = finished(outcome, path_[i], mesh_azimuth(options_, path_[i]), finest());
  if (step.status == Status::failed) {
    step.message = label(i, 1) + step.message;
    if (saved.file())
      step.message +=
          "; what converged up to the first failure is kept in `" + saved.file()->string() + "`";
  }
  step.seconds = seconds_since(start);
  return step;
}

std::string PathRun::label(std::size_t first, std::size_t count) const {
  return (count > 1 ? "steps " + std::to_string(first + 1) + "-" : std::string("step ")) +
         std::to_string(first + count) + "/" + std::to_string(path_.size()) + ", ";
}

Progress PathRun::shown_as(const std::string& label) const {
  if (!progress_) return {};
  return [this, label](const std::string& text) { progress_(label + text); };
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

std::vector<std::optional<LoadPathState>> PathRun::copied_states() const {
  std::vector<std::optional<LoadPathState>> result;
  for (const LoadPathState* state : states())
    result.push_back(state != nullptr ? std::optional(*state) : std::nullopt);
  return result;
}

void PathRun::restore(std::vector<std::optional<LoadPathState>> states) {
  for (std::size_t i = 0; i < states.size(); ++i) levels_.at(i)->restore(std::move(states[i]));
}

}  // namespace ciliaval::fem

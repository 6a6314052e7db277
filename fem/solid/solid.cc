// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/solid.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "fem/parallel.h"
#include "fem/solid/checkpoint.h"
#include "fem/solid/level.h"
#include "fem/solid/load_path.h"
#include "fem/solid/round.h"
#include "meshes/cylinder_mesh.h"
#include "problem/error.h"

namespace ciliaval::fem {
namespace {

/// Meshes from coarse to fine. From one to the next the layers at the clamped end and at the
/// interfaces and the cells under the mantle halve, and the others shrink as far as they matter.
struct MeshLevel {
  unsigned int square_cells;
  unsigned int rings;
  double ring_ratio;
  double finest_layer;
  double coarsest_layer;
  double growth;
};
constexpr std::array<MeshLevel, mesh_level_count> mesh_levels{{{2, 1, 1.0, 0.32, 1.2, 0.35},
                                                               {2, 2, 0.5, 0.16, 0.8, 0.25},
                                                               {2, 3, 0.5, 0.08, 0.5, 0.3},
                                                               {2, 4, 0.5, 0.04, 0.5, 0.3},
                                                               {4, 5, 0.5, 0.02, 0.4, 0.25},
                                                               {4, 6, 0.5, 0.01, 0.25, 0.2}}};
/// The level of each refinement.
constexpr std::array<unsigned int, 4> refinement_levels{1, 3, 4, 5};

Hyperelastic material(const Segment& segment, const SolidOptions& options) {
  const double mu = segment.shear_modulus();
  const double K = segment.bulk_modulus();
  switch (options.material) {
    case SolidOptions::Material::mooney_rivlin:
      return Hyperelastic::mooney_rivlin(mu, K, options.mooney_ratio);
    case SolidOptions::Material::yeoh:
      return Hyperelastic::yeoh(mu, K, options.yeoh_ratios[0], options.yeoh_ratios[1]);
    default:
      return Hyperelastic::neo_hooke(mu, K);
  }
}

std::vector<Hyperelastic> materials(const Cilium& cilium, const SolidOptions& options) {
  std::vector<Hyperelastic> result;
  for (const Segment& segment : cilium.segments) result.push_back(material(segment, options));
  return result;
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

/// Force scale under which a residual is rounding error: J − 1 carries a few ε, which the bulk
/// modulus turns into forces of some ε K A on a section; Newton's method asks for 1e-6 of the
/// scale.
double least_force(const Cilium& cilium) {
  double stiffest = 0;
  for (const Segment& segment : cilium.segments)
    stiffest = std::max(stiffest, segment.bulk_modulus());
  return 4e6 * std::numeric_limits<double>::epsilon() * stiffest * cilium.area();
}

void require_valid(const Cilium& cilium, const LoadPath& path, const SolidOptions& options) {
  ciliaval::require_valid(cilium);
  for (const Load& load : path) {
    ciliaval::require_valid(load, cilium);
    if (type(load) != type(path.front()))
      throw InputError("a load path cannot change from one load type to another");
    const std::optional<double> height = contact_height(load);
    if (height &&
        !(*height > options.kernel_width && *height + options.kernel_width < cilium.length()))
      throw InputError(
          "the solid spreads the contact force over h - kernel_width < z < h + kernel_width, which "
          "must lie between the base and the tip: choose a smaller kernel_width");
  }
}

/// The mesh of a level for a load path, with a plane at each loaded section; half of it if the
/// options say so.
meshes::CylinderMeshOptions path_mesh(unsigned int index, const SolidOptions& options,
                                      const LoadPath& path) {
  meshes::CylinderMeshOptions mesh = level_mesh(index);
  mesh.half = options.symmetry;
  for (const Load& load : path)
    if (const auto* section = std::get_if<SectionLoad>(&load))
      mesh.planes.push_back(section->arclength);
  return mesh;
}

/// The meshes from the coarsest to that of the refinement asked for; a user's mesh alone.
std::vector<std::unique_ptr<Level>> make_levels(const Cilium& cilium, const LoadPath& path,
                                                const SolidOptions& options) {
  const LevelOptions level_options{
      {{options.tolerance, options.max_iterations, least_force(cilium)},
       options.max_cutbacks,
       options.kernel_width},
      options.solver,
      options.initial_guess == InitialGuess::beam};
  std::vector<std::unique_ptr<Level>> levels;
  if (!options.mesh.empty()) {
    levels.push_back(std::make_unique<Level>(cilium,
                                             meshes::MeshFile{options.mesh, options.mesh_unit},
                                             materials(cilium, options), level_options));
    return levels;
  }
  for (unsigned int i = 0; i <= mesh_level(options.refinement); ++i)
    levels.push_back(std::make_unique<Level>(cilium, path_mesh(i, options, path),
                                             materials(cilium, options), level_options,
                                             levels.empty() ? nullptr : levels.back().get()));
  return levels;
}

Facts facts(const Cilium& cilium, const LoadPath& path, const SolidOptions& options) {
  std::vector<meshes::CylinderMeshOptions> meshes;
  if (options.mesh.empty())
    for (unsigned int i = 0; i <= mesh_level(options.refinement); ++i)
      meshes.push_back(path_mesh(i, options, path));
  return solid_facts(cilium, path, options, meshes);
}

/// What is made of a step that the finest mesh has ended with.
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

/// The levels on their way along a load path.
class PathRun {
 public:
  PathRun(const Cilium& cilium, const LoadPath& path, const SolidOptions& options,
          const Progress& progress)
      : path_(path),
        options_(options),
        progress_(progress),
        levels_(make_levels(cilium, path, options)),
        apart_(rank_count() > 1 && static_cast<std::size_t>(rank_count()) <= path.size() &&
               std::none_of(path.begin(), path.end(),
                            [](const Load& load) { return magnitude(load) == 0; }) &&
               options.initial_guess == InitialGuess::beam && finest().solved_directly()) {}

  const Level& finest() const { return *levels_.back(); }

  /// Whether each rank solves steps of its own, in place of sharing all of them: where there are at
  /// least as many steps as ranks, each with a load and a guess of its own, and LU solves them,
  /// which gains less by sharing.
  bool apart() const { return apart_; }

  /// Puts the levels and the finished steps where the checkpoint, if there is one, left them.
  void go_on_from(SolidCheckpoint& saved, MechanicsResult& result) {
    restore(saved.read());
    for (std::size_t i = 0; i < saved.steps().size(); ++i) {
      MechanicsStep step = saved.steps()[i];
      if (step.status == Status::converged) add_deformation(step, saved.finished_state(i));
      result.steps.push_back(std::move(step));
    }
  }

  /// All ranks share each step.
  void follow_together(SolidCheckpoint& saved, MechanicsResult& result) {
    bool failed = false;
    while (result.steps.size() < path_.size()) {
      const std::size_t i = result.steps.size();
      MechanicsStep step = solve(i, label(i, 1), saved, !failed);
      failed = failed || step.status == Status::failed;
      if (!failed) {
        saved.add(step, step.deformation ? &finest().state()->current.state : nullptr);
        saved.save(states());
      }
      result.steps.push_back(std::move(step));
    }
  }

  /// In rounds, after each of which all ranks are in the state of its last step.
  void follow_apart(SolidCheckpoint& saved, MechanicsResult& result) {
    const auto usual = static_cast<std::size_t>(rank_count());
    bool failed = false;
    const auto next = [&] {
      return result.steps.empty() || result.steps.back().status == Status::converged ? usual : 1;
    };
    for (std::size_t most = next(); result.steps.size() < path_.size();) {
      const std::size_t first = result.steps.size();
      const std::vector<std::optional<LoadPathState>> before = copied_states();
      const std::size_t count = std::min(most, path_.size() - first);
      std::vector<SolvedStep> solved = solve_round(count, [&](std::size_t number) {
        MechanicsStep step =
            solve(first + number, label(first, count), saved, count == 1 && !failed);
        return SolvedStep{std::move(step), copied_states()};
      });
      // What did not converge is solved as on one rank: by itself, from the step before it.
      most = 1;
      if (solved.empty()) {
        restore(before);
        continue;
      }
      for (auto& [step, levels] : solved) {
        const bool converged = step.status == Status::converged;
        if (converged && !step.deformation) add_deformation(step, levels.back()->current.state);
        failed = failed || step.status == Status::failed;
        if (!failed) saved.add(step, converged ? &levels.back()->current.state : nullptr);
        result.steps.push_back(std::move(step));
      }
      if (solved.size() == count) most = next();
      restore(after(solved));
      if (!failed) saved.save(states());
    }
  }

 private:
  /// "step 2/4, ", "steps 1-2/4, "
  std::string label(std::size_t first, std::size_t count) const {
    return (count > 1 ? "steps " + std::to_string(first + 1) + "-" : std::string("step ")) +
           std::to_string(first + count) + "/" + std::to_string(path_.size()) + ", ";
  }

  /// Step i. If `keep`, saves each equilibrium on the way.
  MechanicsStep solve(std::size_t i, const std::string& shown, SolidCheckpoint& saved, bool keep) {
    const auto start = std::chrono::steady_clock::now();
    const Progress report =
        progress_ ? Progress([&](const std::string& text) { progress_(shown + text); })
                  : Progress();
    const auto save = [&] { saved.save(states()); };
    const LoadPathOutcome outcome = levels_.back()->advance(
        in_mesh_frame(options_, path_[i]), report, keep ? std::function<void()>(save) : nullptr);
    MechanicsStep step = finished(outcome, path_[i], mesh_azimuth(options_, path_[i]), finest());
    if (step.status == Status::failed) {
      step.message = label(i, 1) + step.message;
      if (saved.file())
        step.message +=
            "; what converged up to the first failure is kept in `" + saved.file()->string() + "`";
    }
    step.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return step;
  }

  void add_deformation(MechanicsStep& step, const SolidState& state) const {
    step.deformation =
        finest().deformation({in_mesh_frame(options_, step.load), state, step.applied_force},
                             mesh_azimuth(options_, step.load));
  }

  std::vector<const LoadPathState*> states() const {
    std::vector<const LoadPathState*> result;
    for (const auto& level : levels_) result.push_back(level->state());
    return result;
  }

  std::vector<std::optional<LoadPathState>> copied_states() const {
    std::vector<std::optional<LoadPathState>> result;
    for (const LoadPathState* state : states())
      result.push_back(state != nullptr ? std::optional(*state) : std::nullopt);
    return result;
  }

  /// What the levels go on from after a round: the states of its last step and of the one before
  /// it.
  static std::vector<std::optional<LoadPathState>> after(std::vector<SolvedStep>& solved) {
    std::vector<std::optional<LoadPathState>> states = std::move(solved.back().levels);
    if (solved.size() == 1) return states;
    const std::vector<std::optional<LoadPathState>>& before = solved[solved.size() - 2].levels;
    for (std::size_t i = 0; i < states.size(); ++i) {
      if (!states[i]) continue;
      states[i]->previous.reset();
      if (before[i] && same_place(before[i]->current.load, states[i]->current.load))
        states[i]->previous = before[i]->current;
    }
    return states;
  }

  void restore(std::vector<std::optional<LoadPathState>> states) {
    const RankAlone alone(apart_);
    for (std::size_t i = 0; i < states.size(); ++i) levels_.at(i)->restore(std::move(states[i]));
  }

  const LoadPath& path_;
  const SolidOptions& options_;
  const Progress& progress_;
  std::vector<std::unique_ptr<Level>> levels_;  ///< the coarsest first
  bool apart_;
};

}  // namespace

unsigned int mesh_level(unsigned int refinement) {
  if (refinement >= refinement_levels.size())
    throw InputError("the solid has the refinements 0 to " +
                     std::to_string(refinement_levels.size() - 1) + ", not " +
                     std::to_string(refinement));
  return refinement_levels[refinement];
}

meshes::CylinderMeshOptions level_mesh(unsigned int number) {
  const MeshLevel& level = mesh_levels.at(number);
  meshes::CylinderMeshOptions mesh;
  mesh.square_cells = level.square_cells;
  mesh.rings = level.rings;
  mesh.ring_ratio = level.ring_ratio;
  mesh.finest_layer = level.finest_layer;
  mesh.coarsest_layer = level.coarsest_layer;
  mesh.growth = level.growth;
  return mesh;
}

meshes::CylinderMeshOptions cylinder_mesh_options(unsigned int refinement) {
  return level_mesh(mesh_level(refinement));
}

meshes::CylinderMeshOptions cylinder_mesh_options(const SolidOptions& options,
                                                  const LoadPath& path) {
  return path_mesh(mesh_level(options.refinement), options, path);
}

Solid::Solid(SolidOptions options) : options_(std::move(options)) {
  cylinder_mesh_options(options_.refinement);
  if (!(std::isfinite(options_.kernel_width) && options_.kernel_width > 0))
    throw InputError("the solid's kernel_width must be finite and positive");
  if (!(options_.tolerance > 0 && options_.tolerance < 1))
    throw InputError("the solid's tolerance must lie between 0 and 1");
  if (!(std::isfinite(options_.mesh_unit) && options_.mesh_unit > 0))
    throw InputError("the solid's mesh_unit must be finite and positive");
  if (options_.max_iterations == 0) throw InputError("the solid needs max_iterations of 1 or more");
  if (!(std::isfinite(options_.mooney_ratio) && options_.mooney_ratio >= 0))
    throw InputError("the solid's mooney_ratio C01/C10 must be finite and not negative");
  const auto [ratio_2, ratio_3] = options_.yeoh_ratios;
  if (!(std::isfinite(ratio_2) && std::isfinite(ratio_3) && yeoh_is_stable(ratio_2, ratio_3)))
    throw InputError(
        "with the solid's yeoh_ratios C20/C10 and C30/C10 the shear stress falls from some shear "
        "on: give ratios that are not negative, or a C20/C10 whose square is below 5/3 C30/C10");
}

MechanicsResult Solid::solve(const Cilium& cilium, const LoadPath& path,
                             const Progress& progress) const {
  return solve_from(cilium, path, {}, progress);
}

std::optional<std::size_t> Solid::finished_steps(const Cilium& cilium, const LoadPath& path,
                                                 const Checkpoint& checkpoint) const {
  require_valid(cilium, path, options_);
  return SolidCheckpoint(checkpoint, facts(cilium, path, options_)).verify();
}

MechanicsResult Solid::solve_from(const Cilium& cilium, const LoadPath& path,
                                  const Checkpoint& checkpoint, const Progress& progress) const {
  require_valid(cilium, path, options_);
  try {
    return follow(cilium, path, checkpoint, progress);
  } catch (const CheckpointError&) {
    throw;  // on all ranks
  } catch (const RankFailure&) {
    throw;
  } catch (const std::exception& error) {
    require_failure_of_all_ranks(error.what());
    throw;
  }
}

MechanicsResult Solid::follow(const Cilium& cilium, const LoadPath& path,
                              const Checkpoint& checkpoint, const Progress& progress) const {
  PathRun run{cilium, path, options_, progress};
  MechanicsResult result{
      run.finest().undeformed(path.empty() ? 0 : mesh_azimuth(options_, path.front())), {}};
  SolidCheckpoint saved(checkpoint, facts(cilium, path, options_));
  run.go_on_from(saved, result);
  if (run.apart())
    run.follow_apart(saved, result);
  else
    run.follow_together(saved, result);
  return result;
}

}  // namespace ciliaval::fem

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/level.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "fem/beam/beam.h"
#include "fem/solid/body.h"
#include "fem/solid/section.h"
#include "fem/solid/transfer.h"
#include "meshes/gmsh_mesh.h"
#include "problem/error.h"

namespace ciliaval::fem {
namespace {

/// Observed order of the tip in the thickness of the finest layer, to which rings and growth are
/// tied (docs/solid.md): the singularities at the clamped rim and at the interfaces' rims govern.
constexpr double tip_order = 1.5;

/// Corrections of two loads are extrapolated to so many times their distance.
constexpr double farthest_extrapolation = 3;

/// Says once, of however many levels, that it is not the finest mesh that is solved.
Progress coarser_progress(const Progress& progress) {
  if (!progress) return {};
  return [&progress](const std::string& text) {
    const std::string prefix = "coarser mesh, ";
    progress(text.starts_with(prefix) ? text : prefix + text);
  };
}

void add(SolidState& sum, double factor, const SolidState& state) {
  sum.displacement.add(factor, state.displacement);
  for (std::size_t e = 0; e < sum.pressure.size(); ++e)
    sum.pressure[e] += factor * state.pressure[e];
}

/// A clamped base; on the plane of symmetry, where there is one, no displacement across it.
std::vector<DirichletCondition> supports(Extent extent) {
  std::vector<DirichletCondition> conditions{{.boundary = meshes::base_id}};
  if (extent == Extent::half)
    conditions.push_back({.boundary = meshes::symmetry_id, .components = {false, true, false}});
  return conditions;
}

}  // namespace

Level::Level(const Cilium& cilium, const meshes::CylinderMeshOptions& mesh,
             std::span<const Hyperelastic> materials, const LevelOptions& options, Level* coarser)
    : cilium_(cilium), options_(options), finest_layer_(mesh.finest_layer), coarser_(coarser) {
  meshes::make_cylinder(cilium, mesh, triangulation_);
  mapping_ = meshes::cylinder_mapping(triangulation_, element_degree);
  discretise(mesh.half ? Extent::half : Extent::whole, materials);
}

Level::Level(const Cilium& cilium, const meshes::MeshFile& mesh,
             std::span<const Hyperelastic> materials, const LevelOptions& options)
    : cilium_(cilium), options_(options) {
  mapping_ = meshes::read_gmsh(mesh, cilium, triangulation_).mapping;
  discretise(Extent::whole, materials);
}

void Level::discretise(Extent extent, std::span<const Hyperelastic> materials) {
  space_ = std::make_unique<SolidSpace>(triangulation_, *mapping_, materials);
  fibres_ = std::make_unique<Fibres>(*space_, extent);
}

void Level::make_solver(const Load& first) {
  if (solver_) return;
  if (!newton_)
    newton_ = std::make_unique<Newton>(
        *space_, increment_constraints(*space_, supports(fibres_->extent())), options_.solver);
  solver_ = std::make_unique<LoadPathSolver>(
      *space_, *fibres_, *newton_, first, options_.path,
      [this](const Load& target, const Progress& report) { return first_guess(target, report); });
}

LoadPathOutcome Level::advance(const Load& load, const Progress& progress,
                               const std::function<void()>& on_equilibrium) {
  make_solver(load);
  return solver_->advance(load, progress, on_equilibrium);
}

void Level::restore(std::optional<LoadPathState> state) {
  if (!state) return solver_.reset();
  const auto fits = [this](const Equilibrium& equilibrium) {
    return equilibrium.state.displacement.size() == space_->unknowns() &&
           equilibrium.state.pressure.size() == space_->elements().size();
  };
  if (!fits(state->current) || (state->previous && !fits(*state->previous)))
    throw CheckpointError(
        "the checkpoint cannot be used: its states are those of other meshes; start anew with "
        "--fresh, which deletes it");
  make_solver(state->current.load);
  solver_->restore(std::move(*state));
}

Guess Level::first_guess(const Load& load, const Progress& progress) const {
  Guess guess;
  if (coarser_ != nullptr) {
    const std::vector<Correction> known = corrections(load);
    const LoadPathOutcome outcome = coarser_->advance(load, coarser_progress(progress));
    guess.slip_off =
        outcome.slip_off_displacement ? outcome.slip_off_displacement : outcome.slip_off_force;
    guess.lost = outcome.status == Status::failed;
    if (outcome.status == Status::converged) guess.state = corrected(known, guess.applied_force);
  } else if (options_.beam_guess) {
    guess = beam_guess(load);
  }
  if (guess.state) prescribe(*space_, supports(fibres_->extent()), *guess.state);
  return guess;
}

std::vector<Level::Correction> Level::corrections(const Load& load) const {
  if (!coarser_->solver_) return {};
  const LoadPathState& own = solver().state();
  const LoadPathState& coarse = coarser_->solver().state();
  const auto same_load = [&load](const Equilibrium& a, const Equilibrium& b) {
    return same_place(a.load, load) && same_place(b.load, load) &&
           magnitude(a.load) == magnitude(b.load);
  };
  const double F = magnitude(load);
  const double F1 = magnitude(own.current.load);
  if (F1 == 0 || !same_load(own.current, coarse.current)) return {};
  // Lagrange's polynomial in the load through no correction without load and the ones known.
  if (own.previous && coarse.previous && same_load(*own.previous, *coarse.previous)) {
    const double F0 = magnitude(own.previous->load);
    if (F0 != 0 && F0 != F1 && std::abs(F - F1) <= farthest_extrapolation * std::abs(F1 - F0))
      return {{F * (F - F0) / (F1 * (F1 - F0)), &own.current, coarse.current},
              {F * (F - F1) / (F0 * (F0 - F1)), &*own.previous, *coarse.previous}};
  }
  return {{std::clamp(F / F1, -farthest_extrapolation, farthest_extrapolation), &own.current,
           coarse.current}};
}

SolidState Level::corrected(const std::vector<Correction>& known, double& applied_force) const {
  const Equilibrium& coarse = coarser_->solver().current();
  SolidState difference = coarse.state;
  applied_force = coarse.applied_force;
  for (const Correction& correction : known) {
    add(difference, -correction.factor, correction.coarse.state);
    applied_force +=
        correction.factor * (correction.own->applied_force - correction.coarse.applied_force);
  }
  SolidState result = transferred(*coarser_->space_, *coarser_->fibres_, difference, *space_);
  for (const Correction& correction : known) add(result, correction.factor, correction.own->state);
  return result;
}

Guess Level::beam_guess(const Load& load) const {
  const MechanicsResult beam = Beam().solve(cilium_, {load});
  const MechanicsStep& step = beam.steps.front();
  if (!step.deformation) return {};
  return {lifted(step.deformation->centreline, cilium_, *space_), step.applied_force};
}

Deformation Level::deformation(const SolidState& state, const SpreadLoad& load,
                               double azimuth) const {
  return turned({centreline(*space_, *fibres_, state, load),
                 std::make_shared<const SolidBody>(
                     solid_body(*space_, *fibres_, cilium_, state, element_degree))},
                azimuth);
}

Deformation Level::deformation(const Equilibrium& equilibrium, double azimuth) const {
  return deformation(equilibrium.state,
                     spread_load(acting(equilibrium.load, equilibrium.applied_force),
                                 fibres_->area(), options_.path.kernel_width),
                     azimuth);
}

Deformation Level::deformation(double azimuth) const {
  return deformation(solver().current(), azimuth);
}

Deformation Level::undeformed(double azimuth) const {
  return deformation(space_->undeformed(), SpreadLoad{}, azimuth);
}

Vector3 Level::tip() const {
  const Centreline line = centreline(*space_, *fibres_, solver().current().state);
  return line.at(line.length()).position;
}

std::optional<double> Level::tip_uncertainty() const {
  if (coarser_ == nullptr || !coarser_->solver_ || !solver_) return std::nullopt;
  if (magnitude(coarser_->solver().current().load) != magnitude(solver().current().load))
    return std::nullopt;
  const double ratio = std::pow(coarser_->finest_layer_ / finest_layer_, tip_order);
  return (tip() - coarser_->tip()).norm() / (ratio - 1);
}

}  // namespace ciliaval::fem

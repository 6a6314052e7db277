// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/level.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "fem/beam/beam.h"
#include "fem/parallel.h"
#include "fem/solid/equilibrium/initial_guess.h"
#include "fem/solid/loads/dead_forces.h"
#include "fem/solid/loads/environment_forces.h"
#include "fem/solid/postprocessing/body.h"
#include "fem/solid/postprocessing/centreline.h"
#include "meshes/gmsh/gmsh_mesh.h"
#include "problem/error.h"
#include "problem/support/interruption.h"

namespace ciliaval::fem::solid {
using namespace material;
using namespace discretisation;
using namespace loads;
using namespace equilibrium;
using namespace postprocessing;
namespace {

/// Largest extrapolation of the corrections of two loads, in their distance.
constexpr double farthest_extrapolation = 3;

/// Marks the text of every level but the finest, once.
Progress coarser_progress(const Progress& progress) {
  if (!progress) return {};
  return [&progress](ProgressReport report) {
    const std::string prefix = "coarser mesh, ";
    if (!report.text.starts_with(prefix)) report.text = prefix + report.text;
    progress(report);
  };
}

void add(SolidState& sum, double factor, const SolidState& state) {
  sum.displacement.add(factor, state.displacement);
  for (std::size_t e = 0; e < sum.pressure.size(); ++e)
    sum.pressure[e] += factor * state.pressure[e];
}

/// The difference of two levels' states under a load, and its factor in a guess.
struct Correction {
  double factor;
  EquilibriumPair equilibria;
};

/// Lagrange's polynomial in the load through the known corrections and zero at no load. Corrections
/// of another place are left out, and far extrapolations.
std::vector<Correction> corrections(const Load& load, std::span<const EquilibriumPair> behind) {
  const auto usable = [&load](const EquilibriumPair& pair) {
    return same_place(pair.own->load, load) && same_place(pair.coarse->load, load) &&
           pair.own->load == pair.coarse->load &&
           pair.own->load.environment() == load.environment() && magnitude(pair.own->load) != 0;
  };
  if (behind.empty() || !usable(behind[0])) return {};
  const double F = magnitude(load);
  const double F1 = magnitude(behind[0].own->load);
  if (behind.size() > 1 && usable(behind[1])) {
    const double F0 = magnitude(behind[1].own->load);
    if (F0 != F1 && std::abs(F - F1) <= farthest_extrapolation * std::abs(F1 - F0))
      return {{F * (F - F0) / (F1 * (F1 - F0)), behind[0]},
              {F * (F - F1) / (F0 * (F0 - F1)), behind[1]}};
  }
  return {{std::clamp(F / F1, -farthest_extrapolation, farthest_extrapolation), behind[0]}};
}

/// The last two pairs of equilibria of two levels, the last one first.
std::vector<EquilibriumPair> pairs(const LoadPathState* own, const LoadPathState* coarse) {
  if (own == nullptr || coarse == nullptr) return {};
  std::vector<EquilibriumPair> result{{&own->current, &coarse->current}};
  if (own->previous && coarse->previous) result.push_back({&*own->previous, &*coarse->previous});
  return result;
}

/// Contact forces follow the cilium, and a flow pushes by its height.
bool has_potential(const Load& load) {
  return load.is<EnvironmentLoad>() || load.is<DeadLoad>() || load.is<SectionLoad>();
}

/// A clamped base; on the plane of symmetry, where there is one, no displacement across it.
std::vector<DirichletCondition> supports(Extent extent) {
  std::vector<DirichletCondition> conditions{{.boundary = meshes::base_id}};
  if (extent == Extent::half)
    conditions.push_back({.boundary = meshes::symmetry_id, .components = {false, true, false}});
  return conditions;
}

/// … where the half of the body moves against its mirror image.
std::vector<DirichletCondition> antisymmetric_supports() {
  return {{.boundary = meshes::base_id},
          {.boundary = meshes::symmetry_id, .components = {true, false, true}}};
}

[[noreturn]] void throw_other_meshes() {
  throw CheckpointError(
      "the checkpoint cannot be used: its states are those of other meshes; start anew with "
      "--fresh, which deletes it");
}

}  // namespace

Level::Level(const Cilium& cilium, const meshes::cylinder::CylinderMeshOptions& mesh,
             std::span<const Hyperelastic> materials, const LevelOptions& options, Level* coarser)
    : cilium_(cilium), options_(options), coarser_(coarser) {
  const auto nodes = static_cast<double>(meshes::cylinder::quadratic_nodes(cilium, mesh));
  triangulation_ = meshes::cylinder::make_cylinder(cilium, mesh, ranks_of_mesh(3 * nodes));
  mapping_ = meshes::cylinder::cylinder_mapping(*triangulation_, element_degree);
  discretise(mesh.half ? Extent::half : Extent::whole, materials);
}

Level::Level(const Cilium& cilium, const meshes::MeshFile& mesh,
             std::span<const Hyperelastic> materials, const LevelOptions& options)
    : cilium_(cilium), options_(options) {
  meshes::gmsh::GmshMesh read = meshes::gmsh::read_gmsh(mesh, cilium, [this](std::size_t nodes) {
    return ranks_of_mesh(3 * static_cast<double>(nodes));
  });
  triangulation_ = std::move(read.triangulation);
  mapping_ = std::move(read.mapping);
  discretise(Extent::whole, materials);
}

MPI_Comm Level::ranks_of_mesh(double unknowns) {
  may_be_in_parts_ = options_.may_be_in_parts && solvers::is_iterative(options_.solver, unknowns);
  return may_be_in_parts_ ? options_.communicator : MPI_COMM_SELF;
}

void Level::discretise(Extent extent, std::span<const Hyperelastic> materials) {
  support::check_interruption();
  space_ = std::make_unique<SolidSpace>(*triangulation_, *mapping_, materials);
  quadrature_ = std::make_unique<ExtrudedQuadrature>(*space_, extent);
}

Newton& Level::newton() {
  if (!newton_)
    newton_ = std::make_unique<Newton>(
        *space_, increment_constraints(*space_, supports(quadrature_->extent())), options_.solver,
        options_.communicator);
  return *newton_;
}

void Level::start_from_rest(const Load& first) {
  if (solver_) return;
  solver_ = std::make_unique<LoadPathSolver>(
      *space_, *quadrature_, cilium_, newton(), first, options_.path,
      [this](const Load& target, const Progress& report) { return initial_guess(target, report); });
}

LoadPathOutcome Level::advance(const Load& load, const Progress& progress) {
  start_from_rest(load);
  return solver_->advance(load, progress);
}

void Level::require_own(const SolidState& state) const {
  if (state.displacement.size() != space_->unknowns() ||
      state.pressure.size() != space_->elements().size())
    throw_other_meshes();
}

void Level::restore(std::optional<LoadPathState> kept) {
  if (!kept) return solver_.reset();
  kept->current = restored(std::move(kept->current));
  if (kept->previous) kept->previous = restored(std::move(*kept->previous));
  start_from_rest(kept->current.load);
  solver_->restore(std::move(*kept));
}

SolidState Level::to_keep(const SolidState& state) const {
  if (!may_be_in_parts_) return state;
  state.displacement.update_ghost_values();
  std::vector<double> own;  // number, displacements and pressures of each cell
  for (std::size_t e = 0; e < space_->own_elements().size(); ++e) {
    const SolidElement& element = space_->elements()[e];
    own.push_back(static_cast<double>(element.cell->id().get_coarse_cell_id()));
    for (const auto dof : element.dofs) own.push_back(state.displacement.local_element(dof));
    own.insert(own.end(), state.pressure[e].begin(), state.pressure[e].end());
  }
  const auto cells = static_cast<std::size_t>(triangulation_->n_global_active_cells());
  SolidState kept;
  const auto parts = dealii::Utilities::MPI::gather(space_->communicator(), own);
  if (rank(space_->communicator()) != 0) return kept;
  kept.displacement.reinit(static_cast<unsigned int>(element_dofs * cells));
  kept.pressure.resize(cells);
  for (const auto& part : parts)
    for (auto value = part.begin(); value != part.end();) {
      const auto cell = static_cast<std::size_t>(*value++);
      std::copy_n(value, element_dofs, kept.displacement.begin() + element_dofs * cell);
      value += element_dofs;
      std::copy_n(value, element_pressures, kept.pressure[cell].begin());
      value += element_pressures;
    }
  return kept;
}

LoadPathState Level::to_keep(const LoadPathState& state) const {
  LoadPathState kept = state;
  kept.current = to_keep(state.current);
  if (state.previous) kept.previous = to_keep(*state.previous);
  return kept;
}

Equilibrium Level::to_keep(const Equilibrium& equilibrium) const {
  return {equilibrium.load, to_keep(equilibrium.state), equilibrium.applied_force};
}

Equilibrium Level::restored(Equilibrium kept) const {
  return {kept.load, restored(std::move(kept.state)), kept.applied_force};
}

SolidState Level::restored(SolidState kept) const {
  if (!may_be_in_parts_) {
    require_own(kept);
    return kept;
  }
  const auto cells = static_cast<std::size_t>(triangulation_->n_global_active_cells());
  if (kept.displacement.size() != element_dofs * cells || kept.pressure.size() != cells)
    throw_other_meshes();
  SolidState state = space_->undeformed();
  for (std::size_t e = 0; e < space_->elements().size(); ++e) {
    const SolidElement& element = space_->elements()[e];
    const std::size_t cell = element.cell->id().get_coarse_cell_id();
    const double* value = kept.displacement.begin() + element_dofs * cell;
    for (const auto dof : element.dofs) state.displacement.local_element(dof) = *value++;
    state.pressure[e] = kept.pressure[cell];
  }
  state.displacement.update_ghost_values();
  return state;
}

Guess Level::initial_guess(const Load& load, const Progress& progress) const {
  if (coarser_ == nullptr) return guess(load);
  const std::optional<LoadPathState> before =
      coarser_->state() != nullptr ? std::optional(*coarser_->state()) : std::nullopt;
  const LoadPathOutcome outcome = coarser_->advance(load, coarser_progress(progress));
  Guess result;
  if (outcome.status == Status::converged)
    result = guess(load, coarser_->solver().current(), pairs(state(), before ? &*before : nullptr));
  result.slip_off =
      outcome.slip_off_displacement ? outcome.slip_off_displacement : outcome.slip_off_force;
  result.lost = outcome.status == Status::failed || outcome.status == Status::pulled_in;
  return result;
}

Guess Level::guess(const Load& load, const Equilibrium& coarse,
                   std::span<const EquilibriumPair> behind) const {
  const std::vector<Correction> known = corrections(load, behind);
  SolidState difference = coarse.state;
  Guess result;
  result.applied_force = coarse.applied_force;
  for (const auto& [factor, equilibria] : known) {
    add(difference, -factor, equilibria.coarse->state);
    result.applied_force +=
        factor * (equilibria.own->applied_force - equilibria.coarse->applied_force);
  }
  result.state = interpolated(*coarser_->space_, *coarser_->quadrature_, difference, *space_);
  for (const auto& [factor, equilibria] : known) add(*result.state, factor, equilibria.own->state);
  prescribe(*space_, supports(quadrature_->extent()), *result.state);
  return result;
}

Guess Level::guess(const Load& load) const {
  if (!options_.beam_guess) return {};
  // Any beam is some percent off the solid; fig3b's tip is 5e-12 of its deflection off the
  // default's.
  const beam::BeamOptions rough{.degree = 4, .tolerance = 1e-6, .error_estimate = false};
  const MechanicsResult solved = beam::Beam(rough).solve(cilium_, {load});
  const MechanicsStep& step = solved.steps.front();
  if (!step.deformation) return {};
  SolidState state = rod_guess(step.deformation->centreline, cilium_, *space_);
  prescribe(*space_, supports(quadrature_->extent()), state);
  return {std::move(state), step.applied_force};
}

Deformation Level::deformation(const SolidState& state, const SpreadLoad& load,
                               double azimuth) const {
  return turned(
      {centreline(*space_, *quadrature_, state, load),
       std::make_shared<const SolidBody>(solid_body(*space_, *quadrature_, cilium_, state))},
      azimuth);
}

Deformation Level::deformation(const Equilibrium& equilibrium, double azimuth) const {
  return deformation(equilibrium.state,
                     spread_load(cilium_, acting(equilibrium.load, equilibrium.applied_force),
                                 quadrature_->area(), options_.path.kernel_width),
                     azimuth);
}

Deformation Level::deformation(double azimuth) const {
  return deformation(solver().current(), azimuth);
}

Deformation Level::deformation(const SolidState& state, double azimuth) const {
  return deformation(state, SpreadLoad{}, azimuth);
}

Deformation Level::undeformed(double azimuth) const {
  return deformation(space_->undeformed(), azimuth);
}

continuation::PullIn Level::pull_in(const LoadPathOutcome& outcome, double mesh_azimuth) {
  const auto& [fraction, last] = outcome.way_to_fold.back();
  const Centreline line = deformation(last, mesh_azimuth).centreline;
  const surroundings::Environment environment = acting_environment(last.load);
  if (const auto touched = surroundings::touched_magnet(
          surroundings::turned(environment, mesh_azimuth), cilium_, line))
    throw SolverError(continuation::touches_magnet(*touched));
  continuation::PullIn result;
  result.fraction = fraction;
  result.load = outcome.load_at_fold;
  const CentrelinePoint tip = line.at(line.length());
  result.tip = tip.position;
  result.tip_angle = tip.theta();
  double largest = -1;
  for (const surroundings::magnets::Magnet& magnet : environment.magnets) {
    surroundings::Environment one = environment;
    one.magnets = {magnet};
    const double force = force_of_magnets(*space_, cilium_, one, last.state.displacement).norm();
    if (force > largest) {
      largest = force;
      result.magnet = magnet.name;
    }
  }
  for (const OnTheWay& at : outcome.way_to_fold)
    if (const auto variation = second_variation(at.equilibrium))
      result.approach.push_back({at.fraction, variation->smallest_eigenvalue});
  return result;
}

std::optional<SecondVariation> Level::second_variation(const Equilibrium& now) {
  if (!has_potential(now.load)) return std::nullopt;
  const auto of = [this](const ExternalForces& external, const SolidState& state) {
    const auto modes = [&](const std::vector<DirichletCondition>& supports) {
      return newton().second_variation(external, state, increment_constraints(*space_, supports));
    };
    auto result = modes(supports(quadrature_->extent()));
    if (!result || quadrature_->extent() == Extent::whole) return result;
    const SecondVariation across = modes(antisymmetric_supports()).value();
    result->unstable_modes += across.unstable_modes;
    result->smallest_eigenvalue = std::min(result->smallest_eigenvalue, across.smallest_eigenvalue);
    return result;
  };
  auto result =
      of(external_forces(*space_, *quadrature_, cilium_, now.load, options_.path.kernel_width),
         now.state);
  if (!result) return std::nullopt;
  if (!eigenvalue_at_rest_)
    eigenvalue_at_rest_ =
        of(dead_forces(space_->vector()), space_->undeformed()).value().smallest_eigenvalue;
  result->smallest_eigenvalue /= *eigenvalue_at_rest_;
  return result;
}

MantleCompression Level::mantle_compression() const {
  return mantle_compression(solver().current().state);
}

MantleCompression Level::mantle_compression(const SolidState& state) const {
  return postprocessing::mantle_compression(*space_, cilium_, state);
}

}  // namespace ciliaval::fem::solid

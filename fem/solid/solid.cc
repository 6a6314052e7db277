// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/solid.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fem/parallel.h"
#include "fem/solid/contact_run.h"
#include "fem/solid/level.h"
#include "fem/solid/path_run.h"
#include "meshes/cylinder/cylinder_mesh.h"
#include "problem/cilium.h"
#include "problem/error.h"
#include "problem/surroundings/plane.h"

namespace ciliaval::fem::solid {
using namespace material;
namespace {

/// Meshes from coarse to fine. From one to the next all cells get thinner: the layers at the
/// clamped end and at the interfaces, which are half as thick as the ring under the mantle is wide,
/// the ring itself, the layers between; from the fourth on also along the circumference
/// (docs/theory/meshes.md).
struct MeshLevel {
  unsigned int square_cells;
  unsigned int rings;
  double finest_layer;
  double coarsest_layer;
  double growth;
};
constexpr std::array<MeshLevel, mesh_level_count> mesh_levels{{{2, 1, 0.2, 1.0, 0.6},
                                                               {2, 2, 0.08, 0.7, 0.42},
                                                               {2, 3, 0.036, 0.5, 0.3},
                                                               {4, 4, 0.017, 0.35, 0.2},
                                                               {4, 5, 0.008, 0.25, 0.15}}};

/// Cells along the circumference of the companion that tells what those of the section do: twice
/// those of the coarsest mesh.
constexpr unsigned int section_square_cells = 4;

constexpr unsigned int finest_refinement = mesh_level_count - 2;

/// The meshes of a sweep from coarse to fine, with fine layers at the tip: cells along a side of
/// the section's square, and of which level the rest is. A rim that touches is too soft where its
/// nodes are far apart along the circumference, and too stiff in thick layers, which costs more
/// than all else (docs/evidence/sweep.md).
struct SweepMesh {
  unsigned int square_cells;
  unsigned int level;
};
constexpr std::array<SweepMesh, mesh_level_count> sweep_meshes{
    {{2, 0}, {4, 0}, {4, 1}, {4, 2}, {8, 3}}};

/// Error of a sweep over the difference of its two finest meshes, if from mesh to mesh the
/// differences fall by no more than to three quarters: r/(1 − r). The strip along a sharp rim that
/// bears the force is narrower than the cells (docs/evidence/sweep.md).
constexpr double slow_convergence = 3;

/// The section's part of the error with the 16 cells of the finer meshes over that with 8: cells
/// half as wide, of an order of at least 2.
constexpr double finer_section = 0.25;

Hyperelastic law_of(const Segment& segment, const SolidOptions& options) {
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
  for (const Segment& segment : cilium.segments) result.push_back(law_of(segment, options));
  return result;
}

/// Force scale under which a residual is rounding error: J − 1 carries a few ε, which makes forces
/// of some ε K A on a section.
double least_force(const Cilium& cilium) {
  double stiffest = 0;
  for (const Segment& segment : cilium.segments)
    stiffest = std::max(stiffest, segment.bulk_modulus());
  return 4e6 * std::numeric_limits<double>::epsilon() * stiffest * cilium.area();
}

/// True if a pin touches it.
bool is_touched(const LoadPath& path) {
  return !path.empty() && !path.front().touch().is_plain();
}

void require_valid_touch(const Load& load) {
  const TouchLaw& touch = load.touch();
  if (touch.law != TouchLaw::Law::coulomb || touch.at != TouchLaw::At::mantle || touch.radius <= 0)
    throw InputError(
        "the solid takes a touch by Coulomb's law on the mantle, by a pin with a radius");
  if (!surroundings::is_empty(load.environment()))
    throw InputError("the solid takes a touch without an environment only");
}

void require_valid(const Cilium& cilium, const LoadPath& path, const SolidOptions& options) {
  ciliaval::require_valid(cilium);
  if (!options.mesh.empty() && cilium.section.shape != CrossSection::Shape::circle)
    throw InputError("the solid takes a user's mesh of a circular section only");
  for (const Load& load : path) {
    ciliaval::require_valid(load, cilium);
    if (load.is<SweepLoad>() && !surroundings::is_empty(load.environment()))
      throw InputError("the solid takes a sweep without an environment only");
    if ((cilium.is_rectangular() || has_transverse_magnetization(cilium)) &&
        azimuth(load) != azimuth(path.front()))
      throw InputError(
          "the solid takes a path of one azimuth only, if the section is a rectangle or the "
          "magnetisation has components across the axis");
    if (type(load) != type(path.front()))
      throw InputError("a load path cannot change from one load type to another");
    const bool is_spread = load.touch().is_plain();
    if (!is_spread) require_valid_touch(load);
    const std::optional<double> height = contact_height(load);
    if (is_spread && height &&
        !(*height > options.kernel_width && *height + options.kernel_width < cilium.length()))
      throw InputError(
          "the solid spreads the contact force over h - kernel_width < z < h + kernel_width, which "
          "must lie between the base and the tip: choose a smaller kernel_width");
  }
}

bool is_sweep(const LoadPath& path) {
  return !path.empty() && path.front().is<SweepLoad>();
}

/// True if the environment lies in the load's plane, as the solid's symmetry needs it.
bool is_planar(const Load& load) {
  return surroundings::lies_in_plane(load.environment(), direction(load));
}

/// The mesh of a level for a load path, with a plane at each loaded section; half of it if the
/// options say so.
meshes::cylinder::CylinderMeshOptions path_mesh(unsigned int index, const SolidOptions& options,
                                                const LoadPath& path) {
  meshes::cylinder::CylinderMeshOptions mesh = level_mesh(index);
  if (is_sweep(path)) {
    mesh = level_mesh(sweep_meshes.at(index).level);
    mesh.square_cells = sweep_meshes[index].square_cells;
    mesh.fine_tip = true;
  }
  mesh.half = options.symmetry && std::ranges::all_of(path, is_planar);
  for (const Load& load : path)
    if (const auto section = load.as<SectionLoad>()) mesh.planes.push_back(section->arclength);
  return mesh;
}

LevelOptions make_level_options(const Cilium& cilium, const SolidOptions& options,
                                bool may_be_in_parts, MPI_Comm communicator) {
  return {{{options.newton_tolerance, options.max_iterations, least_force(cilium)},
           options.max_cutbacks,
           options.kernel_width},
          options.solver,
          communicator,
          options.initial_guess == InitialGuess::beam,
          may_be_in_parts};
}

/// The meshes from the coarsest to the refinement asked for and that of the section's error; a
/// user's mesh alone.
Levels make_levels(const Cilium& given, const LoadPath& path, SolidOptions options,
                   MPI_Comm communicator) {
  options.symmetry =
      options.symmetry && std::ranges::all_of(path, [&given](const Load& load) {
        return surroundings::lies_in_plane(load.environment(), given, direction(load));
      });
  const bool in_load_frame = options.mesh.empty() && !path.empty();  // as PathRun solves it
  const Cilium cilium = turned(given, in_load_frame ? -azimuth(path.front()) : 0);
  const LevelOptions level_options =
      make_level_options(cilium, options, !is_sweep(path) && !is_touched(path), communicator);
  Levels levels;
  if (!options.mesh.empty()) {
    levels.all.push_back(std::make_unique<Level>(cilium,
                                                 meshes::MeshFile{options.mesh, options.mesh_unit},
                                                 materials(cilium, options), level_options));
    return levels;
  }
  const auto add = [&](const meshes::cylinder::CylinderMeshOptions& mesh, Level* coarser) {
    levels.all.push_back(
        std::make_unique<Level>(cilium, mesh, materials(cilium, options), level_options, coarser));
  };
  levels.finest = mesh_level(options.refinement);
  for (unsigned int i = 0; i <= levels.finest; ++i)
    add(path_mesh(i, options, path), levels.all.empty() ? nullptr : levels.all.back().get());
  if (is_sweep(path)) {
    levels.companions = {levels.finest - 1};
    levels.error_parts = {{"all directions", 0, 1, slow_convergence}};
    // Error part of the last refinement along the circumference, if the levels above do not have
    // it.
    std::size_t finer = levels.finest;
    while (sweep_meshes.at(finer).square_cells == sweep_meshes.at(finer - 1).square_cells) --finer;
    if (finer < levels.finest) {
      levels.companions.insert(levels.companions.end(), {finer, finer - 1});
      levels.error_parts.push_back({"section", 2, 3, 1});
    }
    return levels;
  }
  auto section = path_mesh(0, options, path);
  section.square_cells = section_square_cells;
  add(section, levels.all.front().get());
  levels.companions = {levels.finest - 1, 0, levels.finest + 1};
  const bool is_finer = mesh_levels.at(levels.finest).square_cells >= section_square_cells;
  levels.error_parts = {{"all directions", 0, 1, 1},
                        {"section", 3, 2, is_finer ? finer_section : 1}};
  return levels;
}

}  // namespace

unsigned int mesh_level(unsigned int refinement) {
  if (refinement > finest_refinement)
    throw InputError(fmt::format("the solid has the refinements 0 to {}, not {}", finest_refinement,
                                 refinement));
  return refinement + 1;
}

meshes::cylinder::CylinderMeshOptions level_mesh(unsigned int number) {
  const MeshLevel& level = mesh_levels.at(number);
  meshes::cylinder::CylinderMeshOptions mesh;
  mesh.square_cells = level.square_cells;
  mesh.rings = level.rings;
  mesh.ring_ratio = 0.5;
  mesh.finest_layer = level.finest_layer;
  mesh.coarsest_layer = level.coarsest_layer;
  mesh.growth = level.growth;
  return mesh;
}

meshes::cylinder::CylinderMeshOptions cylinder_mesh_options(unsigned int refinement) {
  return level_mesh(mesh_level(refinement));
}

meshes::cylinder::CylinderMeshOptions cylinder_mesh_options(const SolidOptions& options,
                                                            const LoadPath& path) {
  return path_mesh(mesh_level(options.refinement), options, path);
}

Solid::Solid(SolidOptions options, MPI_Comm communicator)
    : options_(std::move(options)), communicator_(communicator) {
  cylinder_mesh_options(options_.refinement);
  if (!(std::isfinite(options_.kernel_width) && options_.kernel_width > 0))
    throw InputError("the solid's kernel_width must be finite and positive");
  if (!(options_.newton_tolerance > 0 && options_.newton_tolerance < 1))
    throw InputError("the solid's newton_tolerance must lie between 0 and 1");
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

MechanicsResult Solid::solve_from(const Cilium& cilium, const LoadPath& path,
                                  const Checkpoint& checkpoint, const Progress& progress) const {
  require_valid(cilium, path, options_);
  try {
    start_mpi();
    Levels levels = make_levels(cilium, path, options_, communicator_);
    if (is_sweep(path) || is_touched(path))
      return ContactRun(std::move(levels), path, options_, checkpoint, progress, communicator_)
          .follow();
    return PathRun(std::move(levels), path, options_, checkpoint, progress, communicator_).follow();
  } catch (const CheckpointError&) {
    throw;  // on all ranks
  } catch (const RankFailure&) {
    throw;
  } catch (const std::exception& error) {
    require_failure_of_all_ranks(error.what());
    throw;
  }
}

}  // namespace ciliaval::fem::solid

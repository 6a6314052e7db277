// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/solid.h"

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
#include "fem/solid/level.h"
#include "fem/solid/path_run.h"
#include "meshes/cylinder/cylinder_mesh.h"
#include "problem/error.h"

namespace ciliaval::fem::solid {
using namespace material;
namespace {

/// Meshes from coarse to fine. From one to the next the layers at the clamped end and at the
/// interfaces and the cells under the mantle halve.
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

/// Observed order of the tip in the thickness of the finest layer (docs/theory/solid.md): the
/// singularities at the rims of the base and of the interfaces govern.
constexpr double error_order = 1.5;

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
meshes::cylinder::CylinderMeshOptions path_mesh(unsigned int index, const SolidOptions& options,
                                                const LoadPath& path) {
  meshes::cylinder::CylinderMeshOptions mesh = level_mesh(index);
  mesh.half = options.symmetry;
  for (const Load& load : path)
    if (const auto section = load.as<SectionLoad>()) mesh.planes.push_back(section->arclength);
  return mesh;
}

/// The meshes from the coarsest to the refinement asked for, each of which starts from the one
/// before; the next coarser one is the companion of the result. A user's mesh alone.
Levels make_levels(const Cilium& cilium, const LoadPath& path, const SolidOptions& options,
                   MPI_Comm communicator) {
  const LevelOptions level_options{
      {{options.tolerance, options.max_iterations, least_force(cilium)},
       options.max_cutbacks,
       options.kernel_width},
      options.solver,
      communicator,
      options.initial_guess == InitialGuess::beam};
  Levels levels;
  if (!options.mesh.empty()) {
    levels.all.push_back(std::make_unique<Level>(cilium,
                                                 meshes::MeshFile{options.mesh, options.mesh_unit},
                                                 materials(cilium, options), level_options));
    return levels;
  }
  levels.finest = mesh_level(options.refinement);
  for (unsigned int i = 0; i <= levels.finest; ++i)
    levels.all.push_back(std::make_unique<Level>(
        cilium, path_mesh(i, options, path), materials(cilium, options), level_options,
        levels.all.empty() ? nullptr : levels.all.back().get()));
  levels.companions = {levels.finest - 1};
  const double ratio =
      mesh_levels.at(levels.finest - 1).finest_layer / mesh_levels.at(levels.finest).finest_layer;
  levels.error_parts = {{"layers", 0, 1, 1 / (std::pow(ratio, error_order) - 1)}};
  return levels;
}

}  // namespace

unsigned int mesh_level(unsigned int refinement) {
  if (refinement >= refinement_levels.size())
    throw InputError("the solid has the refinements 0 to " +
                     std::to_string(refinement_levels.size() - 1) + ", not " +
                     std::to_string(refinement));
  return refinement_levels[refinement];
}

meshes::cylinder::CylinderMeshOptions level_mesh(unsigned int number) {
  const MeshLevel& level = mesh_levels.at(number);
  meshes::cylinder::CylinderMeshOptions mesh;
  mesh.square_cells = level.square_cells;
  mesh.rings = level.rings;
  mesh.ring_ratio = level.ring_ratio;
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

MechanicsResult Solid::solve_from(const Cilium& cilium, const LoadPath& path,
                                  const Checkpoint& checkpoint, const Progress& progress) const {
  require_valid(cilium, path, options_);
  try {
    start_mpi();
    return PathRun(make_levels(cilium, path, options_, communicator_), path, options_, checkpoint,
                   progress, communicator_)
        .follow();
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

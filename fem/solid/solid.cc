// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/solid.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "fem/solid/body.h"
#include "fem/solid/fibres.h"
#include "fem/solid/load_path.h"
#include "fem/solid/newton.h"
#include "fem/solid/section.h"
#include "fem/solid/space.h"
#include "meshes/cylinder_mesh.h"
#include "problem/error.h"

namespace ciliaval::fem {
namespace {

meshes::CylinderMeshOptions mesh_options(const SolidOptions& options, const LoadPath& path) {
  meshes::CylinderMeshOptions mesh = cylinder_mesh_options(options.refinement);
  mesh.half = options.symmetry;
  for (const Load& load : path)
    if (const auto* section = std::get_if<SectionLoad>(&load))
      mesh.planes.push_back(section->arclength);
  return mesh;
}

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

/// A clamped base; on the plane of symmetry, where there is one, no displacement across it.
std::vector<DirichletCondition> supports(Extent extent) {
  std::vector<DirichletCondition> conditions{{.boundary = meshes::base_id}};
  if (extent == Extent::half)
    conditions.push_back({.boundary = meshes::symmetry_id, .components = {false, true, false}});
  return conditions;
}

/// The load in the frame of the mesh, whose x axis is the load's direction.
Load in_bending_frame(Load load) {
  std::visit([](auto& l) { l.azimuth = 0; }, load);
  return load;
}

/// The discretised cilium. Its members refer to one another: it stays where it is made.
struct Discretisation {
  dealii::Triangulation<3> triangulation;
  std::unique_ptr<dealii::MappingQCache<3>> mapping;
  std::unique_ptr<SolidSpace> space;
  std::unique_ptr<Fibres> fibres;

  Discretisation(const Cilium& cilium, const meshes::CylinderMeshOptions& mesh,
                 const SolidOptions& options) {
    meshes::make_cylinder(cilium, mesh, triangulation);
    mapping = meshes::cylinder_mapping(triangulation, element_degree);
    space = std::make_unique<SolidSpace>(triangulation, *mapping, materials(cilium, options));
    fibres = std::make_unique<Fibres>(*space, mesh.half ? Extent::half : Extent::whole);
  }
};

/// `azimuth` turns the frame of the mesh into that of the cilium.
Deformation deformation(const Discretisation& discretisation, const Cilium& cilium,
                        const SolidState& state, double azimuth, const SpreadLoad& load = {}) {
  const auto& [space, fibres] = std::tie(*discretisation.space, *discretisation.fibres);
  return turned(
      {centreline(space, fibres, state, load),
       std::make_shared<const SolidBody>(solid_body(space, fibres, cilium, state, element_degree))},
      azimuth);
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
    const auto* contact = std::get_if<ContactLoad>(&load);
    if (contact != nullptr && !(contact->height > options.kernel_width &&
                                contact->height + options.kernel_width < cilium.length()))
      throw InputError(
          "the solid spreads the contact force over h - kernel_width < z < h + kernel_width, which "
          "must lie between the base and the tip: choose a smaller kernel_width");
  }
}

}  // namespace

meshes::CylinderMeshOptions cylinder_mesh_options(unsigned int refinement) {
  meshes::CylinderMeshOptions options;
  switch (refinement) {
    case 0:
      options.square_cells = 2;
      options.rings = 1;
      options.finest_layer = 0.15;
      options.coarsest_layer = 0.8;
      return options;
    case 1:
      options.square_cells = 2;
      options.rings = 3;
      options.ring_ratio = 0.5;
      options.finest_layer = 0.08;
      options.coarsest_layer = 0.5;
      options.growth = 0.3;
      return options;
    case 2:
      options.square_cells = 4;
      options.rings = 2;
      options.ring_ratio = 0.5;
      options.finest_layer = 0.05;
      options.coarsest_layer = 0.5;
      options.growth = 0.3;
      return options;
    default:
      throw InputError("the solid has the refinement levels 0, 1 and 2, not " +
                       std::to_string(refinement));
  }
}

Solid::Solid(SolidOptions options) : options_(options) {
  cylinder_mesh_options(options_.refinement);
  if (!(std::isfinite(options_.kernel_width) && options_.kernel_width > 0))
    throw InputError("the solid's kernel_width must be finite and positive");
  if (!(options_.tolerance > 0 && options_.tolerance < 1))
    throw InputError("the solid's tolerance must lie between 0 and 1");
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
  require_valid(cilium, path, options_);
  const Discretisation discretisation(cilium, mesh_options(options_, path), options_);
  const SolidSpace& space = *discretisation.space;
  MechanicsResult result{deformation(discretisation, cilium, space.undeformed(),
                                     path.empty() ? 0 : azimuth(path.front())),
                         {}};
  if (path.empty()) return result;

  const Fibres& fibres = *discretisation.fibres;
  Newton newton(space, increment_constraints(space, supports(fibres.extent())));
  LoadPathOptions options{{options_.tolerance, options_.max_iterations, least_force(cilium)},
                          options_.max_cutbacks,
                          options_.kernel_width};
  LoadPathSolver solver(space, fibres, newton, in_bending_frame(path.front()), options);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const auto start = std::chrono::steady_clock::now();
    const std::string label =
        "step " + std::to_string(i + 1) + "/" + std::to_string(path.size()) + ", ";
    const Progress report =
        progress ? Progress([&](const std::string& text) { progress(label + text); }) : Progress();
    const Load load = in_bending_frame(path[i]);
    const LoadPathOutcome outcome = solver.advance(load, report);
    MechanicsStep step;
    step.load = path[i];
    step.status = outcome.status;
    step.message = outcome.status == Status::failed ? label + outcome.message : outcome.message;
    step.slip_off_force = outcome.slip_off_force;
    step.iterations = outcome.iterations;
    step.unknowns = space.unknowns();
    if (outcome.status == Status::converged) {
      step.deformation =
          deformation(discretisation, cilium, solver.current().state, azimuth(path[i]),
                      spread_load(load, fibres.area(), options_.kernel_width));
      step.applied_force = solver.current().applied_force;
      if (const auto* contact = std::get_if<ContactLoad>(&path[i]))
        step.contact_arclength = contact_arclength(step.deformation->centreline, contact->height);
    }
    step.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.steps.push_back(std::move(step));
  }
  return result;
}

}  // namespace ciliaval::fem

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/loads/external_forces.h"

#include <string>

#include "fem/parallel.h"
#include "fem/solid/loads/dead_forces.h"
#include "fem/solid/loads/environment_forces.h"
#include "fem/solid/loads/tip_couple.h"
#include "problem/cilium.h"
#include "problem/error.h"

namespace ciliaval::fem::solid::loads {
using namespace discretisation;

namespace {

SpreadLoad spread_alone(const Load& load, double area, double kernel_width) {
  SpreadLoad result;
  result.direction = direction(load);
  if (const auto contact = load.as<ContactLoad>())
    result.per_height = contact_density(contact->force, area, contact->height, kernel_width);
  if (const auto flow = load.as<FlowLoad>())
    result.per_height = flow_density(flow->force_per_height, area);
  if (const auto dead = load.as<DeadLoad>()) result.per_volume = dead->force_per_length / area;
  if (!result.per_height && !load.is<DeadLoad>() && !load.is<SectionLoad>() &&
      !load.is<MomentLoad>() && !load.is<EnvironmentLoad>())
    refuse_type(load, "solid");
  return result;
}

}  // namespace

Vector forces_at(const Vector& displacement, const SolidSpace& space,
                 const ExternalForces& external) {
  Vector forces = space.vector();
  std::string trouble;
  try {
    external(displacement, forces, nullptr);
  } catch (const SolverError& error) {
    trouble = error.what();
  }
  trouble = first_text(space.communicator(), trouble);
  if (!trouble.empty()) throw SolverError(trouble);
  forces.compress(dealii::VectorOperation::add);
  return forces;
}

ExternalForces load_forces(const SolidSpace& space, const ExtrudedQuadrature& quadrature,
                           const Load& load, double kernel_width) {
  const SpreadLoad spread = spread_alone(load, quadrature.area(), kernel_width);
  if (const auto section = load.as<SectionLoad>())
    return dead_forces(
        section_force(space, quadrature, section->force, section->arclength, spread.direction));
  if (const auto couple = load.as<MomentLoad>())
    return TipCouple(space, quadrature, *couple).forces();
  if (!spread.per_height) {
    const auto b = [&spread](const Vector3&) -> Vector3 {
      return spread.per_volume * spread.direction;
    };
    return dead_forces(body_force(space, b));
  }
  return [&space, &quadrature, spread](const Vector& displacement, Vector& forces,
                                       TangentMatrix* tangent) {
    add_height_forces(space, quadrature, *spread.per_height, spread.direction, displacement, forces,
                      tangent);
  };
}

Load acting(const Load& load, double applied_force) {
  if (const auto probe = load.as<ProbeLoad>())
    return with_environment(ContactLoad{applied_force, probe->height, probe->azimuth},
                            load.environment());
  return load;
}

SpreadLoad spread_load(const Cilium& cilium, const Load& load, double area, double kernel_width) {
  SpreadLoad result = spread_alone(load, area, kernel_width);
  const surroundings::Environment environment = acting_environment(load);
  if (surroundings::is_empty(environment)) return result;
  for (const Segment& segment : cilium.segments) {
    result.weight.push_back(surroundings::weight_per_volume(environment, segment));
    result.poles.push_back(segment.magnetization * environment.uniform_field);
    result.magnetization.push_back(segment.magnetization);
  }
  result.magnets = environment.magnets;
  result.uniform_field = environment.uniform_field;
  if (has_transverse_magnetization(cilium))
    for (const Segment& segment : cilium.segments) {
      const Vector3 M = magnetization(segment);
      result.transverse_magnetization.emplace_back(M.x(), M.y(), 0);
    }
  return result;
}

ExternalForces external_forces(const SolidSpace& space, const ExtrudedQuadrature& quadrature,
                               const Cilium& cilium, const Load& load, double kernel_width) {
  const ExternalForces own = load_forces(space, quadrature, load, kernel_width);
  const surroundings::Environment environment = acting_environment(load);
  if (surroundings::is_empty(environment)) return own;
  return [own, around = environment_forces(space, cilium, environment)](
             const Vector& displacement, Vector& forces, TangentMatrix* tangent) {
    own(displacement, forces, tangent);
    around(displacement, forces, tangent);
  };
}

}  // namespace ciliaval::fem::solid::loads

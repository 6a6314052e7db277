// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/cilium_beam.h"

#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "problem/cilium.h"
#include "problem/error.h"

namespace ciliaval::fem::beam {
namespace {

/// Stiffness of a segment's section; a rectangle has its sides along x and y (Beam::solve() turns
/// it so).
SectionStiffness stiffness(const Cilium& cilium, const Segment& s) {
  const double quarter = std::numbers::pi / 2;
  switch (cilium.section.shape) {
    case CrossSection::Shape::rectangle:
      return rectangular_section(cilium.extent(0), cilium.extent(quarter), s.young_modulus,
                                 s.poisson_ratio);
    case CrossSection::Shape::tube:
      return tube_section(cilium.diameter, cilium.section.inner_diameter, s.young_modulus,
                          s.poisson_ratio);
    default:
      return circular_section(cilium.diameter, s.young_modulus, s.poisson_ratio);
  }
}

Section segment_section(const Cilium& cilium, std::size_t segment, const BeamOptions& options,
                        const joints::Corrections& corrections) {
  const Segment& s = cilium.segments[segment];
  Section law = section(stiffness(cilium, s));
  if (options.shear_rigid) return rigid_in_shear(law);
  if (!corrections.empty()) law.beyond = corrections.laws[segment];
  return law;
}

/// Appends 2^refinement equal elements up to S = end.
void append(Mesh& mesh, double end, const Section& law, const BeamOptions& options) {
  if (mesh.vertices.empty()) mesh.vertices.push_back(0);
  const double begin = mesh.vertices.back();
  const std::size_t n = std::size_t{1} << options.refinement;
  for (std::size_t i = 1; i <= n; ++i) {
    mesh.vertices.push_back(
        i == n ? end : std::lerp(begin, end, static_cast<double>(i) / static_cast<double>(n)));
    mesh.sections.push_back(law);
  }
}

/// Appends the joint below segment k.
void append_joint(Mesh& mesh, double S, const joints::Corrections& corrections, std::size_t k) {
  if (corrections.empty()) return;
  if (mesh.vertices.empty()) mesh.vertices.push_back(S);
  mesh.vertices.push_back(S);
  mesh.sections.push_back(joint_section(corrections.joints[k]));
}

CiliumBeam finished(Mesh mesh, std::size_t loaded, const Cilium& cilium) {
  std::vector<std::size_t> segments;
  for (std::size_t e = 0; e < mesh.n_elements(); ++e)
    segments.push_back(cilium.segment_at(std::midpoint(mesh.vertices[e], mesh.vertices[e + 1])));
  return {System(straight_curve, std::move(mesh), {{0}}), loaded, std::move(segments)};
}

}  // namespace

CiliumBeam cilium_beam(const Cilium& cilium, const BeamOptions& options,
                       std::optional<double> load_at, const joints::Corrections& corrections) {
  const std::vector<double> ends = cilium.interfaces();
  const double L = ends.back();
  Mesh mesh;
  mesh.degree = options.degree;
  std::size_t loaded = 0;
  for (std::size_t k = 0; k < cilium.segments.size(); ++k) {
    const Section law = segment_section(cilium, k, options, corrections);
    append_joint(mesh, ends[k], corrections, k);
    const bool inside = load_at && *load_at > ends[k] && *load_at < ends[k + 1];
    if (inside) {
      append(mesh, *load_at, law, options);
      loaded = mesh.n_elements();
    }
    append(mesh, ends[k + 1], law, options);
    if (load_at.value_or(L) == ends[k + 1]) loaded = mesh.n_elements();
  }
  return finished(std::move(mesh), loaded, cilium);
}

CiliumBeam cilium_beam_with_moving_vertex(const Cilium& cilium, const BeamOptions& options,
                                          std::size_t host,
                                          const joints::Corrections& corrections) {
  const std::vector<double> ends = cilium.interfaces();
  const std::size_t n = std::size_t{1} << options.refinement;
  Mesh mesh;
  mesh.degree = options.degree;
  std::size_t loaded = 0;
  for (std::size_t k = 0; k < cilium.segments.size(); ++k) {
    const Section law = segment_section(cilium, k, options, corrections);
    append_joint(mesh, ends[k], corrections, k);
    if (k == host) {
      append(mesh, ends[k], law, options);
      loaded = mesh.n_elements();
    }
    append(mesh, ends[k + 1], law, options);
  }
  mesh.velocities.assign(mesh.vertices.size(), 0.0);
  for (std::size_t i = 0; i <= n; ++i) {
    const double fraction = static_cast<double>(i) / static_cast<double>(n);
    mesh.velocities[loaded - n + i] = fraction;
    mesh.velocities[loaded + i] = 1 - fraction;
  }
  return finished(std::move(mesh), loaded, cilium);
}

Loads environment_loads(const Cilium& cilium, const Load& load, const CiliumBeam& beam) {
  const surroundings::Environment environment = acting_environment(load);
  Loads result;
  if (surroundings::is_empty(environment)) return result;
  result.magnetic_energy = environment.magnetic_energy;
  const bool is_transverse = has_transverse_magnetization(cilium);
  for (std::size_t e = 0; e < beam.segments.size(); ++e) {
    const std::size_t segment = beam.segments[e];
    const bool is_joint = beam.system.mesh().sections[e].is_joint;  // which is not magnetic
    result.force_per_length.push_back(
        cilium.area() * surroundings::weight_per_volume(environment, cilium.segments[segment]));
    result.magnetic_force.push_back(
        is_joint ? Vector3::Zero() : surroundings::pole_force(environment, cilium, segment));
    if (!environment.magnets.empty())
      result.magnetic_charge.push_back(
          is_joint ? 0 : cilium.segments[segment].magnetization * cilium.area());
    if (!is_transverse) continue;
    Eigen::Vector2d charge = Eigen::Vector2d::Zero();
    if (!is_joint) charge = cilium.area() * magnetization(cilium.segments[segment]).head<2>();
    result.transverse_force.push_back(environment.uniform_field * charge.transpose());
    result.transverse_charge.push_back(charge);
  }
  result.magnets = environment.magnets;
  return result;
}

std::optional<double> largest_turn(const Load& load) {
  if (surroundings::is_empty(acting_environment(load))) return std::nullopt;
  return turn_in_environment;
}

double environment_force(const Cilium& cilium, const Load& load) {
  const surroundings::Environment environment = acting_environment(load);
  double force = 0;
  for (const Segment& segment : cilium.segments)
    force += cilium.area() * segment.length *
             surroundings::weight_per_volume(environment, segment).dot(direction(load));
  return force;
}

Loads loads(const Cilium& cilium, const Load& load, const CiliumBeam& beam) {
  if (load.is<ProbeLoad>()) throw InputError("the force of a probe is a result, not a load");
  const Vector3 force = magnitude(load) * direction(load);
  Loads result;
  if (load.is<FlowLoad>())
    result.force_per_height = force;
  else if (load.is<DeadLoad>())
    result.force_per_length.assign(beam.system.mesh().n_elements(), force);
  else if (load.is<ContactLoad>() || load.is<SectionLoad>())
    result.points.push_back({beam.loaded, force, Vector3::Zero()});
  else if (const auto couple = load.as<MomentLoad>())
    result.points.push_back(
        {beam.loaded, Vector3::Zero(), couple->moment * Vector3::UnitZ().cross(direction(load))});
  else if (!load.is<EnvironmentLoad>())
    refuse_type(load, "beam");
  return combine(1, result, 1, environment_loads(cilium, load, beam));
}

}  // namespace ciliaval::fem::beam

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/cilium_beam.h"

#include <cmath>

#include "problem/error.h"

namespace ciliaval::fem::beam {
namespace {

Section segment_section(const Cilium& cilium, std::size_t segment, const BeamOptions& options) {
  const Segment& s = cilium.segments[segment];
  const Section law = section(circular_section(cilium.diameter, s.young_modulus, s.poisson_ratio));
  return options.shear_rigid ? rigid_in_shear(law) : law;
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

}  // namespace

CiliumBeam cilium_beam(const Cilium& cilium, const BeamOptions& options,
                       std::optional<double> load_at) {
  const std::vector<double> ends = cilium.interfaces();
  const double L = ends.back();
  Mesh mesh;
  mesh.degree = options.degree;
  std::size_t loaded = 0;
  for (std::size_t k = 0; k < cilium.segments.size(); ++k) {
    const Section law = segment_section(cilium, k, options);
    const bool inside = load_at && *load_at > ends[k] && *load_at < ends[k + 1];
    if (inside) {
      append(mesh, *load_at, law, options);
      loaded = mesh.n_elements();
    }
    append(mesh, ends[k + 1], law, options);
    if (load_at.value_or(L) == ends[k + 1]) loaded = mesh.n_elements();
  }
  return {System(straight_curve, std::move(mesh), {{0}}), loaded};
}

CiliumBeam cilium_beam_with_moving_vertex(const Cilium& cilium, const BeamOptions& options,
                                          std::size_t host) {
  const std::vector<double> ends = cilium.interfaces();
  const std::size_t n = std::size_t{1} << options.refinement;
  Mesh mesh;
  mesh.degree = options.degree;
  std::size_t loaded = 0;
  for (std::size_t k = 0; k < cilium.segments.size(); ++k) {
    const Section law = segment_section(cilium, k, options);
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
  return {System(straight_curve, std::move(mesh), {{0}}), loaded};
}

Loads loads(const Load& load, const CiliumBeam& beam) {
  if (load.is<ProbeLoad>()) throw InputError("the force of a probe is a result, not a load");
  const Vector3 force = magnitude(load) * direction(load);
  Loads result;
  if (load.is<FlowLoad>())
    result.force_per_height = force;
  else if (load.is<DeadLoad>())
    result.force_per_length.assign(beam.system.mesh().n_elements(), force);
  else if (load.is<ContactLoad>() || load.is<SectionLoad>())
    result.points.push_back({beam.loaded, force, Vector3::Zero()});
  else
    refuse_type(load, "beam");
  return result;
}

}  // namespace ciliaval::fem::beam

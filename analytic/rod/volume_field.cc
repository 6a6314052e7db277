// SPDX-License-Identifier: LGPL-2.1-or-later
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "analytic/rod/end_discs.h"
#include "analytic/rod/end_rectangles.h"
#include "analytic/rod/field_models.h"
#include "analytic/rod/loop_stack.h"
#include "analytic/rod/mantle.h"
#include "analytic/rod/rod_magnet.h"
#include "analytic/rod/rod_quadrature.h"
#include "analytic/rod/uniform_sums.h"
#include "analytic/sources/adaptive_order.h"
#include "analytic/sources/field_points.h"
#include "problem/error.h"
#include "problem/support/interruption.h"
#include "problem/types.h"

namespace ciliaval::analytic::rod {
namespace {

/// The closed form if its uncertainty is within the tolerance. Far from a magnet that is short
/// beside the distance its parts cancel; there the field is that of the dipoles in the volume.
sources::FieldValue closed_form_or_far_field(const RodMagnet& magnet, const RodInterior& interior,
                                             VolumeOptions::Slices slices,
                                             const sources::FieldValue& closed_form,
                                             const sources::AdaptiveOrder& asked) {
  if (sources::is_within(closed_form, asked.tolerance)) return closed_form;
  if (const auto far = far_field_of_rod(magnet, interior, slices, asked.tolerance, asked.x))
    return *far;
  sources::require_tolerance(closed_form, asked);
  return closed_form;
}

/// B = μ₀ Σ σ H(disc or rectangle) + μ₀ m of the wedge's reference charge on the end sections, and
/// by quadrature of what is on the mantle.
Field field_of_discs(const RodMagnet& magnet, double tolerance, std::span<const Vector3> points) {
  const RodInterior interior(magnet);
  const bool is_rectangular = magnet.shape.shape == CrossSection::Shape::rectangle;
  const std::vector<MantlePatch> patches = mantle_patches(magnet);
  const body::PatchIntegral<2, double> mantle(
      patches.size(),
      [&patches](std::size_t patch, const std::array<double, 2>& xi) { return patches[patch](xi); },
      "field of the charged mantle");
  return sources::field_at(points, 256, [&](const Vector3& x) {
    sources::FieldValue sum = is_rectangular ? field_of_end_rectangles(magnet.ends, x)
                                             : field_of_end_discs(magnet.ends, x);
    if (const auto m = interior.magnetization_at(x)) {
      const Vector3 inside = vacuum_permeability * *m;
      sum += {inside, Vector3::Constant(40 * epsilon * inside.norm())};
    }
    if (!patches.empty()) {
      const sources::FieldValue all = mantle.sum(x, sum.B, tolerance).value;
      sum = {all.B, sum.uncertainty + all.uncertainty};
    }
    return closed_form_or_far_field(magnet, interior, VolumeOptions::Slices::wedge, sum,
                                    {tolerance, 0, "field of the charged faces", x});
  });
}

Field field_of_loops(const RodMagnet& magnet, double tolerance, std::span<const Vector3> points) {
  const LoopStack stack(magnet);
  const RodInterior interior(magnet);
  return sources::field_at(points, 16, [&](const Vector3& x) {
    require_off_the_rims(magnet.ends, x);
    return closed_form_or_far_field(magnet, interior, VolumeOptions::Slices::stacked,
                                    stack.field(x, tolerance),
                                    {tolerance, 0, "field of the stacked slices", x});
  });
}

}  // namespace

Field VolumeField::field(const Cilium& cilium, const Deformation& deformation,
                         std::span<const Vector3> points) const {
  const RodMagnet magnet = rod_magnet(cilium, deformation);
  const bool is_wedge = options_.slices == VolumeOptions::Slices::wedge;
  if (cilium.section.shape != CrossSection::Shape::circle &&
      options_.method != Method::quadrature &&
      !(is_wedge && options_.method == Method::closed_form))
    throw InputError(
        "the model `volume` takes a rectangle or a tube by the slices `wedge` and the method "
        "`closed_form`, or by the method `quadrature`");
  if (is_wedge) require_body(magnet);
  if (!is_wedge && options_.method == Method::closed_form && is_transverse(magnet))
    throw InputError(
        "the current loops of the model `volume` with the slices `stacked` are those of an axial "
        "magnetisation: take the slices `wedge` or the method `quadrature`");
  if (options_.method == Method::closed_form)
    return is_wedge ? field_of_discs(magnet, options_.tolerance, points)
                    : field_of_loops(magnet, options_.tolerance, points);
  if (options_.method == Method::uniform) return field_of_uniform_volume(magnet, options_, points);
  const RodInterior interior(magnet);
  return sources::field_at(points, 1, [&](const Vector3& x) {
    if (!cilium.is_rectangular()) require_off_the_rims(magnet.ends, x);
    return rod_field_by_quadrature(magnet, interior, options_.slices, options_.tolerance, x);
  });
}

std::vector<Vector3> VolumeField::magnetization(const Cilium& cilium,
                                                const Deformation& deformation,
                                                std::span<const Vector3> points) const {
  const RodMagnet magnet = rod_magnet(cilium, deformation);
  const bool is_wedge = options_.slices == VolumeOptions::Slices::wedge;
  if (is_wedge) require_body(magnet);
  const RodInterior interior(magnet);
  std::vector<Vector3> result;
  for (const Vector3& x : points) {
    support::check_interruption();
    const std::optional<Vector3> m = interior.magnetization_at(x);
    if (m && !is_wedge)
      throw InputError("the magnetisation of the model `volume` was asked at " +
                       sources::to_string(x) +
                       ", inside the magnet: its slices `stacked` overlap there, take `wedge`");
    result.push_back(m.value_or(Vector3::Zero()));
  }
  return result;
}

std::vector<Matrix3> VolumeField::gradient(const Cilium& cilium, const Deformation& deformation,
                                           std::span<const Vector3> points) const {
  if (options_.slices != VolumeOptions::Slices::wedge || options_.method != Method::closed_form)
    throw InputError(
        "the gradient of the model `volume` has a closed form for the slices `wedge` by the method "
        "`closed_form` only");
  if (cilium.is_rectangular())
    throw InputError("the gradient of the model `volume` has no closed form for a rectangle yet");
  const RodMagnet magnet = rod_magnet(cilium, deformation);
  require_body(magnet);
  if (is_transverse(magnet))
    throw InputError(
        "the gradient of the model `volume` has a closed form for an axial magnetisation only");
  const RodInterior interior(magnet);
  return sources::gradient_at(points, [&](const Vector3& x) {
    if (interior.magnetization_at(x))
      throw InputError("the gradient of the model `volume` was asked at " + sources::to_string(x) +
                       ", inside the magnet: move the point outside");
    const DiscsGradient discs = gradient_of_end_discs(magnet.ends, x);
    if (discs.rounding <= options_.tolerance * discs.value.norm()) return discs.value;
    return far_gradient_of_rod(magnet, interior, options_.tolerance, x).value_or(discs.value);
  });
}

}  // namespace ciliaval::analytic::rod

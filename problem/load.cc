// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/load.h"

#include <cmath>
#include <type_traits>

#include "problem/error.h"

namespace ciliaval {
namespace {

double& magnitude_of(ContactLoad& load) {
  return load.force;
}
double& magnitude_of(FlowLoad& load) {
  return load.force_per_height;
}
double& magnitude_of(SectionLoad& load) {
  return load.force;
}
double& magnitude_of(DeadLoad& load) {
  return load.force_per_length;
}
double& magnitude_of(ProbeLoad& load) {
  return load.displacement;
}

std::string_view unit_of(const ContactLoad& /*load*/) {
  return "N";
}
std::string_view unit_of(const FlowLoad& /*load*/) {
  return "N/m";
}
std::string_view unit_of(const SectionLoad& /*load*/) {
  return "N";
}
std::string_view unit_of(const DeadLoad& /*load*/) {
  return "N/m";
}
std::string_view unit_of(const ProbeLoad& /*load*/) {
  return "m";
}

ContactLoad mix(const ContactLoad& a, const ContactLoad& b, double t) {
  return {std::lerp(a.force, b.force, t), std::lerp(a.height, b.height, t),
          std::lerp(a.azimuth, b.azimuth, t)};
}
FlowLoad mix(const FlowLoad& a, const FlowLoad& b, double t) {
  return {std::lerp(a.force_per_height, b.force_per_height, t), std::lerp(a.azimuth, b.azimuth, t)};
}
SectionLoad mix(const SectionLoad& a, const SectionLoad& b, double t) {
  return {std::lerp(a.force, b.force, t), std::lerp(a.arclength, b.arclength, t),
          std::lerp(a.azimuth, b.azimuth, t)};
}
DeadLoad mix(const DeadLoad& a, const DeadLoad& b, double t) {
  return {std::lerp(a.force_per_length, b.force_per_length, t), std::lerp(a.azimuth, b.azimuth, t)};
}
ProbeLoad mix(const ProbeLoad& a, const ProbeLoad& b, double t) {
  return {std::lerp(a.displacement, b.displacement, t), std::lerp(a.height, b.height, t),
          std::lerp(a.azimuth, b.azimuth, t)};
}

}  // namespace

std::string_view type(const Load& load) {
  return std::visit([](const auto& l) { return std::decay_t<decltype(l)>::type; }, load);
}

double azimuth(const Load& load) {
  return std::visit([](const auto& l) { return l.azimuth; }, load);
}

Vector3 direction(const Load& load) {
  const double phi = azimuth(load);
  return {std::cos(phi), std::sin(phi), 0.0};
}

double magnitude(const Load& load) {
  return std::visit([](auto l) { return magnitude_of(l); }, load);
}

std::string_view magnitude_unit(const Load& load) {
  return std::visit([](const auto& l) { return unit_of(l); }, load);
}

std::optional<double> contact_height(const Load& load) {
  if (const auto* contact = std::get_if<ContactLoad>(&load)) return contact->height;
  if (const auto* probe = std::get_if<ProbeLoad>(&load)) return probe->height;
  return std::nullopt;
}

Load with_magnitude(const Load& load, double magnitude) {
  return std::visit(
      [magnitude](auto l) -> Load {
        magnitude_of(l) = magnitude;
        return l;
      },
      load);
}

Load interpolate(const Load& from, const Load& to, double t) {
  return std::visit(
      [&](const auto& a) -> Load {
        const auto* b = std::get_if<std::decay_t<decltype(a)>>(&to);
        if (b == nullptr)
          throw InputError("a load path cannot change from one load type to another");
        return mix(a, *b, t);
      },
      from);
}

void require_valid(const Load& load, const Cilium& cilium) {
  if (!std::isfinite(magnitude(load)) || magnitude(load) < 0)
    throw InputError(
        "the load must be finite and not negative; to turn it round, add 180 deg to the azimuth");
  if (!std::isfinite(azimuth(load))) throw InputError("the azimuth must be finite");
  if (const auto height = contact_height(load)) {
    if (!(*height > 0 && *height < cilium.length()))
      throw InputError("the contact height must lie between the base and the tip of the cilium");
  }
  if (const auto* section = std::get_if<SectionLoad>(&load)) {
    if (!(section->arclength > 0 && section->arclength <= cilium.length()))
      throw InputError(
          "the loaded section must lie above the base and not beyond the tip of the cilium");
  }
}

}  // namespace ciliaval

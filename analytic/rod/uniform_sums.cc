// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/rod/uniform_sums.h"

#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>

#include "analytic/sources/dipole.h"
#include "analytic/sources/field_points.h"
#include "problem/error.h"

namespace ciliaval::analytic::rod {
namespace {

double height(const RodMagnet& magnet, const RodStretch& stretch, double S) {
  return at(magnet, stretch, S).position.z();
}

void require_rising(const CentrelinePoint& point) {
  if (!(point.derivative.z() > 0))
    throw InputError(
        "the method `uniform` cuts the magnet into slices of equal height, as the paper does, but "
        "the centreline does not rise all along: take `closed_form` or `quadrature`");
}

/// The section at the height z of a stretch.
CentrelinePoint section_at_height(const RodMagnet& magnet, const RodStretch& stretch, double z) {
  const double z_begin = height(magnet, stretch, stretch.begin);
  const double z_end = height(magnet, stretch, stretch.end);
  const double guess = std::lerp(stretch.begin, stretch.end,
                                 std::clamp((z - z_begin) / (z_end - z_begin), 0.0, 1.0));
  const auto above = [&](double S) {
    const CentrelinePoint point = at(magnet, stretch, S);
    require_rising(point);
    return std::pair(point.position.z() - z, point.derivative.z());
  };
  std::uintmax_t iterations = 100;
  const double S = boost::math::tools::newton_raphson_iterate(
      above, guess, stretch.begin, stretch.end, std::numeric_limits<double>::digits - 4,
      iterations);
  CentrelinePoint point = at(magnet, stretch, S);
  require_rising(point);
  return point;
}

/// n slices of the stretches of one segment.
void append_slices(const RodMagnet& magnet, std::span<const RodStretch> segment, std::size_t n,
                   std::vector<UniformSlice>& slices) {
  const double bottom = height(magnet, segment.front(), segment.front().begin);
  const double top = height(magnet, segment.back(), segment.back().end);
  const double dz = (top - bottom) / static_cast<double>(n);
  std::size_t current = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double z = bottom + (static_cast<double>(i) + 0.5) * dz;
    while (current + 1 < segment.size() &&
           height(magnet, segment[current], segment[current].end) < z)
      ++current;
    const RodStretch& stretch = segment[current];
    const CentrelinePoint point = section_at_height(magnet, stretch, z);
    slices.push_back({point, dz / point.derivative.z(), stretch});
  }
}

/// B(n), and its difference from B(n/2) (of n = 1: B(2)) and its rounding as the uncertainty.
template <class Sum, class Rounding>
Field field_of_sums(std::span<const Vector3> points, std::size_t grain, const Sum& sum,
                    const Sum& other, const Rounding& rounding_of_the_ends) {
  return sources::field_at(points, grain, [&](const Vector3& x) {
    sources::FieldValue value = sum(x);
    value.uncertainty += (value.B - other(x).B).cwiseAbs();
    value.uncertainty += Vector3::Constant(rounding_of_the_ends(x));
    return value;
  });
}

std::size_t other_count(std::size_t n) {
  return n == 1 ? 2 : n / 2;
}

std::vector<sources::Dipole> line_dipoles(const RodMagnet& magnet, const LineOptions& options,
                                          std::size_t n) {
  std::vector<sources::Dipole> dipoles;
  for (const UniformSlice& slice : uniform_slices(magnet, n)) {
    const Vector3 axis = options.push_forward == sources::PushForward::F ? slice.point.derivative
                                                                         : slice.point.normal();
    dipoles.push_back(
        {slice.point.position,
         magnet.area * slice.thickness * carried_magnetization(slice.stretch, slice.point, axis)});
  }
  return dipoles;
}

/// The sum of n³ dipoles; their places in a section are the same in all.
class VolumeSum {
 public:
  VolumeSum(const RodMagnet& magnet, const VolumeOptions& options, std::size_t n)
      : wedge_(options.slices == VolumeOptions::Slices::wedge), slices_(uniform_slices(magnet, n)) {
    const double dr = magnet.radius / static_cast<double>(n);
    const double dphi = 2 * std::numbers::pi / static_cast<double>(n);
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t k = 0; k < n; ++k) {
        const double r = (static_cast<double>(j) + 0.5) * dr;
        const double phi = (static_cast<double>(k) + 0.5) * dphi;
        places_.push_back({{r * std::cos(phi), r * std::sin(phi)}, r * dr * dphi});
      }
  }

  sources::FieldValue operator()(const Vector3& x) const {
    sources::SourceSum sum(x);
    for (const UniformSlice& slice : slices_) {
      const Matrix3 directors = slice.point.rotation.toRotationMatrix();
      Vector3 section = Vector3::Zero();
      for (const Place& place : places_) {
        const Vector3 y = slice.point.position + directors.leftCols<2>() * place.offset;
        const Vector3 axis = wedge_ ? stretch_vector(slice.point, y) : Vector3(directors.col(2));
        section += sources::dipole_field(
            place.area * carried_magnetization(slice.stretch, slice.point, axis), x - y);
      }
      sum.add(slice.thickness * section, slice.point.position);
    }
    return sum.value();
  }

 private:
  struct Place {
    Eigen::Vector2d offset;  // along d₁ and d₂, m
    double area;             // m²
  };
  bool wedge_;
  std::vector<UniformSlice> slices_;
  std::vector<Place> places_;
};

}  // namespace

std::vector<UniformSlice> uniform_slices(const RodMagnet& magnet, std::size_t n) {
  if (n == 0) throw InputError("the method `uniform` was asked for 0 elements: ask for 1 or more");
  std::vector<UniformSlice> slices;
  for (std::size_t first = 0; first < magnet.stretches.size();) {
    std::size_t last = first + 1;
    while (last < magnet.stretches.size() &&
           magnet.stretches[last].segment == magnet.stretches[first].segment)
      ++last;
    append_slices(magnet, std::span(magnet.stretches).subspan(first, last - first), n, slices);
    first = last;
  }
  return slices;
}

Field field_of_uniform_line(const RodMagnet& magnet, const LineOptions& options,
                            std::span<const Vector3> points) {
  const auto sum_of = [&](std::size_t n) {
    return [dipoles = line_dipoles(magnet, options, n)](const Vector3& x) {
      sources::SourceSum sum(x);
      for (const sources::Dipole& dipole : dipoles)
        sum.add(sources::dipole_field(dipole.moment, x - dipole.position), dipole.position);
      return sum.value();
    };
  };
  const std::size_t n = options.elements;
  return field_of_sums(points, 1 + 4096 / (n + 1), sum_of(n), sum_of(other_count(n)),
                       [&](const Vector3& x) { return rounding_of_poles(magnet, x); });
}

Field field_of_uniform_volume(const RodMagnet& magnet, const VolumeOptions& options,
                              std::span<const Vector3> points) {
  const RodInterior interior(magnet);
  for (const Vector3& x : points)
    if (x.allFinite() && interior.magnetization_at(x))
      throw SolverError("the sum of the model `volume` with the method `uniform` was asked at " +
                        sources::to_string(x) +
                        ", inside the magnet, where it does not converge: take "
                        "`closed_form`");
  const std::size_t n = options.elements;
  return field_of_sums(points, 1, VolumeSum(magnet, options, n),
                       VolumeSum(magnet, options, other_count(n)),
                       [&](const Vector3& x) { return rounding_of_ends(magnet, x); });
}

}  // namespace ciliaval::analytic::rod

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/rod/mantle.h"

#include <cmath>
#include <numbers>

namespace ciliaval::analytic::rod {
namespace {

/// A point (X, Y) of the section's outline and N ds, its outward normal times the length per dξ.
struct OutlinePoint {
  Eigen::Vector2d place;
  Eigen::Vector2d normal;
};
using Outline = std::function<OutlinePoint(double xi)>;

/// A circle in quarters; the normal points outwards, or inwards of a hole.
void append_circle(double radius, double outwards, std::vector<Outline>& outlines) {
  constexpr double quarter = std::numbers::pi / 2;
  for (int i = 0; i < 4; ++i)
    outlines.emplace_back([=](double xi) -> OutlinePoint {
      const Eigen::Vector2d e(std::cos(quarter * (i + xi)), std::sin(quarter * (i + xi)));
      return {radius * e, outwards * radius * quarter * e};
    });
}

void append_rectangle(const CrossSection& shape, std::vector<Outline>& outlines) {
  const Eigen::Rotation2Dd turn(shape.orientation);
  const Eigen::Vector2d a = turn * Eigen::Vector2d(shape.width / 2, 0);
  const Eigen::Vector2d b = turn * Eigen::Vector2d(0, shape.height / 2);
  const auto append = [&](const Eigen::Vector2d& out, const Eigen::Vector2d& along) {
    outlines.emplace_back([=](double xi) -> OutlinePoint {
      return {out + (2 * xi - 1) * along, 2 * along.norm() * out.normalized()};
    });
  };
  append(a, b);
  append(-a, b);
  append(b, a);
  append(-b, a);
}

std::vector<Outline> outlines_of(const RodMagnet& magnet) {
  std::vector<Outline> outlines;
  if (magnet.shape.shape == CrossSection::Shape::rectangle)
    append_rectangle(magnet.shape, outlines);
  else
    append_circle(magnet.radius, 1, outlines);
  if (magnet.shape.shape == CrossSection::Shape::tube)
    append_circle(magnet.shape.inner_diameter / 2, -1, outlines);
  return outlines;
}

}  // namespace

std::vector<MantlePatch> mantle_patches(const RodMagnet& magnet) {
  std::vector<MantlePatch> patches;
  for (const RodStretch& stretch : magnet.stretches) {
    const Eigen::Vector2d M = stretch.magnetization.head<2>();
    if (M.isZero(0)) continue;
    for (const Outline& outline : outlines_of(magnet))
      patches.emplace_back([&magnet, &stretch, M, outline](const std::array<double, 2>& xi) {
        const double length = stretch.end - stretch.begin;
        const CentrelinePoint point = at(magnet, stretch, stretch.begin + xi[0] * length);
        const auto [place, normal] = outline(xi[1]);
        return body::PatchPoint<double>{
            point.position + point.rotation * Vector3(place.x(), place.y(), 0),
            length * M.dot(normal)};
      });
  }
  return patches;
}

}  // namespace ciliaval::analytic::rod

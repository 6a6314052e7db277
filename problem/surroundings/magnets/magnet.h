// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "problem/types.h"

/// Uniformly magnetised bodies beside the cilium: their shapes, their fields with derivatives.
namespace ciliaval::surroundings::magnets {

enum class Shape { ball, cylinder, cuboid };

/// "ball", "cylinder" or "cuboid".
std::string_view name(Shape shape);

/// A permanent magnet at rest. Its own axes have their origin at its centre; a cylinder's axis is
/// the third, a cuboid's edges lie along all three.
struct Magnet {
  std::string name;
  Shape shape = Shape::ball;
  Vector3 position = Vector3::Zero();            ///< of the centre, m
  Quaternion rotation = Quaternion::Identity();  ///< from its own axes to those of space
  double diameter = 0;                           ///< of a ball or a cylinder, m
  double length = 0;                             ///< of a cylinder, m
  Vector3 edges = Vector3::Zero();               ///< of a cuboid, m
  Vector3 magnetization = Vector3::Zero();       ///< M in its own axes, A/m

  bool operator==(const Magnet& other) const;
};

double volume(const Magnet& magnet);   ///< m³
Vector3 moment(const Magnet& magnet);  ///< in the axes of space, A·m²
double radius(const Magnet& magnet);   ///< of the ball around the magnet, about its centre, m

/// The point of the closed body that is nearest to x; x itself inside.
Vector3 nearest_point(const Magnet& magnet, const Vector3& x);
/// Distance of x from the body, m; 0 inside.
double distance(const Magnet& magnet, const Vector3& x);
/// Distance (m) of the body from the upright cylinder on z = 0 of the given radius and height, the
/// straight cilium, by projections on the two in turn; 0 if they touch.
double distance_from_upright_cylinder(const Magnet& magnet, double cylinder_radius, double height);

/// Distance (m) of the body from a disc, a section of the bent cilium; 0 if they touch.
double distance_from_disc(const Magnet& magnet, const Vector3& centre, const Vector3& normal,
                          double disc_radius);

/// Deviation of the magnet from its own image in the plane through the origin across n (a unit
/// vector): the largest of the moment's and the position's component along n, and of a cuboid the
/// sine between n and the nearest of its axes.
double asymmetry(const Magnet& magnet, const Vector3& n);

/// a·x + b·y in the fields: each magnet with its magnetisation by the factor, one that is in both
/// once, one without magnetisation not at all.
std::vector<Magnet> superposed(double a, const std::vector<Magnet>& x, double b,
                               const std::vector<Magnet>& y);

/// Throws InputError if a number is not finite, a size is not positive, the rotation is not of unit
/// length or a cylinder is magnetised across its axis, whose field has no closed form here.
void require_valid(const Magnet& magnet);

}  // namespace ciliaval::surroundings::magnets

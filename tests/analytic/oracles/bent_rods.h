// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "problem/cilium.h"
#include "problem/deformation.h"
#include "problem/field_model.h"

namespace ciliaval::oracle {

/// Diameter 3 mm, base 3 mm without, magnet 17 mm with M = 75 kA/m (the paper's Fig. 3).
Cilium paper_cilium();
/// (−0.1, 0.2, −1.55) mm.
inline const Vector3 paper_sensor(-0.1e-3, 0.2e-3, -1.55e-3);

/// The exact state of a rod: what a mechanics model would hand back at S.
using Shape = std::function<CentrelinePoint(double S)>;

/// The centreline of a shape, interpolated on n Chebyshev points in each of the cilium's segments.
Deformation sampled(const Cilium& cilium, const Shape& shape, std::size_t n = 24);

Deformation straight(const Cilium& cilium);

/// A circular arc of the given curvature (1/m), bent in the plane of the azimuth, inextensible and
/// unsheared: an elastica.
Shape arc(double curvature, double azimuth);

/// A shape that is bent in three dimensions, twisted, sheared and stretched: Λ = Rz(τS) Ry(βS),
/// r' = Λ (0.15, −0.1, 1.2 + 8S).
Shape contorted();

/// rotation·x + shift of a shape.
Shape moved(const Shape& shape, const Quaternion& rotation, const Vector3& shift);

/// The paper's cilium bent to arc(60, 0.5).
Deformation bent_cilium();

/// B of one field model at one point.
Vector3 flux_density(const FieldModel& model, const Cilium& cilium, const Deformation& deformation,
                     const Vector3& x);

/// B of dipoles F·M dV all over the volume of the magnet: Gauss's rule in S and across the section,
/// the trapezoidal one around a circle. They share the map of the rod with the models, no charge.
Vector3 by_dipoles(const Cilium& cilium, const Centreline& line, const Vector3& x);

/// |a − b|/|b|
double relative_difference(const Vector3& a, const Vector3& b);

/// Prints a measured figure and keeps it in the test's XML report.
void record(const std::string& name, double value);

}  // namespace ciliaval::oracle

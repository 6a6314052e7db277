// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <vector>

#include "analytic/elastica/point_forces/section.h"
#include "analytic/elastica/tip_contact.h"

namespace ciliaval::analytic::elastica {

/// The steps of the integration along the rod of an equilibrium, from the base to the tip.
std::vector<point_forces::Step> steps_along(const TipProblem& problem, const TipContact& contact);

/// A point of the outline (of the disc's corners, its face and the mantle's two sides; or of a
/// point tip that alone), with the surface's height over it, in L.
struct OutlinePoint {
  Touch touch;  ///< without forces
  double gap = 0;
};

/// The outline of a cilium's longitudinal section, under a surface.
class Outline {
 public:
  Outline(const TipProblem& problem, const surroundings::Surface& surface,
          const std::vector<SurfacePlace>& places);

  /// Point where the surface is nearest, or deepest in the cilium. Samples the outline at twelfths
  /// of the surface's smallest feature and refines the minima.
  OutlinePoint nearest(const SurfacePlace& place, const TipContact& contact) const;

  /// The touching points as they must be changed where the contact is not admissible: a corner that
  /// the surface's slope passes over to the face or the mantle, a point beyond the end of the face
  /// or the mantle, a point that would be pulled (if there are others), a new one where the surface
  /// goes into the cilium. Empty: it is admissible.
  std::vector<Touch> changed(const SurfacePlace& place, const TipContact& contact) const;

  static constexpr double deepest_gap = 1e-9;  ///< that is admissible, in L

 private:
  struct Shape;
  struct Sample;
  OutlinePoint on_mantle(const SurfacePlace& place, const point_forces::Section& section,
                         double side) const;
  OutlinePoint at(const SurfacePlace& place, const Shape& shape, TouchPoint where, double side,
                  double parameter) const;
  double gap(const SurfacePlace& place, double x, double z) const;

  const TipProblem& problem_;
  const surroundings::Surface& surface_;
  double highest_ = 0;  ///< p, in L
  double spacing_ = 0;  ///< of the mantle's samples, in L
  int face_samples_ = 0;
};

}  // namespace ciliaval::analytic::elastica

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "analytic/circle.h"
#include "problem/cilium.h"
#include "problem/deformation.h"

namespace ciliaval::analytic {

/// A smooth stretch of a magnetic segment: its part on one piece of the centreline.
struct RodStretch {
  double begin = 0;          ///< S, m
  double end = 0;            ///< S, m
  std::size_t piece = 0;     ///< of the centreline
  std::size_t segment = 0;   ///< of the cilium
  double magnetization = 0;  ///< M, A/m
};

/// A section where the magnetisation changes: an end of the magnet or an interface between two of
/// its segments.
struct RodEnd {
  Circle section;             ///< centred on the centreline, normal d₃
  double magnetization_jump;  ///< M below − M above, A/m; the reference charge on the section
};

/// A section of a magnetic segment, for the search of a point inside the rod.
struct RodSample {
  double S;  ///< m
  std::size_t stretch;
  Vector3 position;  ///< r, m
  Vector3 normal;    ///< d₃
  double jacobian;   ///< the smallest J = d₃·∂x/∂S of the section
};

/// The magnetic segments of a bent rod, as the field models of rods read them.
struct RodMagnet {
  double radius = 0;  ///< m
  Centreline centreline;
  std::vector<RodStretch> stretches;          ///< from base to tip
  std::vector<RodEnd> ends;                   ///< those with a jump
  std::vector<std::vector<RodSample>> lines;  ///< samples of each magnetic segment, base to tip
};

/// Throws InputError if the cilium has no segments, or its length is not that of the centreline.
RodMagnet rod_magnet(const Cilium& cilium, const Deformation& deformation);

/// The state at S on a stretch, by the interpolation of the stretch's own piece.
CentrelinePoint at(const RodMagnet& magnet, const RodStretch& stretch, double S);

/// The section at S as a circle.
Circle section(const RodMagnet& magnet, const CentrelinePoint& point);

/// ∂x/∂S = r' + κ × (x − r): how the rod map x = r + X d₁ + Y d₂ carries a unit of reference
/// length at the point x of the section.
Vector3 stretch_vector(const CentrelinePoint& point, const Vector3& x);

/// The magnet's stretches, bisected until none is longer than the distance of its middle section
/// from the field point, as `distance` measures it: then Gauss–Legendre converges at least like
/// 3.7^(−2n) on each. Nothing if a part shorter than `shortest` (m) would be needed.
std::optional<std::vector<RodStretch>> graded_stretches(
    const RodMagnet& magnet, const std::function<double(const CentrelinePoint&)>& distance,
    double shortest);

/// Throws SolverError if sections cross inside a magnetic segment (J ≤ 0: bent more sharply than
/// its radius), so that the rod is no body.
void require_body(const RodMagnet& magnet);

/// m = F·M/J (A/m) at x if x is inside a magnetic segment: on the section S with
/// (x − r)·d₃ = 0, nearer to r than the radius, where F·M = M ∂x/∂S and J = d₃·∂x/∂S. The mantle
/// and a segment's upper end section count as outside, its lower end section as inside.
std::optional<Vector3> magnetization_at(const RodMagnet& magnet, const Vector3& x);

}  // namespace ciliaval::analytic

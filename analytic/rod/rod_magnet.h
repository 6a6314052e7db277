// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include "analytic/sources/circle.h"
#include "problem/cilium.h"
#include "problem/deformation.h"

namespace ciliaval::analytic::rod {

/// A smooth stretch of a magnetic segment: its part on one piece of the centreline.
struct RodStretch {
  double begin = 0;                         ///< S, m
  double end = 0;                           ///< S, m
  std::size_t piece = 0;                    ///< of the centreline
  std::size_t segment = 0;                  ///< of the cilium
  Vector3 magnetization = Vector3::Zero();  ///< M along the reference's axes, A/m
};

/// The sides of a rectangular section.
struct RodRectangle {
  Eigen::Matrix3d axes;          ///< columns: along the first and second side, and d₃
  std::array<double, 2> half{};  ///< of the sides, m
};

/// A section where the magnetisation changes: an end of the magnet or an interface between two of
/// its segments. A tube has two for each, the hole's with the opposite charge.
struct RodEnd {
  sources::Circle section;    ///< centred on the centreline, normal d₃; around a rectangle
  double magnetization_jump;  ///< M₃ below − M₃ above, A/m; the reference charge on the section
  std::optional<RodRectangle> rectangle{};
};

/// The magnetic segments of a bent rod, as the field models of rods read them. It refers to the
/// deformation's centreline.
struct RodMagnet {
  double radius = 0;  ///< of the circle around the section, m
  double area = 0;    ///< of the section, m²
  const Centreline& centreline;
  std::vector<RodStretch> stretches{};  ///< from base to tip
  std::vector<RodEnd> ends{};           ///< with a jump
  std::vector<RodEnd> segment_ends{};   ///< both of each segment, with |M| and without holes
  CrossSection shape{};
};

/// Throws InputError if the cilium has no segments, or is not as long as the centreline.
RodMagnet rod_magnet(const Cilium& cilium, const Deformation& deformation);

/// The state at S on a stretch, by the interpolation of the stretch's own piece.
CentrelinePoint at(const RodMagnet& magnet, const RodStretch& stretch, double S);

/// The charge of an end as a whole, its magnetisation's jump times its area, A·m.
double pole_strength(const RodEnd& end);

/// The section at S as a circle.
sources::Circle section(const RodMagnet& magnet, const CentrelinePoint& point);

/// Distance (m) of x from the section at the point; of a tube from the section without its hole.
double distance_from_section(const RodMagnet& magnet, const CentrelinePoint& point,
                             const Vector3& x);

/// The error of B (T) at x outside that the rounding of the centreline and of its arc length leaves
/// in the ends of the segments, 4ε(|r| + L) each. A displaced end is a layer of dipoles: at most
/// μ₀|M|/(distance from its edge) within three radii and μ₀|M|A/(πa³) beyond.
double rounding_of_ends(const RodMagnet& magnet, const Vector3& x);
/// The same of the model `line`, in which a displaced end is a dipole: at most μ₀|M|A/(2πa³).
double rounding_of_poles(const RodMagnet& magnet, const Vector3& x);

/// ∂x/∂S = r' + κ × (x − r): how the rod map x = r + X d₁ + Y d₂ carries a unit of reference
/// length at the point x of the section.
Vector3 stretch_vector(const CentrelinePoint& point, const Vector3& x);

/// F·M = M₁ d₁ + M₂ d₂ + M₃ a with a = ∂x/∂S, or by rigid sections with a = d₃, A/m.
Vector3 carried_magnetization(const RodStretch& stretch, const CentrelinePoint& point,
                              const Vector3& a);

/// True if a stretch is magnetised across the axis.
bool is_transverse(const RodMagnet& magnet);

/// The magnet's stretches, bisected until none is longer than the distance of its middle section
/// from the field point, as `distance` measures it: then Gauss–Legendre converges at least like
/// 3.7^(−2n) on each. Nothing if a part shorter than `shortest` (m) would be needed.
std::optional<std::vector<RodStretch>> graded_stretches(
    const RodMagnet& magnet, const std::function<double(const CentrelinePoint&)>& distance,
    double shortest);

/// Throws SolverError if sections cross at a node of a magnetic segment (J ≤ 0: bent more sharply
/// than its radius), so that the rod is no body.
void require_body(const RodMagnet& magnet);

/// The inside of the magnetic segments. The search is prepared at the first point that is near
/// enough; several threads may ask at once.
class RodInterior {
 public:
  explicit RodInterior(const RodMagnet& magnet);

  /// m = F·M/J (A/m) at x if x is inside a magnetic segment: on the section S with
  /// (x − r)·d₃ = 0, nearer to r than the radius, and with J = d₃·∂x/∂S. The mantle
  /// and a segment's upper end section count as outside, its lower end section as inside.
  std::optional<Vector3> magnetization_at(const Vector3& x) const;

 private:
  /// A section of a magnetic segment.
  struct Sample {
    double S;  ///< m
    std::size_t stretch;
    Vector3 position;  ///< r, m
    Vector3 normal;    ///< d₃
  };
  using Line = std::vector<Sample>;  ///< of one segment, base to tip

  std::vector<Line> sample() const;
  void append_samples(std::size_t stretch, Line& line) const;
  std::optional<Vector3> magnetization_between(const Sample& low, const Sample& high,
                                               double above_low, double above_high,
                                               const Vector3& x) const;

  const RodMagnet& magnet_;
  Eigen::AlignedBox3d box_;  ///< around all that may be inside
  mutable std::once_flag sampled_;
  mutable std::vector<Line> lines_;
};

}  // namespace ciliaval::analytic::rod

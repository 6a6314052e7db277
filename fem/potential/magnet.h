// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "problem/cilium.h"
#include "problem/deformation.h"

namespace ciliaval::fem::potential {

/// A permeable body: a box with its own relative permeability.
struct PermeableBox {
  Eigen::AlignedBox3d box;           ///< m
  double relative_permeability = 1;  ///< μ_r > 0
};

/// Law by which the reference magnetisation M enters the current configuration: `F`, m = F·M/J, an
/// ideal hard magnet; `R`, m = R·M with the rotation R of F = R·U (solid) or of the section (rod).
enum class MagnetPushForward { F, R };

/// A quadrature point of the deformed magnet.
struct MagnetSample {
  Vector3 position;   ///< x, m
  double volume = 0;  ///< its share dv of the current volume, m³
  Vector3 moment;     ///< m dv, A·m²
};

/// The deformed magnetised segments as curvilinear hexahedra that can be cut and sampled at will: a
/// solid's own cells, or a rod x = r(S) + X d₁ + Y d₂ in polar coordinates of its sections.
class Magnet {
 public:
  /// Nothing magnetised.
  Magnet() = default;
  /// The body of the deformation if it has one, else the rod about its centreline. Throws
  /// InputError if the cilium has no magnetised segment or the deformation is not finite.
  Magnet(const Cilium& cilium, const Deformation& deformation, MagnetPushForward push_forward);
  /// The magnetised cells of a body.
  Magnet(std::shared_ptr<const SolidBody> body, MagnetPushForward push_forward);

  /// A part of one hexahedron, in its own coordinates.
  struct Block {
    std::size_t part = 0;
    Eigen::AlignedBox3d range;
  };
  /// The whole magnet as blocks.
  const std::vector<Block>& blocks() const { return blocks_; }

  /// Lengths of a block along its three coordinates, m, and a box that holds it; both from 3³ of
  /// its points, the box a quarter wider than these.
  struct Extent {
    Vector3 lengths;
    Eigen::AlignedBox3d box;
  };
  Extent extent(const Block& block) const;

  /// Appends the n³ points of the Gauss–Legendre product rule on the block.
  void sample(const Block& block, std::size_t n, std::vector<MagnetSample>& samples) const;

  /// True if any part of the magnet lies in the box, to a hundredth of the shortest edge of its
  /// block.
  bool meets(const Eigen::AlignedBox3d& box) const;

  /// Distance of the point from the magnet, m, from below, to 2 % or twice the resolution
  /// (m); 0 inside.
  double distance(const Vector3& point, double resolution) const;

 private:
  struct RodPart {
    std::size_t piece;
    Vector3 magnetization;
  };
  void require_usable() const;
  MagnetSample on_rod(const RodPart& part, const CentrelinePoint& section, double r,
                      double phi) const;
  MagnetSample in_cell(const SolidCell& cell, const Vector3& xi) const;
  /// Positions of 3³ points of a block, its corners and the points half-way between.
  using Corners = std::array<std::array<std::array<Vector3, 3>, 3>, 3>;
  Corners corners(const Block& block) const;

  MagnetPushForward push_forward_ = MagnetPushForward::F;
  double radius_ = 0;
  Centreline centreline_;
  std::vector<RodPart> rod_;
  std::shared_ptr<const SolidBody> body_;
  std::vector<std::size_t> cells_;  ///< of the body, magnetised
  std::vector<Block> blocks_;
};

/// The two halves of a block, cut across the coordinate.
std::array<Magnet::Block, 2> halves(const Magnet::Block& block, Eigen::Index coordinate);

}  // namespace ciliaval::fem::potential

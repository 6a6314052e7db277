// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <vector>

namespace ciliaval::meshes::cylinder {

/// Resolution of the cylinder's mesh. Lengths are in diameters (of a rectangle its shorter side, of
/// a tube its wall), so that one set of options suits every cilium.
struct CylinderMeshOptions {
  unsigned int square_cells = 4;  ///< n: cells along a side of the section's inner square; the
                                  ///< section has n² + 4nm cells; n even
  unsigned int rings = 2;         ///< m: rings of cells between the square and the mantle
  double ring_ratio = 0.7;        ///< width of a ring over that of its inner neighbour
  bool equal_area = true;       ///< put the mantle's nodes slightly outside R, so that the section
                                ///< of quadratic cells has the area πR² (false: on R)
  double finest_layer = 0.08;   ///< thickness of the layers at the clamped end and at interfaces
  double coarsest_layer = 0.4;  ///< largest thickness of a layer
  double growth = 0.25;         ///< growth of the thickness with the distance from the nearest of
                                ///< those planes; 0: all layers as thin as the finest
  bool fine_tip = false;        ///< grow from the tip, too
  bool half = false;            ///< only Y ≥ 0, cut along mesh lines: the half of the whole mesh
  std::vector<double> planes;   ///< further reference arc lengths S where mesh planes must lie, m
};

}  // namespace ciliaval::meshes::cylinder

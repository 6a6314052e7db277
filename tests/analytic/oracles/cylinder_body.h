// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "problem/deformation.h"

namespace ciliaval::oracle {

/// x(X): where a deformation takes the material point X.
using Map = std::function<Vector3(const Vector3& X)>;

/// A cylinder about the z axis as a solid model would hand it back: an O-grid of one square and
/// four outer blocks, each cut into cuts², by `layers` layers, the polynomial patches of `degree`
/// through nodes that lie on the cylinder and are moved by the map.
struct CylinderBody {
  double radius = 1.5e-3;
  double bottom = 3e-3;
  double top = 20e-3;
  double magnetization = 75e3;
  std::size_t degree = 6;
  std::size_t cuts = 1;
  std::size_t layers = 4;

  std::shared_ptr<const SolidBody> moved(const Map& map) const;
};

inline Vector3 identity(const Vector3& X) {
  return X;
}

/// A deformation that has the body and nothing else.
Deformation deformation_of(const CylinderBody& cylinder, const Map& map);

}  // namespace ciliaval::oracle

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/curvature.h"

#include "problem/lagrange.h"

namespace ciliaval {

void differentiate_rotation(Centreline::Piece& piece) {
  std::vector<SectionState>& states = piece.states;
  for (std::size_t i = 1; i < states.size(); ++i) {
    Quaternion& q = states[i].rotation;
    if (q.dot(states[i - 1].rotation) < 0) q.coeffs() = -q.coeffs();
  }
  const LagrangeBasis basis(piece.S);
  for (std::size_t i = 0; i < states.size(); ++i) {
    Quaternion derivative(0, 0, 0, 0);
    for (std::size_t j = 0; j < states.size(); ++j)
      derivative.coeffs() += basis.slope(j, i) * states[j].rotation.coeffs();
    states[i].curvature = 2 * (derivative * states[i].rotation.conjugate()).vec();
  }
}

}  // namespace ciliaval

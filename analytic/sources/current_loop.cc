// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/sources/current_loop.h"

namespace ciliaval::analytic::sources {

MeridianVector current_loop_field(double rho, double zeta) {
  const LoopField<double> H = loop_field(rho, zeta);
  return {rho * H.radial_over_rho, H.axial};
}

}  // namespace ciliaval::analytic::sources

// SPDX-License-Identifier: LGPL-2.1-or-later
// A user's program: the tip of the paper's cilium under 1 mN by the elastica and by the beam FEM.
#include <ciliaval/analytic/elastica/elastica.h>
#include <ciliaval/fem/beam/beam.h>

#include <cstdio>

int main() {
  const ciliaval::Cilium cilium{3e-3,
                                {{"base", 3e-3, 1e5, 0.49, 0}, {"magnet", 17e-3, 3e6, 0.49, 75e3}}};
  const ciliaval::LoadPath path{ciliaval::ContactLoad{1e-3, 16e-3, 0.0}};
  const auto elastica = ciliaval::analytic::elastica::Elastica().solve(cilium, path);
  const auto beam = ciliaval::fem::beam::Beam().solve(cilium, path);
  const double tip_elastica =
      elastica.steps[0].deformation->centreline.at(cilium.length()).position.x();
  const double tip_beam = beam.steps[0].deformation->centreline.at(cilium.length()).position.x();
  std::printf("tip deflection: elastica %.6e m, beam %.6e m\n", tip_elastica, tip_beam);
  return tip_elastica > 1e-3 && tip_beam > tip_elastica && tip_beam < 1.2 * tip_elastica ? 0 : 1;
}

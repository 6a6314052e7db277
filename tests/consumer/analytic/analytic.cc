// SPDX-License-Identifier: LGPL-2.1-or-later
// A user's program: the signal of the paper's cilium under 1 mN by the paper's models.
#include <ciliaval/analytic/elastica/elastica.h>
#include <ciliaval/analytic/rod/field_models.h>

#include <array>
#include <cstdio>

int main() {
  const ciliaval::Cilium cilium{3e-3,
                                {{"base", 3e-3, 1e5, 0.49, 0}, {"magnet", 17e-3, 3e6, 0.49, 75e3}}};
  const ciliaval::LoadPath path{ciliaval::ContactLoad{1e-3, 16e-3, 0.0}};
  const auto bent = ciliaval::analytic::elastica::Elastica().solve(cilium, path);
  const std::array<ciliaval::Vector3, 1> sensor{ciliaval::Vector3(-0.1e-3, 0.2e-3, -1.55e-3)};
  const auto field =
      ciliaval::analytic::rod::VolumeField().field(cilium, *bent.steps[0].deformation, sensor);
  std::printf("B_x = %.4e T\n", field.B[0].x());
  return field.B[0].x() > 1e-5 && field.B[0].x() < 1e-3 ? 0 : 1;
}

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/potential/potential.h"

#include <utility>

#include "fem/potential/adaptive.h"

namespace ciliaval::fem::potential {

Potential::Potential(PotentialOptions options, MPI_Comm communicator)
    : options_(std::move(options)), communicator_(communicator) {}

Field Potential::field(const Cilium& cilium, const Deformation& deformation,
                       std::span<const Vector3> points) const {
  if (points.empty()) return {};
  PotentialProblem problem;
  problem.magnet = Magnet(cilium, deformation, options_.push_forward);
  problem.relative_permeability = options_.relative_permeability;
  problem.plates = options_.plates;
  problem.points.assign(points.begin(), points.end());
  PotentialControl control;
  control.tolerance = options_.tolerance;
  control.max_unknowns = options_.max_unknowns;
  control.communicator = communicator_;
  PotentialResult result = solve_potential(problem, control);
  return {std::move(result.B), std::move(result.uncertainty), std::move(result.mesh)};
}

}  // namespace ciliaval::fem::potential

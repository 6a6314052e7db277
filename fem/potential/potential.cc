// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/potential/potential.h"

#include <exception>
#include <sstream>
#include <utility>

#include "fem/parallel.h"
#include "fem/potential/adaptive.h"

namespace ciliaval::fem::potential {

Potential::Potential(PotentialOptions options, MPI_Comm communicator)
    : options_(std::move(options)),
      plates_(std::make_shared<const plates::Plates>(options_.plates)),
      communicator_(communicator) {}

Field Potential::field(const Cilium& cilium, const Deformation& deformation,
                       std::span<const Vector3> points) const {
  if (points.empty()) return {};
  try {
    PotentialProblem problem;
    problem.magnet = Magnet(cilium, deformation, options_.push_forward);
    problem.relative_permeability = options_.relative_permeability;
    problem.plates = plates_;
    problem.points.assign(points.begin(), points.end());
    PotentialControl control;
    control.tolerance = options_.tolerance;
    control.max_unknowns = options_.max_unknowns;
    control.communicator = communicator_;
    PotentialResult result = solve_potential(problem, control);
    Field field{std::move(result.B), std::move(result.uncertainty), std::move(result.mesh)};
    if (has_untested_jump(problem)) {
      std::ostringstream remark;
      remark.precision(3);
      remark << "the error of B is not known: its estimate is tested for a relative_permeability "
                "from "
             << 1 / largest_tested_jump << " to " << largest_tested_jump
             << " and may be far too small beyond (docs/evidence/potential.md)";
      field.remark = remark.str();
    }
    return field;
  } catch (const std::exception& error) {
    if (rank_count(communicator_) > 1) require_failure_of_all_ranks(error.what());
    throw;
  }
}

}  // namespace ciliaval::fem::potential

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <mpi.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "fem/potential/magnet.h"
#include "fem/potential/plates/field.h"
#include "problem/field_model.h"

namespace ciliaval::fem::potential {

/// Ratio μ_r or 1/μ_r of the magnet to vacuum up to which the stated uncertainty holds against
/// oracles (docs/evidence/potential.md#permeability). Where its surface cuts leaves, polynomials
/// cannot follow the jump of ∇ψ; the estimate sees less and less of this error the larger the jump
/// is.
inline constexpr double largest_tested_jump = 1.05;

/// −∇·(μ₀μ_r ∇ψ) + ∇·B_r = 0 in all of space, B = −μ₀μ_r∇ψ + B_r: finite elements for the magnet,
/// charges of their faces for the plates.
struct PotentialProblem {
  Magnet magnet;                                   ///< carries m = B_r/μ₀
  double relative_permeability = 1;                ///< μ_r of the magnet
  std::shared_ptr<const plates::Plates> plates{};  ///< null: none
  Vector3 uniform_field = Vector3::Zero();         ///< B₀ far away, T
  std::vector<Vector3> points;                     ///< where B is wanted, m, outside of all bodies
};

struct PotentialControl {
  /// Uncertainty of B at each point, relative to |B| with or without the plates, the larger one.
  double tolerance = 2e-3;
  std::size_t max_unknowns = 600000;  ///< of the solution that B is taken from
  /// The same where the uncertainty is not known: more unknowns would not make it known.
  std::size_t untested_unknowns = 30000;
  double box = 16;  ///< half-width of the octree over the radius of all bodies and points
  MPI_Comm communicator = MPI_COMM_WORLD;  ///< of the ranks that share the work
};

/// One mesh of the sequence.
struct PotentialCycle {
  std::size_t unknowns = 0;              ///< of the solution that B is taken from
  std::vector<Vector3> B;                ///< T
  std::vector<Vector3> difference;       ///< B one degree higher − B, T
  std::vector<Vector3> interface_error;  ///< share of the permeable bodies in the difference, T
  double truncation = 0;                 ///< bound of the error that the outer boundary makes, T

  /// Estimate of the error of each component of B: the norm of difference + 2 interface_error
  /// (docs/theory/potential.md), shared out between the components, and the truncation. A component
  /// whose difference happens to be small is not trusted.
  Vector3 estimate(std::size_t point) const;
};

struct PotentialResult {
  std::vector<Vector3> B;            ///< T
  std::vector<Vector3> uncertainty;  ///< T; empty where a body's μ_r is beyond the tested ones
  std::vector<PotentialCycle> cycles;
  std::shared_ptr<const FieldMesh> mesh;  ///< the solution that B is taken from
};

/// True if the permeability of the magnet is beyond `largest_tested_jump`.
bool has_untested_jump(const PotentialProblem& problem);

/// Refines until the uncertainties are below the tolerance. Where a permeability is beyond the
/// tested ones the uncertainty is not known: the mesh is refined until the estimate is below the
/// tolerance, but not beyond `untested_unknowns`. Collective. Throws InputError if a point is not
/// finite, in a body or too close to one, a permeability is not positive or two bodies meet;
/// SolverError if the tolerance is not reached with the unknowns allowed.
PotentialResult solve_potential(const PotentialProblem& problem, const PotentialControl& control);

}  // namespace ciliaval::fem::potential

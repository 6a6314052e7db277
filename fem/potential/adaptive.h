// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fem/potential/cut_cells.h"
#include "fem/potential/magnet.h"
#include "problem/field_mesh.h"

namespace ciliaval::fem::potential {

/// What is to be solved for: −∇·(μ₀μ_r ∇ψ) + ∇·B_r = 0 in all of space, B = −μ₀μ_r∇ψ + B_r.
struct PotentialProblem {
  Magnet magnet;                     ///< carries m = B_r/μ₀
  double relative_permeability = 1;  ///< μ_r of the magnet
  std::vector<PermeableBox> plates;
  Vector3 uniform_field = Vector3::Zero();  ///< B₀ far away, T
  std::vector<Vector3> points;              ///< where B is wanted, m, outside of all bodies
};

struct PotentialControl {
  double tolerance = 1e-3;            ///< of B at each point, relative to |B|
  std::size_t max_unknowns = 600000;  ///< of the solution that B is taken from
  double box = 16;  ///< half-width of the octree over the radius of all bodies and points
  double refined_fraction = 0.7;  ///< of the estimate's sum whose leaves are cut
  Sampling sampling;
};

/// One mesh of the sequence.
struct PotentialCycle {
  std::size_t cells = 0;
  std::size_t unknowns = 0;           ///< of the solution that B is taken from
  unsigned int iterations = 0;        ///< of conjugate gradients for it
  unsigned int check_iterations = 0;  ///< for the solution one degree higher
  std::vector<Vector3> B;             ///< T
  std::vector<Vector3> difference;    ///< B one degree higher − B, T
  std::vector<Vector3> kinks;         ///< share of the permeable bodies in the difference, T
  double truncation = 0;              ///< bound of the error that the outer boundary makes, T
  double seconds = 0;

  /// Estimate of the error of each component of B: the norm of difference + 2 kinks
  /// (docs/theory/potential.md), shared out between the components so that none that happens to be
  /// small is trusted; and the truncation.
  Vector3 estimate(std::size_t point) const;
};

struct PotentialResult {
  std::vector<Vector3> B;            ///< T
  std::vector<Vector3> uncertainty;  ///< T
  std::vector<PotentialCycle> cycles;
  std::shared_ptr<const FieldMesh> mesh;  ///< the solution that B is taken from
};

/// Refines until the estimates are below the tolerance. Collective. Throws InputError if a point is
/// not finite or too close to a body, a permeability is not positive or two bodies meet;
/// SolverError if the tolerance is not reached.
PotentialResult solve_potential(const PotentialProblem& problem, const PotentialControl& control,
                                const std::function<void(const std::string&)>& progress = {});

}  // namespace ciliaval::fem::potential

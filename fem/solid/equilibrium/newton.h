// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/lac/affine_constraints.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fem/solid/discretisation/assembly.h"
#include "fem/solid/discretisation/space.h"
#include "fem/solid/equilibrium/second_variation.h"
#include "fem/solid/loads/external_forces.h"
#include "fem/solid/solvers/linear_solver.h"

namespace ciliaval::fem::solid::equilibrium {

class BorderedSystem;

struct NewtonOptions {
  double tolerance = 1e-9;  ///< of the remaining increment, relative to the displacement,
                            ///< and of the residual, relative to the force scale, as far as
                            ///< rounding errors let it fall
  unsigned int max_iterations = 25;  ///< increments
  double least_force = 0;            ///< lower bound of the force scale, N
};

struct NewtonResult {
  bool converged = false;
  std::string reason;                ///< why not
  bool overshot = false;             ///< det F was not positive after the very first iteration
  std::vector<double> residuals;     ///< relative, before each iteration and at the end
  std::vector<double> increments;    ///< ‖Δu‖_max of each iteration, m
  discretisation::Vector reactions;  ///< internal − external forces before the last increment, all
                                     ///< rows, N
  discretisation::Vector external;     ///< external forces at the end, N
  std::vector<int> linear_iterations;  ///< of GMRES in each iteration; 1: solved directly
  int iterations() const { return static_cast<int>(increments.size()); }
};

/// Called after each evaluation of the residual: iteration, relative residual.
using NewtonProgress = std::function<void(int, double)>;

/// Newton's method for internal(u, p) = external(u), p condensed, with a LinearSolver for the
/// unsymmetric tangent. All functions are collective.
///
/// The force scale of the residual is the l₂ norm of the nodal external forces or, if they vanish,
/// of the reactions at the constrained degrees of freedom. Stopping rule: once the residual is
/// below the tolerance, or below 1e-4, where rounding errors may keep it, the last tangent's
/// increment for it estimates the error of the displacement. If that is below the tolerance, it is
/// added, and the state has converged.
///
/// An increment of the last tangent also spares a new tangent if it is at most a hundredth of the
/// increment before. It is tried at residuals below the same bound, and below 1e-2 where the last
/// increment was at most a tenth of its predecessor.
class Newton {
 public:
  Newton(const discretisation::SolidSpace& space, dealii::AffineConstraints<double> constraints,
         solvers::SolverKind solver, MPI_Comm communicator);
  Newton(const Newton&) = delete;
  Newton& operator=(const Newton&) = delete;

  /// Solves from the given state, which must satisfy the Dirichlet conditions; it holds the last
  /// iterate at the end, converged or not.
  NewtonResult solve(const loads::ExternalForces& external, discretisation::SolidState& state,
                     const NewtonOptions& options, const NewtonProgress& progress = {});

  /// Solves for the amplitude of the force too, by the bordered tangent
  /// (fem/solid/equilibrium/bordered_system.h).
  NewtonResult solve(loads::UnknownForce& force, discretisation::SolidState& state,
                     const NewtonOptions& options, const NewtonProgress& progress = {});

  /// K⁻¹ ∂f/∂t at an equilibrium, m, `rate` the derivative of the external forces by a parameter t.
  /// Throws SolverError.
  discretisation::Vector response(const loads::ExternalForces& external,
                                  const loads::ExternalForces& rate,
                                  const discretisation::SolidState& state);

  /// At an equilibrium under external forces that have a potential, in the displacements that the
  /// constraints leave free. None with the iterative solver, for meshes of its size have large
  /// factors. Throws SolverError as equilibrium::second_variation().
  std::optional<SecondVariation> second_variation(
      const loads::ExternalForces& external, const discretisation::SolidState& state,
      const dealii::AffineConstraints<double>& constraints);

 private:
  struct Step {
    discretisation::Vector increment;
    double amplitude = 0;  ///< increment of the unknown force's, if there is one
    int linear_iterations = 0;
    double size() const { return increment.linfty_norm(); }
  };
  /// The increment by the solver's last tangent, and its use.
  Step last_tangents_step(const discretisation::SolidState& state,
                          const discretisation::Vector& residual, BorderedSystem* bordered);
  enum class Use { last_increment, increment, none };
  Use use_of(const Step& step, const discretisation::SolidState& state, const NewtonResult& result,
             const NewtonOptions& options) const;
  void assemble_tangent(const loads::ExternalForces& external,
                        const discretisation::SolidState& state,
                        const discretisation::InternalForces& internal,
                        discretisation::TangentMatrix& tangent);
  /// The increment by the tangent at the state, which the solver has.
  Step own_tangents_step(const discretisation::SolidState& state,
                         const discretisation::Vector& residual, BorderedSystem* bordered);
  NewtonResult iterate(const loads::ExternalForces& external, BorderedSystem* bordered,
                       discretisation::SolidState& state, const NewtonOptions& options,
                       const NewtonProgress& progress);

  const discretisation::SolidSpace& space_;
  dealii::AffineConstraints<double> constraints_;
  std::unique_ptr<solvers::LinearSolver> solver_;
  MPI_Comm communicator_;
  double size_;  ///< diameter of the body, m
};

}  // namespace ciliaval::fem::solid::equilibrium

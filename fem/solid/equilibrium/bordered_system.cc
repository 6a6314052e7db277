// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/equilibrium/bordered_system.h"

#include <cmath>

#include "problem/error.h"

namespace ciliaval::fem::solid::equilibrium {
using namespace discretisation;

void BorderedSystem::prepare(const Vector& u, const Solve& solve) {
  gradient_.reinit(u);
  force_.condition(u, force_.amplitude, &gradient_);
  constraints_.set_zero(gradient_);
  Vector rate;
  rate.reinit(u);
  (force_.rate ? force_.rate(force_.amplitude) : force_.forces(1))(u, rate, nullptr);
  rate.compress(dealii::VectorOperation::add);
  constraints_.set_zero(rate);
  response_.reinit(u);
  solve(rate, response_);
  constraints_.set_zero(response_);
  pivot_ = gradient_ * response_ + force_.condition_rate;
  if (!std::isfinite(pivot_) || pivot_ == 0)
    throw SolverError("the displacement does not depend on the force that is sought");
}

double BorderedSystem::complete(const Vector& u, Vector& increment) const {
  const double amplitude = -(gap(u) + gradient_ * increment) / pivot_;
  increment.add(amplitude, response_);
  return amplitude;
}

}  // namespace ciliaval::fem::solid::equilibrium

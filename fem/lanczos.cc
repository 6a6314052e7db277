// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/lanczos.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "problem/error.h"
#include "problem/support/interruption.h"

namespace ciliaval::fem {
namespace {

using Eigen::Index;

constexpr int most_vectors = 150;
/// Residual of an eigenpair over its eigenvalue. The eigenvalue's error is of its square.
constexpr double tolerance = 1e-9;
/// Part of the largest |1/ω| below which a value is rounding.
constexpr double rounding = 1e-11;

/// A bit of every mode.
Eigen::VectorXd some_vector(Index size) {
  std::mt19937 random;  // NOLINT(cert-msc51-cpp): every run takes the same
  Eigen::VectorXd result(size);
  for (double& value : result) value = static_cast<double>(random()) / std::mt19937::max() - 0.5;
  return result;
}

/// The Ritz value that is wanted, once all that matter have converged; `last` is the norm of what
/// K⁻¹ W adds to the last vector.
std::optional<Index> wanted(const Eigen::VectorXd& values, const Eigen::MatrixXd& vectors,
                            double last, int negative) {
  const Index n = values.size();
  const auto has_converged = [&](Index i) {
    return std::abs(last * vectors(n - 1, i)) <= tolerance * std::abs(values[i]);
  };
  const auto if_converged = [&](Index i) {
    return has_converged(i) ? std::optional(i) : std::nullopt;
  };
  // Where ω is rounding, inertia and ω may differ in its sign.
  if (negative == 0) return if_converged(-values[0] > values[n - 1] ? 0 : n - 1);
  Index below = 0;
  while (below < n && values[below] < -rounding * values.cwiseAbs().maxCoeff()) {
    if (!has_converged(below)) return std::nullopt;
    ++below;
  }
  // The first steps may not have seen all of them.
  if (last > 0 && n < 20 + 4 * negative) return std::nullopt;
  return if_converged(below > 0 ? below - 1 : n - 1);
}

}  // namespace

Eigenpair smallest_eigenpair(const EigenProblem& problem, int negative) {
  std::vector<Eigen::VectorXd> basis;
  std::vector<Eigen::VectorXd> weighed;  // W times it
  const auto add = [&](Eigen::VectorXd vector, Eigen::VectorXd weight, double norm) {
    basis.push_back(std::move(vector) / norm);
    weighed.push_back(std::move(weight) / norm);
  };
  const auto norm = [](const Eigen::VectorXd& vector, const Eigen::VectorXd& weight) {
    return std::sqrt(std::max(0.0, vector.dot(weight)));
  };
  {
    // Without what W does not see.
    Eigen::VectorXd vector = problem.solve(problem.weigh(some_vector(problem.size)));
    Eigen::VectorXd weight = problem.weigh(vector);
    const double length = norm(vector, weight);
    add(std::move(vector), std::move(weight), length);
  }
  Eigen::MatrixXd projected = Eigen::MatrixXd::Zero(most_vectors, most_vectors);
  for (Index n = 1; n <= most_vectors; ++n) {
    support::check_interruption();
    const auto j = static_cast<std::size_t>(n - 1);
    Eigen::VectorXd next = problem.solve(weighed[j]);
    for (int pass = 0; pass < 2; ++pass)
      for (std::size_t i = 0; i <= j; ++i) {
        const double part = next.dot(weighed[i]);
        next -= part * basis[i];
        if (i == j) projected(n - 1, n - 1) += part;
      }
    Eigen::VectorXd weight = problem.weigh(next);
    const double last = norm(next, weight);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz(projected.topLeftCorner(n, n));
    if (const auto i = wanted(ritz.eigenvalues(), ritz.eigenvectors(), last, negative)) {
      Eigenpair result{1 / ritz.eigenvalues()[*i], Eigen::VectorXd::Zero(problem.size)};
      for (Index k = 0; k < n; ++k)
        result.vector += ritz.eigenvectors()(k, *i) * basis[static_cast<std::size_t>(k)];
      return result;
    }
    if (!(last > 0) || n == most_vectors) break;
    projected(n, n - 1) = projected(n - 1, n) = last;
    add(std::move(next), std::move(weight), last);
  }
  throw SolverError("Lanczos's method did not find the smallest eigenvalue");
}

}  // namespace ciliaval::fem

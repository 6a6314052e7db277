// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

/// The planar elastica under point forces, with its derivatives: EI θ′ = M,
/// M′ = −F_x cos θ + F_z sin θ, x′ = sin θ, z′ = cos θ, with F constant from force to force.
/// Without units, as tip_contact.h.
namespace ciliaval::analytic::elastica::point_forces {

inline constexpr int most_unknowns = 16;

/// Derivatives of a value by the unknowns of a problem.
using Gradient = Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, most_unknowns>;

/// The state of a section; of its gradients those by S are at fixed forces.
struct Section {
  double S = 0;
  double theta = 0;
  double x = 0;
  double z = 0;
  double moment = 0;
  double energy = 0;     ///< ∫ M²/(2EI) dS of the part below
  double curvature = 0;  ///< θ′, below
  Gradient theta_by, x_by, z_by, moment_by;
};

/// The force that the part above exerts on the part below.
struct Force {
  double x = 0;
  double z = 0;
  Gradient x_by, z_by;
};

/// A step of the Taylor-series method for a flexibility f = max(EI)/EI, with g = f F:
///
///     θ′ = κ,  κ′ = −g_x cos θ + g_z sin θ,
///
/// and the variations of the series by κ(start), g_x and g_z, by recurrence (Jorba & Zou,
/// Experimental Mathematics 14, 2005). The variation by θ(start) follows from the invariance under
/// rotations of the shape and the force together.
class Step {
 public:
  /// The longest step from `start` towards S = target whose last terms are below 1e-16.
  Step(const Section& start, double flexibility, const Force& force, double target);

  double end() const { return end_; }
  double start() const { return start_; }
  bool complete() const { return complete_; }
  /// The state at S, without gradients and energy.
  Section at(double S) const;
  /// Moves the section, with gradients and energy, from the start to the end of the step.
  void advance(Section& section, const Force& force) const;

 private:
  static constexpr std::size_t order = 22;
  using Jet = Eigen::Array4d;  ///< a value, and its derivatives by κ(start), g_x, g_z

  Jet sum(const std::array<Jet, order + 1>& series, double t) const;

  double start_;
  double end_;
  double width_ = 0;
  double trial_ = 0;  ///< τ: the series are in t = (S − start)/τ
  bool complete_ = false;
  double flexibility_;
  Section first_;  ///< without gradients
  std::array<Jet, order + 1> theta_, x_, z_;
};

/// A piecewise constant compliance.
struct Rod {
  const std::vector<double>& ends;        ///< S of the segments' ends: 0, …, 1
  const std::vector<double>& compliance;  ///< max(EI)/EI
};

/// Moves the section up to S = target; calls each(step) for every step if it is not null. Throws
/// SolverError where the state is not finite.
template <class Each>
void integrate(const Rod& rod, Section& section, const Force& force, double target,
               const Each& each) {
  for (std::size_t i = 0; i < rod.compliance.size(); ++i)
    while (section.S < std::min(target, rod.ends[i + 1])) {
      const Step step(section, rod.compliance[i], force, std::min(target, rod.ends[i + 1]));
      step.advance(section, force);
      each(step);
    }
}

}  // namespace ciliaval::analytic::elastica::point_forces

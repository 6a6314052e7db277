// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <cstddef>

#include "analytic/elastica/planar.h"

namespace ciliaval::analytic::elastica {

/// Change of the internal force along the arc length, dH/dS.
enum class ForceLaw {
  constant,  ///< 0: point force
  height,    ///< −dz/dS: force per height
  length     ///< −1: force per reference length
};

/// One step of the Taylor-series method for the planar elastica
///
///     dθ/dS = f M,  dM/dS = −H dz/dS,  dH/dS by law,
///     dw/dS = s sin θ + g H,  dz/dS = s cos θ,  s = 1 + (x − g) H sin θ,
///
/// with constant flexibilities f, g of shear and x of extension, and with what a PlanarLaw adds.
/// The coefficients follow from the state by recurrence (Jorba & Zou, Experimental Mathematics 14,
/// 2005), so the step is also its own dense output. The angle carries its complement φ = π/2 − θ
/// along: cos θ = sin φ keeps its relative accuracy near 90°.
class TaylorStep {
 public:
  static constexpr std::size_t order = 24;

  /// The longest step from `start` towards S = target (in either direction) whose last terms are
  /// below `tolerance`, relative to each variable's size in the step (for the angle: the smaller of
  /// θ and φ); times `fraction` ≤ 1 unless it gets there in one step. Throws SolverError if the
  /// state is not finite.
  TaylorStep(const PlanarState& start, const Flexibility& flexibility, ForceLaw law, double target,
             double tolerance, double fraction);

  /// A straight part without moment, from `start` to S = target.
  static TaylorStep straight(PlanarState start, ForceLaw law, double target, double extension = 0);

  double start() const { return start_.S; }
  double end() const { return end_; }
  double lower() const { return start() < end() ? start() : end(); }
  bool complete() const { return complete_; }  ///< it reached its target

  /// State at S, by the series.
  PlanarState at(double S) const;
  /// State at the end of the step.
  PlanarState end_state() const { return at(end_); }

  /// S in the step where M = 0, given that M changes sign in the step.
  double zero_moment() const;

  /// Cuts the step off at S.
  void cut(double S) { end_ = S; }
  /// Translates w and z.
  void translate(double w, double z);

 private:
  using Series = std::array<double, order + 1>;

  void expand(ForceLaw law);
  double relative_remainder(double ratio) const;
  void rescale(double ratio);
  bool finite() const;

  PlanarState start_;
  double end_ = 0;
  double width_ = 0;  // τ: the series are in t = (S − start)/τ
  Flexibility flexibility_;
  bool complete_ = false;
  Series theta_{};
  Series w_{};
  Series z_{};
  Series moment_{};
  Series force_{};
};

}  // namespace ciliaval::analytic::elastica

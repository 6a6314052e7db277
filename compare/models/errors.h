// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/models/run.h"

namespace ciliaval::compare::models {

enum class Verdict {
  resolved,           ///< |difference| is larger than the combined numerical uncertainty
  below_uncertainty,  ///< it is not: nothing can be said but that the two agree
  inconclusive        ///< the difference or an uncertainty is not known
};
std::string_view to_string(Verdict verdict);

/// One figure that separates a model from its reference (docs/guide/results.md). An empty optional
/// is undefined or unknown; `note` says why.
struct Comparison {
  std::optional<std::size_t> step;    ///< none: over the whole load path
  std::optional<std::size_t> sensor;  ///< none: not a field
  std::string quantity;               ///< "centreline", "tip", "tip_angle", "deflection", "B", "dB"
  std::string component;              ///< "x", "y", "z", or none
  std::string statistic;              ///< "value", "maximum", "rms", "r2", "rrmse"
  std::string model;
  std::string reference;
  std::optional<double> difference;   ///< in `unit`
  std::optional<double> scale;        ///< what `relative` is divided by, in `unit`
  std::optional<double> relative;     ///< difference / scale
  std::optional<double> r2;           ///< statistic "r2": R² of w(z), about the identity
  std::optional<double> correlation;  ///< statistic "r2": r² of w(z), blind to a constant factor
  std::string unit;                   ///< "m", "rad" or "T"
  std::optional<double> uncertainty;  ///< combined numerical uncertainty of `difference`, in `unit`
  Verdict verdict = Verdict::inconclusive;
  std::string note;
};

/// A difference of two curves.
struct CurveDistance {
  double largest = 0;  ///< max |r_a − r_b|, m
  double rms = 0;      ///< √(1/L ∫₀ᴸ |r_a − r_b|² dS), m
};

/// Distance of two centrelines at common material points S, both evaluated by their own
/// interpolation: ten Gauss points in each interval of the union of their breaks (none longer than
/// L/20) for the integral, these and the intervals' ends for the maximum. Throws InputError if the
/// lengths differ by more than 1e-9 L.
CurveDistance distance(const Centreline& a, const Centreline& b);

/// Agreement of two bent shapes in the deflection w(z) along e as a function of the *current*
/// height z, at 401 equidistant heights from 0 to the lower of the two tips.
struct ShapeAgreement {
  double rms = 0;          ///< √mean (w_a − w_ref)², m
  double deviation = 0;    ///< √mean (w_ref − mean w_ref)², m
  double correlation = 0;  ///< r of w_a and w_ref (Pearson); NaN if one of them is constant

  /// 1 − Σ(w_a − w_ref)²/Σ(w_ref − mean w_ref)²: the share of the reference that the model explains
  /// without any fit. NaN if w_ref is constant.
  double r2() const { return 1 - rms * rms / (deviation * deviation); }
};
/// Empty if z does not increase along one of the curves (θ ≥ 90°): w(z) is then not a function.
std::optional<ShapeAgreement> compare_deflection(const Centreline& model,
                                                 const Centreline& reference,
                                                 const Vector3& direction);

/// A field value with what is known of its numerical error.
struct FieldValue {
  Vector3 value;                         ///< B or ΔB, T
  std::optional<Vector3> numerical;      ///< uncertainty of the field model, T
  std::optional<double> from_mechanics;  ///< what the deformation's error does to it, in any
                                         ///< direction, T: FieldStep::from_mechanics; of a model
                                         ///< that states the tip's error u alone,
                                         ///< |ΔB|·u/|tip displacement|
  double rounding;                       ///< what the deformation's rounding may make of it, T
};
/// The run that the fields belong to, without a step if it is not there; readings belong to none.
const MechanicsRun& mechanics_of(const FieldRun& run, const CaseResult& result);
/// B, or its change ΔB, of a pair of models at a step and sensor; empty if there is none.
/// `mechanics` is the run that the fields belong to; of readings it is not used.
std::optional<FieldValue> field_value(const FieldRun& run, const MechanicsRun& mechanics,
                                      std::size_t step, std::size_t sensor, bool change);
/// Uncertainty of the components of a − b, T: the sum of the field models', and of what both
/// deformations carry into them unless it is the same deformation. Empty if a part is not known.
std::optional<Vector3> combined_uncertainty(const FieldValue& a, const FieldValue& b,
                                            bool same_mechanics);

/// The largest component of the uncertainty of a pair's ΔB, T: the field model's own, and what the
/// deformation's carries into it. Empty if a part is not known.
std::optional<double> change_uncertainty(const MechanicsRun& mechanics, const FieldRun& run,
                                         std::size_t step, std::size_t sensor);
/// The numerical uncertainty of each component of B or ΔB, T: the field model's own, and what the
/// deformation's carries into it. Empty if a part is not known.
std::optional<Vector3> uncertainties(const MechanicsRun& mechanics, const FieldRun& run,
                                     std::size_t step, std::size_t sensor, bool change);

/// Every pair of mechanics models and every pair of field results, step by step and over the path.
std::vector<Comparison> compare_models(const CaseResult& result);

}  // namespace ciliaval::compare::models

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/input/case.h"
#include "compare/study/case_number.h"
#include "problem/support/fingerprint.h"

namespace ciliaval::compare::study {

/// A pair of models by their ids, "elastica/volume".
struct ModelPair {
  std::string mechanics;
  std::string field;
  std::string name() const { return mechanics + "/" + field; }
};

/// Outputs that a study computes for each pair of models at each point, SI units.
enum class Output {
  B_x,          ///< B at the sensor, T
  B_y,          ///< …
  B_z,          ///< …
  dB_x,         ///< ΔB at the sensor, T
  dB_y,         ///< …
  dB_z,         ///< …
  dB_norm,      ///< |ΔB|, T
  sensitivity,  ///< d|ΔB|/dF, F the load's magnitude: T/N, T m/N (force per length) or T/m (probe)
  range,        ///< the largest F: where the contact slips off, or the tip's rotation is `rotation`
  resolution,   ///< the change of F that the sensor's noise hides: noise / |sensitivity|
  first_number  ///< from here on the mechanics model's own numbers (compare/results/quantity.h)
};
std::vector<Output> all_outputs();
/// One of the mechanics model's own numbers at a step; none if the step does not have it.
std::optional<double> number(Output output, const MechanicsStep& step);

/// "dB_norm", as files say it.
std::string_view id(Output output);
/// "|dB|", as tables say it.
std::string_view symbol(Output output);

/// Quantity of an output under this type of load, with its SI unit.
Quantity quantity_of(Output output, const Load& load);

/// One parameter of a study and its values, SI units.
struct Parameter {
  CaseNumber number;
  std::string name;      ///< for people; the last part of the path unless the study says
  std::string unit;      ///< in which it is shown, as the study states it; empty: a plain number
  double unit_size = 1;  ///< SI value of that unit
  std::vector<double> values;
  bool is_logarithmic = false;
};

/// A number of the case that is not known exactly.
struct Tolerance {
  CaseNumber number;
  double nominal = 0;    ///< value in the case with its fixed numbers, SI units
  double deviation = 0;  ///< standard deviation, SI units
  std::string unit;      ///< in which it is shown
  double unit_size = 1;  ///< SI value of that unit
};

/// Part of a standard deviation by which a number is moved for the differences of fourth order of
/// python/ciliaval/design/tolerances.py, once and twice, to both sides.
inline constexpr double tolerance_step = 0.25;

/// A limit that a design must keep.
struct Limit {
  Output output{};
  bool is_lower = true;  ///< the output's magnitude is at least, not at most, the value
  double value = 0;      ///< positive, SI units
};

/// The search for the design whose goal has the largest magnitude.
struct Optimisation {
  Output goal = Output::dB_norm;
  std::vector<Limit> limits;
  std::vector<Parameter> parameters;  ///< what is searched; `values` are the two bounds
  std::vector<double> start;          ///< one value for each parameter, within the bounds
  unsigned int global_evaluations = 2000;
  unsigned int starts = 10;  ///< of local searches, besides the start and the global search's end
};

/// A study, as its file states it (docs/guide/studies.md).
struct Study {
  std::string name;  ///< a plain file name: the results go to DIR/name
  std::string title;
  input::Case base;  ///< of one load step and one sensor, with the models of the pairs
  std::vector<Setting> fixed;
  std::vector<Parameter> parameters;
  bool is_zipped = false;  ///< the parameters' values go together; else every combination
  std::vector<ModelPair> pairs;
  std::vector<Output> outputs;
  std::vector<Tolerance> tolerances;
  std::optional<Optimisation> optimisation;  ///< in place of parameters and tolerances; the first
                                             ///< pair searches
  std::optional<double> noise;  ///< standard deviation of a reading, T, for `resolution`
  /// Rods are compared with the corrected rod at each point, or by [optimise] at the reported
  /// designs (models::add_model_parts()): 25 ms and more.
  bool has_model_uncertainty = false;
  std::optional<double> rotation;  ///< rad, for the `range` of a load that has no slip-off

  const Load& load() const { return base.load_path.front(); }
  /// Points of the sweep over the parameters; 0 without parameters.
  std::size_t point_count() const;
  /// All points that are solved: behind those of the sweep, if there are tolerances, the case with
  /// its fixed numbers alone and each number moved by −2, −1, 1 and 2 steps.
  std::size_t all_points() const;
  /// The parameters' values at a point of the sweep; of a product the last parameter runs fastest.
  std::vector<double> values_at(std::size_t point) const;
  input::Case case_at(std::size_t point) const;
  /// The case with its fixed numbers and these values of what is optimised.
  input::Case design(const std::vector<double>& values) const;
  /// "E1 = 0.1 MPa, d = 3 mm"
  std::string describe(std::size_t point) const;
  /// The mechanics models of the pairs, each once, in their order.
  std::vector<std::string> mechanics() const;
  /// The place of a pair among those of its mechanics model.
  std::size_t place(std::size_t pair) const;
  bool asks_for(Output output) const;
  bool needs_slope() const { return asks_for(Output::sensitivity) || asks_for(Output::resolution); }
};

/// Everything that the results of the study depend on, in SI units and full precision; not names,
/// titles and units of display.
support::Fingerprint fingerprint(const Study& study);

}  // namespace ciliaval::compare::study

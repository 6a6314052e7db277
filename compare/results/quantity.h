// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "problem/mechanics_model.h"
#include "problem/parameter.h"

/// The numbers of a result: what they are, declared once, and the table of them.
namespace ciliaval::compare::results {

/// The larger of the two magnitudes, unless the value is not finite.
void raise(double& largest, double value);

/// The largest values of a mechanics model over its load path, by which its numbers are judged.
struct Extent {
  double length = 0;      ///< of the cilium, m
  double deflection = 0;  ///< horizontal, of any of the places, m
  double angle = 0;       ///< of the tip, rad
  double force = 0;       ///< applied, or at which it slips off, N
  double contact = 0;     ///< normal force of a sweep, N

  explicit Extent(const MechanicsResult& result);
};

/// The sizes that errors of a number are parts of, in its unit.
struct Size {
  double scale = 0;  ///< its rounding
  double group = 0;  ///< its tolerance: the largest of its kind
};

/// A quantity that a mechanics model gives at a step, a number or a vector.
struct Quantity {
  std::string_view name;                                 ///< in summary.json, baselines, …
  ciliaval::Quantity kind = ciliaval::quantity::number;  ///< whose SI unit the values are in
  std::vector<std::string_view> components{};            ///< empty: a number
  /// Gives the step's values, one for each component; empty: there is none.
  std::function<std::vector<double>(const MechanicsStep&)> values;
  /// Numerical, of each of them; empty: not known of any step.
  std::function<std::optional<double>(const MechanicsStep&)> uncertainty{};
  /// Empty: the largest of its values over the path.
  std::function<Size(const Extent&, std::size_t component)> size{};
  /// True if baselines and mesh studies have it of the step; empty: of any.
  std::function<bool(const MechanicsStep&)> is_compared{};
  /// True if summary.json has a null where the step has none; empty: it does.
  std::function<bool(const MechanicsStep&)> belongs{};
  bool is_in_summary = true;  ///< summary.json has it
  bool is_estimate = false;   ///< the error of another one
  bool is_accepted = true;    ///< a baseline has it
  bool is_converged = true;   ///< a mesh study has it
  bool is_looked_at = false;  ///< people look at it first
  /// The line of a terminal, with the value in place of {}: "slips off above {}"; empty: none.
  std::string_view words{};
  /// True if the step has that line; empty: it does.
  std::function<bool(const MechanicsStep&)> is_said{};
};

/// Numerical uncertainty of a converged step's tip angle, rad: the model's own; where it has none,
/// |angle|·u/|tip displacement| with the tip's uncertainty u, as if the section's rotation were
/// wrong in proportion to the displacement.
std::optional<double> tip_angle_uncertainty(const MechanicsStep& step);

/// Change of a flux density per unit of a load's magnitude: in T/N, T/(N/m); in T for a plain
/// number.
ciliaval::Quantity flux_density_per(const ciliaval::Quantity& magnitude);

/// Every quantity, first those of this suite.
const std::vector<Quantity>& quantities();
/// Adds a quantity that a program brings along.
void add_quantity(Quantity quantity);

}  // namespace ciliaval::compare::results

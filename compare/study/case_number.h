// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

#include "compare/input/case.h"
#include "problem/description/field.h"

namespace ciliaval::compare::study {

/// A number of a case that a study can set: one that the case file states, or one made of several
/// of them.
struct CaseNumber : description::Field<input::Case> {
  std::string path;  ///< dotted, as in the case file: "cilium.segment.base.young_modulus"
  /// When it is set: plain numbers first, then those that rescale what these have set.
  enum class Order { plain, total_length, proportion, aspect_ratio };
  Order order = Order::plain;
  std::string sets;  ///< two numbers that set the same contradict each other
};

/// The numbers of this case: those of its cilium and segments, of its load (set at all its steps),
/// of its first sensor and of the models' options, and
/// - `cilium.length`: the total length, the segments in proportion;
/// - `cilium.segment.NAME.proportion`: the segment's part of the total length, which stays, as do
///   the proportions of the others among themselves (the paper's L₂/L₀);
/// - `cilium.aspect_ratio`: length over diameter, by the diameter (the paper's L₀/d).
std::vector<CaseNumber> case_numbers(const input::Case& c);

/// A number and the value that it is set to, SI units.
struct Setting {
  CaseNumber number;
  double value = 0;
};

/// The case with the settings, whatever their order; a flow that is given by its velocity is
/// computed anew.
input::Case with_settings(input::Case c, const std::vector<Setting>& settings);

}  // namespace ciliaval::compare::study

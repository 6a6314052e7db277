// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/models/run.h"
#include "compare/validation/input_number.h"
#include "compare/validation/sensitivity.h"
#include "compare/validation/statistics.h"

namespace ciliaval::compare::validation {

/// A measured value beside a model's, SI.
struct Point {
  input::measurement::Measurement measured;  ///< D, u_D
  std::optional<double> simulated;           ///< S
  std::optional<double> u_num;
  std::optional<double> u_input;
  /// Shift of S by one standard uncertainty of each input.
  std::vector<std::optional<double>> contributions;
  std::optional<Assessment> assessment;  ///< none: a part is not known, which `note` says
  std::string note;

  Verdict verdict() const { return assessment ? assessment->verdict : Verdict::not_known; }
};

/// One model, or pair of models, and the values of one measurand.
struct Series {
  std::string model;  ///< its id, of a pair MECHANICS/FIELD
  std::string
      sensitivities_by;       ///< whose derivatives u_input is from; empty: no quick model has any
  std::vector<Point> points;  ///< in the order of the case
  // Statistics of the points that have an assessment:
  std::size_t assessed = 0;
  std::optional<double> chi_squared;
  std::optional<double> rms_error;  ///< √mean E²

  const input::measurement::Measurand& measurand() const {
    return points.front().measured.measurand;
  }
  std::size_t count(Verdict verdict) const;
  bool has_sensitivities_of_another() const {
    return !sensitivities_by.empty() && sensitivities_by != model;
  }
  /// Points at which the model's error would be seen with a u_D and a u_input so many times as
  /// large.
  std::size_t seen_with(double factor_of_u_D, double factor_of_u_input = 1) const;
  std::size_t fitted() const;  ///< points to which parameters were fitted
};

/// Range of a number over the measurements, beyond which no verdict holds.
struct Extent {
  std::string name;     ///< "slenderness"
  std::string meaning;  ///< "L/d"
  std::string unit;     ///< SI; empty: a plain number
  double from = 0;
  double to = 0;
};

/// Factors of u_D for which the verdicts are also asked: where u_D is assumed, as of a picture that
/// was digitised, a verdict may depend on it.
inline constexpr std::array<double, 4> factors_of_u_D{0.5, 1, 2, 3};

struct Validation {
  std::vector<Input> inputs;
  std::vector<Extent> domain;
  std::vector<Series> series;  ///< measurand by measurand, the models in the order of the registry
  std::vector<std::string> remarks;
};

/// Every model of the results against the measurements of the case: shapes by the mechanics models,
/// fields by the pairs. None without measurements. Solves the models that `whose` names again for
/// the sensitivities, twice for each input. Throws InputError as read_inputs().
std::optional<Validation> validate(const models::CaseResult& result,
                                   std::span<const models::MechanicsEntry> mechanics,
                                   std::span<const models::FieldEntry> fields,
                                   const Progress& progress = {},
                                   Sensitivities whose = Sensitivities::quick);

/// The numbers that place a case among others: load and field, both also as λ against the bending
/// stiffness of the softest segment, slenderness, Poisson's ratio.
std::vector<Extent> domain_of(const input::Case& c);

}  // namespace ciliaval::compare::validation

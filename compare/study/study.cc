// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/study/study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <deque>
#include <mutex>
#include <utility>

#include "compare/input/units.h"
#include "compare/models/fingerprint.h"
#include "compare/results/quantity.h"

namespace ciliaval::compare::study {
namespace {

struct Names {
  std::string_view id;
  std::string_view symbol;
};
/// In the order of Output.
constexpr std::array<Names, static_cast<std::size_t>(Output::first_number)> names{{
    {"B_x", "B_x"},
    {"B_y", "B_y"},
    {"B_z", "B_z"},
    {"dB_x", "dB_x"},
    {"dB_y", "dB_y"},
    {"dB_z", "dB_z"},
    {"dB_norm", "|dB|"},
    {"sensitivity", "d|dB|/dF"},
    {"range", "range"},
    {"resolution", "resolution"},
}};

/// A number of the mechanics model: a component of a quantity.
struct Number {
  std::size_t quantity;  ///< of results::quantities()
  std::size_t component;
  std::string id;     ///< "tip_x"
  std::string title;  ///< "tip x"
};

/// Numbers of all quantities. References to them stay valid.
const std::deque<Number>& numbers() {
  static std::deque<Number> all;
  static std::size_t known = 0;
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  const auto& quantities = results::quantities();
  for (; known < quantities.size(); ++known) {
    const results::Quantity& quantity = quantities[known];
    if (!quantity.is_in_summary && !quantity.is_looked_at) continue;
    for (std::size_t c = 0; c < std::max<std::size_t>(quantity.components.size(), 1); ++c) {
      std::string id(quantity.name);
      if (!quantity.components.empty()) id += fmt::format("_{}", quantity.components[c]);
      std::ranges::replace(id, '/', '_');
      std::string title = id;
      std::ranges::replace(title, '_', ' ');
      all.push_back({known, c, std::move(id), std::move(title)});
    }
  }
  return all;
}

bool is_number(Output output) {
  return output >= Output::first_number;
}

const Number& number_of(Output output) {
  return numbers().at(static_cast<std::size_t>(output) -
                      static_cast<std::size_t>(Output::first_number));
}

Names names_of(Output output) {
  if (!is_number(output)) return names.at(static_cast<std::size_t>(output));
  const Number& number = number_of(output);
  return {number.id, number.id};
}

/// A value in the parameter's unit: "0.1 MPa".
std::string format_value(const Parameter& parameter, double value) {
  const std::string text = fmt::format("{:.6g}", value / parameter.unit_size);
  return parameter.unit.empty() ? text : fmt::format("{} {}", text, parameter.unit);
}

/// Points of the central differences, in steps.
constexpr std::array<int, 4> steps{-2, -1, 1, 2};

/// Number that is moved at a point behind the sweep; none at the first one.
std::optional<Setting> moved_number(const Study& study, std::size_t point) {
  const std::size_t index = point - study.point_count();
  if (index == 0) return std::nullopt;
  const Tolerance& tolerance = study.tolerances[(index - 1) / steps.size()];
  const int step = steps[(index - 1) % steps.size()];
  return Setting{tolerance.number, tolerance.nominal + step * tolerance_step * tolerance.deviation};
}

void append_optimisation(const Optimisation& o, support::Fingerprint& all) {
  all.emplace_back("maximise", id(o.goal));
  all.emplace_back("global_evaluations", std::to_string(o.global_evaluations));
  all.emplace_back("starts", std::to_string(o.starts));
  for (const Limit& limit : o.limits)
    all.emplace_back(
        fmt::format("{} {}", limit.is_lower ? "at_least" : "at_most", id(limit.output)),
        fmt::to_string(limit.value));
  for (std::size_t i = 0; i < o.parameters.size(); ++i) {
    const Parameter& p = o.parameters[i];
    all.emplace_back(fmt::format("parameter {}", i + 1),
                     fmt::format("{} = {}, {}, from {}", p.number.path, fmt::join(p.values, " "),
                                 p.is_logarithmic ? "logarithmic" : "linear", o.start[i]));
  }
}

/// The case with the study's fixed numbers and these values of parameters.
input::Case with_values(const Study& study, const std::vector<Parameter>& parameters,
                        const std::vector<double>& values) {
  std::vector<Setting> settings = study.fixed;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    settings.push_back({parameters[i].number, values[i]});
  return with_settings(study.base, settings);
}

}  // namespace

std::vector<Output> all_outputs() {
  std::vector<Output> all(names.size() + numbers().size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<Output>(i);
  return all;
}

std::optional<double> number(Output output, const MechanicsStep& step) {
  if (!is_number(output)) return std::nullopt;
  const Number& number = number_of(output);
  const std::vector<double> values = results::quantities().at(number.quantity).values(step);
  return values.empty() ? std::nullopt : std::optional(values.at(number.component));
}

std::string_view id(Output output) {
  return names_of(output).id;
}
std::string_view symbol(Output output) {
  return names_of(output).symbol;
}

Quantity quantity_of(Output output, const Load& load) {
  if (is_number(output)) {
    const Number& number = number_of(output);
    const Quantity& kind = results::quantities().at(number.quantity).kind;
    return {kind.article, number.title, kind.unit, kind.example};
  }
  const Quantity& magnitude = load.type().parameters.front().quantity;
  if (output == Output::range || output == Output::resolution) return magnitude;
  return output == Output::sensitivity ? results::flux_density_per(magnitude)
                                       : quantity::flux_density;
}

std::size_t Study::point_count() const {
  std::size_t count = parameters.empty() ? 0 : 1;
  for (const Parameter& p : parameters)
    count = is_zipped ? p.values.size() : count * p.values.size();
  return count;
}

std::size_t Study::all_points() const {
  return point_count() + (tolerances.empty() ? 0 : 1 + steps.size() * tolerances.size());
}

std::vector<double> Study::values_at(std::size_t point) const {
  std::vector<double> values(parameters.size());
  for (std::size_t i = parameters.size(); i-- > 0;) {
    const std::vector<double>& all = parameters[i].values;
    values[i] = all[is_zipped ? point : point % all.size()];
    point = is_zipped ? point : point / all.size();
  }
  return values;
}

input::Case Study::case_at(std::size_t point) const {
  if (point < point_count()) return with_values(*this, parameters, values_at(point));
  const input::Case nominal = with_settings(base, fixed);
  const auto moved = moved_number(*this, point);
  return moved ? with_settings(nominal, {*moved}) : nominal;
}

input::Case Study::design(const std::vector<double>& values) const {
  return with_values(*this, optimisation->parameters, values);
}

std::string Study::describe(std::size_t point) const {
  if (point >= point_count()) {
    const auto moved = moved_number(*this, point);
    return moved ? fmt::format("{} = {}", moved->number.path,
                               input::format_quantity(moved->value, moved->number.quantity))
                 : "nominal";
  }
  const std::vector<double> values = values_at(point);
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    texts.push_back(
        fmt::format("{} = {}", parameters[i].name, format_value(parameters[i], values[i])));
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::vector<std::string> Study::mechanics() const {
  std::vector<std::string> ids;
  for (const ModelPair& pair : pairs)
    if (std::find(ids.begin(), ids.end(), pair.mechanics) == ids.end())
      ids.push_back(pair.mechanics);
  return ids;
}

std::size_t Study::place(std::size_t pair) const {
  return static_cast<std::size_t>(std::count_if(
      pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(pair),
      [&](const ModelPair& other) { return other.mechanics == pairs[pair].mechanics; }));
}

bool Study::asks_for(Output output) const {
  return std::find(outputs.begin(), outputs.end(), output) != outputs.end();
}

support::Fingerprint fingerprint(const Study& study) {
  support::Fingerprint all = models::fingerprint(study.base);
  for (const Setting& s : study.fixed)
    all.emplace_back("fixed " + s.number.path, fmt::to_string(s.value));
  std::size_t count = 0;
  for (const Parameter& p : study.parameters)
    all.emplace_back(fmt::format("parameter {}", ++count),
                     fmt::format("{} = {}", p.number.path, fmt::join(p.values, " ")));
  count = 0;
  for (const Tolerance& t : study.tolerances)
    all.emplace_back(fmt::format("tolerance {}", ++count),
                     fmt::format("{} = {}", t.number.path, t.deviation));
  all.emplace_back("combine", study.is_zipped ? "zip" : "product");
  std::vector<std::string> names;
  for (const ModelPair& pair : study.pairs) names.push_back(pair.name());
  all.emplace_back("pairs", fmt::format("{}", fmt::join(names, " ")));
  names.clear();
  for (const Output output : study.outputs) names.emplace_back(id(output));
  all.emplace_back("outputs", fmt::format("{}", fmt::join(names, " ")));
  if (study.optimisation) append_optimisation(*study.optimisation, all);
  if (study.noise) all.emplace_back("noise", fmt::to_string(*study.noise));
  if (study.has_model_uncertainty) all.emplace_back("model_uncertainty", "true");
  if (study.rotation) all.emplace_back("rotation", fmt::to_string(*study.rotation));
  return all;
}

}  // namespace ciliaval::compare::study

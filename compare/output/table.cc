// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/table.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "compare/output/results.h"
#include "compare/output/sweep.h"
#include "compare/output/text_table.h"

namespace ciliaval::compare::output {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// The relative error in percent: two decimals, or the order of magnitude of a smaller one.
std::string percent(const models::Comparison* c) {
  if (c == nullptr || !c->relative) return "-";
  const double value = *c->relative * 100;
  return std::abs(value) >= 0.01 || value == 0 ? number_cell(value, 1, "{:.2f}")
                                               : fmt::format("{:.0e}", value);
}

const models::Comparison* find(const std::vector<models::Comparison>& comparisons,
                               std::optional<std::size_t> step, std::string_view quantity,
                               std::string_view component, std::string_view statistic,
                               std::string_view model, std::string_view reference) {
  const auto it =
      std::find_if(comparisons.begin(), comparisons.end(), [&](const models::Comparison& c) {
        return c.step == step && c.sensor.value_or(0) == 0 && c.quantity == quantity &&
               c.component == component && c.statistic == statistic && c.model == model &&
               c.reference == reference;
      });
  return it == comparisons.end() ? nullptr : &*it;
}

std::string mechanics_table(const models::CaseResult& result, std::size_t index) {
  TextRows rows{{"mechanics", "status", "tip x", "y", "z (mm)", "+-(um)", "(deg)", "force(mN)",
                 "unknowns", "iter.", "time (s)"}};
  for (const models::MechanicsRun& run : result.mechanics) {
    const MechanicsStep& step = run.result.steps[index];
    std::vector<std::string>& row = rows.emplace_back();
    row = {run.model, std::string(to_string(step.status))};
    if (step.deformation) {
      const Centreline& centreline = step.deformation->centreline;
      const CentrelinePoint tip = centreline.at(centreline.length());
      for (const double x : tip.position) row.push_back(number_cell(x, 1e-3, "{:.4f}"));
      row.push_back(number_cell(step.tip_uncertainty, 1e-6, "{:.2g}"));
      row.push_back(number_cell(tip.theta(), degree, "{:.3f}"));
      row.push_back(number_cell(step.applied_force, 1e-3, "{:.5g}"));
    } else {
      row.insert(row.end(), 6, "-");
    }
    row.push_back(fmt::format("{}", step.unknowns));
    row.push_back(fmt::format("{}", step.iterations));
    row.push_back(fmt::format("{:.3g}", step.seconds));
  }
  std::string text = text_table(rows, "<<>");
  for (const models::MechanicsRun& run : result.mechanics) {
    const MechanicsStep& step = run.result.steps[index];
    if (!step.message.empty()) text += fmt::format("  {}: {}\n", run.model, step.message);
    if (step.status != Status::slipped_off) continue;
    if (step.slip_off_displacement)
      text += fmt::format("  {}: slips off beyond {:.4g} mm\n", run.model,
                          *step.slip_off_displacement * 1e3);
    if (step.slip_off_force)
      text +=
          fmt::format("  {}: slips off above {:.4g} mN\n", run.model, *step.slip_off_force * 1e3);
  }
  return text;
}

std::string mechanics_errors(const models::CaseResult& result,
                             const std::vector<models::Comparison>& comparisons, std::size_t step) {
  TextRows rows{{"difference (1)", "max (%)", "RMS (%)", "tip (%)", "angle (%)", "R2 of w(z)",
                 "corr.^2", "tip"}};
  for (std::size_t b = 0; b < result.mechanics.size(); ++b)
    for (std::size_t a = 0; a < b; ++a) {
      const std::string& model = result.mechanics[a].model;
      const std::string& reference = result.mechanics[b].model;
      const auto get = [&](const char* quantity, const char* statistic) {
        return find(comparisons, step, quantity, "", statistic, model, reference);
      };
      const models::Comparison* tip = get("tip", "value");
      if (tip == nullptr) continue;
      const models::Comparison* shape = get("deflection", "r2");
      rows.push_back(
          {fmt::format("{} - {}", model, reference), percent(get("centreline", "maximum")),
           percent(get("centreline", "rms")), percent(tip), percent(get("tip_angle", "value")),
           number_cell(shape->r2, 1, "{:.6f}"), number_cell(shape->correlation, 1, "{:.6f}"),
           std::string(to_string(tip->verdict))});
    }
  return rows.size() == 1 ? "" : "\n" + text_table(rows, "<>>>>>><");
}

constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};

std::optional<double> component(const std::optional<Vector3>& v, Eigen::Index axis) {
  return v ? std::optional((*v)[axis]) : std::nullopt;
}

/// Whether a pair has B or ΔB at the sensor that is shown.
bool has_field(const models::FieldRun& run, std::size_t step) {
  return run.steps[step] && (run.steps[step]->B.front() || run.steps[step]->dB.front());
}

std::string fields_table(const models::CaseResult& result,
                         const std::vector<models::Comparison>& comparisons, std::size_t step) {
  TextRows rows{{"field at sensor 0", "Bx", "By", "Bz (mT)", "dBx", "dBy", "dBz (uT)", "+-dB",
                 "x (%)", "y", "z (2)", "time (s)"}};
  std::string failures;
  const models::FieldRun* reference = nullptr;  // the most detailed pair that has a field here
  for (const models::FieldRun& run : result.fields)
    if (has_field(run, step)) reference = &run;
  for (const models::FieldRun& run : result.fields) {
    if (!run.steps[step]) continue;
    const models::FieldStep& field = *run.steps[step];
    if (!field.failure.empty()) failures += fmt::format("  {}: {}\n", run.name(), field.failure);
    if (!has_field(run, step)) continue;
    std::vector<std::string>& row = rows.emplace_back();
    row.push_back(run.name());
    for (Eigen::Index i = 0; i < 3; ++i)
      row.push_back(number_cell(component(field.B.front(), i), 1e-3, "{:.4f}"));
    for (Eigen::Index i = 0; i < 3; ++i)
      row.push_back(number_cell(component(field.dB.front(), i), 1e-6, "{:.2f}"));
    row.push_back(number_cell(models::change_uncertainty(result, run, step, 0), 1e-6, "{:.1g}"));
    for (const char* axis : axis_names)
      row.push_back(&run == reference ? "ref."
                                      : percent(find(comparisons, step, "dB", axis, "value",
                                                     run.name(), reference->name())));
    row.push_back(fmt::format("{:.2g}", field.seconds));
  }
  return (rows.size() == 1 ? "" : "\n" + text_table(rows, "<>")) + failures;
}

/// Every pair against the most detailed one that has a field at any step.
std::string path_errors(const models::CaseResult& result,
                        const std::vector<models::Comparison>& comparisons) {
  const models::FieldRun* last = nullptr;
  for (const models::FieldRun& run : result.fields)
    for (std::size_t step = 0; step < run.steps.size(); ++step)
      if (has_field(run, step)) last = &run;
  if (last == nullptr) return {};
  const std::string reference = last->name();
  TextRows rows{{"field", "Bx", "By", "Bz", "dBx", "dBy", "dBz"}};
  for (const models::FieldRun& run : result.fields) {
    if (&run == last) break;
    std::vector<std::string> row{run.name()};
    bool any = false;
    for (const char* quantity : {"B", "dB"})
      for (const char* axis : axis_names) {
        const models::Comparison* c =
            find(comparisons, std::nullopt, quantity, axis, "rrmse", run.name(), reference);
        any = any || c != nullptr;
        row.push_back(percent(c));
      }
    if (any) rows.push_back(std::move(row));
  }
  if (rows.size() == 1) return {};
  return fmt::format("\nOver the load path, at sensor 0: RRMSE (3) against {}, in %\n{}", reference,
                     text_table(rows, "<>"));
}

constexpr const char* mechanics_legend =
    "+- estimate of the tip's discretisation error in micrometres, where the model has one.\n"
    "(1) distance of the two centrelines at common material points, largest, RMS over the arc\n"
    "    length and at the tip, divided by the tip deflection of the second; tip angle divided by\n"
    "    its tip angle. R2 of the deflection w over the current height z, and the square of its\n"
    "    correlation, which does not see a constant factor. The last column says whether the\n"
    "    difference of the tips is larger than the numerical uncertainty of the two.\n";
constexpr const char* fields_legend =
    "+-dB: numerical uncertainty of dB in uT, its own and its shape's, largest component.\n"
    "(2) error of dB = B - B(undeformed), each component divided by the largest |dB| of the\n"
    "    reference (ref.) over the load path.\n"
    "(3) RMS of the error of a component over the path divided by the RMS of that component.\n"
    "    - is undefined: the divisor vanishes.\n";

}  // namespace

std::string describe(const Load& load) {
  std::string text(type(load));
  for (std::size_t i = 0; i < load.values().size(); ++i) {
    const LoadParameter& parameter = load.type().parameters[i];
    text += fmt::format(fmt::runtime(parameter.words), parameter.display_factor * load.values()[i]);
  }
  return text;
}

std::string table(const models::CaseResult& result,
                  const std::vector<models::Comparison>& comparisons) {
  const input::Case& problem = result.problem;
  std::string text = problem.name + (problem.title.empty() ? "" : ": " + problem.title) + '\n';
  if (is_sweep(problem)) return text + sweep_table(result) + path_errors(result, comparisons);
  bool pairs = false;
  for (std::size_t step = 0; step < problem.load_path.size(); ++step) {
    text += fmt::format("\nStep {} of {}: {}\n", step + 1, problem.load_path.size(),
                        describe(problem.load_path[step]));
    text += mechanics_table(result, step);
    const std::string errors = mechanics_errors(result, comparisons, step);
    pairs = pairs || !errors.empty();
    text += errors;
    if (!problem.sensors.empty()) text += fields_table(result, comparisons, step);
  }
  if (!problem.sensors.empty()) text += path_errors(result, comparisons);
  text += '\n';
  if (pairs) text += mechanics_legend;
  if (!result.fields.empty() && !problem.sensors.empty()) text += fields_legend;
  if (problem.sensors.size() == 2)
    text += "The other sensor is in summary.json and errors.csv.\n";
  else if (problem.sensors.size() > 2)
    text += fmt::format("The other {} sensors are in summary.json and errors.csv.\n",
                        problem.sensors.size() - 1);
  return text;
}

}  // namespace ciliaval::compare::output

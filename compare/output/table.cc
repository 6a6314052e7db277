// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/table.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "compare/output/results.h"

namespace ciliaval::compare {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// A number in a unit, or a dash for what is undefined. What rounds to zero has no sign.
std::string cell(std::optional<double> value, double unit, std::string_view format) {
  if (!value) return "-";
  const std::string text = fmt::format(fmt::runtime(format), *value / unit);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero && text.starts_with('-') ? text.substr(1) : text;
}

/// The relative error in percent: two decimals, or the order of magnitude of a smaller one.
std::string percent(const Comparison* c) {
  if (c == nullptr || !c->relative) return "-";
  const double value = *c->relative * 100;
  return std::abs(value) >= 0.01 || value == 0 ? cell(value, 1, "{:.2f}")
                                               : fmt::format("{:.0e}", value);
}

const Comparison* find(const std::vector<Comparison>& comparisons, std::optional<std::size_t> step,
                       std::string_view quantity, std::string_view component,
                       std::string_view statistic, std::string_view model,
                       std::string_view reference) {
  const auto it = std::find_if(comparisons.begin(), comparisons.end(), [&](const Comparison& c) {
    return c.step == step && c.sensor.value_or(0) == 0 && c.quantity == quantity &&
           c.component == component && c.statistic == statistic && c.model == model &&
           c.reference == reference;
  });
  return it == comparisons.end() ? nullptr : &*it;
}

std::string mechanics_table(const CaseResult& result, std::size_t index) {
  std::string text = fmt::format("  {:<22}{:<12}{:>9}{:>9}{:>9}{:>9}{:>9}{:>10}{:>10}{:>7}{:>9}\n",
                                 "mechanics", "status", "tip x", "y", "z (mm)", "+-(um)", "(deg)",
                                 "force(mN)", "unknowns", "iter.", "time (s)");
  for (const MechanicsRun& run : result.mechanics) {
    const MechanicsStep& step = run.result.steps[index];
    std::array<std::string, 6> cells{"-", "-", "-", "-", "-", "-"};
    if (step.deformation) {
      const Centreline& centreline = step.deformation->centreline;
      const CentrelinePoint tip = centreline.at(centreline.length());
      for (std::size_t i = 0; i < 3; ++i)
        cells[i] = cell(tip.position[static_cast<Eigen::Index>(i)], 1e-3, "{:.4f}");
      if (step.tip_uncertainty) cells[3] = cell(*step.tip_uncertainty, 1e-6, "{:.2g}");
      cells[4] = cell(tip.theta(), degree, "{:.3f}");
      cells[5] = cell(step.applied_force, 1e-3, "{:.5g}");
    }
    text += fmt::format("  {:<22}{:<12}{:>9}{:>9}{:>9}{:>9}{:>9}{:>10}{:>10}{:>7}{:>9.3g}\n",
                        run.model, to_string(step.status), cells[0], cells[1], cells[2], cells[3],
                        cells[4], cells[5], step.unknowns, step.iterations, step.seconds);
  }
  for (const MechanicsRun& run : result.mechanics) {
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

std::string mechanics_errors(const CaseResult& result, const std::vector<Comparison>& comparisons,
                             std::size_t step) {
  std::string rows;
  for (std::size_t b = 0; b < result.mechanics.size(); ++b)
    for (std::size_t a = 0; a < b; ++a) {
      const std::string& model = result.mechanics[a].model;
      const std::string& reference = result.mechanics[b].model;
      const auto get = [&](const char* quantity, const char* statistic) {
        return find(comparisons, step, quantity, "", statistic, model, reference);
      };
      const Comparison* tip = get("tip", "value");
      if (tip == nullptr) continue;
      const Comparison* shape = get("deflection", "r2");
      rows += fmt::format("  {:<22}{:>9}{:>9}{:>9}{:>11}{:>12}{:>12}  {}\n",
                          fmt::format("{} - {}", model, reference),
                          percent(get("centreline", "maximum")), percent(get("centreline", "rms")),
                          percent(tip), percent(get("tip_angle", "value")),
                          cell(shape->r2, 1, "{:.6f}"), cell(shape->correlation, 1, "{:.6f}"),
                          to_string(tip->verdict));
    }
  if (rows.empty()) return rows;
  return fmt::format("\n  {:<22}{:>9}{:>9}{:>9}{:>11}{:>12}{:>12}  {}\n", "difference (1)",
                     "max (%)", "RMS (%)", "tip (%)", "angle (%)", "R2 of w(z)", "corr.^2", "tip") +
         rows;
}

constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};

std::optional<double> component(const std::optional<Vector3>& v, Eigen::Index axis) {
  return v ? std::optional((*v)[axis]) : std::nullopt;
}

/// Whether a pair has B or ΔB at the sensor that is shown.
bool has_field(const FieldRun& run, std::size_t step) {
  return run.steps[step] && (run.steps[step]->B.front() || run.steps[step]->dB.front());
}

std::string fields_table(const CaseResult& result, const std::vector<Comparison>& comparisons,
                         std::size_t step) {
  std::string rows;
  std::string failures;
  const FieldRun* reference = nullptr;  // the most detailed pair that has a field here
  for (const FieldRun& run : result.fields)
    if (has_field(run, step)) reference = &run;
  for (const FieldRun& run : result.fields) {
    if (!run.steps[step]) continue;
    const FieldStep& field = *run.steps[step];
    if (!field.failure.empty()) failures += fmt::format("  {}: {}\n", run.name(), field.failure);
    if (!has_field(run, step)) continue;
    rows += fmt::format("  {:<18}", run.name());
    for (Eigen::Index i = 0; i < 3; ++i)
      rows += fmt::format("{:>10}", cell(component(field.B.front(), i), 1e-3, "{:.4f}"));
    for (Eigen::Index i = 0; i < 3; ++i)
      rows += fmt::format("{:>10}", cell(component(field.dB.front(), i), 1e-6, "{:.2f}"));
    rows += fmt::format("{:>8}", cell(change_uncertainty(result, run, step, 0), 1e-6, "{:.1g}"));
    for (const char* axis : axis_names)
      rows += fmt::format("{:>9}", &run == reference
                                       ? "ref."
                                       : percent(find(comparisons, step, "dB", axis, "value",
                                                      run.name(), reference->name())));
    rows += fmt::format("{:>9.2g}\n", field.seconds);
  }
  if (rows.empty()) return failures;
  return fmt::format("\n  {:<18}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>8}{:>9}{:>9}{:>9}{:>9}\n",
                     "field at sensor 0", "Bx", "By", "Bz (mT)", "dBx", "dBy", "dBz (uT)", "+-dB",
                     "x (%)", "y", "z (2)", "time (s)") +
         rows + failures;
}

/// Every pair against the most detailed one that has a field at any step.
std::string path_errors(const CaseResult& result, const std::vector<Comparison>& comparisons) {
  const FieldRun* last = nullptr;
  for (const FieldRun& run : result.fields)
    for (std::size_t step = 0; step < run.steps.size(); ++step)
      if (has_field(run, step)) last = &run;
  if (last == nullptr) return {};
  const std::string reference = last->name();
  std::string rows;
  for (const FieldRun& run : result.fields) {
    if (&run == last) break;
    std::string row = fmt::format("  {:<18}", run.name());
    bool any = false;
    for (const char* quantity : {"B", "dB"})
      for (const char* axis : axis_names) {
        const Comparison* c =
            find(comparisons, std::nullopt, quantity, axis, "rrmse", run.name(), reference);
        any = any || c != nullptr;
        row += fmt::format("{:>9}", percent(c));
      }
    if (any) rows += row + '\n';
  }
  if (rows.empty()) return rows;
  return fmt::format(
             "\nOver the load path, at sensor 0: RRMSE (3) against {}, in %\n"
             "  {:<18}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}\n",
             reference, "field", "Bx", "By", "Bz", "dBx", "dBy", "dBz") +
         rows;
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
  if (const auto* contact = std::get_if<ContactLoad>(&load))
    text += fmt::format(", force {:g} mN at height {:g} mm", contact->force * 1e3,
                        contact->height * 1e3);
  else if (const auto* flow = std::get_if<FlowLoad>(&load))
    text += fmt::format(", {:g} N per metre of height", flow->force_per_height);
  else if (const auto* section = std::get_if<SectionLoad>(&load))
    text += fmt::format(", force {:g} mN at arc length {:g} mm", section->force * 1e3,
                        section->arclength * 1e3);
  else if (const auto* dead = std::get_if<DeadLoad>(&load))
    text += fmt::format(", {:g} N per metre of length", dead->force_per_length);
  else if (const auto* probe = std::get_if<ProbeLoad>(&load))
    text += fmt::format(", displacement {:g} mm at height {:g} mm", probe->displacement * 1e3,
                        probe->height * 1e3);
  return text + fmt::format(", azimuth {:g} deg", azimuth(load) / degree);
}

std::string table(const CaseResult& result, const std::vector<Comparison>& comparisons) {
  const Case& problem = result.problem;
  std::string text = problem.name + (problem.title.empty() ? "" : ": " + problem.title) + '\n';
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

}  // namespace ciliaval::compare

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/table.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "compare/models/magnet_forces.h"
#include "compare/output/results.h"
#include "compare/output/sweep.h"
#include "compare/output/text_table.h"
#include "compare/results/band.h"
#include "compare/results/external_field.h"
#include "compare/results/quantity.h"
#include "problem/types.h"

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
                               std::string_view model, std::string_view reference,
                               std::size_t sensor = 0) {
  const auto it =
      std::find_if(comparisons.begin(), comparisons.end(), [&](const models::Comparison& c) {
        return c.step == step && c.sensor.value_or(sensor) == sensor && c.quantity == quantity &&
               c.component == component && c.statistic == statistic && c.model == model &&
               c.reference == reference;
      });
  return it == comparisons.end() ? nullptr : &*it;
}

/// " 1 at 0, 0.5 at 0.3": the eigenvalues at their fractions.
std::string approach(const continuation::PullIn& pull_in) {
  std::string text;
  for (const continuation::ApproachToFold& at : pull_in.approach)
    text += fmt::format("{} {:.3g} at {:.6g}", text.empty() ? "" : ",", at.smallest_eigenvalue,
                        at.fraction);
  return text;
}

/// A line for each quantity that a terminal says of the step.
std::string sentences(const std::string& model, const MechanicsStep& step) {
  std::string text;
  for (const results::Quantity& quantity : results::quantities()) {
    if (quantity.words.empty() || (quantity.is_said && !quantity.is_said(step))) continue;
    const ShownUnit unit = shown_unit(quantity.kind.unit);
    std::vector<std::string> numbers;
    for (const double value : quantity.values(step))
      numbers.push_back(number_cell(value, unit.size, "{:.4g}"));
    if (numbers.empty()) continue;
    const std::string value =
        fmt::format("{}{}{}", fmt::join(numbers, ", "), unit.name.empty() ? "" : " ", unit.name);
    text += fmt::format("  {}: {}\n", model, fmt::format(fmt::runtime(quantity.words), value));
  }
  return text;
}

/// The band, or ">3", what is known of it, where it is not known what the model leaves out.
std::string band_cell(std::optional<double> band, std::optional<double> known) {
  constexpr double unit = 1e-6;
  const std::optional<double> shown = band ? band : known;
  if (!shown) return "?";
  return (band ? "" : ">") + number_cell(shown, unit, *shown >= 10 * unit ? "{:.0f}" : "{:.2g}");
}

/// A number with as many decimals as its band leaves two digits of, at most so many.
std::string cell_within(std::optional<double> value, std::optional<double> band, double unit,
                        int most) {
  int decimals = most;
  if (band && *band > 0)
    decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(*band / unit))), 0, most);
  return number_cell(value, unit, fmt::format("{{:.{}f}}", decimals));
}

std::string mechanics_table(const models::CaseResult& result, std::size_t index) {
  TextRows rows{
      {"mechanics", "status", "tip x", "y", "z (mm)", "+-(um)", "(deg)", "force(mN)", "time (s)"}};
  for (const models::MechanicsRun& run : result.mechanics) {
    const MechanicsStep& step = run.result.steps[index];
    std::vector<std::string>& row = rows.emplace_back();
    row = {run.model, std::string(to_string(step.status))};
    if (step.deformation) {
      const Centreline& centreline = step.deformation->centreline;
      const CentrelinePoint tip = centreline.at(centreline.length());
      const results::Band tip_band = results::shape_band(run, index, results::ShapeQuantity::tip);
      for (const double x : tip.position) row.push_back(cell_within(x, tip_band.known(), 1e-3, 4));
      row.push_back(band_cell(tip_band.total, tip_band.known()));
      const results::Band angle =
          results::shape_band(run, index, results::ShapeQuantity::tip_angle);
      row.push_back(cell_within(tip.theta(), angle.known(), degree, 3));
      row.push_back(number_cell(step.applied_force, 1e-3, "{:.5g}"));
    } else {
      row.insert(row.end(), 6, "-");
    }
    row.push_back(fmt::format("{:.1g}", step.seconds));
  }
  std::string text = text_table(rows, "<<>");
  for (const models::MechanicsRun& run : result.mechanics) {
    const MechanicsStep& step = run.result.steps[index];
    if (!step.message.empty()) text += fmt::format("  {}: {}\n", run.model, step.message);
    text += sentences(run.model, step);
    if (step.pull_in && !step.pull_in->approach.empty())
      text += fmt::format("  {}: smallest eigenvalue of that at rest on the way:{}\n", run.model,
                          approach(*step.pull_in));
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
  return rows.size() == 1 ? "" : fmt::format("\n{}", text_table(rows, "<>>>>>><"));
}

std::optional<double> component(const std::optional<Vector3>& v, Eigen::Index axis) {
  return v ? std::optional((*v)[axis]) : std::nullopt;
}

/// The sensors of which a terminal shows tables.
std::size_t shown_sensors(const input::Case& problem) {
  constexpr std::size_t most = 16;
  return std::min(problem.sensors.size(), most);
}

/// True if a pair has B or ΔB at a sensor.
bool has_field(const models::FieldRun& run, std::size_t step, std::size_t sensor) {
  return run.steps[step] && (run.steps[step]->B[sensor] || run.steps[step]->dB[sensor]);
}

std::string fields_table(const models::CaseResult& result,
                         const std::vector<models::Comparison>& comparisons, std::size_t step,
                         std::size_t sensor) {
  TextRows rows{{"sensor " + input::sensor_name(result.problem, sensor), "Bx", "By", "Bz (mT)",
                 "dBx", "dBy", "dBz (uT)", "+-dB", "% (2)"}};
  const models::FieldRun* reference = nullptr;  // the most detailed pair that has a field here
  for (const models::FieldRun& run : result.fields)
    if (has_field(run, step, sensor)) reference = &run;
  for (const models::FieldRun& run : result.fields) {
    if (!has_field(run, step, sensor)) continue;
    const models::FieldStep& field = *run.steps[step];
    std::vector<std::string>& row = rows.emplace_back();
    row.push_back(run.name());
    for (Eigen::Index i = 0; i < 3; ++i)
      row.push_back(number_cell(component(field.B[sensor], i), 1e-3, "{:.4f}"));
    const results::FieldBands bands = results::field_bands(result, run, step, true);
    const auto largest_of = [](const std::optional<Vector3>& of) {
      return of ? std::optional(of->maxCoeff()) : std::nullopt;
    };
    // Readings leave nothing out: their uncertainty is all there is.
    const auto numerical =
        models::change_uncertainty(models::mechanics_of(run, result), run, step, sensor);
    const auto total = run.measured ? numerical : largest_of(bands.total[sensor]);
    const auto known = results::Band{numerical, {}, largest_of(bands.input[sensor]), total}.known();
    for (Eigen::Index i = 0; i < 3; ++i)
      row.push_back(cell_within(component(field.dB[sensor], i), known, 1e-6, 2));
    row.push_back(field.dB[sensor] ? band_cell(total, known) : "-");
    const models::Comparison* largest = nullptr;
    for (const char* axis : axis_names) {
      const auto* c =
          find(comparisons, step, "dB", axis, "value", run.name(), reference->name(), sensor);
      if (c != nullptr && c->relative &&
          (largest == nullptr || std::abs(*c->relative) > std::abs(*largest->relative)))
        largest = c;
    }
    row.push_back(&run == reference ? "ref." : percent(largest));
  }
  if (rows.size() == 1) return "";
  std::string text = fmt::format("\n{}", text_table(rows, "<>"));
  const auto external = results::external_field(result.problem);
  if (external.empty() || reference == nullptr || reference->measured) return text;
  const Vector3& B = external[step][sensor];
  const auto micro = [](const Vector3& field) {
    return fmt::format("({:.4g}, {:.4g}, {:.4g}) uT", 1e6 * field.x(), 1e6 * field.y(),
                       1e6 * field.z());
  };
  const Vector3 read = reference->steps[step]->dB[sensor].value_or(Vector3::Zero()) + B;
  return text + "  " +
         wrapped(
             fmt::format("the environment's own field there is {}: with dB of {} the chip reads "
                         "{}",
                         micro(B), reference->name(), micro(read)),
             "  ");
}

/// Reasons why values are missing, or their errors not known.
std::string failures(const models::CaseResult& result, std::size_t step) {
  std::string text;
  for (const models::FieldRun& run : result.fields)
    if (run.steps[step])
      for (const std::string& message : {run.steps[step]->failure, run.steps[step]->remark})
        if (!message.empty()) text += fmt::format("  {}: {}\n", run.name(), message);
  return text;
}

/// The last step at which a model has a shape, or the last one of all.
std::size_t last_with_a_shape(const models::CaseResult& result) {
  const std::size_t count = result.problem.load_path.size();
  for (std::size_t step = count; step-- > 0;)
    for (const models::MechanicsRun& run : result.mechanics)
      if (run.result.steps[step].deformation) return step;
  return count - 1;
}

/// Failures and messages of the steps whose tables are not shown.
std::string troubles(const models::CaseResult& result, std::size_t shown) {
  std::string text;
  const std::size_t steps = result.problem.load_path.size();
  for (std::size_t step = 0; step < steps; ++step) {
    if (step == shown) continue;
    std::string of_step;
    for (const models::MechanicsRun& run : result.mechanics) {
      const MechanicsStep& at = run.result.steps[step];
      if (at.status != Status::converged || !at.message.empty())
        of_step += fmt::format("  {} {}{}{}\n", run.model, to_string(at.status),
                               at.message.empty() ? "" : ": ", at.message);
    }
    of_step += failures(result, step);
    if (!of_step.empty()) text += fmt::format("Step {} of {}:\n{}", step + 1, steps, of_step);
  }
  return text;
}

/// Force and torque on the magnets beside the cilium, by each mechanics model.
std::string magnets_table(const models::CaseResult& result, std::size_t step) {
  TextRows rows{{"magnet", "by", "Fx mN", "Fy mN", "Fz mN", "Tx uN m", "Ty uN m", "Tz uN m"}};
  for (const models::MechanicsRun& run : result.mechanics)
    for (const models::MagnetForce& magnet :
         models::forces_on_magnets(result.problem.cilium, run.result.steps[step])) {
      std::vector<std::string> row{magnet.name, run.model};
      const auto add = [&row](const Vector3& v, double unit) {  // without what is but rounding
        for (const double component : v)
          row.push_back(
              number_cell(std::abs(component) < 1e-9 * v.norm() ? 0 : component, unit, "{:.4g}"));
      };
      add(magnet.force, 1e-3);
      add(magnet.torque, 1e-6);
      rows.push_back(std::move(row));
    }
  if (rows.size() == 1) return {};
  return "\nForce of the cilium on each magnet and torque about the magnet's centre\n" +
         text_table(rows, "<<>");
}

/// Every pair against the most detailed one that has a field at any step.
std::string path_errors(const models::CaseResult& result,
                        const std::vector<models::Comparison>& comparisons, std::size_t sensor) {
  const models::FieldRun* last = nullptr;
  for (const models::FieldRun& run : result.fields)
    for (std::size_t step = 0; step < run.steps.size(); ++step)
      if (has_field(run, step, sensor)) last = &run;
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
            find(comparisons, std::nullopt, quantity, axis, "rrmse", run.name(), reference, sensor);
        any = any || c != nullptr;
        row.push_back(percent(c));
      }
    if (any) rows.push_back(std::move(row));
  }
  if (rows.size() == 1) return {};
  return fmt::format("\nOver the load path, at sensor {}: RRMSE (3) against {}, in %\n{}",
                     input::sensor_name(result.problem, sensor), reference, text_table(rows, "<>"));
}

std::string more_or_less(double ratio, const char* more, const char* less) {
  return fmt::format("{:.2g} % {}", 100 * std::abs(ratio - 1), ratio >= 1 ? more : less);
}

/// Verdict on the pair's difference in ΔB: resolved if any component's is, inconclusive if all are.
std::string_view field_verdict(const std::vector<models::Comparison>& comparisons, std::size_t step,
                               const std::string& model, const std::string& reference,
                               std::size_t sensor) {
  models::Verdict verdict = models::Verdict::inconclusive;
  for (const char* axis : axis_names)
    if (const auto* c = find(comparisons, step, "dB", axis, "value", model, reference, sensor))
      if (verdict != models::Verdict::resolved && c->verdict != models::Verdict::inconclusive)
        verdict = c->verdict;
  return to_string(verdict);
}

/// " (+-11 %: model)" of a number: its band and the largest part of it; empty where it is not
/// known.
std::string band_words(const results::Band& of, double value) {
  if (!of.total || value == 0) return {};
  // The numerical error of a corrected rod has what its corrections are uncertain by: the model's.
  constexpr double nearly = 0.9;
  const std::pair<double, const char*> parts[] = {
      {of.model.value_or(0), "model"},
      {nearly * of.numerical.value_or(0), "numerical"},
      {results::two_sided_95 * of.input.value_or(0), "inputs"}};
  const auto& largest =
      *std::ranges::max_element(parts, {}, &std::pair<double, const char*>::first);
  return fmt::format(" (+-{:.2g} %: {})", 100 * *of.total / std::abs(value), largest.second);
}

/// Band of |ΔB|.
results::Band norm_band(const models::CaseResult& result, const models::FieldRun& run,
                        std::size_t step, std::size_t sensor) {
  const results::FieldBands bands = results::field_bands(result, run, step, true);
  const auto norm = [](const std::optional<Vector3>& of) {
    return of ? std::optional(of->norm()) : std::nullopt;
  };
  const auto numerical =
      models::uncertainties(models::mechanics_of(run, result), run, step, sensor, true);
  return {norm(numerical), norm(bands.model[sensor]), norm(bands.input[sensor]),
          norm(bands.total[sensor])};
}

/// Comparison of the pairs' |ΔB| at a sensor with the most detailed pair's.
std::string field_meaning(const models::CaseResult& result,
                          const std::vector<models::Comparison>& comparisons, std::size_t step,
                          std::size_t sensor) {
  const models::FieldRun* reference = nullptr;
  const auto change_of = [&](const models::FieldRun& run) {
    return run.steps[step] ? run.steps[step]->dB[sensor] : std::nullopt;
  };
  for (const models::FieldRun& run : result.fields)
    if (change_of(run)) reference = &run;
  if (reference == nullptr) return {};
  const double signal = change_of(*reference)->norm();
  std::string text =
      fmt::format("  |dB| at sensor {} by {}: {:.4g} uT\n",
                  input::sensor_name(result.problem, sensor), reference->name(), 1e6 * signal);
  for (const models::FieldRun& run : result.fields)
    if (&run != reference && change_of(run) && signal != 0)
      text += fmt::format("  {} sees {}{}: {}\n", run.name(),
                          more_or_less(change_of(run)->norm() / signal, "more", "less"),
                          band_words(norm_band(result, run, step, sensor), change_of(run)->norm()),
                          field_verdict(comparisons, step, run.name(), reference->name(), sensor));
  return text;
}

/// Meaning of the numbers, at the last step that has any: the deflection of each model and the |ΔB|
/// of its pair, against the most detailed one.
std::string meaning(const models::CaseResult& result,
                    const std::vector<models::Comparison>& comparisons) {
  std::string text;
  for (std::size_t step = result.problem.load_path.size(); step-- > 0 && text.empty();) {
    const models::MechanicsRun* best = nullptr;
    for (const models::MechanicsRun& run : result.mechanics)
      if (run.result.steps[step].deformation) best = &run;
    if (best == nullptr) continue;
    const auto deflection = [&](const models::MechanicsRun& run) {
      const Centreline& centreline = run.result.steps[step].deformation->centreline;
      return centreline.at(centreline.length()).position.head<2>().norm();
    };
    for (const models::MechanicsRun& run : result.mechanics) {
      if (&run == best || !run.result.steps[step].deformation || deflection(*best) == 0) continue;
      const auto* tip = find(comparisons, step, "tip", "", "value", run.model, best->model);
      if (tip == nullptr) continue;
      text += fmt::format(
          "  {} bends {} than {}{}: {}\n", run.model,
          more_or_less(deflection(run) / deflection(*best), "further", "less far"), best->model,
          band_words(results::shape_band(run, step, results::ShapeQuantity::tip), deflection(run)),
          to_string(tip->verdict));
    }
    for (std::size_t sensor = 0; sensor < shown_sensors(result.problem); ++sensor)
      text += field_meaning(result, comparisons, step, sensor);
    if (!text.empty())
      text = fmt::format("At step {} of {}:\n{}", step + 1, result.problem.load_path.size(), text);
  }
  return text;
}

constexpr const char* mechanics_legend =
    "+- 95 % band of the tip in micrometres: its numerical error, what the rod leaves out, "
    "against\n"
    "    one with corrected joints, and what [[input_uncertainty]] make; >3: the numerical error, "
    "the\n"
    "    rest is not known. Behind a number it is in % of it, with its largest part.\n"
    "(1) distance of the two centrelines at common material points, largest, RMS over the arc\n"
    "    length and at the tip, divided by the tip deflection of the second; tip angle divided by\n"
    "    its tip angle. R2 of the deflection w over the current height z, and the square of its\n"
    "    correlation, which does not see a constant factor. The last column says whether the\n"
    "    difference of the tips is larger than the numerical uncertainty of the two.\n";
constexpr const char* fields_legend =
    "+-dB: 95 % band of dB in uT, largest component: the numerical errors of field and shape,\n"
    "    what the two models leave out, and inputs; >3: the numerical errors, the rest is not "
    "known;\n"
    "    ?: neither is known.\n"
    "(2) largest error of a component of dB = B - B(undeformed), divided by the largest |dB| of\n"
    "    the reference (ref.) over the load path.\n"
    "(3) RMS of the error of a component over the path divided by the RMS of that component.\n"
    "    - is undefined: the divisor vanishes.\n";

}  // namespace

std::string describe(const Load& load) {
  std::string text(type(load));
  for (std::size_t i = 0; i < load.values().size(); ++i) {
    const LoadParameter& parameter = load.type().parameters[i];
    text += fmt::format(fmt::runtime(parameter.words), parameter.display_factor * load.values()[i]);
  }
  const Vector3 field = 1e3 * load.environment().uniform_field;
  if (!field.isZero(0))
    text += fmt::format(", field ({:g}, {:g}, {:g}) mT", field.x(), field.y(), field.z());
  for (const surroundings::magnets::Magnet& magnet : load.environment().magnets) {
    const Vector3 at = 1e3 * magnet.position;
    text += fmt::format(", {} at ({:g}, {:g}, {:g}) mm", magnet.name, at.x(), at.y(), at.z());
  }
  return text;
}

std::string describe(const MechanicsStep& step) {
  std::string text = describe(step.load);
  if (step.deformation) {
    const Centreline& centreline = step.deformation->centreline;
    const CentrelinePoint tip = centreline.at(centreline.length());
    text += fmt::format(": tip at ({:.4f}, {:.4f}, {:.4f}) mm, {:.3f} deg", 1e3 * tip.position.x(),
                        1e3 * tip.position.y(), 1e3 * tip.position.z(), tip.theta() / degree);
  } else {
    text += fmt::format(": {}", to_string(step.status));
  }
  return text + fmt::format(", {:.3g} s", step.seconds);
}

std::string footnotes(Footnotes which, std::string_view text) {
  if (which == Footnotes::text || text.empty()) return std::string(text);
  return "What the columns, marks and (1), (2), … are: --explain\n";
}

std::string table(const models::CaseResult& result,
                  const std::vector<models::Comparison>& comparisons, Footnotes which,
                  Steps steps) {
  const input::Case& problem = result.problem;
  const std::size_t sensors = shown_sensors(problem);
  const auto of_path = [&] {
    std::string text;
    for (std::size_t s = 0; s < sensors; ++s) text += path_errors(result, comparisons, s);
    return text;
  };
  std::string text = problem.name + (problem.title.empty() ? "" : ": " + problem.title) + '\n';
  std::string legend;
  if (is_sweep(problem)) {
    text += sweep_table(result, sensors) + of_path();
    legend = sweep_legend;
  } else {
    text += meaning(result, comparisons);
    if (!result.unstated_touch.empty()) text += "  " + wrapped(result.unstated_touch, "  ");
    const std::size_t count = problem.load_path.size();
    const std::size_t shown = last_with_a_shape(result);
    for (std::size_t step = 0; step < count; ++step) {
      if (steps == Steps::last && step != shown) continue;
      text +=
          fmt::format("\nStep {} of {}: {}\n", step + 1, count, describe(problem.load_path[step]));
      text += mechanics_table(result, step);
      text += magnets_table(result, step);
      const std::string errors = mechanics_errors(result, comparisons, step);
      if (!errors.empty()) legend = mechanics_legend;
      text += errors;
      for (std::size_t s = 0; s < sensors; ++s) text += fields_table(result, comparisons, step, s);
      text += failures(result, step);
    }
    text += of_path();
    if (steps == Steps::last && count > 1)
      text += fmt::format("\n{}The other steps: --all\n", troubles(result, shown));
  }
  if (!result.fields.empty() && sensors > 0) legend += fields_legend;
  text += '\n' + footnotes(which, legend);
  if (sensors < problem.sensors.size())
    text += fmt::format("The other {} sensors are in fields.csv and errors.csv.\n",
                        problem.sensors.size() - sensors);
  return text;
}

}  // namespace ciliaval::compare::output

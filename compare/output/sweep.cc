// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/sweep.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>

#include "compare/output/csv_writer.h"
#include "compare/output/results.h"
#include "compare/output/text_table.h"
#include "problem/types.h"

namespace ciliaval::compare::output {
namespace {

constexpr std::size_t most_jumps = 8;  ///< of a model that a terminal shows
constexpr std::size_t most_messages = 3;

SweepLoad sweep_of(const Load& load) {
  return load.as<SweepLoad>().value();
}

std::optional<Vector3> tip_of(const MechanicsStep& step) {
  if (!step.deformation) return std::nullopt;
  const Centreline& centreline = step.deformation->centreline;
  return centreline.at(centreline.length()).position;
}

/// Suffix of B in the columns of a sensor: "0", or "_left" for a sensor with a name.
std::string column_label(const input::Case& problem, std::size_t sensor) {
  return fmt::format("{}{}", problem.sensor_names.empty() ? "" : "_",
                     input::sensor_name(problem, sensor));
}

void add_columns(CsvWriter& csv, const models::CaseResult& result) {
  csv.column("step");
  csv.column("travel", "m");
  csv.column("way", "m");
  csv.column("time", "s");
  for (const models::MechanicsRun& run : result.mechanics) {
    const std::string name = run.model + ".";
    csv.column(name + "status");
    csv.column(name + "state");
    csv.column(name + "where");
    csv.column(name + "normal_force", "N");
    csv.column(name + "friction_force", "N");
    csv.vector_columns(name + "point_", "m");
    csv.vector_columns(name + "tip_", "m");
    csv.column(name + "tip_angle", "rad");
    for (const char* energy : {"elastic_energy", "surface_work", "friction_work", "energy_lost"})
      csv.column(name + energy, "J");
  }
  for (const models::FieldRun& run : result.fields)
    for (std::size_t s = 0; s < result.problem.sensors.size(); ++s)
      for (const char* quantity : {"B", "dB"})
        csv.vector_columns(
            fmt::format("{}.{}{}_", run.name(), quantity, column_label(result.problem, s)), "T");
  csv.end_row();
}

void add_mechanics(CsvWriter& csv, const MechanicsStep& step) {
  csv.add(to_string(step.status));
  const bool touches = step.contact && step.contact->state != SurfaceContact::State::open;
  const auto number = [&](double SurfaceContact::*member) {
    return step.contact ? std::optional(step.contact.value().*member) : std::nullopt;
  };
  csv.add(step.contact ? to_string(step.contact->state) : "");
  csv.add(touches ? to_string(step.contact->where) : "");
  csv.add(number(&SurfaceContact::normal_force));
  csv.add(number(&SurfaceContact::friction_force));
  csv.add(touches ? std::optional(step.contact->point) : std::nullopt);
  const std::optional<Vector3> tip = tip_of(step);
  csv.add(tip);
  csv.add(tip ? std::optional(
                    step.deformation->centreline.at(step.deformation->centreline.length()).theta())
              : std::nullopt);
  csv.add(number(&SurfaceContact::elastic_energy));
  csv.add(number(&SurfaceContact::surface_work));
  csv.add(number(&SurfaceContact::friction_work));
  csv.add(step.contact ? step.contact->energy_lost : std::nullopt);
}

// ------------------------------------------------------------------------------------- terminal

std::string heading(const LoadPath& path) {
  const SweepLoad first = sweep_of(path.front());
  const double longest =
      std::ranges::max(path, {}, [](const Load& load) { return sweep_of(load).travel; })
          .as<SweepLoad>()
          ->travel;
  const bool back = sweep_of(path.back()).travel < longest;
  return fmt::format(
      "\nSweep, {} samples: interference {:g} mm, travel {:g} mm{}, azimuth {:g} "
      "deg, friction {:g}\n",
      path.size(), 1e3 * first.interference, 1e3 * longest, back ? " and back" : "",
      180 / std::numbers::pi * first.azimuth, path.front().surface()->friction);
}

std::string models_table(const models::CaseResult& result) {
  TextRows rows{{"mechanics", "solved", "open", "stick", "slip", "N (mN)", "T from", "to (mN)",
                 "jumps", "lost(uJ)", "rest (1)", "time (s)"}};
  for (const models::MechanicsRun& run : result.mechanics) {
    std::array<int, 3> count{};
    int jumps = 0;
    int solved = 0;
    double normal = 0;
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    double seconds = 0;
    for (const MechanicsStep& step : run.result.steps) {
      seconds += step.seconds;
      solved += step.status == Status::converged ? 1 : 0;
      if (!step.contact) continue;
      ++count.at(static_cast<std::size_t>(step.contact->state));
      jumps += step.contact->energy_lost ? 1 : 0;
      normal = std::max(normal, step.contact->normal_force);
      low = std::min(low, step.contact->friction_force);
      high = std::max(high, step.contact->friction_force);
    }
    const EnergyBalance balance = energy_balance(run);
    rows.push_back({run.model, fmt::format("{}", solved), fmt::format("{}", count[0]),
                    fmt::format("{}", count[1]), fmt::format("{}", count[2]),
                    number_cell(normal, 1e-3, "{:.4g}"), number_cell(low, 1e-3, "{:.4g}"),
                    number_cell(high, 1e-3, "{:.4g}"), fmt::format("{}", jumps),
                    number_cell(balance.energy_lost, 1e-6, "{:.4g}"),
                    fmt::format("{:.0e}", balance.relative_rest()),
                    fmt::format("{:.3g}", seconds)});
  }
  return text_table(rows, "<>");
}

/// Jumps of the models, and messages of their steps.
std::string events(const models::CaseResult& result) {
  std::string text;
  for (const models::MechanicsRun& run : result.mechanics) {
    std::size_t shown = 0;
    std::string message;
    std::size_t messages = 0;
    for (const MechanicsStep& step : run.result.steps) {
      if (!step.message.empty() && step.message != message && ++messages <= most_messages)
        text += fmt::format("  {}: at the travel {:.4g} mm: {}\n", run.model,
                            1e3 * sweep_of(step.load).travel, step.message);
      message = step.message;
      if (!step.contact || !step.contact->energy_lost || ++shown > most_jumps) continue;
      text +=
          fmt::format("  {}: has jumped at the travel {:.4g} mm; {:.4g} uJ are lost\n", run.model,
                      1e3 * sweep_of(step.load).travel, 1e6 * *step.contact->energy_lost);
    }
    if (messages > most_messages)
      text += fmt::format("  {}: {} more messages are in summary.json\n", run.model,
                          messages - most_messages);
    if (shown > most_jumps)
      text += fmt::format("  {}: {} more jumps are in sweep.csv\n", run.model, shown - most_jumps);
  }
  return text;
}

/// Distances of the tips over the path.
std::string differences(const models::CaseResult& result) {
  TextRows rows{{"difference (2)", "tip max(mm)", "at (mm)", "RMS (mm)", "N max(mN)", "at (mm)"}};
  for (std::size_t b = 0; b < result.mechanics.size(); ++b)
    for (std::size_t a = 0; a < b; ++a) {
      const auto& first = result.mechanics[a].result.steps;
      const auto& second = result.mechanics[b].result.steps;
      double tip = 0;
      double tip_at = 0;
      double squares = 0;
      double force = 0;
      double force_at = 0;
      int compared = 0;
      for (std::size_t i = 0; i < first.size(); ++i) {
        if (!first[i].contact || !second[i].contact) continue;
        const double apart = (*tip_of(first[i]) - *tip_of(second[i])).norm();
        const double forces =
            std::abs(first[i].contact->normal_force - second[i].contact->normal_force);
        const double travel = sweep_of(first[i].load).travel;
        if (apart > tip) tip_at = travel;
        if (forces > force) force_at = travel;
        tip = std::max(tip, apart);
        force = std::max(force, forces);
        squares += apart * apart;
        ++compared;
      }
      if (compared == 0) continue;
      rows.push_back({fmt::format("{} - {}", result.mechanics[a].model, result.mechanics[b].model),
                      number_cell(tip, 1e-3, "{:.4f}"), number_cell(tip_at, 1e-3, "{:.4g}"),
                      number_cell(std::sqrt(squares / compared), 1e-3, "{:.4f}"),
                      number_cell(force, 1e-3, "{:.4g}"), number_cell(force_at, 1e-3, "{:.4g}")});
    }
  return rows.size() == 1 ? "" : fmt::format("\n{}", text_table(rows, "<>"));
}

/// The range of ΔB at a sensor.
std::string fields_table(const models::CaseResult& result, std::size_t sensor) {
  TextRows rows{{fmt::format("dB at sensor {} (uT)", input::sensor_name(result.problem, sensor)),
                 "x from", "to", "y from", "to", "z from", "to"}};
  for (const models::FieldRun& run : result.fields) {
    std::vector<std::string>& row = rows.emplace_back();
    row.push_back(run.name());
    for (Eigen::Index i = 0; i < 3; ++i) {
      double low = std::numeric_limits<double>::infinity();
      double high = -low;
      for (const auto& step : run.steps)
        if (step && step->dB[sensor]) {
          low = std::min(low, (*step->dB[sensor])[i]);
          high = std::max(high, (*step->dB[sensor])[i]);
        }
      for (const double end : {low, high})
        row.push_back(std::isfinite(end) ? number_cell(end, 1e-6, "{:.2f}") : "-");
    }
  }
  return rows.size() == 1 ? "" : fmt::format("\n{}", text_table(rows, "<>"));
}

}  // namespace

bool is_sweep(const input::Case& problem) {
  return !problem.load_path.empty() && problem.load_path.front().is<SweepLoad>();
}

std::vector<double> ways(const LoadPath& path) {
  std::vector<double> result;
  for (std::size_t i = 0; i < path.size(); ++i)
    result.push_back(
        i == 0 ? 0
               : result.back() + std::abs(sweep_of(path[i]).travel - sweep_of(path[i - 1]).travel));
  return result;
}

double EnergyBalance::scale() const {
  return std::max(
      {std::abs(surface_work), std::abs(friction_work), std::abs(energy_lost), std::abs(stored)});
}

double EnergyBalance::relative_rest() const {
  return scale() > 0 ? rest() / scale() : 0;
}

EnergyBalance energy_balance(const models::MechanicsRun& run) {
  EnergyBalance balance;
  const std::vector<MechanicsStep>& steps = run.result.steps;
  for (std::size_t i = 0; i < steps.size() && steps[i].contact; ++i) {
    balance.stored = steps[i].contact->elastic_energy - steps[0].contact->elastic_energy;
    if (i == 0) continue;  // how the first state came about is not a part of the sweep
    balance.surface_work += steps[i].contact->surface_work;
    balance.friction_work += steps[i].contact->friction_work;
    balance.energy_lost += steps[i].contact->energy_lost.value_or(0);
  }
  return balance;
}

std::string sweep_csv(const models::CaseResult& result) {
  CsvWriter csv;
  add_columns(csv, result);
  const LoadPath& path = result.problem.load_path;
  const std::vector<double> way = ways(path);
  for (std::size_t i = 0; i < path.size(); ++i) {
    csv.add(i);
    csv.add(sweep_of(path[i]).travel);
    csv.add(way[i]);
    csv.add(way[i] / sweep_of(path[i]).speed);
    for (const models::MechanicsRun& run : result.mechanics)
      add_mechanics(csv, run.result.steps[i]);
    for (const models::FieldRun& run : result.fields)
      for (std::size_t s = 0; s < result.problem.sensors.size(); ++s) {
        csv.add(run.steps[i] ? run.steps[i]->B[s] : std::nullopt);
        csv.add(run.steps[i] ? run.steps[i]->dB[s] : std::nullopt);
      }
    csv.end_row();
  }
  return csv.text();
}

std::string sweep_table(const models::CaseResult& result, std::size_t sensors) {
  std::string text = heading(result.problem.load_path) + models_table(result) + events(result) +
                     differences(result);
  for (std::size_t sensor = 0; sensor < sensors; ++sensor) text += fields_table(result, sensor);
  return text;
}

}  // namespace ciliaval::compare::output

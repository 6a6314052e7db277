// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/check_command.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "compare/app/case_files.h"
#include "compare/regression/baseline.h"
#include "compare/regression/check.h"
#include "compare/regression/report.h"
#include "compare/models/registry.h"
#include "compare/output/results.h"
#include "compare/models/run.h"
#include "compare/app/terminal.h"
#include "fem/parallel.h"
#include "problem/error.h"

namespace ciliaval::compare {
namespace {

namespace fs = std::filesystem;

/// The models that take seconds, which `--quick` leaves out.
constexpr std::array<std::string_view, 3> slow_models{"calculix", "solid", "potential"};

/// Those of the case's models that are not run.
std::vector<std::string> left_out_of(const Case& problem, bool quick) {
  std::vector<std::string> result;
  for (const auto* ids : {&problem.mechanics, &problem.fields})
    for (const std::string& id : *ids)
      if (quick && std::find(slow_models.begin(), slow_models.end(), id) != slow_models.end())
        result.push_back(id);
  return result;
}

CaseResult run_case(Case problem, const std::vector<std::string>& left_out) {
  const auto is_left_out = [&](const std::string& id) {
    return std::find(left_out.begin(), left_out.end(), id) != left_out.end();
  };
  std::erase_if(problem.mechanics, is_left_out);
  std::erase_if(problem.fields, is_left_out);
  ProgressLine line;
  const Progress progress = line.callback();
  Progress named;
  if (progress) named = [&](const std::string& text) { progress(problem.name + ": " + text); };
  return run(problem, mechanics_models(), field_models(), named);
}

/// All baselines, before anything runs.
std::vector<std::optional<Baseline>> read_baselines(const std::vector<fs::path>& files,
                                                    bool may_be_missing) {
  std::vector<std::optional<Baseline>> baselines;
  std::string faults;
  for (const fs::path& file : files) {
    const fs::path path = baseline_path(file);
    baselines.emplace_back();
    try {
      if (fs::exists(path))
        baselines.back() = read_baseline(path);
      else if (!may_be_missing)
        throw InputError(
            fmt::format("{} has no baseline `{}`: `ciliaval check --accept {}` makes "
                        "a candidate",
                        file.string(), path.string(), file.string()));
    } catch (const InputError& error) {
      faults += (faults.empty() ? "" : "\n") + std::string(error.what());
    }
  }
  if (!faults.empty()) throw InputError(faults);
  return baselines;
}

std::string number(const std::optional<double>& value) {
  return value ? fmt::format("{}", *value) : "nothing";
}

std::string change_line(const Change& change) {
  std::string line =
      fmt::format("  {}: {} -> {}", change.id, number(change.old_value), number(change.new_value));
  if (change.old_value && change.new_value && *change.old_value != 0)
    line += fmt::format(" ({:+.2e})", (*change.new_value - *change.old_value) / *change.old_value);
  return line + "\n";
}

/// Whether they differ in nothing but where they come from.
bool same_content(Baseline a, const Baseline& b) {
  a.origin = b.origin;
  a.changes = b.changes;
  return to_json(a) == to_json(b);
}

/// Writes a candidate beside the case, unless its baseline says the same already.
void write_candidate(const Case& problem, const fs::path& file, const Baseline* old,
                     const std::string& command) {
  const Baseline candidate =
      make_baseline(problem, measurements(run_case(problem, {})), provenance(command), old);
  if (old != nullptr && same_content(*old, candidate)) {
    print(fmt::format("{}: as its baseline, nothing to accept\n", problem.name));
    return;
  }
  const fs::path baseline = baseline_path(file);
  fs::path path = baseline;
  path.replace_extension(".candidate.json");
  replace_text(path, to_json(candidate));
  std::string text =
      fmt::format("{}: {} quantities, {} changed\n", problem.name, candidate.quantities.size(),
                  old == nullptr ? candidate.quantities.size() : candidate.changes.size());
  for (const Change& change : candidate.changes) text += change_line(change);
  print(text + fmt::format("  to accept it: mv '{}' '{}'\n", path.string(), baseline.string()));
}

ExitCode verdict(const std::vector<CheckReport>& reports) {
  const auto any = [&](auto&& what) { return std::any_of(reports.begin(), reports.end(), what); };
  if (any([](const CheckReport& r) { return r.model_failed; })) return ExitCode::solver;
  if (any([](const CheckReport& r) { return r.compared() > 0 && !r.passed(); }))
    return ExitCode::tolerance;
  if (any([](const CheckReport& r) { return !r.passed(); })) return ExitCode::undecided;
  return ExitCode::pass;
}

}  // namespace

ExitCode check_cases(std::vector<fs::path> files, const CheckOptions& options) {
  if (fem::rank_count() > 1)
    throw InputError("`ciliaval check` runs on one rank: start it without mpirun");
  if (options.quick && options.accept)
    throw InputError("--accept needs all models: leave out --quick");
  if (files.empty()) files = shipped_cases().files;
  if (files.empty())
    throw InputError("no shipped cases were found beside the program: name a case file");
  const std::vector<Case> cases = read_cases(files);
  const auto baselines = read_baselines(files, options.accept);
  if (options.accept) {
    for (std::size_t i = 0; i < cases.size(); ++i)
      write_candidate(cases[i], files[i], baselines[i] ? &*baselines[i] : nullptr, options.command);
    return ExitCode::pass;
  }
  std::vector<CheckReport> reports;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const std::vector<std::string> left_out = left_out_of(cases[i], options.quick);
    reports.push_back(check(cases[i], run_case(cases[i], left_out), *baselines[i], left_out));
  }
  if (options.junit) replace_text(*options.junit, report_junit(reports));
  if (options.json) replace_text(*options.json, report_json(reports));
  print(report_text(reports));
  return verdict(reports);
}

}  // namespace ciliaval::compare

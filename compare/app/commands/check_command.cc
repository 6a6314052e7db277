// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/commands.h"

#include <fmt/core.h>

#include <algorithm>

#include "compare/app/case_files.h"
#include "compare/app/terminal.h"
#include "compare/models/registry.h"
#include "compare/models/run.h"
#include "compare/output/output_file.h"
#include "compare/regression/baseline.h"
#include "compare/regression/check.h"
#include "problem/error.h"

namespace ciliaval::compare::app::commands {
namespace {

namespace fs = std::filesystem;

struct CheckOptions {
  std::vector<fs::path> files;
  bool quick = false;   ///< without the models that take more than a moment
  bool accept = false;  ///< write candidates for new baselines instead
  OptionalFile junit;
  Outputs outputs;
};

/// Ids of the case's models that are not run: `--quick` leaves out the slow ones.
std::vector<std::string> left_out_of(const input::Case& problem, bool quick) {
  std::vector<std::string> result;
  const auto add = [&](const std::vector<std::string>& ids, const auto& entries) {
    for (const std::string& id : ids)
      if (quick && models::entry_of(entries, id).is_slow) result.push_back(id);
  };
  add(problem.mechanics, models::mechanics_models());
  add(problem.fields, models::field_models());
  return result;
}

models::CaseResult run_case(input::Case problem, const std::vector<std::string>& left_out) {
  const auto is_left_out = [&](const std::string& id) {
    return std::find(left_out.begin(), left_out.end(), id) != left_out.end();
  };
  std::erase_if(problem.mechanics, is_left_out);
  std::erase_if(problem.fields, is_left_out);
  ProgressLine line;
  const Progress progress = line.callback();
  return models::run(problem, models::mechanics_models(), models::field_models(),
                     with_prefix(progress, problem.name + ": "));
}

/// All baselines, before anything runs.
std::vector<std::optional<regression::Baseline>> read_baselines(const std::vector<fs::path>& files,
                                                                bool may_be_missing) {
  std::vector<std::optional<regression::Baseline>> baselines;
  std::string faults;
  for (const fs::path& file : files) {
    const fs::path path = regression::baseline_path(file);
    baselines.emplace_back();
    try {
      if (fs::exists(path))
        baselines.back() = regression::read_baseline(path);
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

std::string change_line(const regression::Change& change) {
  std::string line =
      fmt::format("  {}: {} -> {}", change.id, number(change.old_value), number(change.new_value));
  if (change.old_value && change.new_value && *change.old_value != 0)
    line += fmt::format(" ({:+.2e})", (*change.new_value - *change.old_value) / *change.old_value);
  return line + "\n";
}

/// True if the baselines differ at most in their origin and their list of changes.
bool same_content(regression::Baseline a, const regression::Baseline& b) {
  a.origin = b.origin;
  a.changes = b.changes;
  return to_json(a) == to_json(b);
}

/// Writes a candidate beside the case, unless its baseline says the same already.
void write_candidate(const input::Case& problem, const fs::path& file,
                     const regression::Baseline* old, const std::string& command) {
  const regression::Baseline candidate = regression::make_baseline(
      problem, regression::measurements(run_case(problem, {})), output::provenance(command), old);
  if (old != nullptr && same_content(*old, candidate)) {
    print(fmt::format("{}: as its baseline, nothing to accept\n", problem.name));
    return;
  }
  const fs::path baseline = regression::baseline_path(file);
  fs::path path = baseline;
  path.replace_extension(".candidate.json");
  output::write_file(path, to_json(candidate));
  std::string text =
      fmt::format("{}: {} quantities, {} changed\n", problem.name, candidate.quantities.size(),
                  old == nullptr ? candidate.quantities.size() : candidate.changes.size());
  for (const regression::Change& change : candidate.changes) text += change_line(change);
  print(text + fmt::format("  to accept it: mv '{}' '{}'\n", path.string(), baseline.string()));
}

ExitCode verdict(const std::vector<regression::CheckReport>& reports) {
  const auto any = [&](auto&& what) { return std::any_of(reports.begin(), reports.end(), what); };
  if (any([](const regression::CheckReport& r) { return r.model_failed; })) return ExitCode::solver;
  if (any([](const regression::CheckReport& r) { return r.compared() > 0 && !r.passed(); }))
    return ExitCode::tolerance;
  if (any([](const regression::CheckReport& r) { return !r.passed(); })) return ExitCode::undecided;
  return ExitCode::pass;
}

/// Runs the cases, all shipped ones if none is named, and compares them with the baselines beside
/// them. With `accept` it writes `NAME.baseline.candidate.json` beside each case that differs from
/// its baseline; the baseline itself is never touched. Returns `tolerance`, `solver` or `undecided`
/// if the check fails.
ExitCode execute_check(const CheckOptions& options, const std::string& words) {
  require_one_rank("check");
  if (options.quick && options.accept)
    throw InputError("--accept needs all models: leave out --quick");
  if (options.accept && (options.outputs.json || options.junit))
    throw InputError("--accept writes candidates and no report: leave out --json and --junit");
  const std::vector<fs::path> files = options.files.empty() ? shipped_cases().files : options.files;
  if (files.empty())
    throw InputError("no shipped cases were found beside the program: name a case file");
  const std::vector<input::Case> cases = read_cases(files);
  std::vector<fs::path> inputs;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const std::vector<fs::path> of_case = input_files(files[i], cases[i]);
    inputs.insert(inputs.end(), of_case.begin(), of_case.end());
    inputs.push_back(regression::baseline_path(files[i]));
  }
  options.outputs.check(inputs, options.junit);
  const auto baselines = read_baselines(files, options.accept);
  if (options.accept) {
    for (std::size_t i = 0; i < cases.size(); ++i)
      write_candidate(cases[i], files[i], baselines[i] ? &*baselines[i] : nullptr, words);
    return ExitCode::pass;
  }
  std::vector<regression::CheckReport> reports;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const std::vector<std::string> left_out = left_out_of(cases[i], options.quick);
    reports.push_back(
        regression::check(cases[i], run_case(cases[i], left_out), *baselines[i], left_out));
  }
  print(regression::report_text(reports));
  if (options.junit) output::write_file(*options.junit, regression::report_junit(reports));
  options.outputs.write([&] { return regression::report_json(reports); });
  return verdict(reports);
}

}  // namespace

void add_check(CommandLine& line) {
  const auto options = std::make_shared<CheckOptions>();
  CLI::App* check = line.add(
      "check",
      "Regression check: run cases, by default all shipped ones, and hold every result against\n"
      "the accepted one in the baseline beside the case, NAME.baseline.json "
      "(docs/guide/validation.md).",
      options, execute_check);
  check->add_option("CASE", options->files, "Case files (TOML); none: all shipped ones")
      ->transform(input_file());
  check->add_flag(
      "--quick", options->quick,
      "Leave out the models that `ciliaval list` calls slow: seconds instead of minutes");
  check->add_flag(
      "--accept", options->accept,
      "Check nothing: write NAME.baseline.candidate.json beside each case that has\n"
      "changed, and say what changed from what to what. It is accepted by renaming it.");
  add_output(check, "--junit", options->junit, "Write the report as JUnit's XML too");
  options->outputs.declare(check, "the report");
}

}  // namespace ciliaval::compare::app::commands

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/case_files.h"
#include "compare/app/commands/commands.h"
#include "compare/app/python.h"
#include "problem/error.h"

namespace ciliaval::compare::app::commands {
namespace {

struct ClaimsOptions {
  Outputs outputs;
  CLI::App* command = nullptr;
};

ExitCode execute_claims(const ClaimsOptions& options, const std::string& words) {
  require_one_rank("claims");
  const ShippedCases shipped = shipped_cases();
  const std::filesystem::path folder = shipped.folder / "paper";
  if (!std::filesystem::exists(folder / "fig3d.toml"))
    throw InputError("the shipped cases are not beside the program: " + folder.string() +
                     "/fig3d.toml does not exist");
  for (const auto* inputs : {&shipped.files, &shipped.studies, &shipped.benches})
    options.outputs.check(*inputs);
  become_python_command("ciliaval.paper", *options.command, words, {folder.string()});
}

}  // namespace

void add_claims(CommandLine& line) {
  const auto options = std::make_shared<ClaimsOptions>();
  CLI::App* claims = line.add(
      "claims",
      "The paper's quantitative statements, each with what the models find: reproduced, not\n"
      "reproduced, depends on what the paper does not state (and where it holds), or not\n"
      "checkable and why (docs/evidence/paper.md).",
      options, execute_claims);
  options->command = claims;
  claims->add_flag_callback(
      "--quick", [] {}, "Without the 3D solid, which takes some minutes the first time");
  options->outputs.declare(claims, "the ledger");
}

}  // namespace ciliaval::compare::app::commands

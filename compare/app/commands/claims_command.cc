// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/commands.h"

#include "compare/app/case_files.h"
#include "compare/app/terminal.h"
#include "compare/claims/claim.h"
#include "compare/output/output_file.h"
#include "compare/output/provenance.h"
#include "problem/error.h"

namespace ciliaval::compare::app::commands {
namespace {

struct ClaimsOptions {
  bool quick = false;  ///< without the 3D solid
  Outputs outputs;
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
  ProgressLine line;
  const std::vector<claims::Claim> all = claims::claims(folder, !options.quick, line.callback());
  print(claims::claims_text(all));
  options.outputs.write([&] { return claims::claims_json(all, output::provenance(words)); });
  return ExitCode::pass;
}

}  // namespace

void add_claims(CommandLine& line) {
  const auto options = std::make_shared<ClaimsOptions>();
  CLI::App* claims = line.add(
      "claims",
      "The paper's quantitative statements, each with what the models find: reproduced, not\n"
      "reproduced, depends on the model, or not checkable and why (docs/evidence/paper.md).",
      options, execute_claims);
  claims->add_flag("--quick", options->quick,
                   "Without the 3D solid: seconds instead of two minutes");
  options->outputs.declare(claims, "the ledger");
}

}  // namespace ciliaval::compare::app::commands

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/claims_command.h"

#include "compare/app/case_files.h"
#include "compare/claims/ledger.h"
#include "compare/output/provenance.h"
#include "compare/output/results.h"
#include "compare/app/terminal.h"
#include "fem/parallel.h"
#include "problem/error.h"

namespace ciliaval::compare {

ExitCode print_claims(const ClaimsOptions& options) {
  if (fem::rank_count() > 1)
    throw InputError("`ciliaval claims` runs on one rank: start it without mpirun");
  const std::filesystem::path folder = shipped_cases().folder / "paper";
  if (!std::filesystem::exists(folder / "fig3d.toml"))
    throw InputError("the shipped cases are not beside the program: " + folder.string() +
                     "/fig3d.toml does not exist");
  ProgressLine line;
  const std::vector<Claim> all = claims(folder, !options.quick, line.callback());
  print(claims_text(all));
  if (options.json) replace_text(*options.json, claims_json(all, provenance(options.command)));
  return ExitCode::pass;
}

}  // namespace ciliaval::compare

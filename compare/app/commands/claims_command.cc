// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/claims_command.h"

#include "compare/app/case_files.h"
#include "compare/app/terminal.h"
#include "compare/claims/ledger.h"
#include "compare/output/output_file.h"
#include "compare/output/provenance.h"
#include "fem/parallel.h"
#include "problem/error.h"

namespace ciliaval::compare::app::commands {

ExitCode print_claims(const ClaimsOptions& options) {
  if (fem::rank_count() > 1)
    throw InputError("`ciliaval claims` runs on one rank: start it without mpirun");
  const ShippedCases shipped = shipped_cases();
  const std::filesystem::path folder = shipped.folder / "paper";
  if (!std::filesystem::exists(folder / "fig3d.toml"))
    throw InputError("the shipped cases are not beside the program: " + folder.string() +
                     "/fig3d.toml does not exist");
  for (const auto* inputs : {&shipped.files, &shipped.studies, &shipped.benches})
    output::check_outputs({options.json}, *inputs);
  ProgressLine line;
  const std::vector<claims::Claim> all = claims::claims(folder, !options.quick, line.callback());
  print(claims::claims_text(all));
  if (options.json)
    output::write_file(*options.json,
                       claims::claims_json(all, output::provenance(options.command)));
  return ExitCode::pass;
}

}  // namespace ciliaval::compare::app::commands

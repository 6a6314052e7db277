// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/commands.h"

#include <fmt/core.h>

#include "compare/output/provenance.h"
#include "fem/parallel.h"
#include "problem/error.h"

namespace ciliaval::compare::app::commands {

CLI::Option* add_file(CLI::App* command, const char* name, std::filesystem::path& file,
                      const char* description) {
  return command->add_option(name, file, description)->required()->check(CLI::ExistingFile);
}

void add_output(CLI::App* command, const char* name, OptionalFile& file, const char* description,
                const char* type) {
  command->add_option(name, file, description)->type_name(type);
}

void require_one_rank(const char* command) {
  if (fem::rank_count() > 1)
    throw InputError(
        fmt::format("`ciliaval {}` runs on one rank: start it without mpirun", command));
}

std::string version_line() {
  const output::Provenance origin = output::provenance("");
  return fmt::format("ciliaval {} (git {})", origin.version, origin.git);
}

}  // namespace ciliaval::compare::app::commands

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

#include "compare/models/errors.h"
#include "compare/models/run.h"

/// Output that sweeps alone have.
namespace ciliaval::compare::output {

/// True if the case's load is a sweep.
bool is_sweep(const input::Case& problem);

/// Path length of the surface up to each step, there and back, m.
std::vector<double> ways(const LoadPath& path);

/// Work and energy over a whole path, J.
struct EnergyBalance {
  double surface_work = 0;
  double friction_work = 0;
  double energy_lost = 0;  ///< at jumps
  double stored = 0;       ///< elastic energy at the end less that at the beginning

  double rest() const { return surface_work - friction_work - energy_lost - stored; }
  double scale() const;  ///< the largest of the terms
  /// The rest over the scale; 0 if all vanish.
  double relative_rest() const;
};
/// Balance of the steps up to the first without a contact.
EnergyBalance energy_balance(const models::MechanicsRun& run);

/// sweep.csv as text: a row for each sample; travel, way and time (by the speed), then of each
/// mechanics model the contact, tip and energies, of each pair of models B and ΔB at each sensor.
/// Units in the comment line.
std::string sweep_csv(const models::CaseResult& result);

/// The sweep for a terminal: a line for each model, its jumps, the differences of the tips, the
/// range of ΔB at the first `sensors`.
std::string sweep_table(const models::CaseResult& result, std::size_t sensors);
/// Footnotes of sweep_table().
inline constexpr const char* sweep_legend =
    "(1) work of the surface less friction, losses at jumps and elastic energy, over the largest\n"
    "    of them.\n"
    "(2) of the two tips, and of the two normal forces, over the samples that both have.\n";

}  // namespace ciliaval::compare::output

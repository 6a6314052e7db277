// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <span>

#include "compare/input/case.h"
#include "compare/models/registry.h"
#include "problem/mechanics_model.h"

namespace ciliaval::compare::models {

/// The one door to a mechanics model: all that runs one, runs an Evaluator. It refuses what the
/// model does not take, and where the case sets an error limit, it refines the model until its
/// estimate is below it, or as far as it can be; a message on each step says which it was.
///
/// The case gives the options and, for a limit on the field's error, the sensors; the first of
/// `fields` that takes the body computes that field. The entries must outlive the Evaluator.
class Evaluator : public MechanicsModel {
 public:
  Evaluator(const MechanicsEntry& entry, const input::Case& problem,
            std::span<const FieldEntry> fields);

  /// Throws InputError `model: what` if the model does not take the load, what is around the
  /// cilium, or its own options with them; and what the model throws.
  MechanicsResult solve(const Cilium& cilium, const LoadPath& path,
                        const Progress& progress = {}) const override;
  /// Each refinement has a part of the checkpoint of its own.
  MechanicsResult solve_from(const Cilium& cilium, const LoadPath& path,
                             const Checkpoint& checkpoint,
                             const Progress& progress = {}) const override;

 private:
  const MechanicsEntry& entry_;
  input::Case problem_;
  std::span<const FieldEntry> fields_;
};

/// A converged step without a deformation that is finite all along the centreline has failed.
void fail_unless_finite(MechanicsStep& step);

}  // namespace ciliaval::compare::models

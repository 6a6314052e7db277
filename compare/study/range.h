// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>

#include "analytic/elastica/elastica.h"
#include "problem/mechanics_model.h"

namespace ciliaval::compare::study {

/// The largest magnitude of a contact (N) or a probe's displacement (m) that the model bears: where
/// it slips off. `step` is the model's step at some magnitude. Throws SolverError if the model
/// finds none.
double slip_off(const MechanicsModel& model, const Cilium& cilium, const MechanicsStep& step,
                const analytic::elastica::ElasticaOptions& elastica, const Progress& progress = {});

/// The magnitude of the load at which the tip's rotation from +z is `rotation` (rad, below 90°), to
/// 1e-6 of it, by bracketing and TOMS 748: each trial is a solution from the straight cilium.
/// Throws SolverError.
double magnitude_at_rotation(const MechanicsModel& model, const Cilium& cilium, const Load& load,
                             double rotation, const Progress& progress = {});

}  // namespace ciliaval::compare::study

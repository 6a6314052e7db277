// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "analytic/elastica/tip_contact.h"
#include "problem/joints/joints.h"
#include "problem/mechanics_model.h"

namespace ciliaval::analytic::elastica {

struct ElasticaOptions {
  enum class Form {
    arclength,  ///< dθ/dS = M/(EI), regular up to θ = 90°, all loads
    height      ///< the paper's quadrature in z (Eq. 1–4), contact, flow and probe only
  };
  Form form = Form::arclength;
  CiliumEnd tip = CiliumEnd::disc;  ///< what touches the surface of a sweep
  double tolerance = 1e-12;  ///< relative, of position over length and of angle, in (0, 1e-3]
  /// In the arc-length form, without an environment, of other loads than a sweep. Then the rod
  /// shears and extends as well, and its error is the corrections' uncertainty, too …
  joints::Correction joints = joints::Correction::none;
  bool error_estimate = true;  ///< … by a companion, which takes the same work again
  bool slip_off = true;        ///< whether a contact's largest force is looked for under each load
};

/// The paper's bending model (Eq. 1–4): inextensible, shear-rigid elastica under horizontal loads,
///
///     E I θ' = M,  w' = sin θ,  z' = cos θ,  M = F (h − z)₊, q (z_tip − z)²/2, …
///
/// docs/theory/elastica.md has the equations of all loads and the limits of both forms,
/// docs/evidence/elastica.md the errors. A contact step above the slip-off force, or a probe beyond
/// the displacement that goes with it, has the status slipped_off; one that misses the tolerance
/// has the status failed. Both leave the other steps alone. solve() throws InputError if the
/// cilium, a load or the tolerance is not valid, or if the height form is asked for a section load,
/// a dead load or a moment.
class Elastica : public MechanicsModel {
 public:
  explicit Elastica(ElasticaOptions options = {}) : options_(options) {}
  MechanicsResult solve(const Cilium& cilium, const LoadPath& path,
                        const Progress& progress = {}) const override;

 private:
  ElasticaOptions options_;
};

}  // namespace ciliaval::analytic::elastica

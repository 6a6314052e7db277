// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "problem/mechanics_model.h"

namespace ciliaval::analytic {

struct ElasticaOptions {
  enum class Form {
    arclength,  ///< dθ/dS = M/(EI), regular up to θ = 90°, all loads
    height      ///< the paper's quadrature in z (Eq. 1–4), contact and flow only
  };
  Form form = Form::arclength;
  double tolerance = 1e-12;  ///< relative, of position over length and of angle
};

/// The paper's bending model (Eq. 1–4): inextensible, shear-rigid elastica under horizontal loads.
class Elastica : public MechanicsModel {
 public:
  explicit Elastica(ElasticaOptions options = {}) : options_(options) {}
  MechanicsResult solve(const Cilium& cilium, const LoadPath& path,
                        const Progress& progress = {}) const override;

 private:
  ElasticaOptions options_;
};

}  // namespace ciliaval::analytic

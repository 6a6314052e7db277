// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/models/estimates.h"

#include "analytic/elastica/elastica.h"
#include "fem/beam/beam.h"

namespace ciliaval::compare::models {

void without_error_estimates(input::ModelOptions& options) {
  options.of<analytic::elastica::ElasticaOptions>().error_estimate = false;
  options.of<fem::beam::BeamOptions>().error_estimate = false;
}

}  // namespace ciliaval::compare::models

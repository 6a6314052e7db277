// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/elastica.h"

#include <fmt/format.h>

#include "compare/input/case.h"
#include "compare/models/entries/values.h"

namespace ciliaval::compare::models::entries {
namespace {

using analytic::elastica::CiliumEnd;
using analytic::elastica::Elastica;
using analytic::elastica::ElasticaOptions;

void check(const input::CaseCheck& check) {
  if (!check.is_asked_for || !check.load_is_right ||
      check.problem.options.of<ElasticaOptions>().form != ElasticaOptions::Form::height)
    return;
  const Load& load = check.problem.load_path.front();
  if (load.is<ContactLoad>() || load.is<FlowLoad>() || load.is<ProbeLoad>()) return;
  check.report("models.elastica.form",
               fmt::format("the elastica's form 'height' (Eq. 1-4) takes the load types 'contact', "
                           "'flow' and 'probe', not '{}': use the form 'arclength'",
                           type(load)));
}

}  // namespace

input::MechanicsEntry elastica() {
  return {
      .id = "elastica",
      .description = "the paper's inextensible, shear-rigid elastica (Eq. 1-4)",
      .make = input::make<Elastica, ElasticaOptions>,
      .options = {input::choice(&ElasticaOptions::form, "form",
                                {{"arclength", ElasticaOptions::Form::arclength},
                                 {"height", ElasticaOptions::Form::height}},
                                "`arclength`: dθ/dS = M/(EI), any load; `height`: the paper's "
                                "quadrature in z (Eq. 1-4), `contact`, `flow` and `probe` only."),
                  input::choice(&ElasticaOptions::tip, "tip",
                                {{"rim", CiliumEnd::disc}, {"point", CiliumEnd::point}},
                                "`sweep`: `rim`, the end is a disc with a rim and a mantle that "
                                "touch; `point`, the end of the centreline does."),
                  input::option(&ElasticaOptions::tolerance, "tolerance", tolerance_range,
                                "Relative, of position over length and of angle.")},
      .refinements = {tolerances({1e-4, 1e-6, 1e-8, 1e-10, 1e-12})},
      .check = check,
  };
}

}  // namespace ciliaval::compare::models::entries

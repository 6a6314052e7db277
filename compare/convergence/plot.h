// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

#include "compare/convergence/study.h"
#include "compare/plot/gnuplot.h"

namespace ciliaval::compare::convergence {

struct ConvergencePlot {
  std::string script;  ///< for gnuplot; empty if there is nothing to draw
  plot::Size size;
};

/// A log-log plot, a panel for each study: at the last load step that has any, |f − f₀|/|f| of the
/// tip's deflection and of |ΔB| of each pair at sensor 0 over the level's size h, and the line α
/// h^p of the observed order. f₀ is the extrapolated limit and f the finest level's value. What is
/// inconclusive has no limit and no line: grey crosses show the distances from the finest level.
ConvergencePlot convergence_plot(const input::Case& problem,
                                 const std::vector<RefinementStudy>& studies);

/// The panel of one study alone, without a title above it.
ConvergencePlot convergence_panel(const RefinementStudy& study);

}  // namespace ciliaval::compare::convergence

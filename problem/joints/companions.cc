// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/joints/companions.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iomanip>
#include <numeric>
#include <sstream>
#include <utility>

#include "problem/error_estimate.h"

namespace ciliaval::joints {

std::vector<double> strains(const Cilium& cilium, const Centreline& centreline) {
  std::vector<double> result(cilium.segments.size(), 0);
  const std::vector<double>& breaks = centreline.breaks();
  for (std::size_t piece = 0; piece < centreline.pieces().size(); ++piece) {
    double& largest = result[cilium.segment_at(std::midpoint(breaks[piece], breaks[piece + 1]))];
    for (std::size_t i = 0; i < centreline.pieces()[piece].S.size(); ++i)
      largest = std::max(largest, centreline.node(piece, i).bending_curvature() * cilium.radius());
  }
  return result;
}

void add_companion(MechanicsResult& result, const Cilium& cilium, Corrections corrections,
                   const Solve& solve) {
  LoadPath path;
  for (const MechanicsStep& step : result.steps) {
    const bool is_probe = step.load.is<ProbeLoad>();
    path.push_back(is_probe ? with_magnitude(step.load, (1 + probe_error) * magnitude(step.load))
                            : step.load);
  }
  corrections += uncertainties(cilium);
  result.companions.push_back(companion_of(result, [&] {
    return MechanicsResult{.undeformed = result.undeformed, .steps = solve(path, corrections)};
  }));
  result.error_parts.push_back({std::string(error_direction), result.companions.size(), 0, 1});
  for (std::size_t i = 0; i < result.steps.size(); ++i)
    result.steps[i].seconds += result.companions.back().steps[i].seconds;
}

void remark_on_strains(const Cilium& cilium, std::vector<MechanicsStep>& steps) {
  for (MechanicsStep& step : steps) {
    if (step.status != Status::converged) continue;
    const std::vector<double> strain = strains(cilium, step.deformation->centreline);
    const auto largest = std::ranges::max_element(strain);
    if (!(*largest > largest_strain)) continue;
    std::ostringstream text;
    text << "segment '" << cilium.segments[static_cast<std::size_t>(largest - strain.begin())].name
         << "' is bent to a strain of " << std::setprecision(3) << *largest
         << ", outside of the domain of joints = \"corrected\", which ends at " << largest_strain;
    step.message += (step.message.empty() ? "" : "; ") + text.str();
  }
}

}  // namespace ciliaval::joints

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/sources/adaptive_order.h"

#include <cstdio>
#include <map>
#include <string>

namespace ciliaval::analytic::sources {

const QuadratureRule& unit_gauss_legendre(std::size_t n) {
  thread_local std::map<std::size_t, QuadratureRule> rules;  // whose entries never move
  auto rule = rules.find(n);
  if (rule == rules.end()) rule = rules.emplace(n, gauss_legendre(n, 0, 1)).first;
  return rule->second;
}

void throw_tolerance_missed(const AdaptiveOrder& asked, double reached) {
  char text[128];
  std::snprintf(text, sizeof text, " to %.2g of |B|, but is uncertain by %.2g", asked.tolerance,
                reached);
  throw SolverError("the " + std::string(asked.integral) + " was asked at " + to_string(asked.x) +
                    text +
                    ": ask for a larger tolerance; a point beside the magnet's surface may also be "
                    "moved away from it");
}

}  // namespace ciliaval::analytic::sources

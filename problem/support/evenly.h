// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace ciliaval::support {

/// The indices of `shown` of `count` things, evenly chosen, the first and the last among them.
inline std::vector<std::size_t> evenly(std::size_t count, std::size_t shown) {
  std::vector<std::size_t> chosen;
  const std::size_t n = std::min(count, shown);
  for (std::size_t i = 0; i < n; ++i) chosen.push_back(n < 2 ? 0 : i * (count - 1) / (n - 1));
  return chosen;
}

}  // namespace ciliaval::support

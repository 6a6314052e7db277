// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>

namespace ciliaval::compare::models {

/// A pair of models by their ids, "elastica/volume".
struct ModelPair {
  std::string mechanics;
  std::string field;
  std::string name() const { return mechanics + "/" + field; }
};

}  // namespace ciliaval::compare::models

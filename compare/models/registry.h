// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "compare/input/case.h"
#include "problem/field_model.h"
#include "problem/mechanics_model.h"

namespace ciliaval::compare::models {

struct MechanicsEntry {
  std::string id;
  std::string description;  ///< one line for `ciliaval list`
  std::function<std::unique_ptr<MechanicsModel>(const input::ModelOptions&)> make;
};

struct FieldEntry {
  std::string id;
  std::string description;
  std::function<std::unique_ptr<FieldModel>(const input::ModelOptions&)> make;
};

/// Every model, the more detailed ones later: in a comparison the later one is the reference.
/// To add a model, write it and add its line in registry.cc.
const std::vector<MechanicsEntry>& mechanics_models();
const std::vector<FieldEntry>& field_models();

}  // namespace ciliaval::compare::models

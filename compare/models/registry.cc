// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/models/registry.h"

#include <utility>

// Every model, one line each, the more detailed ones later. CalculiX stands before the solid, which
// is the reference: it takes every load, and on a mesh of the same size its error is a tenth
// (docs/measurements/calculix.md).
#define CILIAVAL_MODELS(MECHANICS, FIELD) \
  MECHANICS(elastica)                     \
  MECHANICS(beam)                         \
  MECHANICS(calculix)                     \
  MECHANICS(solid)                        \
  FIELD(dipole)                           \
  FIELD(line)                             \
  FIELD(volume)                           \
  FIELD(mesh)                             \
  FIELD(potential)

namespace ciliaval::compare::models {

namespace entries {
#define CILIAVAL_DECLARE_MECHANICS(model) MechanicsEntry model();
#define CILIAVAL_DECLARE_FIELD(model) FieldEntry model();
CILIAVAL_MODELS(CILIAVAL_DECLARE_MECHANICS, CILIAVAL_DECLARE_FIELD)
}  // namespace entries

namespace {

input::Models& all() {
  static input::Models models = [] {
    input::Models list;
#define CILIAVAL_ADD_MECHANICS(model) list.mechanics.push_back(entries::model());
#define CILIAVAL_ADD_FIELD(model) list.fields.push_back(entries::model());
    CILIAVAL_MODELS(CILIAVAL_ADD_MECHANICS, CILIAVAL_ADD_FIELD)
    return list;
  }();
  return models;
}

}  // namespace

const input::Models& known() {
  return all();
}

void add_model(MechanicsEntry entry) {
  all().mechanics.push_back(std::move(entry));
}

void add_model(FieldEntry entry) {
  all().fields.push_back(std::move(entry));
}

}  // namespace ciliaval::compare::models

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

#include "compare/input/model_entry.h"
#include "problem/error.h"

namespace ciliaval::compare::models {

using input::FieldEntry;
using input::MechanicsEntry;

/// Every model, the more detailed ones later: in a comparison the later one is the reference. To
/// add a model, write its entry in compare/models/entries and its line in registry.cc.
const input::Models& known();
inline const std::vector<MechanicsEntry>& mechanics_models() {
  return known().mechanics;
}
inline const std::vector<FieldEntry>& field_models() {
  return known().fields;
}

/// Adds a model that a program brings along, before the program uses any other.
void add_model(MechanicsEntry entry);
void add_model(FieldEntry entry);

/// The entry of this id. Throws InputError if there is none.
template <class Entries>
const typename Entries::value_type& entry_of(const Entries& entries, const std::string& id) {
  for (const auto& entry : entries)
    if (entry.id == id) return entry;
  throw InputError("there is no model `" + id + "`; `ciliaval list` names them all");
}

/// Fault of a case for a mechanics model, beginning with its id: the load, the environment, or a
/// condition of the model's own check; empty: the model takes the case.
std::string fault_of(const MechanicsEntry& entry, const input::Case& problem);

/// The last of the quick ones, the most detailed that takes but a moment. Throws InputError if
/// there is none.
template <class Entries>
const typename Entries::value_type& quick_one(const Entries& entries) {
  const typename Entries::value_type* last = nullptr;
  for (const auto& entry : entries)
    if (entry.is_quick()) last = &entry;
  if (last == nullptr) throw InputError("there is no quick model of this kind");
  return *last;
}

}  // namespace ciliaval::compare::models

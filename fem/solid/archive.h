// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "fem/solid/contact/follower.h"
#include "fem/solid/equilibrium/load_path.h"
#include "problem/support/archive.h"

// Serialisation of the solid's state, as in problem/support/archive.h.
namespace boost::serialization {

template <class Archive>
void serialize(Archive& archive, ciliaval::fem::solid::discretisation::SolidState& state,
               unsigned int /*version*/) {
  auto& [displacement, pressure] = state;
  auto unknowns = displacement.size();
  std::size_t elements = pressure.size();
  archive& unknowns& elements;
  if (unknowns != displacement.size()) displacement.reinit(unknowns);
  pressure.resize(elements);
  archive& make_array(displacement.begin(), unknowns);
  for (auto& coefficients : pressure) archive& coefficients;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::fem::solid::equilibrium::Equilibrium& equilibrium,
               unsigned int /*v*/) {
  auto& [load, state, applied_force] = equilibrium;
  archive& load& state& applied_force;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::fem::solid::equilibrium::LoadPathState& state,
               unsigned int /*version*/) {
  auto& [current, previous, slipped] = state;
  archive& current& previous& slipped;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::fem::solid::contact::SweepPlace& place,
               unsigned int /*version*/) {
  auto& [interference, travel, hold] = place;
  archive& interference& travel& hold;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::fem::solid::contact::NodeMemory& memory,
               unsigned int /*version*/) {
  auto& [multiplier, friction, place, state, along] = memory;
  archive& multiplier& friction& place& state& along;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::fem::solid::contact::NodeForce& node,
               unsigned int /*version*/) {
  auto& [gap, normal, friction, trial, slides, force, derivative] = node;
  archive& gap& normal& friction& trial& slides& force& derivative;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::fem::solid::contact::ContactState& contact,
               unsigned int /*version*/) {
  auto& [place, solid, memory, forces, energy, force] = contact;
  archive& place& solid& memory& forces& energy& force;
}

template <class Archive>
void serialize(Archive& archive, ciliaval::fem::solid::contact::FollowerState& state,
               unsigned int /*version*/) {
  auto& [now, before, step] = state;
  archive& now& before& step;
}

}  // namespace boost::serialization

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/models/registry.h"

#include "fem/solid/solid.h"

namespace ciliaval::compare::models {

const std::vector<MechanicsEntry>& mechanics_models() {
  static const std::vector<MechanicsEntry> entries{
      {"elastica", "the paper's inextensible, shear-rigid elastica (Eq. 1-4)",
       [](const input::ModelOptions& o) {
         return std::make_unique<analytic::elastica::Elastica>(o.elastica);
       }},
      {"beam", "geometrically exact Simo-Reissner beam FEM: bending, shear, extension, torsion",
       [](const input::ModelOptions& o) { return std::make_unique<fem::beam::Beam>(o.beam); }},
      // Before the solid, which is the reference: it takes every load, and on a mesh of the same
      // size its error is a tenth (docs/measurements/calculix.md).
      {"calculix", "CalculiX's 3D solid, another program (needs `ccx`; loads section and dead)",
       [](const input::ModelOptions& o) {
         return std::make_unique<fem::calculix::Calculix>(o.calculix);
       }},
      {"solid", "3D finite-strain near-incompressible solid FEM",
       [](const input::ModelOptions& o) { return std::make_unique<fem::solid::Solid>(o.solid); }},
  };
  return entries;
}

const std::vector<FieldEntry>& field_models() {
  static const std::vector<FieldEntry> entries{
      {"dipole", "each magnetic segment as one dipole at its centroid",
       [](const input::ModelOptions& o) {
         return std::make_unique<analytic::rod::DipoleField>(o.dipole);
       }},
      {"line", "dipoles along the centreline (Eq. 5-7, the paper's single-dipole model)",
       [](const input::ModelOptions& o) {
         return std::make_unique<analytic::rod::LineField>(o.line);
       }},
      {"volume", "volume of the bent rod (Eq. 8-9, the paper's multi-dipole model)",
       [](const input::ModelOptions& o) {
         return std::make_unique<analytic::rod::VolumeField>(o.volume);
       }},
      {"mesh", "the solid's own deformed magnet (with `solid` only)",
       [](const input::ModelOptions& o) {
         return std::make_unique<analytic::body::MeshField>(o.mesh);
       }},
      {"potential", "scalar-potential FEM with recoil permeability and permeable plates",
       [](const input::ModelOptions& o) {
         return std::make_unique<fem::potential::Potential>(o.potential);
       }},
  };
  return entries;
}

}  // namespace ciliaval::compare::models

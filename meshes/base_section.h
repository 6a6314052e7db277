// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/fe/mapping.h>
#include <deal.II/grid/tria.h>

#include "meshes/section_properties.h"

namespace ciliaval::meshes {

/// Properties of the faces with base_id, integrated exactly for a mapping of degree 2.
SectionProperties base_section(const dealii::Triangulation<3>& triangulation,
                               const dealii::Mapping<3>& mapping);

}  // namespace ciliaval::meshes

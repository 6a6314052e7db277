// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include "meshes/mesh_nodes.h"
#include "problem/cilium.h"

namespace ciliaval::compare::output::vtk {

/// A mesh as it is computed on: triquadratic hexahedra and, for the boundary, biquadratic
/// quadrilaterals (threshold by `BoundaryIDs`). Cell data: `MaterialIDs`, the index of the segment,
/// −1 on the boundary; `BoundaryIDs`, −1 in the volume. Field data `materials` and `boundaries`:
/// the names by id. In metres.
vtkSmartPointer<vtkUnstructuredGrid> mesh_grid(const meshes::MeshNodes& mesh, const Cilium& cilium);

}  // namespace ciliaval::compare::output::vtk

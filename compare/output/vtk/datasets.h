// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <vtkImageData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <cstddef>

#include "analytic/sources/push_forward.h"
#include "compare/models/run.h"
#include "compare/output/field_grid.h"
#include "meshes/mesh_nodes.h"

/// Results as VTK data sets, SI units, all floating-point arrays Float64. Every data set carries
/// the units of its arrays in the field data `units` ("displacement: m").
namespace ciliaval::compare::output::vtk {

/// The body on its undeformed mesh: triquadratic hexahedra on 27 points each of its own, so that
/// fields may jump between cells. Point data `displacement` x − X (Warp By Vector), `J`,
/// `cauchy_stress` (xx, yy, zz, xy, yz, xz), `magnetization` m = F·M/J; cell data `MaterialIDs`,
/// the index of the segment. J and σ are left out if the body has none.
vtkSmartPointer<vtkUnstructuredGrid> solid_grid(const SolidBody& body);

/// The deformed centreline as one polyline through output_points(). Point data: `S`, `radius`
/// (Tube filter), `displacement`, the section's directors `d1`, `d2`, `d3`, `theta`, `kappa` (of
/// bending), `curvature` κ, `section_force`, `section_moment`, `segment`.
vtkSmartPointer<vtkPolyData> rod_polyline(const Cilium& cilium, const Centreline& centreline);

/// The line model's dipoles: each magnetic segment in 64 slices of equal arc length, each a vertex
/// at its middle with `moment` A·M·Δr (push-forward F) or A·M·d₃ ΔS (R), A·m².
vtkSmartPointer<vtkPolyData> dipoles(const Cilium& cilium, const Centreline& centreline,
                                     analytic::sources::PushForward push_forward);

/// The sensors as vertices with `B` and `dB` of every pair of models at a step, named
/// `B_elastica_line`, and a mask `valid_B_elastica_line` that is 0 where there is no value; of rods
/// `band_dB_elastica_line` too, the ± of ΔB (results::field_bands()).
vtkSmartPointer<vtkPolyData> sensors(const models::CaseResult& result, std::size_t step);

/// The surface of a sweep around the cilium as quadrilaterals, three diameters wide, where it
/// stands at the load. Point data `height`, of the profile with its tilt.
vtkSmartPointer<vtkPolyData> surface_mesh(const Load& load, const Cilium& cilium);

/// The contact of a sweep as a vertex at its point, with `force` (on the cilium), `normal_force`
/// and `friction_force`.
vtkSmartPointer<vtkPolyData> contact_point(const Load& load, const SurfaceContact& contact);

/// A scalar potential on its octree: triquadratic hexahedra on 27 points each of its own, so that
/// the fields may jump between leaves. Point data `psi`, `H` = −∇ψ and `B` = μ₀(μ_r H + m) with the
/// means of μ_r and m = B_r/μ₀ over the leaf; these two as cell data.
vtkSmartPointer<vtkUnstructuredGrid> octree_grid(const FieldMesh& mesh);

/// A mesh as it is computed on: triquadratic hexahedra and, for the boundary, biquadratic
/// quadrilaterals (threshold by `BoundaryIDs`). Cell data: `MaterialIDs`, the index of the segment,
/// −1 on the boundary; `BoundaryIDs`, −1 in the volume. Field data `materials` and `boundaries`:
/// the names by id. In metres.
vtkSmartPointer<vtkUnstructuredGrid> mesh_grid(const meshes::MeshNodes& mesh, const Cilium& cilium);

/// B on a grid, with the mask `valid`.
vtkSmartPointer<vtkImageData> field_image(const FieldGrid& grid, const FieldGrid::Step& step);

}  // namespace ciliaval::compare::output::vtk

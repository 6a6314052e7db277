// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/fe/mapping_q_cache.h>
#include <deal.II/grid/tria.h>

#include <memory>
#include <vector>

#include "meshes/boundary_ids.h"
#include "meshes/cylinder/cylinder_mesh_options.h"
#include "problem/cilium.h"

namespace ciliaval::meshes::cylinder {

/// Arc lengths 0 = Z₀ < Z₁ < … = L of the planes between the layers, m. All segment interfaces and
/// all planes asked for are among them (one within 1e-9 L of an earlier one counts as that one);
/// between them the thickness follows min(coarsest, finest + growth·distance to the clamped end,
/// the next interface or a fine tip). Throws InputError if the options are out of range or a plane
/// lies outside [0, L].
std::vector<double> layer_planes(const Cilium& cilium, const CylinderMeshOptions& options);

/// The straight cylinder of the cilium: an o-grid (inner square and rings), the rings of a tube or
/// the grid of a rectangle, whose sides must lie along X and Y, extruded through layer_planes().
/// Material ids are the segments' indices, boundary ids as above. The mesh lines along the third
/// local coordinate ζ run from base to tip and are straight: X and Y are constant on them. The
/// mantle is a cylinder, all other edges are straight. The triangulation must be empty and must
/// stay at its place in memory, for its manifolds point to it. Throws InputError if the cilium or
/// the options are not valid.
void make_cylinder(const Cilium& cilium, const CylinderMeshOptions& options,
                   dealii::Triangulation<3>& triangulation);

/// Number of the nodes of quadratic cells on it, without making it. Throws as make_cylinder().
std::size_t quadratic_nodes(const Cilium& cilium, const CylinderMeshOptions& options);

/// The same in parts, one for each rank (make_in_parts()), or whole if there is one rank alone.
/// Collective.
std::unique_ptr<dealii::Triangulation<3>> make_cylinder(const Cilium& cilium,
                                                        const CylinderMeshOptions& options,
                                                        MPI_Comm communicator);

/// Polynomial mapping of the curved cells, its support points computed once. Use the degree of the
/// displacement's element (isoparametric): with a higher one, the element cannot represent linear
/// fields, hence no rigid rotation. With
/// degree 2 and `equal_area` the section's area is exact and its second moment right to 1e-5 or
/// better.
std::unique_ptr<dealii::MappingQCache<3>> cylinder_mapping(
    const dealii::Triangulation<3>& triangulation, unsigned int degree = 2);

}  // namespace ciliaval::meshes::cylinder

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <iosfwd>
#include <vector>

#include "meshes/mesh_nodes.h"
#include "problem/cilium.h"
#include "problem/load.h"
#include "problem/types.h"

namespace ciliaval::fem::calculix {

/// The nodes of CalculiX's C3D20R among the 27 of a cell, in CalculiX's order.
extern const std::array<int, 20> calculix_nodes;

/// Shape functions of the 20-node hexahedron (serendipity) at a point of [−1, 1]³: columns N,
/// ∂N/∂ξ, ∂N/∂η, ∂N/∂ζ; rows in CalculiX's order.
Eigen::Matrix<double, 20, 4> serendipity_functions(const Vector3& at);

/// Consistent nodal forces of a dead load on the 20-node hexahedra, N, one for each node of the
/// mesh (zero where an element has no node): ∫ N_a q/A e dV for `dead`, ∫ N_a F/A e dA over the
/// plane Z = S for `section`. On a half of the cylinder, the half's share. Throws InputError for
/// any other load, or if the mesh has no plane Z = S.
std::vector<Vector3> calculix_forces(const meshes::MeshNodes& mesh, const Cilium& cilium,
                                     const Load& load);

/// Writes the part of CalculiX's input that is there before the loads: C3D20R elements (the nodes
/// ALL, the elements SEGMENT0, SEGMENT1, ...; numbers are those of the mesh, from 1), the neo-Hooke
/// solid U = C₁₀(Ī₁ − 3) + (J − 1)²/D₁ with C₁₀ = μ/2, D₁ = 2/K, the base clamped, no displacement
/// across a plane of symmetry.
void write_calculix_model(std::ostream& out, const meshes::MeshNodes& mesh, const Cilium& cilium);

/// Writes the input of a static, geometrically nonlinear run of CalculiX: write_calculix_model()
/// under the load. Its .dat file then holds the displacements of all nodes. Azimuth 0 is needed on
/// a half. CalculiX cuts back `first_increment` of the load or lets it grow. Throws InputError as
/// calculix_forces() does.
void write_calculix(std::ostream& out, const meshes::MeshNodes& mesh, const Cilium& cilium,
                    const Load& load, double first_increment = 1);

/// True for each node of the mesh that 20-node elements have: not the middles of faces and cells.
std::vector<bool> calculix_node_set(const meshes::MeshNodes& mesh);

/// The displacements of the last increment in a .dat file, one for each node of the mesh (zero
/// where an element has no node). Throws FileError if the file ends before time 1, or in the middle
/// of a line, or lacks a node of the elements: CalculiX stopped, or the disk is full.
std::vector<Vector3> read_calculix(std::istream& in, const meshes::MeshNodes& mesh);

}  // namespace ciliaval::fem::calculix

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "fem/solid/discretisation/space.h"
#include "fem/solid/discretisation/vector.h"
#include "fem/solid/solvers/block_csr.h"

namespace ciliaval::fem::solid::solvers {

inline constexpr std::size_t corners = 8;

/// Lexicographic node of a corner of the element.
std::size_t corner_node(std::size_t corner);

/// Trilinear shape function of a corner at a node of the element.
double trilinear(std::size_t corner, std::size_t node);

/// The additive Schwarz method on vertex patches. The patch of a vertex holds the nodes inside the
/// cells around it (27 for an inner vertex of Q2); there the matrix is inverted exactly. A patch
/// can hold displacements that keep the volume, so that the method does not slow down with K/μ
/// (Schöberl, Numer. Math. 84, 1999). Vertices joined by edges that are much shorter than the cell
/// is long share one patch, up to ten: along its short directions a thin cell couples its nodes
/// so strongly that patches of single vertices cannot move them along the others. Every cell meets
/// eight patches: the preconditioned matrix, if it is positive definite, has no eigenvalue
/// beyond 8.
class VertexPatchSchwarz {
 public:
  static constexpr double largest_eigenvalue = 8;

  /// The patches of the vertices that this rank owns, of whose cells it has all.
  VertexPatchSchwarz(const discretisation::SolidSpace& space, const CellNodes& cells,
                     const BlockCsr& matrix, Node own_nodes);
  /// Inverts the symmetric part of the matrix on the patches.
  void update(const BlockCsr& matrix);
  /// z = Σ Rᵀ A⁻¹ R r over the patches of all ranks. Collective.
  void vmult(discretisation::Vector& z, const discretisation::Vector& r) const;

 private:
  using Index = std::uint32_t;
  std::vector<std::size_t> starts_;         ///< of the patches' entries in dofs_
  std::vector<Index> dofs_;                 ///< of all patches, one after the other
  std::vector<std::size_t> matrix_starts_;  ///< of the patches' matrices in inverses_
  std::vector<float> inverses_;             ///< lower triangles, column by column
  std::vector<Index> user_starts_;          ///< for each unknown: its entries in users_
  std::vector<Index> users_;                ///< positions in dofs_
  mutable std::vector<float> corrections_;  ///< of all patches
};

}  // namespace ciliaval::fem::solid::solvers

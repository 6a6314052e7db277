// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/types.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/sparse_matrix.h>

#include <span>

namespace ciliaval::fem::solid::discretisation {

using Dofs = std::span<const dealii::types::global_dof_index>;

/// A tangent on its way: takes the shares of elements and nodes, wherever it is kept.
class TangentMatrix {
 public:
  TangentMatrix() = default;
  TangentMatrix(const TangentMatrix&) = delete;
  TangentMatrix& operator=(const TangentMatrix&) = delete;
  virtual ~TangentMatrix() = default;

  /// Adds local(i, j) in the row rows[i] and the column columns[j], where both are free.
  virtual void add(const dealii::FullMatrix<double>& local, Dofs rows, Dofs columns) = 0;
  void add(const dealii::FullMatrix<double>& local, Dofs dofs) { add(local, dofs, dofs); }
};

/// Tangent in one sparse matrix, with something positive on the diagonal of constrained rows.
class AssembledTangent : public TangentMatrix {
 public:
  /// Both must outlive it.
  AssembledTangent(const dealii::AffineConstraints<double>& constraints,
                   dealii::SparseMatrix<double>& matrix)
      : constraints_(constraints), matrix_(matrix) {}
  using TangentMatrix::add;
  void add(const dealii::FullMatrix<double>& local, Dofs rows, Dofs columns) override;

 private:
  const dealii::AffineConstraints<double>& constraints_;
  dealii::SparseMatrix<double>& matrix_;
};

}  // namespace ciliaval::fem::solid::discretisation

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/potential/space.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>

#include <array>

namespace ciliaval::fem::potential {
namespace {

LagrangeBasis gauss_lobatto(unsigned int degree) {
  std::vector<double> nodes;
  const dealii::QGaussLobatto<1> rule(degree + 1);
  for (const dealii::Point<1>& p : rule.get_points()) nodes.push_back(p[0]);
  return LagrangeBasis(nodes);
}

}  // namespace

Eigen::VectorXd shape_values(const LagrangeBasis& basis, const Vector3& unit) {
  const LagrangeValues a(basis, unit[0]);
  const LagrangeValues b(basis, unit[1]);
  const LagrangeValues c(basis, unit[2]);
  const std::size_t n = basis.size();
  Eigen::VectorXd result(static_cast<Eigen::Index>(n * n * n));
  Eigen::Index node = 0;
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i, ++node)
        result[node] = a.value[i] * b.value[j] * c.value[k];
  return result;
}

Eigen::Matrix<double, Eigen::Dynamic, 3> shape_gradients(const LagrangeBasis& basis,
                                                         const Vector3& unit) {
  const LagrangeValues a(basis, unit[0]);
  const LagrangeValues b(basis, unit[1]);
  const LagrangeValues c(basis, unit[2]);
  const std::size_t n = basis.size();
  Eigen::Matrix<double, Eigen::Dynamic, 3> result(static_cast<Eigen::Index>(n * n * n), 3);
  Eigen::Index node = 0;
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i, ++node)
        result.row(node) << a.derivative[i] * b.value[j] * c.value[k],
            a.value[i] * b.derivative[j] * c.value[k], a.value[i] * b.value[j] * c.derivative[k];
  return result;
}

Eigen::MatrixXd interpolation(const LagrangeBasis& from, const LagrangeBasis& to) {
  const std::size_t n = to.size();
  const auto count = [](const LagrangeBasis& b) {
    return static_cast<Eigen::Index>(b.size() * b.size() * b.size());
  };
  Eigen::MatrixXd result(count(to), count(from));
  Eigen::Index row = 0;
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i, ++row)
        result.row(row) =
            shape_values(from, {to.nodes()[i], to.nodes()[j], to.nodes()[k]}).transpose();
  return result;
}

Eigen::MatrixXd unit_stiffness(const LagrangeBasis& basis) {
  const std::size_t n = basis.size();
  const QuadratureRule rule = gauss_legendre(n, 0, 1);
  const auto size = static_cast<Eigen::Index>(n * n * n);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b)
      for (std::size_t c = 0; c < n; ++c) {
        const auto gradients =
            shape_gradients(basis, {rule.nodes[a], rule.nodes[b], rule.nodes[c]});
        result +=
            rule.weights[a] * rule.weights[b] * rule.weights[c] * gradients * gradients.transpose();
      }
  return result;
}

PotentialSpace::PotentialSpace(const Octree& octree, unsigned int degree)
    : octree_(octree),
      degree_(degree),
      nodes_(static_cast<Eigen::Index>((degree + 1) * (degree + 1) * (degree + 1))),
      basis_(gauss_lobatto(degree)),
      dofs_(octree.triangulation()) {
  const dealii::FE_Q<3> element(degree);
  dofs_.distribute_dofs(element);
  dealii::IndexSet relevant;
  dealii::DoFTools::extract_locally_relevant_dofs(dofs_, relevant);
  hanging_.reinit(relevant);
  dealii::DoFTools::make_hanging_node_constraints(dofs_, hanging_);
  constraints_.copy_from(hanging_);
  hanging_.close();
  dealii::DoFTools::make_zero_boundary_constraints(dofs_, constraints_);
  constraints_.close();
  partitioner_ = std::make_shared<const dealii::Utilities::MPI::Partitioner>(
      dofs_.locally_owned_dofs(), relevant, octree.communicator());

  const std::vector<unsigned int> hierarchic = element.get_poly_space_numbering_inverse();
  std::vector<dealii::types::global_dof_index> indices(static_cast<std::size_t>(nodes_));
  entries_start_.push_back(0);
  for (const Octree::CellIterator& cell : octree.cells()) {
    const typename dealii::DoFHandler<3>::active_cell_iterator with_dofs(
        &cell->get_triangulation(), cell->level(), cell->index(), &dofs_);
    with_dofs->get_dof_indices(indices);
    bool constrained = false;
    for (const unsigned int h : hierarchic) {
      local_.push_back(partitioner_->global_to_local(indices[h]));
      constrained = constrained || constraints_.is_constrained(indices[h]);
    }
    if (constrained) {
      for (unsigned int row = 0; row < hierarchic.size(); ++row) {
        const auto index = indices[hierarchic[row]];
        if (!constraints_.is_constrained(index)) {
          entries_.push_back({partitioner_->global_to_local(index), row, 1});
          continue;
        }
        for (const auto& [master, weight] : *constraints_.get_constraint_entries(index))
          entries_.push_back({partitioner_->global_to_local(master), row, weight});
      }
    }
    entries_start_.push_back(entries_.size());
  }
  assign_nodes();
}

void PotentialSpace::assign_nodes() {
  std::vector<bool> assigned(partitioner_->locally_owned_size(), false);
  assigned_start_.push_back(0);
  for (std::size_t c = 0; c < octree_.cells().size(); ++c) {
    unsigned int row = 0;
    for (const unsigned int node : own_nodes(static_cast<int>(c))) {
      if (node < assigned.size() && !assigned[node] &&
          !constraints_.is_constrained(partitioner_->local_to_global(node))) {
        assigned_.push_back({row, node});
        assigned[node] = true;
      }
      ++row;
    }
    assigned_start_.push_back(assigned_.size());
  }
}

PotentialVector PotentialSpace::vector() const {
  return PotentialVector(partitioner_);
}

void PotentialSpace::read(int cell, const PotentialVector& complete,
                          Eigen::Ref<Eigen::VectorXd> u) const {
  Eigen::Index row = 0;
  for (const unsigned int node : own_nodes(cell)) u[row++] = complete.local_element(node);
}

void PotentialSpace::read_free(int cell, const PotentialVector& free,
                               Eigen::Ref<Eigen::VectorXd> u) const {
  const auto c = static_cast<std::size_t>(cell);
  if (entries_start_[c] == entries_start_[c + 1]) {
    read(cell, free, u);
    return;
  }
  u.setZero();
  for (std::size_t e = entries_start_[c]; e < entries_start_[c + 1]; ++e)
    u[entries_[e].row] += entries_[e].weight * free.local_element(entries_[e].node);
}

void PotentialSpace::add_free(int cell, const Eigen::Ref<const Eigen::VectorXd>& r,
                              PotentialVector& free) const {
  const auto c = static_cast<std::size_t>(cell);
  if (entries_start_[c] == entries_start_[c + 1]) {
    Eigen::Index row = 0;
    for (const unsigned int node : own_nodes(cell)) free.local_element(node) += r[row++];
    return;
  }
  for (std::size_t e = entries_start_[c]; e < entries_start_[c + 1]; ++e)
    free.local_element(entries_[e].node) += entries_[e].weight * r[entries_[e].row];
}

void PotentialSpace::add_diagonal(int cell, const Eigen::Ref<const Eigen::VectorXd>& d,
                                  PotentialVector& free) const {
  const auto c = static_cast<std::size_t>(cell);
  if (entries_start_[c] == entries_start_[c + 1]) {
    add_free(cell, d, free);
    return;
  }
  for (std::size_t e = entries_start_[c]; e < entries_start_[c + 1]; ++e)
    free.local_element(entries_[e].node) +=
        entries_[e].weight * entries_[e].weight * d[entries_[e].row];
}

void PotentialSpace::write(int cell, const Eigen::Ref<const Eigen::VectorXd>& u,
                           PotentialVector& complete) const {
  Eigen::Index row = 0;
  for (const unsigned int node : own_nodes(cell)) {
    if (node < partitioner_->locally_owned_size()) complete.local_element(node) = u[row];
    ++row;
  }
}

PotentialVector PotentialSpace::boundary_values(
    const std::function<double(const Vector3&)>& psi) const {
  PotentialVector result = vector();
  const std::vector<double>& x = basis_.nodes();
  const std::size_t n = x.size();
  for (std::size_t c = 0; c < octree_.cells().size(); ++c) {
    if (!octree_.cells()[c]->at_boundary()) continue;
    const Cube& cube = octree_.cubes()[c];
    const std::span<const unsigned int> nodes = own_nodes(static_cast<int>(c));
    for (unsigned int face = 0; face < 6; ++face) {
      if (!octree_.cells()[c]->face(face)->at_boundary()) continue;
      const std::size_t fixed = face % 2 == 0 ? 0 : n - 1;
      for (std::size_t a = 0; a < n; ++a) {
        for (std::size_t b = 0; b < n; ++b) {
          std::array<std::size_t, 3> i{a, b, fixed};
          if (face / 2 == 0) i = {fixed, a, b};
          if (face / 2 == 1) i = {a, fixed, b};
          const unsigned int local = nodes[i[0] + n * (i[1] + n * i[2])];
          if (local < partitioner_->locally_owned_size())
            result.local_element(local) =
                psi(cube.lower + cube.size * Vector3(x[i[0]], x[i[1]], x[i[2]]));
        }
      }
    }
  }
  complete(result);
  return result;
}

void PotentialSpace::complete(PotentialVector& v) const {
  v.zero_out_ghost_values();
  hanging_.distribute(v);
  v.update_ghost_values();
}

}  // namespace ciliaval::fem::potential

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tools/end_problem/excess.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_dgp.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>
#include <deal.II/lac/vector.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "problem/error.h"
#include "problem/joints/shear_coefficient.h"

namespace ciliaval::tools::end_problem {
namespace {

using std::numbers::pi;
constexpr double R = 0.5;
constexpr double area = pi * R * R;
constexpr double second_moment = pi * R * R * R * R / 4;

double shear_modulus(const Bar& bar) {
  return bar.young_modulus / (2 * (1 + bar.poisson_ratio));
}

void require_valid(const std::vector<Bar>& bars) {
  bool valid = !bars.empty();
  for (const Bar& bar : bars)
    valid = valid && bar.length > 0 && bar.young_modulus > 0 && bar.poisson_ratio > -1 &&
            bar.poisson_ratio < 0.5;
  if (!valid) throw InputError("end problem: lengths and moduli must be positive, -1 < nu < 0.5");
}

/// Sizes of cells over a length that is refined towards its lower and upper end.
std::vector<double> graded(double length, bool towards_lower, bool towards_upper,
                           const Resolution& resolution) {
  const int edges = static_cast<int>(towards_lower) + static_cast<int>(towards_upper);
  const double zone = std::min(length / std::max(edges, 1), R);
  std::vector<double> towards;  // from the edge inwards
  double end = zone * std::pow(resolution.ratio, resolution.layers);
  towards.push_back(end);
  for (unsigned int i = 0; i < resolution.layers; ++i) {
    const double next = end / resolution.ratio;
    towards.push_back(next - end);
    end = next;
  }
  std::vector<double> sizes;
  if (towards_lower) sizes = towards;
  const double rest = length - edges * zone;
  const auto n = static_cast<std::size_t>(std::ceil(rest / R - 1e-9));
  sizes.insert(sizes.end(), n, rest / static_cast<double>(n));
  if (towards_upper) sizes.insert(sizes.end(), towards.rbegin(), towards.rend());
  return sizes;
}

/// Saint-Venant's traction on a face with the normal +z: the amplitudes of its three components,
/// radial and axial ones times cos mφ, the circumferential one times sin mφ.
using Traction = std::array<double, 3>;

/// Resultants N (m = 0), or M and Q (m = 1), of the stress σ_zz = N/A, −M x/I, and for Q Timoshenko
/// and Goodier, Theory of Elasticity, §121.
struct Resultants {
  double N = 0;
  double M = 0;
  double Q = 0;
};

Traction traction(const Resultants& f, const Bar& bar, double r) {
  const double nu = bar.poisson_ratio;
  const double shear = f.Q * (3 + 2 * nu) / (8 * (1 + nu) * second_moment);
  const double beta = (1 - 2 * nu) / (3 + 2 * nu);
  return {shear * (R * R - r * r), -shear * (R * R - beta * r * r),
          f.N / area - f.M * r / second_moment};
}

/// The mixed problem of one Fourier term m.
class Meridional {
 public:
  Meridional(const std::vector<Bar>& bars, Base base, unsigned int m, const Resolution& resolution)
      : bars_(bars),
        base_(base),
        m_(m),
        element_(dealii::FE_Q<2>(resolution.degree), 3, dealii::FE_DGP<2>(resolution.degree - 1),
                 1),
        dofs_(mesh_) {
    std::vector<std::vector<double>> sizes{graded(R, false, true, resolution), {}};
    for (std::size_t i = 0; i < bars.size(); ++i) {
      const bool below = i > 0 || base == Base::clamped;
      const auto more = graded(bars[i].length, below, i + 1 < bars.size(), resolution);
      sizes[1].insert(sizes[1].end(), more.begin(), more.end());
      length_ += bars[i].length;
    }
    dealii::GridGenerator::subdivided_hyper_rectangle(mesh_, sizes, dealii::Point<2>(),
                                                      dealii::Point<2>(R, length_), false);
    dofs_.distribute_dofs(element_);
    constrain();
    assemble();
  }

  /// ∫ t·δu over the ends, for the resultants of the top and of the base.
  dealii::Vector<double> load(const Resultants& top, const Resultants& base) const {
    dealii::Vector<double> result(dofs_.n_dofs());
    dealii::FEFaceValues<2> values(
        element_, dealii::QGauss<1>(element_.degree + 1),
        dealii::update_values | dealii::update_quadrature_points | dealii::update_JxW_values);
    dealii::Vector<double> local(element_.n_dofs_per_cell());
    std::vector<dealii::types::global_dof_index> indices(element_.n_dofs_per_cell());
    for (const auto& cell : dofs_.active_cell_iterators())
      for (const unsigned int face : {2U, 3U}) {
        if (!cell->at_boundary(face) || (face == 2 && base_ == Base::clamped)) continue;
        values.reinit(cell, face);
        local = 0;
        for (unsigned int q = 0; q < values.n_quadrature_points; ++q) {
          const double r = values.quadrature_point(q)[0];
          Traction t =
              face == 3 ? traction(top, bars_.back(), r) : traction(base, bars_.front(), r);
          if (face == 2)
            for (double& component : t) component = -component;
          for (unsigned int i = 0; i < local.size(); ++i) {
            const unsigned int c = element_.system_to_component_index(i).first;
            if (c < 3) local[i] += values.shape_value(i, q) * t[c] * angle() * r * values.JxW(q);
          }
        }
        cell->get_dof_indices(indices);
        constraints_.distribute_local_to_global(local, indices, result);
      }
    return result;
  }

  dealii::Vector<double> solve(const dealii::Vector<double>& load) const {
    dealii::Vector<double> solution(load);
    inverse_.solve(solution);
    return solution;
  }

 private:
  double angle() const { return m_ == 0 ? 2 * pi : pi; }  ///< ∫ cos² mφ dφ

  /// The axis is regular; a clamped base is held, else the rigid motions are.
  void constrain() {
    std::vector<dealii::types::global_dof_index> indices(element_.n_dofs_per_cell());
    const auto& support = element_.base_element(0).get_unit_support_points();
    constraints_.clear();
    for (const auto& cell : dofs_.active_cell_iterators()) {
      cell->get_dof_indices(indices);
      const auto low = cell->vertex(0);
      const auto size = cell->vertex(3) - low;
      std::vector<std::array<dealii::types::global_dof_index, 3>> nodes(support.size());
      for (unsigned int i = 0; i < indices.size(); ++i) {
        const unsigned int c = element_.system_to_component_index(i).first;
        if (c < 3) nodes[element_.system_to_component_index(i).second][c] = indices[i];
      }
      for (std::size_t n = 0; n < nodes.size(); ++n) {
        const double r = low[0] + support[n][0] * size[0];
        const double z = low[1] + support[n][1] * size[1];
        const bool axis = r < 1e-14;
        const auto& [U, V, W] = nodes[n];
        const bool held = base_ == Base::clamped && z < 1e-14;
        const bool pinned = base_ == Base::free && axis &&
                            (z < 1e-14 || (m_ == 1 && std::abs(z - length_) < 1e-12));
        if (held || (axis && m_ == 0) || (pinned && m_ == 1)) constraints_.add_line(U);
        if (held || m_ == 0)
          constraints_.add_line(V);
        else if (axis && !constraints_.is_constrained(V)) {
          constraints_.add_line(V);
          constraints_.add_entry(V, U, -1);
        }
        if (held || (axis && m_ == 1) || (pinned && m_ == 0)) constraints_.add_line(W);
      }
    }
    constraints_.close();
  }

  const Bar& bar_at(double z) const {
    std::size_t i = 0;
    for (double end = bars_[0].length; z > end && i + 1 < bars_.size(); end += bars_[i].length) ++i;
    return bars_[i];
  }

  void assemble() {
    const dealii::QGauss<2> rule(element_.degree + 1);
    dealii::FEValues<2> values(element_, rule,
                               dealii::update_values | dealii::update_gradients |
                                   dealii::update_quadrature_points | dealii::update_JxW_values);
    const unsigned int n = element_.n_dofs_per_cell();
    dealii::DynamicSparsityPattern dynamic(dofs_.n_dofs());
    dealii::DoFTools::make_sparsity_pattern(dofs_, dynamic, constraints_, false);
    pattern_.copy_from(dynamic);
    dealii::SparseMatrix<double> matrix(pattern_);
    dealii::FullMatrix<double> local(n, n);
    std::vector<dealii::types::global_dof_index> indices(n);
    // Deviatoric strains rr, φφ, zz and √½ of the shears rz, rφ, φz; the volume strain; p.
    std::vector<std::array<double, 8>> modes(n);
    for (const auto& cell : dofs_.active_cell_iterators()) {
      values.reinit(cell);
      local = 0;
      const Bar& bar = bar_at(cell->center()[1]);
      const double two_mu = 2 * shear_modulus(bar);
      const double per_bulk = 3 * (1 - 2 * bar.poisson_ratio) / bar.young_modulus;
      for (unsigned int q = 0; q < rule.size(); ++q) {
        const double r = values.quadrature_point(q)[0];
        for (unsigned int i = 0; i < n; ++i) modes[i] = strains(values, i, q, r);
        const double w = angle() * r * values.JxW(q);
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int j = 0; j < n; ++j) {
            double shape = 0;
            for (std::size_t k = 0; k < 6; ++k) shape += modes[i][k] * modes[j][k];
            local(i, j) += w * (two_mu * shape + modes[i][6] * modes[j][7] +
                                modes[i][7] * modes[j][6] - per_bulk * modes[i][7] * modes[j][7]);
          }
      }
      cell->get_dof_indices(indices);
      constraints_.distribute_local_to_global(local, indices, matrix);
    }
    inverse_.initialize(matrix);
  }

  std::array<double, 8> strains(const dealii::FEValues<2>& values, unsigned int i, unsigned int q,
                                double r) const {
    const unsigned int c = element_.system_to_component_index(i).first;
    const double N = values.shape_value(i, q);
    if (c == 3) return {0, 0, 0, 0, 0, 0, 0, N};
    const auto gradient = values.shape_grad(i, q);
    std::array<double, 8> e{};
    const double m = m_;
    const double half = std::numbers::sqrt2 / 2;
    if (c == 0) e = {gradient[0], N / r, 0, half * gradient[1], -half * m * N / r, 0, 0, 0};
    if (c == 1) e = {0, m * N / r, 0, 0, half * (gradient[0] - N / r), half * gradient[1], 0, 0};
    if (c == 2) e = {0, 0, gradient[1], half * gradient[0], 0, -half * m * N / r, 0, 0};
    e[6] = e[0] + e[1] + e[2];
    for (std::size_t k = 0; k < 3; ++k) e[k] -= e[6] / 3;
    return e;
  }

  const std::vector<Bar>& bars_;
  Base base_;
  unsigned int m_;
  double length_ = 0;
  dealii::Triangulation<2> mesh_;
  dealii::FESystem<2> element_;
  dealii::DoFHandler<2> dofs_;
  dealii::AffineConstraints<double> constraints_;
  dealii::SparsityPattern pattern_;
  dealii::SparseDirectUMFPACK inverse_;
};

}  // namespace

Excess excess(const std::vector<Bar>& bars, Base base, double z, const Resolution& resolution) {
  require_valid(bars);
  double top = 0;
  for (const Bar& bar : bars) top += bar.length;
  const Meridional bending(bars, base, 1, resolution);
  const auto by_M = bending.load({0, 1, 0}, {0, 1, 0});
  const auto by_Q = bending.load({0, z - top, 1}, {0, z, 1});
  const auto of_M = bending.solve(by_M);
  const auto of_Q = bending.solve(by_Q);
  const Meridional extension(bars, base, 0, resolution);
  const auto by_N = extension.load({1, 0, 0}, {1, 0, 0});

  Excess result{by_M * of_M, by_M * of_Q, by_Q * of_Q, by_N * extension.solve(by_N)};
  double begin = 0;
  for (const Bar& bar : bars) {
    const double EI = bar.young_modulus * second_moment;
    const double EA = bar.young_modulus * area;
    const double kGA =
        joints::energy_shear_coefficient(bar.poisson_ratio) * shear_modulus(bar) * area;
    const double from = z - begin;  // arms of Q
    const double to = from - bar.length;
    result.rotation -= bar.length / EI;
    result.coupling -= (from * from - to * to) / (2 * EI);
    result.displacement -= (from * from * from - to * to * to) / (3 * EI) + bar.length / kGA;
    result.extension -= bar.length / EA;
    begin += bar.length;
  }
  return result;
}

}  // namespace ciliaval::tools::end_problem

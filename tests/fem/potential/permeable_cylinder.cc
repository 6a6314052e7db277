// SPDX-License-Identifier: LGPL-2.1-or-later
#include "permeable_cylinder.h"

#include <Eigen/LU>
#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/special_functions/ellint_rd.hpp>
#include <boost/math/special_functions/ellint_rg.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "problem/field_model.h"
#include "problem/lagrange.h"

namespace ciliaval::oracle {
namespace {

using Rule = boost::math::quadrature::gauss<double, 16>;

struct Radial {
  double rho = 0;
  double z = 0;
};

/// H of a ring of radius a with unit charge per length at (ρ, ζ) from its centre, by the derivative
/// of ψ = a K(m)/(πs), m = 4aρ/s²:
///
///     H_ρ = a/(2πρs) [K − E (a² − ρ² + ζ²)/d²],   H_ζ = a ζ E/(π s d²),
///
/// s² = (ρ + a)² + ζ², d² = (ρ − a)² + ζ². With (a² − ρ² + ζ²)/d² = 1 + 2ρ(a − ρ)/d² the bracket is
/// (K − E) − 2ρ(a − ρ)E/d², where K − E = m R_D(0, d²/s², 1)/3 does not cancel.
Radial ring(double a, double rho, double zeta) {
  const double s2 = (rho + a) * (rho + a) + zeta * zeta;
  const double d2 = (rho - a) * (rho - a) + zeta * zeta;
  const double s = std::sqrt(s2);
  const double E = 2 * boost::math::ellint_rg(0.0, d2 / s2, 1.0);
  const double K_less_E = 4 * a * rho / s2 / 3 * boost::math::ellint_rd(0.0, d2 / s2, 1.0);
  const double H_z = a * zeta * E / (std::numbers::pi * s * d2);
  if (rho == 0) return {0, H_z};
  const double bracket = K_less_E - 2 * rho * (a - rho) * E / d2;
  return {a / (2 * std::numbers::pi * rho * s) * bracket, H_z};
}

}  // namespace

PermeableCylinder::PermeableCylinder(double M, double permeability, double radius, double bottom,
                                     double top, Resolution resolution)
    : radius_(radius),
      middle_((bottom + top) / 2),
      half_length_((top - bottom) / 2),
      points_(resolution.points),
      nodes_(gauss_legendre(static_cast<std::size_t>(resolution.points), 0, 1).nodes) {
  const auto add = [&](bool on_face, double start, double end) {
    panels_.push_back({on_face, start, end, points_ * static_cast<Eigen::Index>(panels_.size())});
  };
  // Positions on the end face from the axis, on the mantle from the middle; the last panel of each
  // ends at the edge.
  for (int level = 0; level < resolution.halvings; ++level)
    add(true, radius * (1 - std::ldexp(1.0, -level)), radius * (1 - std::ldexp(1.0, -level - 1)));
  add(true, radius * (1 - std::ldexp(1.0, -resolution.halvings)), radius);
  const double near = std::min(radius, half_length_);
  const auto far = static_cast<int>(std::ceil((half_length_ - near) / radius));
  for (int i = 0; i < far; ++i)
    add(false, -(half_length_ - near) * i / far, -(half_length_ - near) * (i + 1) / far);
  for (int level = 0; level < resolution.halvings; ++level)
    add(false, -half_length_ + near * std::ldexp(1.0, -level),
        -half_length_ + near * std::ldexp(1.0, -level - 1));
  add(false, -half_length_ + near * std::ldexp(1.0, -resolution.halvings), -half_length_);
  solve(M, permeability);
}

PermeableCylinder::Point PermeableCylinder::at(const Panel& panel, double s) const {
  const double position = panel.start + s * (panel.end - panel.start);
  return panel.on_face ? Point{position, -half_length_} : Point{radius_, position};
}

/// Adds ∫ kernel(ρ', z') ℓ_i ds of the panel, or of its mirror image (mirror = −1) with the
/// opposite charge, to the entries of its unknowns. The panel is halved until each part is no
/// longer than its distance from x; a part at x itself is left out where it is 1e-15 of the radius.
template <typename Kernel>
void PermeableCylinder::integrate(const Panel& panel, int mirror, const Point& x,
                                  const Kernel& kernel, Eigen::Ref<Eigen::RowVectorXd> row) const {
  const LagrangeBasis basis(nodes_);
  std::vector<double> shape(nodes_.size());
  const double length = std::abs(panel.end - panel.start);
  std::vector<std::pair<double, double>> parts{{0.0, 1.0}};
  while (!parts.empty()) {
    const double lower = parts.back().first;
    const double upper = parts.back().second;
    parts.pop_back();
    const Point p = at(panel, lower);
    const Point q = at(panel, upper);
    const double d_rho =
        std::max({std::min(p.rho, q.rho) - x.rho, x.rho - std::max(p.rho, q.rho), 0.0});
    const double d_z = std::max({std::min(mirror * p.z, mirror * q.z) - x.z,
                                 x.z - std::max(mirror * p.z, mirror * q.z), 0.0});
    const double size = (upper - lower) * length;
    if (std::hypot(d_rho, d_z) < size) {
      if (size < 1e-15 * radius_) continue;
      parts.emplace_back(lower, (lower + upper) / 2);
      parts.emplace_back((lower + upper) / 2, upper);
      continue;
    }
    const auto add = [&](double t, double weight) {
      const double s = (lower + upper) / 2 + t * (upper - lower) / 2;
      basis.values(s, shape);
      const Point source = at(panel, s);
      const double value = mirror * weight * size / 2 * kernel(source.rho, mirror * source.z);
      for (int i = 0; i < points_; ++i)
        row[panel.first + i] += value * shape[static_cast<std::size_t>(i)];
    };
    for (std::size_t g = 0; g < Rule::abscissa().size(); ++g)
      for (const int sign : {1, -1}) add(sign * Rule::abscissa()[g], Rule::weights()[g]);
  }
}

void PermeableCylinder::solve(double M, double permeability) {
  const Eigen::Index n = points_ * static_cast<Eigen::Index>(panels_.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
  Eigen::RowVectorXd row(n);
  for (const Panel& target : panels_) {
    for (int i = 0; i < points_; ++i) {
      const Point x = at(target, nodes_[static_cast<std::size_t>(i)]);
      // H along the outward normal; a flat face has none of its own charge.
      const auto kernel = [&](double a, double z) {
        const Radial H = ring(a, x.rho, x.z - z);
        return target.on_face ? -H.z : H.rho;
      };
      row.setZero();
      for (const Panel& source : panels_)
        for (const int mirror : {1, -1})
          if (mirror == -1 || !target.on_face || !source.on_face)
            integrate(source, mirror, x, kernel, row);
      A.row(target.first + i) = -(permeability - 1) * row;
      A(target.first + i, target.first + i) += (permeability + 1) / 2;
      if (target.on_face) b[target.first + i] = -M;
    }
  }
  sigma_ = A.partialPivLu().solve(b);
}

Vector3 PermeableCylinder::B(const Vector3& x) const {
  const Point p{std::hypot(x[0], x[1]), x[2] - middle_};
  Radial H;
  for (double* component : {&H.rho, &H.z}) {
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(sigma_.size());
    const auto kernel = [&](double a, double z) {
      const Radial value = ring(a, p.rho, p.z - z);
      return component == &H.rho ? value.rho : value.z;
    };
    for (const Panel& panel : panels_)
      for (const int mirror : {1, -1}) integrate(panel, mirror, p, kernel, row);
    *component = row * sigma_;
  }
  Vector3 B(0, 0, H.z);
  if (p.rho > 0) B.head<2>() = H.rho / p.rho * x.head<2>();
  return vacuum_permeability * B;
}

}  // namespace ciliaval::oracle

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "problem/types.h"

namespace ciliaval::oracle {

/// A cylinder about the z axis with the uniform axial remanence μ₀M and the recoil permeability
/// μ_r, by an integral equation for the charge σ (A/m) on its surface. Inside ∇·H = 0; across the
/// surface B_n is continuous and H_n jumps by σ, so that
///
///     σ (μ_r + 1)/2 = (μ_r − 1) ∫ σ' n·(x − x')/(4π|x − x'|³) dA' + M n_z
///
/// (J. D. Jackson, Classical Electrodynamics, 3rd ed., sections 1.5 and 5.9). σ is axisymmetric and
/// odd about the middle: the unknowns are its values at the Gauss points of panels on the lower end
/// face and the lower half of the mantle, halved again and again towards the edge, where σ is
/// singular; it is a polynomial on each. The field of a ring of charge is closed in complete
/// elliptic integrals (Boost.Math's Carlson forms).
class PermeableCylinder {
 public:
  /// Halvings of the panels towards the edge, and Gauss points of a panel.
  struct Resolution {
    int halvings = 24;
    int points = 8;
  };
  PermeableCylinder(double M, double permeability, double radius, double bottom, double top,
                    Resolution resolution);

  /// B (T) outside.
  Vector3 B(const Vector3& x) const;
  /// σ (A/m) in the middle of the lower end face.
  double charge_at_centre() const { return sigma_[0]; }
  Eigen::Index unknowns() const { return sigma_.size(); }

 private:
  /// A panel of the end face (ρ from start to end) or of the mantle (height above the middle).
  struct Panel {
    bool on_face = false;
    double start = 0;
    double end = 0;
    Eigen::Index first = 0;  ///< unknown
  };
  /// A point of a half-plane through the axis.
  struct Point {
    double rho = 0;
    double z = 0;  ///< above the middle
  };
  Point at(const Panel& panel, double s) const;
  template <typename Kernel>
  void integrate(const Panel& panel, int mirror, const Point& x, const Kernel& kernel,
                 Eigen::Ref<Eigen::RowVectorXd> row) const;
  void solve(double M, double permeability);

  double radius_;
  double middle_;
  double half_length_;
  int points_;
  std::vector<double> nodes_;  ///< of a panel, on [0, 1]
  std::vector<Panel> panels_;
  Eigen::VectorXd sigma_;
};

}  // namespace ciliaval::oracle

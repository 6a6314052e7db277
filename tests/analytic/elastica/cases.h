// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <string>
#include <vector>

#include "analytic/elastica/elastica.h"
#include "problem/cilium.h"
#include "problem/mechanics_model.h"

/// Cilia, and the closed form of one material under a point force, of the elastica's tests.
namespace ciliaval::analytic {

using Real = boost::multiprecision::cpp_bin_float_50;

/// The paper's cilium: 3 mm of 0.1 MPa below 17 mm of 3 MPa, diameter 3 mm.
Cilium paper_cilium();
/// Three segments of 2 GPa, 40 kPa and 3 MPa, of 4, 5 and 11 mm, diameter 2 mm.
Cilium three_segments();
/// One material, length 20 mm, diameter 1 mm, 1 MPa.
Cilium uniform_cilium();
/// EI of a segment, N·m².
double bending_stiffness(const Cilium& cilium, std::size_t segment = 0);

elastica::ElasticaOptions height_form();

/// The one step of a load that must converge; a test failure otherwise.
MechanicsStep solve(const Cilium& cilium, const Load& load,
                    const elastica::ElasticaOptions& options = {});

/// A point in the plane of bending.
struct PlanarPoint {
  double w = 0;      ///< along e, m
  double z = 0;      ///< m
  double theta = 0;  ///< rad, with the sign of the rotation about e_z × e
};
PlanarPoint planar_point(const MechanicsStep& step, double S);

/// The elastica of one material whose internal force is F up to a point without moment at the angle
/// θ_c, by Legendre's integrals. With λ² = F/(EI), p² = (1 + sin θ_c)/2, p sin ψ = sin(π/4 + θ/2):
///
///     λS = [F(ψ) − F(ψ₀)],  λw = λS − 2[E(ψ) − E(ψ₀)],  λz = √(2 sin θ_c) − √(2(sin θ_c − sin θ)),
///
/// all of modulus p; ψ = π/2 at θ = θ_c. (dθ/dS = λ√(2(sin θ_c − sin θ)) is the energy integral.)
class PointForceElastica {
 public:
  /// `p_squared` = (1 + sin θ_c)/2.
  PointForceElastica(Real lambda, const Real& p_squared);
  static PointForceElastica with_end_angle(const Real& lambda, const Real& sine);
  /// The one whose arc up to the point without moment has the length L.
  static PointForceElastica with_length(const Real& lambda, const Real& length);

  const Real& sine() const { return sine_; }  ///< sin θ_c
  Real length() const;                        ///< S of the point without moment
  Real height() const;                        ///< z there
  Real deflection() const;                    ///< w there
  Real end_angle() const;                     ///< θ_c

  struct Point {
    Real S;
    Real w;
    Real z;
  };
  Point at(const Real& theta) const;  ///< at θ ≤ θ_c

 private:
  Real lambda_;
  Real p_;
  Real sine_;
  Real f0_;  ///< F(ψ₀, p)
  Real e0_;  ///< E(ψ₀, p)
};

/// h/L at which a uniform cilium slips off, and FL²/(EI) there, of the elastica with end angle θ_c.
struct UniformSlipOff {
  Real height;
  Real load;
};
UniformSlipOff uniform_slip_off(const Real& sine);

}  // namespace ciliaval::analytic

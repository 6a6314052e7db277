// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <vector>

// Semi-analytic solutions of the plane Reissner beam by quadrature (Boost.Math). They share no code
// with the finite elements. The beam stands on the origin along +z, bends towards +x; θ is the turn
// of the section from +z, β = 1/EA − 1/kGA.
namespace oracle {

struct Tip {
  double x;
  double z;
  double theta;
};

/// Cantilever of length L under a horizontal dead tip force F. With N = F sin θ, V = F cos θ,
/// r' = (1 + N/EA) d₃ + (V/kGA) d₁ and EI θ'' = −F z', the first integral is
///   ½ EI θ'² = F (sin θ_L − sin θ) + ½ F² β (sin² θ_L − sin² θ),
/// and L = ∫ dθ/θ' gives θ_L (as in M. Batista, arXiv:1508.04424, there in elliptic integrals).
Tip cantilever(double L, double EI, double one_over_EA, double one_over_kGA, double F);

/// A stretch of beam in the contact and flow problems.
struct Stretch {
  double length;
  double EI;
  double beta = 0;  ///< 1/EA − 1/kGA
  double one_over_EA = 0;
  double one_over_kGA = 0;
};

struct Contact {
  double arclength;  ///< S of the material point at z = h
  Tip tip;
};

/// Horizontal force F that acts on whatever material point is at z = h. M = F (h − z), so
///   EI d(sin θ + ½ F β sin² θ) = F (h − z) dz
/// in each stretch, θ continuous; S = ∫ dz/z', z' = cos θ (1 + F β sin θ). Above the contact the
/// beam is straight and unstrained.
Contact contact(const std::vector<Stretch>& beam, double F, double h);

/// The largest contact force: the one with S = L.
double slip_off_force(const std::vector<Stretch>& beam, double h);

/// Horizontal force q per unit of current height on an inextensible, shear-rigid beam (paper,
/// Eq. 3–4): EI d(sin θ) = ½ q (z₂ − z)² dz, z₂ the height of the tip.
Tip flow(const std::vector<Stretch>& beam, double q);

}  // namespace oracle

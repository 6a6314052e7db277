// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>
#include <span>
#include <string>

namespace ciliaval::compare::convergence {

/// A quantity on one level of refinement.
struct RefinementLevel {
  double size = 0;   ///< of the discretisation, h > 0, in any unit
  double value = 0;  ///< f(h)
};

/// The limit f(0) that a refinement study finds.
struct Extrapolation {
  bool conclusive = false;      ///< whether there is an interval at all
  std::string reason;           ///< why not, or a remark
  std::optional<double> order;  ///< observed, p in f(h) = f₀ + α h^p
  double limit = 0;             ///< f₀
  double uncertainty = 0;       ///< half-width of the interval about the finest level's value
  double safety = 0;            ///< F_s that is in it
};

/// Richardson's extrapolation with the grid convergence index of three levels, finest first
/// (Celik et al., J. Fluids Eng. 130, 078001, 2008, Eq. 3-7; Roache, Verification and Validation,
/// 1998): with e₂₁ = f₂ − f₁, e₃₂ = f₃ − f₂, r₂₁ = h₂/h₁, r₃₂ = h₃/h₂ the order solves
///
///   p ln r₂₁ = ln(e₃₂/e₂₁) + ln[(r₂₁^p − 1)/(r₃₂^p − 1)],
///
/// f₀ = f₁ − e₂₁/(r₂₁^p − 1), and the interval is f₁ ± F_s |e₂₁|/(r₂₁^p − 1). F_s is 1.25 if p is
/// within 10 % of the formal order, where that is given; else 3, with p no larger than the formal
/// order in the interval (Oberkampf & Roy, 2010, section 8.6). Not conclusive: e₃₂/e₂₁ ≤ 0 (not
/// monotone), p ≤ 0.1 (does not converge). Where p > 12 (element degrees of a smooth solution)
/// there is no order, the limit is f₁ and the interval F_s |e₂₁|/(r₂₁^q − 1) with F_s = 3 and q the
/// formal order, 2 where that is not given. Where the two finest values agree to rounding
/// (`rounding`, absolute), that is the interval.
///
/// Throws InputError if there are not three levels, sizes are not positive and increasing, or a
/// value is not finite.
Extrapolation grid_convergence(std::span<const RefinementLevel> levels,
                               std::optional<double> formal_order = {}, double rounding = 0);

/// The least-squares version for four or more levels, finest first (Eça & Hoekstra, J. Comput.
/// Phys. 262, 104, 2014, section 3): f₀, α and p minimise the standard deviation
/// σ² = Σ (f_i − f₀ − α h_i^p)²/(n − 3). The interval of the finest level is F_s |f₁ − f₀| + σ +
/// |f₁ − fit(h₁)|, F_s = 1.25 if 0.5 ≤ p ≤ formal order (2 where that is not given) + 0.1 and σ is
/// less than the data's mean difference from level to level (f_max − f_min)/(n − 1), else 3. Not
/// conclusive if the values are not monotone or p is at the end of what was searched, 0.1 to 12;
/// but where all changes fall faster than with order 12, the interval is grid_convergence()'s.
/// Throws as grid_convergence().
Extrapolation least_squares_convergence(std::span<const RefinementLevel> levels,
                                        std::optional<double> formal_order = {},
                                        double rounding = 0);

/// The one for the number of levels.
Extrapolation extrapolate(std::span<const RefinementLevel> levels,
                          std::optional<double> formal_order = {}, double rounding = 0);

/// Extrapolation from promised tolerances: the value computed with the tolerance h is off by no
/// more than h times `scale`. Conclusive if each level, finest first, is within its own promise and
/// the finest one's of the finest: |f_i − f₁| ≤ (h_i + h₁) scale. Then the interval is f₁ ± h₁
/// scale. Throws as grid_convergence().
Extrapolation kept_tolerances(std::span<const RefinementLevel> levels, double scale);

}  // namespace ciliaval::compare::convergence

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <any>
#include <optional>

#include "problem/cilium.h"
#include "problem/load.h"
#include "problem/mechanics_model.h"

/// A rigid pin that is moved against the side of the cilium (docs/theory/touch.md). Without units:
/// lengths in Body::length(), forces in Body::force_unit().
namespace ciliaval::pin {

struct Pin {
  double height = 0;           ///< h of its centre
  double radius = 0;           ///< r
  double mantle = 0;           ///< R, distance of the mantle from the axis; 0: touched there
  bool is_horizontal = false;  ///< the force stays horizontal, whatever friction that takes
  double friction_angle = 0;   ///< arctan μ

  /// The pin's centre is so far from the axis.
  double distance() const { return mantle + radius; }
  /// True if where the pin goes next depends on where it has been.
  bool has_history() const { return !is_horizontal && friction_angle > 0; }
};

/// The pin of a load with a TouchLaw, lengths in `unit` (m). Throws InputError if it reaches the
/// base.
Pin pin_of(const Cilium& cilium, const Load& load, double unit);

/// A number that an equilibrium is asked to have.
struct Condition {
  enum class Number {
    friction,      ///< arctan T/N
    slip,          ///< s = S + rθ, which is constant where the pin sticks
    displacement,  ///< of the pin, from where it touches the straight cilium
    force,         ///< H
    arclength      ///< S of the contact
  } number;
  double value;
};

struct Equilibrium {
  double S = 0;  ///< of the contact
  double slip = 0;
  double displacement = 0;
  double force = 0;           ///< H
  double vertical = 0;        ///< V, downwards
  double base_moment = 0;     ///< as ProbeContact's
  double normal = 0;          ///< N
  double friction_angle = 0;  ///< arctan T/N
  // Derivatives by the value of the second of the conditions.
  double slip_by_second = 0;
  double force_by_second = 0;
  int iterations = 0;
  std::any state{};  ///< the body's own
};

/// The cilium of a model that the pin touches.
class Body {
 public:
  Body() = default;
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;
  virtual ~Body() = default;

  virtual const Pin& pin() const = 0;
  virtual double length() const = 0;      ///< unit of lengths, m
  virtual double force_unit() const = 0;  ///< N
  virtual double tip() const = 0;         ///< S of the tip
  /// Rounding of slips and forces, by which a pin has not turned back.
  virtual double rounding() const = 0;

  /// The cilium that the pin just touches, without a force. Throws SolverError.
  virtual Equilibrium untouched() = 0;
  /// The equilibrium with two given numbers, by Newton's method from the guess; where the force is
  /// horizontal, V = 0 stands for a given friction. Empty if it does not converge. A contact beyond
  /// the tip lies on the last segment as if that went on.
  virtual std::optional<Equilibrium> solve(const Condition& first, const Condition& second,
                                           const Equilibrium& guess) = 0;
  virtual Deformation deformation(const Equilibrium& equilibrium) = 0;
  virtual std::size_t n_unknowns() const = 0;
};

}  // namespace ciliaval::pin

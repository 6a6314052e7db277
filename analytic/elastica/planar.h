// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include "problem/centreline.h"
#include "problem/cilium.h"
#include "problem/joints/joints.h"
#include "problem/load.h"

/// The planar elastica without units, which both forms of analytic::Elastica solve: lengths in L,
/// forces in P (F of a point force, qL of a distributed one, M/L of a couple), moments in PL.
namespace ciliaval::analytic::elastica {

/// Dependence of the internal force H(S) on the shape.
enum class PlanarLoad {
  contact,  ///< H = 1 below z = h, M = (h − z)₊
  flow,     ///< H = z_tip − z, M = (z_tip − z)²/2
  section,  ///< H = 1 below S = s, M = z(s) − z
  dead,     ///< H = 1 − S, M = ∫_S^1 (z(σ) − z(S)) dσ
  moment    ///< H = 0, M = 1
};

/// The second-order law of bending (problem/joints/joints.h) without units: θ' = … + 2 p N M + g M³
/// + h M⁵, along the normal … + p M².
struct PlanarLaw {
  double lengthening = 0;        ///< p
  double softening = 0;          ///< g
  double further_softening = 0;  ///< h

  bool is_empty() const { return lengthening == 0 && softening == 0 && further_softening == 0; }
  double of_rotation(double M, double N) const {
    return M * (2 * lengthening * N + M * M * (softening + M * M * further_softening));
  }
};

/// A joint (problem/joints/joints.h): Δθ = a M + b Q, along the section b M + c Q, along its normal
/// e N, and what its law adds.
struct PlanarJoint {
  double rotation = 0;      ///< a
  double coupling = 0;      ///< b
  double displacement = 0;  ///< c
  double extension = 0;     ///< e
  PlanarLaw law{};
};

/// Strains of a section per unit of its moment and force.
struct Flexibility {
  double bending = 0;    ///< θ' = bending·M
  double shear = 0;      ///< along the section shear·Q, Q = H cos θ
  double extension = 0;  ///< along its normal 1 + extension·N, N = H sin θ
  PlanarLaw law{};

  bool is_rigid() const { return shear == 0 && extension == 0 && law.is_empty(); }
};

struct PlanarProblem {
  PlanarLoad kind = PlanarLoad::contact;
  std::vector<double> ends;        ///< S/L of the segments' ends: 0, …, 1
  std::vector<double> compliance;  ///< max(EI)/EI of each segment, ≥ 1
  double load = 0;                 ///< PL²/max(EI); θ'(S) = load · compliance · M
  double point = 1;                ///< h/L (contact) or s/L (section)
  // With corrected joints; else empty. The paper's rod neither shears nor extends.
  std::vector<PlanarJoint> joints{};  ///< under a load of 1, at the lower end of each segment
  std::vector<double> shear{};        ///< max(EI)/(kGA L²) of each segment
  std::vector<double> extension{};    ///< max(EI)/(EA L²) of each segment
  std::vector<PlanarLaw> laws{};      ///< of each segment

  /// Flexibility of segment i under the load.
  Flexibility flexibility(std::size_t i, double under) const;
  /// Joint i under the load.
  PlanarJoint joint(std::size_t i, double under) const;
};

/// Units of a planar problem.
struct PlanarUnits {
  double length = 0;  ///< L, m
  double force = 0;   ///< P, N
};

/// The problem of one load on a cilium. A probe's is a contact with a force of 1 N, which is yet to
/// be found. With corrections the segments shear and extend as well. Throws InputError if PL²/EI is
/// not representable.
PlanarProblem planar_problem(const Cilium& cilium, const Load& load,
                             const joints::Corrections& corrections = {});
PlanarUnits planar_units(const Cilium& cilium, const Load& load);

/// State at one material point, in the problem's units.
struct PlanarState {
  double S = 0;
  double theta = 0;                   ///< θ, rad
  double phi = std::numbers::pi / 2;  ///< π/2 − θ, kept apart: it carries the digits near 90°
  double w = 0;
  double z = 0;
  double moment = 0;     ///< M
  double force = 0;      ///< H, exerted by the part above on the part below
  double vertical = 0;   ///< the same along z: that of a surface alone has it
  double curvature = 0;  ///< θ'(S)
};

/// A solved shape.
struct PlanarShape {
  std::vector<double> breaks;  ///< 0, …, 1; θ(S) is smooth between them
  /// State at S, which lies in the piece [breaks[i], breaks[i+1]]; one-sided at its ends.
  std::function<PlanarState(double S, std::size_t i)> state;
  std::optional<double> contact;  ///< S at z = h
  /// w there, if the contact is between the two sides of a joint.
  std::optional<double> deflection;
  double error = 0;    ///< estimate of the error of w and z at the tip
  int iterations = 0;  ///< integrations along the whole cilium
};

/// The load of a contact problem where `excess`, a function of its logarithm, changes sign from
/// positive to negative, to the last digits: bracketed from where linear theory has it. Only the
/// sign need have a meaning. Throws SolverError if it is not found.
double slip_off_load(const PlanarProblem& problem, const std::function<double(double)>& excess);

/// Shortest piece: it must have room for its nodes.
inline constexpr double shortest_piece = 1e-13;
/// Adds a break, unless one is already there within shortest_piece.
void add_break(std::vector<double>& breaks, double S);

/// The shape as a Centreline in the plane of `direction` (e): Chebyshev pieces between the breaks,
/// bisected until interpolation meets `tolerance` at points between the nodes. The rotation is the
/// angle θ about e_z × e, κ = θ' e_z × e, the force H e, the moment M e_z × e. Throws SolverError
/// if the shape is not smooth enough or not finite.
Centreline planar_centreline(const PlanarShape& shape, const PlanarUnits& units,
                             const Vector3& direction, double tolerance);

}  // namespace ciliaval::analytic::elastica

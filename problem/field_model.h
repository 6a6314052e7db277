// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "problem/cilium.h"
#include "problem/deformation.h"
#include "problem/types.h"

namespace ciliaval {

/// μ₀, H/m, as in the paper (Eq. 5): 4π·10⁻⁷ exactly.
inline constexpr double vacuum_permeability = 4e-7 * 3.14159265358979323846;

/// A magnetic scalar potential on cubes, as a field model computed it: for drawing.
struct FieldMesh {
  struct Leaf {
    Vector3 lower = Vector3::Zero();  ///< corner with the lowest coordinates, m
    double size = 0;                  ///< edge, m
    std::array<double, 27> psi{};     ///< ψ, A, at the corners and midpoints, first index fastest
    Vector3 magnetization = Vector3::Zero();  ///< B_r/μ₀, mean over the cube, A/m
    double relative_permeability = 1;         ///< mean over the cube
  };
  std::vector<Leaf> leaves;  ///< all of them on rank 0, none on the others
};

struct Field {
  std::vector<Vector3> B;            ///< flux density, T, one for each point
  std::vector<Vector3> uncertainty;  ///< estimate of the numerical error of each component, T;
                                     ///< empty if the model has none
  std::shared_ptr<const FieldMesh> mesh = nullptr;  ///< what the model computed B from, if it can
                                                    ///< be drawn
  std::string remark{};  ///< why the uncertainty is not known, if there is a reason to tell
};

/// A model of the magnetic field of the deformed cilium.
class FieldModel {
 public:
  virtual ~FieldModel() = default;

  /// True if each point is computed by itself at little cost, so that the field may be drawn on a
  /// grid of many points.
  virtual bool pointwise() const { return true; }

  /// The model that takes this one's place where only the change of B between two nearly equal
  /// deformations is asked for: a cheaper one, if this is dear.
  virtual const FieldModel& for_differences() const { return *this; }

  /// B of the deformed magnet at the points (m). Inside the magnet it is B, not μ₀H. Throws
  /// InputError where B diverges (the end face's rim; a dipole) or if the deformation lacks the
  /// body, SolverError if the accuracy asked cannot be reached.
  virtual Field field(const Cilium& cilium, const Deformation& deformation,
                      std::span<const Vector3> points) const = 0;

  /// M = B/μ₀ − H of the deformed magnet at the points, A/m: 0 outside of it, and everywhere in a
  /// model whose sources fill no volume. Throws InputError where a point lies in matter whose M the
  /// model does not tell.
  virtual std::vector<Vector3> magnetization(const Cilium& /*cilium*/,
                                             const Deformation& /*deformation*/,
                                             std::span<const Vector3> points) const {
    return std::vector<Vector3>(points.size(), Vector3::Zero());
  }
};

}  // namespace ciliaval

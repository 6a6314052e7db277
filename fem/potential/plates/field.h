// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "fem/potential/magnet.h"
#include "fem/potential/plates/charges.h"
#include "problem/field_model.h"

namespace ciliaval::fem::potential::plates {

/// Share of the magnet's matter in its answer to a field: the moment (μ_r − 1) H dv.
struct InducedMoment {
  Vector3 position = Vector3::Zero();
  double volume = 0;                 ///< (μ_r − 1) dv, m³
  Vector3 moment = Vector3::Zero();  ///< without the plates, A·m²
};

/// What the plates add to B at the points.
struct AddedField {
  std::vector<Vector3> B;           ///< T
  std::vector<double> uncertainty;  ///< of each component, T
  /// To be taken for drawing: the coarsest system and its charges.
  std::shared_ptr<const Charges> system;
  Eigen::VectorXd charges;
};

/// The plates' charges in the field of a magnet, on systems that are kept from call to call: they
/// depend on the plates, the points and roughly on where the magnet is. Safe in threads.
class Plates {
 public:
  explicit Plates(std::vector<PermeableBox> boxes) : boxes_(std::move(boxes)) {}

  const std::vector<PermeableBox>& boxes() const { return boxes_; }
  /// Refines until B changes by no more than `tolerance` (T, of each point), which is then the
  /// uncertainty. The magnet answers to the plates by its induced moments in their field (first
  /// order in the susceptibility μ_r − 1; the second is in the uncertainty). Throws SolverError if
  /// the tolerance takes too many charges.
  AddedField field(const Magnet& magnet, double susceptibility,
                   std::span<const InducedMoment> induced, const Vector3& uniform_field,
                   std::span<const Vector3> points, std::span<const double> tolerance) const;

 private:
  std::shared_ptr<const Charges> system(std::size_t level,
                                        const std::vector<Vector3>& features) const;

  std::vector<PermeableBox> boxes_;
  mutable std::mutex mutex_;
  mutable std::vector<Vector3> features_;
  mutable std::vector<std::shared_ptr<const Charges>> systems_;  ///< one a level, of features_
};

/// Adds the plates to a solution without them: their potential, and no leaves where they are.
std::shared_ptr<const FieldMesh> with_plates(const FieldMesh& mesh, const Plates& plates,
                                             const AddedField& field);

}  // namespace ciliaval::fem::potential::plates

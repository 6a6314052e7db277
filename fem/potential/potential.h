// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <mpi.h>

#include <memory>
#include <vector>

#include "fem/potential/magnet.h"
#include "fem/potential/plates/field.h"
#include "problem/field_model.h"

namespace ciliaval::fem::potential {

struct PotentialOptions {
  /// μ_r of the magnetised segments: about 1.05 for composites with NdFeB; the dipole models
  /// have 1.
  double relative_permeability = 1.05;
  MagnetPushForward push_forward = MagnetPushForward::F;
  double tolerance = 2e-3;             ///< uncertainty of B over |B|, at each sensor
  unsigned int max_unknowns = 600000;  ///< of the solution that B is taken from
  std::vector<PermeableBox> plates;    ///< at rest, below or beside the sensors
};

/// The field of the deformed magnet, with its recoil permeability, and of permeable plates, by a
/// scalar potential in all of space (docs/theory/potential.md): finite elements on an octree,
/// refined for B at the sensors, and charges on the plates' faces. Field::uncertainty is twice the
/// estimate of the error; it is empty and there is a remark where a permeability is beyond the
/// tested ones. field() is collective on the communicator's ranks, which share the work; it starts
/// MPI. Throws as solve_potential().
class Potential : public FieldModel {
 public:
  explicit Potential(PotentialOptions options = {}, MPI_Comm communicator = MPI_COMM_WORLD);

  bool pointwise() const override { return false; }
  Field field(const Cilium& cilium, const Deformation& deformation,
              std::span<const Vector3> points) const override;

 private:
  PotentialOptions options_;
  std::shared_ptr<const plates::Plates> plates_;
  MPI_Comm communicator_;
};

}  // namespace ciliaval::fem::potential

// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "analytic/sources/push_forward.h"
#include "problem/field_model.h"

namespace ciliaval::analytic::body {

/// The field of a solid model's own deformed magnet.
struct MeshOptions {
  sources::PushForward push_forward =
      sources::PushForward::F;  ///< F: reference charge on the deformed faces; R: volume quadrature
  double tolerance = 1e-8;      ///< relative to |B|
};
class MeshField : public FieldModel {
 public:
  explicit MeshField(MeshOptions options = {}) : options_(options) {}
  Field field(const Cilium& cilium, const Deformation& deformation,
              std::span<const Vector3> points) const override;
  /// m = F·M/J; as for `field` there is none inside with the push-forward R.
  std::vector<Vector3> magnetization(const Cilium& cilium, const Deformation& deformation,
                                     std::span<const Vector3> points) const override;

 private:
  MeshOptions options_;
};

}  // namespace ciliaval::analytic::body

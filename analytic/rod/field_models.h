// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "analytic/sources/push_forward.h"
#include "problem/field_model.h"

namespace ciliaval::analytic::rod {

/// Method for an integral that has a closed form.
enum class Method {
  closed_form,
  quadrature,  ///< Gauss–Legendre to the tolerance: the closed form's check
  uniform      ///< the paper's own sums over `elements` slices of equal height: its accuracy
};

/// Each magnetic segment's total moment as one dipole at the centroid of its centreline.
struct DipoleOptions {
  sources::PushForward push_forward = sources::PushForward::F;
};
class DipoleField : public FieldModel {
 public:
  explicit DipoleField(DipoleOptions options = {}) : options_(options) {}
  Field field(const Cilium& cilium, const Deformation& deformation,
              std::span<const Vector3> points) const override;
  /// ∂B_i/∂x_j (T/m) at the points, exactly the derivative of `field`.
  std::vector<Matrix3> gradient(const Cilium& cilium, const Deformation& deformation,
                                std::span<const Vector3> points) const;

 private:
  DipoleOptions options_;
};

/// Dipoles along the centreline (Eq. 5–7, the paper's "single-dipole" model).
struct LineOptions {
  sources::PushForward push_forward = sources::PushForward::F;
  Method method =
      Method::closed_form;   ///< two poles, F only: R has no closed form and takes the quadrature
  double tolerance = 1e-10;  ///< relative to |B|, of the quadrature
  unsigned int elements = 100;  ///< `uniform`: n dipoles in each magnetic segment
};
class LineField : public FieldModel {
 public:
  explicit LineField(LineOptions options = {}) : options_(options) {}
  Field field(const Cilium& cilium, const Deformation& deformation,
              std::span<const Vector3> points) const override;
  /// ∂B_i/∂x_j (T/m) at the points: of `closed_form` and `quadrature`. Throws InputError for
  /// `uniform`.
  std::vector<Matrix3> gradient(const Cilium& cilium, const Deformation& deformation,
                                std::span<const Vector3> points) const;

 private:
  LineOptions options_;
};

/// Volume integral over the bent rod (Eq. 8–9, the paper's "multi-dipole" model).
struct VolumeOptions {
  enum class Slices {
    wedge,   ///< the true volume of the bent rod, Jacobian 1 − κ·(offset)
    stacked  ///< the paper's Eq. 8–9: flat slices of equal thickness dS, no Jacobian
  };
  Slices slices = Slices::wedge;
  Method method =
      Method::closed_form;     ///< wedge: two charged discs; stacked: a stack of current loops
  double tolerance = 1e-10;    ///< relative to |B|, not of `uniform`
  unsigned int elements = 20;  ///< `uniform`: n³ dipoles in each magnetic segment
};
class VolumeField : public FieldModel {
 public:
  explicit VolumeField(VolumeOptions options = {}) : options_(options) {}
  Field field(const Cilium& cilium, const Deformation& deformation,
              std::span<const Vector3> points) const override;
  /// m = F·M/J inside the wedge's magnet. Stacked slices overlap, so that there is no M inside.
  std::vector<Vector3> magnetization(const Cilium& cilium, const Deformation& deformation,
                                     std::span<const Vector3> points) const override;
  /// ∂B_i/∂x_j (T/m) at points outside of the magnet: of the wedge by `closed_form`. Throws
  /// InputError for all else.
  std::vector<Matrix3> gradient(const Cilium& cilium, const Deformation& deformation,
                                std::span<const Vector3> points) const;

 private:
  VolumeOptions options_;
};

}  // namespace ciliaval::analytic::rod

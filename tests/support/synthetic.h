// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compare/models/run.h"
#include "tests/support/temporary_folder.h"

/// Deformations and models of known shape, to test what is made of them.
namespace ciliaval::test {

/// Length of the paper's cilium, m.
inline constexpr double L = 20e-3;

/// The text of a case file: the paper's cilium, or one with another magnet, under contact forces.
struct ContactCaseText {
  std::string name;
  std::string magnet_length = "17 mm";
  std::string force = R"("1 mN")";  ///< a TOML value: a string or a list of them
  std::string height = "16 mm";
  std::string sensor = R"(["-0.1 mm", "0.2 mm", "-1.55 mm"])";
};
/// `models` are the lines that follow `[models]`.
std::string case_text(const ContactCaseText& text, const std::string& models);

/// The curve r(S) with the section's rotation about ê_z × e by θ(S), in two pieces that join at
/// `joint`, each on 24 Chebyshev points.
Centreline planar_curve(double length, double joint, const Vector3& e,
                        const std::function<Vector3(double)>& position,
                        const std::function<double(double)>& theta,
                        const std::function<double(double)>& kappa);

/// Circular arc that leaves the base along +z and bends towards e with curvature k, 1/m.
Centreline arc(double length, double joint, const Vector3& e, double k);
/// Straight line tilted from +z towards e by an angle, rad.
Centreline tilted(double length, double joint, const Vector3& e, double angle);

/// A mechanics model that returns the curve of a function.
class ShapeModel : public MechanicsModel {
 public:
  using Shape = std::function<MechanicsStep(const Load&)>;
  explicit ShapeModel(Shape shape, Centreline undeformed)
      : shape_(std::move(shape)), undeformed_(std::move(undeformed)) {}
  MechanicsResult solve(const Cilium& cilium, const LoadPath& path,
                        const Progress& progress) const override;

 private:
  Shape shape_;
  Centreline undeformed_;
};

/// A field model that returns the value of a function of the deformation and the point.
class FormulaField : public FieldModel {
 public:
  using Formula = std::function<Vector3(const Deformation&, const Vector3&)>;
  FormulaField(Formula formula, const std::optional<Vector3>& uncertainty)
      : formula_(std::move(formula)), uncertainty_(uncertainty) {}
  Field field(const Cilium& cilium, const Deformation& deformation,
              std::span<const Vector3> points) const override;

 private:
  Formula formula_;
  std::optional<Vector3> uncertainty_;
};

compare::models::MechanicsEntry mechanics_entry(std::string id, const ShapeModel::Shape& shape);
compare::models::FieldEntry field_entry(std::string id, const FormulaField::Formula& formula,
                                        const std::optional<Vector3>& uncertainty = {},
                                        bool needs_body = false);

/// A converged step.
MechanicsStep converged(const Load& load, Centreline centreline,
                        std::optional<double> tip_uncertainty = {});

/// The paper's cilium under contact forces at h = 16 mm, azimuth 0, one sensor.
compare::input::Case paper_case(const std::vector<double>& forces);

/// Two bricks on top of each other, nodes of degree 3, bent by x = X + (a Z², 0, −b X Z); the upper
/// one has magnetisation. J and σ are given at the nodes: σ = diag(1, 2, 3) X-component times
/// 10⁵ Pa/m plus the index of the cell in Pa.
struct BentBricks {
  static constexpr double a = 4.0;  ///< 1/m
  static constexpr double b = 6.0;  ///< 1/m
  static Vector3 current(const Vector3& X);
  static Matrix3 deformation_gradient(const Vector3& X);
  static Matrix3 stress(const Vector3& X, std::size_t cell);
  static SolidBody body();
};

}  // namespace ciliaval::test

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/support/synthetic.h"

#include <cmath>
#include <utility>

namespace ciliaval::test {

std::string case_text(const ContactCaseText& text, const std::string& models) {
  return "[case]\nname = \"" + text.name + R"("
title = "A test"
[cilium]
diameter = "3 mm"
[[cilium.segment]]
name = "base"
length = "3 mm"
young_modulus = "0.1 MPa"
poisson_ratio = 0.49
[[cilium.segment]]
name = "magnet"
length = ")" +
         text.magnet_length + R"("
young_modulus = "3 MPa"
poisson_ratio = 0.49
magnetization = "75 kA/m"
[load]
type = "contact"
force = )" +
         text.force + "\nheight = \"" + text.height + R"("
azimuth = "30 deg"
[sensor]
position = )" +
         text.sensor + "\n[models]\n" + models;
}

Centreline planar_curve(double length, double joint, const Vector3& e,
                        const std::function<Vector3(double)>& position,
                        const std::function<double(double)>& theta,
                        const std::function<double(double)>& kappa) {
  const Vector3 axis = Vector3::UnitZ().cross(e);
  std::vector<Centreline::Piece> pieces;
  for (const auto& [from, to] : {std::pair(0.0, joint), std::pair(joint, length)}) {
    Centreline::Piece piece{chebyshev_points(24, from, to), {}};
    for (const double S : piece.S) {
      SectionState state;
      state.position = position(S);
      state.rotation = Eigen::AngleAxisd(theta(S), axis);
      state.curvature = kappa(S) * axis;
      piece.states.push_back(state);
    }
    pieces.push_back(std::move(piece));
  }
  return Centreline(std::move(pieces));
}

Centreline arc(double length, double joint, const Vector3& e, double k) {
  return planar_curve(
      length, joint, e,
      [=](double S) -> Vector3 {
        return (1 - std::cos(k * S)) / k * e + std::sin(k * S) / k * Vector3::UnitZ();
      },
      [=](double S) { return k * S; }, [=](double) { return k; });
}

Centreline tilted(double length, double joint, const Vector3& e, double angle) {
  return planar_curve(
      length, joint, e,
      [=](double S) -> Vector3 {
        return S * (std::sin(angle) * e + std::cos(angle) * Vector3::UnitZ());
      },
      [=](double) { return angle; }, [](double) { return 0; });
}

MechanicsResult ShapeModel::solve(const Cilium&, const LoadPath& path, const Progress&) const {
  MechanicsResult result;
  result.undeformed.centreline = undeformed_;
  for (const Load& load : path) {
    result.steps.push_back(shape_(load));
    if (result.steps.back().deformation && result.steps.back().deformation->body)
      result.undeformed.body = std::make_shared<SolidBody>(BentBricks::body());
  }
  return result;
}

Field FormulaField::field(const Cilium&, const Deformation& deformation,
                          std::span<const Vector3> points) const {
  Field field;
  for (const Vector3& point : points) {
    field.B.push_back(formula_(deformation, point));
    if (uncertainty_) field.uncertainty.push_back(*uncertainty_);
  }
  return field;
}

compare::models::MechanicsEntry mechanics_entry(std::string id, const ShapeModel::Shape& shape) {
  return {.id = std::move(id),
          .description = "a known shape",
          .make =
              [shape](const compare::input::ModelOptions&) {
                return std::make_unique<ShapeModel>(shape, straight_centreline({0, 3e-3, 20e-3}));
              },
          .takes_environment = true,
          .takes_sections = true};
}

compare::models::FieldEntry field_entry(std::string id, const FormulaField::Formula& formula,
                                        const std::optional<Vector3>& uncertainty,
                                        bool needs_body) {
  return {.id = std::move(id),
          .description = "a known field",
          .make =
              [=](const compare::input::ModelOptions&) {
                return std::make_unique<FormulaField>(formula, uncertainty);
              },
          .has_body = needs_body};
}

MechanicsStep converged(const Load& load, Centreline centreline,
                        std::optional<double> tip_uncertainty) {
  MechanicsStep step;
  step.load = load;
  step.status = Status::converged;
  step.deformation = Deformation{std::move(centreline), nullptr};
  step.applied_force = magnitude(load);
  step.tip_uncertainty = tip_uncertainty;
  return step;
}

compare::input::Case paper_case(const std::vector<double>& forces) {
  compare::input::Case c;
  c.name = "paper";
  c.title = "The paper's cilium";
  c.cilium = {3e-3, {{"base", 3e-3, 0.1e6, 0.49, 0}, {"magnet", 17e-3, 3e6, 0.49, 75e3}}};
  for (const double force : forces) c.load_path.emplace_back(ContactLoad{force, 16e-3, 0});
  c.sensors = {Vector3(-0.1e-3, 0.2e-3, -1.55e-3)};
  return c;
}

Vector3 BentBricks::current(const Vector3& X) {
  return X + Vector3(a * X.z() * X.z(), 0, -b * X.x() * X.z());
}

Matrix3 BentBricks::deformation_gradient(const Vector3& X) {
  Matrix3 F;
  F << 1, 0, 2 * a * X.z(), 0, 1, 0, -b * X.z(), 0, 1 - b * X.x();
  return F;
}

Matrix3 BentBricks::stress(const Vector3& X, std::size_t cell) {
  Matrix3 s = Vector3(1, 2, 3).asDiagonal() * (1e5 * X.x());
  s(0, 1) = s(1, 0) = 4e5 * X.y();
  s(1, 2) = s(2, 1) = 5e5 * X.z();
  s(0, 2) = s(2, 0) = 6e5 * X.x();
  return s + static_cast<double>(cell) * Matrix3::Identity();
}

SolidBody BentBricks::body() {
  SolidBody body{LagrangeBasis(chebyshev_points(4, 0, 1)), {}, {}};
  for (std::size_t segment = 0; segment < 2; ++segment) {
    SolidCell cell;
    cell.segment = segment;
    if (segment == 1) cell.magnetization = Vector3(0, 0, 75e3);
    for (const double z : body.nodes.nodes())
      for (const double y : body.nodes.nodes())
        for (const double x : body.nodes.nodes()) {
          const Vector3 X(2e-3 * x - 1e-3, 2e-3 * y - 1e-3,
                          10e-3 * (z + static_cast<double>(segment)));
          cell.reference.push_back(X);
          cell.current.push_back(current(X));
          cell.jacobian.push_back(deformation_gradient(X).determinant());
          cell.cauchy_stress.push_back(stress(X, segment));
        }
    body.cells.push_back(std::move(cell));
  }
  return body;
}

}  // namespace ciliaval::test

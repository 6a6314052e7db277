// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/analytic/oracles/bent_rods.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "problem/lagrange.h"

namespace ciliaval::oracle {

Cilium paper_cilium() {
  return {3e-3, {{"base", 3e-3, 0.1e6, 0.49, 0}, {"magnet", 17e-3, 3e6, 0.49, 75e3}}};
}

Deformation sampled(const Cilium& cilium, const Shape& shape, std::size_t n) {
  std::vector<Centreline::Piece> pieces;
  const std::vector<double> interfaces = cilium.interfaces();
  for (std::size_t i = 0; i + 1 < interfaces.size(); ++i) {
    Centreline::Piece piece{chebyshev_points(n, interfaces[i], interfaces[i + 1]), {}};
    for (const double S : piece.S) piece.states.push_back(shape(S));
    pieces.push_back(std::move(piece));
  }
  return {Centreline(std::move(pieces)), nullptr};
}

Deformation straight(const Cilium& cilium) {
  return {straight_centreline(cilium.interfaces()), nullptr};
}

Shape arc(double curvature, double azimuth) {
  const Vector3 e(std::cos(azimuth), std::sin(azimuth), 0);
  const Vector3 axis = Vector3::UnitZ().cross(e);
  return [=](double S) {
    const double theta = curvature * S;
    CentrelinePoint point;
    point.rotation = Eigen::AngleAxisd(theta, axis);
    point.position = ((1 - std::cos(theta)) * e + std::sin(theta) * Vector3::UnitZ()) / curvature;
    point.derivative = point.normal();
    point.curvature = curvature * axis;
    return point;
  };
}

Shape contorted() {
  const double twist = 60;
  const double bend = 45;
  const auto frame = [=](double S) {
    return Quaternion(Eigen::AngleAxisd(twist * S, Vector3::UnitZ()) *
                      Eigen::AngleAxisd(bend * S, Vector3::UnitY()));
  };
  const auto derivative = [=](double S) {
    return Vector3(frame(S) * Vector3(0.15, -0.1, 1.2 + 8 * S));
  };
  return [=](double S) {
    CentrelinePoint point;
    point.rotation = frame(S);
    point.derivative = derivative(S);
    point.curvature = twist * Vector3::UnitZ() +
                      bend * (Eigen::AngleAxisd(twist * S, Vector3::UnitZ()) * Vector3::UnitY());
    point.position.setZero();
    if (S > 0) {
      const QuadratureRule rule = gauss_legendre(30, 0, S);
      for (std::size_t i = 0; i < rule.nodes.size(); ++i)
        point.position += rule.weights[i] * derivative(rule.nodes[i]);
    }
    return point;
  };
}

Shape moved(const Shape& shape, const Quaternion& rotation, const Vector3& shift) {
  return [=](double S) {
    CentrelinePoint point = shape(S);
    point.position = rotation * point.position + shift;
    point.derivative = rotation * point.derivative;
    point.curvature = rotation * point.curvature;
    point.rotation = rotation * point.rotation;
    return point;
  };
}

Vector3 flux_density(const FieldModel& model, const Cilium& cilium, const Deformation& deformation,
                     const Vector3& x) {
  return model.field(cilium, deformation, std::span(&x, 1)).B.front();
}

double relative_difference(const Vector3& a, const Vector3& b) {
  return (a - b).norm() / b.norm();
}

void record(const std::string& name, double value) {
  std::printf("[ measured ] %-60s %.2e\n", name.c_str(), value);
  char text[32];
  std::snprintf(text, sizeof text, "%.3e", value);
  ::testing::Test::RecordProperty(name, text);
}

}  // namespace ciliaval::oracle

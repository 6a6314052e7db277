// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/analytic/oracles/bent_rods.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "analytic/sources/dipole.h"
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

Vector3 by_dipoles(const Cilium& cilium, const Centreline& line, const Vector3& x) {
  const QuadratureRule rule = gauss_legendre(8);
  const CrossSection& section = cilium.section;
  Vector3 B = Vector3::Zero();
  const auto add = [&](const CentrelinePoint& p, double X, double Y, double dV,
                       const Vector3& of_segment) {
    const Vector3 at = p.position + p.rotation * Vector3(X, Y, 0);
    Matrix3 F;
    F << p.rotation * Vector3::UnitX(), p.rotation * Vector3::UnitY(),
        p.derivative + p.curvature.cross(at - p.position);
    B += analytic::sources::dipole_field(dV * F * of_segment, x - at);
  };
  const std::vector<double>& breaks = line.breaks();
  for (std::size_t piece = 0; piece + 1 < breaks.size(); ++piece) {
    const Segment& own =
        cilium.segments[cilium.segment_at((breaks[piece] + breaks[piece + 1]) / 2)];
    if (!is_magnetic(own)) continue;
    constexpr int parts = 12;
    const double dS = (breaks[piece + 1] - breaks[piece]) / (2 * parts);
    for (int part = 0; part < parts; ++part)
      for (std::size_t s = 0; s < rule.nodes.size(); ++s) {
        const CentrelinePoint p =
            line.at(breaks[piece] + dS * (2 * part + 1 + rule.nodes[s]), piece);
        for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
          const double weight = dS * rule.weights[s] * rule.weights[i];
          if (section.shape == CrossSection::Shape::rectangle) {
            const Eigen::Rotation2Dd turn(section.orientation);
            for (std::size_t j = 0; j < rule.nodes.size(); ++j) {
              const Eigen::Vector2d at = turn * Eigen::Vector2d(section.width / 2 * rule.nodes[i],
                                                                section.height / 2 * rule.nodes[j]);
              add(p, at.x(), at.y(), section.width * section.height / 4 * weight * rule.weights[j],
                  magnetization(own));
            }
            continue;
          }
          const double inner = section.inner_diameter / 2;
          const double half = (cilium.diameter / 2 - inner) / 2;
          const double r = inner + half * (1 + rule.nodes[i]);
          constexpr int around = 32;
          for (int k = 0; k < around; ++k)
            add(p, r * std::cos(2 * std::numbers::pi * k / around),
                r * std::sin(2 * std::numbers::pi * k / around),
                half * r * 2 * std::numbers::pi / around * weight, magnetization(own));
        }
      }
  }
  return B;
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

Deformation bent_cilium() {
  return sampled(paper_cilium(), arc(60, 0.5));
}

}  // namespace ciliaval::oracle
